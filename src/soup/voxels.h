// SPDX-License-Identifier: Apache-2.0
// A grid of cells over a part of a mesh, and which cells its surface touches.
//
// Cell edges are m * 2^e with m from 8 to 15, and cell 0 begins at a multiple of that. Both are
// chosen so that along the axes of the world every number that a box of cells has, its middle and
// its half edges included, is a float: (origin + n) * m is below 2^23.
#ifndef OCC_SOUP_VOXELS_H
#define OCC_SOUP_VOXELS_H

#include "soup/mesh.h"
#include "team.h"

#include <occlude/inner.h>

// What is known of a cell.
enum { OCC_CELL_TOUCHED = 1, OCC_CELL_REACHED = 2, OCC_CELL_BLOCKED = 4, OCC_CELL_SEEN = 8 };

#define OCC_LEAST_CELLS 4096u
#define OCC_MOST_CELLS  ((uint32_t)1 << 28)

// Room for states and work is that of the largest grid so far.
typedef struct occ_voxels {
    occ_inner_grid grid;
    double inverse[3][3]; // column k leads one cell along k, in world units
    size_t step[3];       // from a cell to the next along each axis
    uint32_t count;
    uint32_t room;
    uint8_t *state;
    uint32_t *work; // one for each cell
} occ_voxels;

// A list of triangles; NULL stands for the first `count` of the mesh.
typedef struct occ_triangles {
    const occ_mesh *mesh;
    const uint32_t *list;
    uint32_t count;
} occ_triangles;

static inline uint32_t occ_triangle_at(const occ_triangles *t, uint32_t i)
{
    return t->list ? t->list[i] : i;
}

// Plans a grid of at most `most` cells around triangles, along these axes. `closing` and `hole`
// follow from `max_hole`. False if nothing fits: the part has no extent, or lies too far from the
// origin for its size.
bool occ_grid_plan(const occ_triangles *triangles, const float axis[3][3], uint32_t most,
                   float max_hole, occ_inner_grid *grid);

// Makes ready for a grid, which may come from anywhere. False: it makes no sense.
bool occ_voxels_set(occ_voxels *voxels, const occ_inner_grid *grid);

// Whether the mesh is so near the grid, in cells, that no rounding matters. Planned grids are.
bool occ_voxels_are_near(const occ_voxels *voxels, const occ_mesh *mesh);

// Room for a grid's cells.
occ_result occ_voxels_reserve(occ_hooks *hooks, occ_voxels *voxels);

// Sets the state of every cell to OCC_CELL_TOUCHED or 0. A cell that a triangle touches, be it with
// a single point, is touched; one that a triangle comes closer to than 2^-15 of its edge may be.
void occ_voxels_mark(occ_voxels *voxels, const occ_triangles *triangles, occ_team *team);

void occ_voxels_free(occ_hooks *hooks, occ_voxels *voxels);

// A point in units of cells, from the corner of cell (0, 0, 0).
void occ_voxels_lead(const occ_voxels *voxels, const float point[3], double out[3]);

// And back. The result is off by its rounding to floats, and little more.
void occ_voxels_lead_back(const occ_voxels *voxels, const double at[3], double out[3]);

static inline uint32_t occ_cell_at(const occ_voxels *voxels, const uint32_t at[3])
{
    return (uint32_t)(at[0] + at[1] * voxels->step[1] + at[2] * voxels->step[2]);
}

static inline void occ_cell_place(const occ_voxels *voxels, uint32_t cell, uint32_t at[3])
{
    at[2] = (uint32_t)(cell / voxels->step[2]);
    at[1] = (uint32_t)(cell % voxels->step[2] / voxels->step[1]);
    at[0] = (uint32_t)(cell % voxels->step[1]);
}

#endif
