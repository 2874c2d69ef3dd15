// SPDX-License-Identifier: Apache-2.0
/// @file
/// The occlusion test of a 2019 master's thesis (octree and CUDA), as published: the warning
/// example, not a method to use. Every object is tried against the bounds of every other object. A
/// corner counts as blocked by a face if the ray from the corner towards the eye, however far
/// beyond the eye, meets the face's plane at a point whose four triangles with the face's edges
/// have, in float, the face's area to within 0.01. An object is hidden when one other object
/// blocks all eight corners.
///
/// So it hides what can be seen: when a wall is behind the camera, when the scene is small next to
/// the tolerance, when an object sticks out a little, when bounds are not solid. And it misses what
/// it should hide when the areas are so large that floats no longer add up to 0.01.
#ifndef OCC_BENCH_THESIS_H
#define OCC_BENCH_THESIS_H

#include "obs.h"

/// Fills OCC_MASK_WORDS(scene->object_count) words: bit `i % 32` of word `i / 32` is 1 where object
/// `i` is in the frustum and counts as visible. Quadratic in the objects.
void thesis_cull(const obs_scene *scene, const obs_frame *frame, uint32_t *mask_words);

/// The first half: bits of the objects whose boxes meet the frustum (tested plane by plane).
void thesis_frustum(const obs_scene *scene, const obs_frame *frame, uint32_t *mask_words);

/// The second half for one pair: whether `blocker` counts as hiding `box` from `eye`.
bool thesis_hides(const occ_box *blocker, const occ_box *box, const float eye[3]);

/// What the thesis keeps from one frame to the next. All zero: nothing yet.
typedef struct thesis_memory {
    bool holds;
    float eye[3];
} thesis_memory;

/// thesis_cull() with the thesis's cache: while the eye stays where it was, `mask_words` (always
/// the same array) is left as it is. So turning in place returns a stale answer.
void thesis_cull_remembered(thesis_memory *memory, const obs_scene *scene, const obs_frame *frame,
                            uint32_t *mask_words);

#endif
