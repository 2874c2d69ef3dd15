// SPDX-License-Identifier: Apache-2.0
// Which cells of a grid are solid: neither touched by the surface nor reached from outside.
#ifndef OCC_SOUP_SOLID_H
#define OCC_SOUP_SOLID_H

#include "soup/overlap.h"
#include "soup/voxels.h"

// Floods the free cells from the outermost ones and from those around the points given. With
// `closing` the flood keeps that many cells away from the surface, and in the end comes closer by
// one more than that: what it can only get to through a narrow opening stays dry.
//
//     reached ........ #touched# ...        # touched   . reached   x solid
//             .......#           #...
//             .......# xxxxxxxxx    .... <- an opening narrower than the flood
//             .......#           #...
//
// If the outside is solid, the outermost cells are walls instead.
//
// A point in a touched cell stands for the free cells nearby that a straight way leads to without
// meeting a triangle, or, if there is none, for all of those nearby.
void occ_solid_flood(occ_voxels *voxels, const occ_triangles *triangles, bool outside_solid,
                     const float *points, uint32_t count);

// Whether all of a mesh is inside the outermost cells.
bool occ_solid_encloses(const occ_voxels *voxels, const occ_mesh *mesh);

// Says whether a group of solid cells, any of which is `cell`, is to be kept.
typedef occ_result (*occ_solid_judge)(void *context, const occ_voxels *voxels, uint32_t cell,
                                      bool *kept);

// Puts before `judge` the largest groups of solid cells that hang together by their faces, at most
// OCC_MOST_GROUPS. Then the state of a cell is its distance in cells, diagonals counted as 1, to
// one that is not solid (up to 255): 0 for those that are not, or not kept.
#define OCC_MOST_GROUPS 256u
occ_result occ_solid_settle(occ_hooks *hooks, occ_voxels *voxels, occ_solid_judge judge,
                            void *context);

// Whether a box, which no triangle enters, holds the middle of a solid cell: then all of it is in
// that cell's region of space. After the flood.
bool occ_solid_meets(const occ_voxels *voxels, const occ_ready_box *box);

// Makes of `work` the number of solid cells from the first cell to each, in all three directions.
// After the settling. Returns the number of all of them.
uint32_t occ_solid_sum(occ_voxels *voxels);

// How many cells of the box [low, high) are solid. No `low` may be 0: the outermost cells are
// never solid. After the sums.
static inline uint32_t occ_solid_count(const occ_voxels *v, const uint32_t low[3],
                                       const uint32_t high[3])
{
    size_t x0 = low[0] - 1u, x1 = high[0] - 1u, y0 = (low[1] - 1u) * v->step[1],
           y1 = (high[1] - 1u) * v->step[1], z0 = (low[2] - 1u) * v->step[2],
           z1 = (high[2] - 1u) * v->step[2];
    const uint32_t *s = v->work;
    return s[x1 + y1 + z1] - s[x0 + y1 + z1] - s[x1 + y0 + z1] - s[x1 + y1 + z0] + s[x0 + y0 + z1] +
           s[x0 + y1 + z0] + s[x1 + y0 + z0] - s[x0 + y0 + z0];
}

#endif
