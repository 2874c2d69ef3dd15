// SPDX-License-Identifier: Apache-2.0
/// @file
/// Frames of a scene drawn whole and drawn culled: what differs, and what is saved.
#ifndef OCC_BENCH_IMAGE_RUN_H
#define OCC_BENCH_IMAGE_RUN_H

#include "image_gl.h"

#include <occlude/cull.h>

/// What to draw and how to cull.
typedef struct image_wish {
    image_gl_options gl;
    occ_cull_desc knobs;
    occ_backend backend;
    uint32_t threads;
    bool against_frustum;   ///< Compare with all that is in the frustum, not with all there is.
    const uint32_t *frames; ///< Which ones, in the file.
    uint32_t frame_count;
    const char *pictures; ///< What the names of pictures that differ begin with.
} image_wish;

/// A frame's figures. "In the frustum" is what method frustum leaves. Seen are those of them that
/// show in a pixel of the whole picture, and those of which light passes some.
typedef struct image_row {
    uint32_t frame, in_frustum, visible, seen;
    uint32_t triangles_in_frustum;
    image_pass full, culled;
    double cull_ms;
    uint64_t differing; ///< Pixels.
} image_row;

/// What came out. image_result_free() it when done.
typedef struct image_result {
    image_row *rows; ///< One for each frame wished for.
    char renderer[128];
} image_result;

/// Draws and compares. Objects that show in the whole picture alone are named on standard error,
/// with their occluders, and both pictures are written. On failure says why, zeroes `out` and
/// returns false.
bool image_run(const image_wish *wish, const obs_scene *scene, const image_parts *parts,
               image_result *out);

void image_result_free(image_result *result);

#endif
