// SPDX-License-Identifier: Apache-2.0
// Boxes of solid cells that can be made no larger.
#ifndef OCC_SOUP_CUBOIDS_H
#define OCC_SOUP_CUBOIDS_H

#include "soup/solid.h"

// The cells [low, high).
typedef struct occ_cuboid {
    uint32_t low[3], high[3];
} occ_cuboid;

// Appends to `out` (occ_cuboid) maximal boxes around some `seeds` cells, spread over the grid, that
// lie deepest in their neighbourhoods. Each seed is grown in several orders of the axes. After
// occ_solid_sum().
occ_result occ_cuboids_find(occ_hooks *hooks, const occ_voxels *voxels, uint32_t seeds,
                            occ_team *team, occ_array *out);

#endif
