// SPDX-License-Identifier: Apache-2.0
/// @file
/// A long way through the free cells of a model.
#ifndef OCC_BENCH_ROUTE_H
#define OCC_BENCH_ROUTE_H

#include "voxels.h"

/// Which cells may be walked through.
typedef struct route_rule {
    int hits;      ///< At least so many of the VOXEL_DIRECTIONS meet surface…
    int facing;    ///< … and at least so many more of these its front than its back.
    int max_above; ///< At most so many cells above a floor; 0: a floor is not asked for.
} route_rule;

/// Cells in order, each next to the one before. All zero is empty; route_free() it when done.
typedef struct route {
    size_t *cells;
    size_t count;
    double length; ///< In cell edges.
    bool *allowed; ///< For each cell of the grid: it obeys the rule and has room all around.
} route;

/// Finds a way about as long as any within a connected region that obeys a rule, keeping off walls
/// and near the upper half of the heights allowed. Of the larger regions, it is the one around
/// which most triangles are. Finding none is not a failure: the route is then empty. Returns false
/// when memory runs out.
bool route_find(const voxel_grid *grid, const route_rule *rule, route *out);

/// Frees what a route holds and zeroes it.
void route_free(route *r);

#endif
