// SPDX-License-Identifier: Apache-2.0
// A box of cells becomes a box of the world, and its faces move outward until a triangle stops
// them.
#ifndef OCC_SOUP_GROW_H
#define OCC_SOUP_GROW_H

#include "soup/cuboids.h"
#include "soup/overlap.h"

// The box of cells, its numbers rounded inward. Along the world's axes nothing is lost.
bool occ_grow_start(const occ_voxels *voxels, const occ_cuboid *cells, occ_box *box);

// A triangle near the box that grows: its extent along the grid's axes, in cells.
typedef struct occ_near_triangle {
    double low[3], high[3];
    uint32_t triangle;
} occ_near_triangle;

// The largest box found to hold the box of cells and no point of a triangle in its interior, which
// is decided exactly. `*grown` is false if not even the box of cells is such a box, which may be
// where the axes are not the world's. `room` is an array of occ_near_triangle that may be used
// again.
occ_result occ_grow_box(occ_hooks *hooks, const occ_voxels *voxels, const occ_triangles *triangles,
                        const occ_cuboid *cells, occ_array *room, occ_box *box, bool *grown);

// The first triangle of a list that enters a box, exactly, or UINT32_MAX.
uint32_t occ_find_intruder(const occ_triangles *triangles, const occ_box *box);

#endif
