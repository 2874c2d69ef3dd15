// SPDX-License-Identifier: Apache-2.0
/// @file
/// The triangles of a scene's objects, in the order in which they are drawn.
#ifndef OCC_BENCH_IMAGE_PARTS_H
#define OCC_BENCH_IMAGE_PARTS_H

#include "division.h"
#include "obs.h"

/// Every triangle of a model has one place: object after object, in each the opaque ones first. All
/// zero is empty; image_parts_free() it when done.
typedef struct image_parts {
    uint32_t object_count, triangle_count, vertex_count;
    const float (*positions)[3]; ///< The model's, which must outlive this.
    uint32_t (*corners)[3];      ///< Vertices of the triangle at each place.
    uint32_t *triangles;         ///< Its number in the model.
    uint32_t *first;             ///< Object i has the places from first[i] to before first[i + 1],
    uint32_t *see_through;       ///< of which light passes from see_through[i] on.
    uint32_t see_through_count;  ///< Triangles, of all objects.
} image_parts;

/// Whether a scene's objects are those of a division: as many, and every box the same bits. If not,
/// says so on standard error, with what to do about it; `scene_name` and `model_name` stand for the
/// files.
bool image_parts_agree(const division *d, const obs_scene *scene, const char *scene_name,
                       const char *model_name);

/// Puts the triangles in order. Returns false when memory runs out.
bool image_parts_make(const model *m, const division *d, image_parts *out);

/// The object that the triangle at a place belongs to.
uint32_t image_parts_object(const image_parts *parts, uint32_t place);

void image_parts_free(image_parts *parts);

#endif
