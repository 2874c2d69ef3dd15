// SPDX-License-Identifier: Apache-2.0
/// @file
/// Two pictures of a frame against each other, and who is missing in the second one.
#ifndef OCC_BENCH_IMAGE_COMPARE_H
#define OCC_BENCH_IMAGE_COMPARE_H

#include "image_parts.h"

/// A picture: see image_gl.h. Rows from the bottom.
typedef struct image_pixels {
    uint32_t width, height;
    uint32_t *front, *veil;
} image_pixels;

/// Makes an empty one. Returns false when memory runs out.
bool image_pixels_create(image_pixels *p, uint32_t width, uint32_t height);

void image_pixels_free(image_pixels *p);

/// An object of which some shows in the first picture only.
typedef struct image_missing {
    uint32_t object, pixels;
    uint32_t x, y;     ///< The first of these pixels, from the upper left.
    uint32_t triangle; ///< The model's triangle that shows there; UINT32_MAX: a see-through one.
} image_missing;

/// What came out. image_difference_free() it when done.
typedef struct image_difference {
    uint64_t pixels; ///< That differ, for whatever reason.
    uint32_t count;
    image_missing *missing; ///< Ascending by object.
    uint64_t unnamed;       ///< Pixels of which it is not known who is missing.
} image_difference;

/// Fills `veil` with what an object's see-through triangles alone give, as in a picture. On failure
/// says why and returns false.
typedef bool image_veil_probe(void *state, uint32_t object, uint32_t *veil);

/// Compares pixel by pixel. `is_drawn[i]` is whether object i is in the second picture. On
/// failure says why and returns false.
bool image_compare(const image_pixels *full, const image_pixels *culled, const image_parts *parts,
                   const bool *is_drawn, image_veil_probe *probe, void *state,
                   image_difference *out);

void image_difference_free(image_difference *d);

/// Writes a picture as PNG, every triangle in a colour of its own. On failure says why and returns
/// false.
bool image_write_png(const image_pixels *p, const char *path);

#endif
