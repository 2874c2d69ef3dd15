// SPDX-License-Identifier: Apache-2.0
/// @file
/// A camera's way through the free space of a model.
#ifndef OCC_BENCH_PATH_H
#define OCC_BENCH_PATH_H

#include "model.h"
#include "obs.h"

/// What a path came to.
typedef struct path_report {
    const char *kind; ///< "walk", "flight", or "orbit" around a model that has no inside.
    double length;    ///< Of the way, in world units.
    double clearance; ///< The least distance from an eye to a triangle.
    double near_z, far_z;
} path_report;

/// Adds `frames` frames to a scene. The near plane is at most half as far as it would have to be to
/// cut a triangle, the far plane beyond all of them. `eye_height` is how far above floors to keep;
/// 0: 3 % of the model's width, or 10 % of its height if that is less. Returns false when memory
/// runs out.
bool path_make(const model *m, uint32_t frames, double eye_height, obs_scene *scene,
               path_report *report);

#endif
