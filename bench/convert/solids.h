// SPDX-License-Identifier: Apache-2.0
/// @file
/// Inner boxes of a model as occluders of a scene.
#ifndef OCC_BENCH_SOLIDS_H
#define OCC_BENCH_SOLIDS_H

#include "model.h"
#include "obs.h"

/// What to look for.
typedef struct solids_wish {
    uint32_t most;        ///< Boxes of the model as a whole.
    uint32_t most_placed; ///< Boxes of each mesh that has several places.
    uint32_t max_cells;
    double coverage, max_hole;
    bool within; ///< The eye is in rooms of the model, beyond whose walls all may be solid.
} solids_wish;

/// What came of it.
typedef struct solids_report {
    uint32_t boxes;      ///< Of the model as a whole.
    uint32_t closed;     ///< Of these, proven without tolerance.
    uint32_t of_meshes;  ///< Found for meshes that have several places.
    uint32_t carried;    ///< Of these, occluders, all places in sum.
    double coverage;     ///< Of the model's silhouette, or its layers, from 0 to 1.
    double largest_hole; ///< The widest opening that a grid of a box took for closed.
} solids_report;

/// Adds inner boxes of a model's opaque triangles to a scene whose path is there already: no eye of
/// it is in the same space as one of them. They are part of no object. On failure says why on
/// standard error and returns false.
bool solids_find(const model *m, const solids_wish *wish, obs_scene *scene, solids_report *report);

#endif
