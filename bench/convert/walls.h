// SPDX-License-Identifier: Apache-2.0
/// @file
/// Sheets of a model's surface as occluders of a scene.
#ifndef OCC_BENCH_WALLS_H
#define OCC_BENCH_WALLS_H

#include "division.h"
#include "obs.h"

/// What to look for.
typedef struct walls_wish {
    uint32_t most;   ///< Sheets.
    double min_area; ///< Smaller ones are left out.
    bool one_sided;  ///< Triangles are drawn from where they go counterclockwise only.
} walls_wish;

/// What came of it.
typedef struct walls_report {
    uint32_t sheets; ///< Occluders.
    uint32_t found;  ///< Sheets that there are.
    uint32_t planes; ///< Pieces of the surface in one plane each.
    double share;    ///< Of the opaque surface, from 0 to 1, that all that were found cover.
} walls_report;

/// Adds sheets of a model's opaque triangles to a scene. One that stands for triangles of one
/// object is part of it, others are part of none. On failure says why on standard error and returns
/// false.
bool walls_find(const model *m, const division *d, const walls_wish *wish, obs_scene *scene,
                walls_report *report);

#endif
