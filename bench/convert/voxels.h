// SPDX-License-Identifier: Apache-2.0
/// @file
/// The space of a model as a grid of cells: where surface is, and what each free cell looks at.
#ifndef OCC_BENCH_VOXELS_H
#define OCC_BENCH_VOXELS_H

#include "model.h"

/// Directions that a free cell looks along: 6 axes and 8 diagonals.
enum { VOXEL_DIRECTIONS = 14 };

/// Cells of a grid one cell wider than the model on each side. voxels_free() it when done.
typedef struct voxel_grid {
    int size[3]; ///< Cells along each axis.
    size_t count;
    double origin[3]; ///< The outer corner of cell (0, 0, 0).
    double cell;      ///< Edge of a cell.
    bool *solid;      ///< A triangle touches the cell: no free cell is touched by one.
    uint16_t *detail; ///< Triangles whose middle is in the cell, up to 65535.
    uint8_t *hits;    ///< For a free cell: directions along which surface is met.
    int8_t *facing;   ///< For a free cell: of these, fronts less backs of one-sided surface.
    uint8_t *room;    ///< Cells to the nearest solid one or the border, diagonals as 1, up to 255.
    uint16_t *height; ///< Free cells below down to surface, itself counted; UINT16_MAX: none.
} voxel_grid;

/// Makes the grid with about `cells` cells. Returns false when memory runs out.
bool voxels_build(const model *m, double cells, voxel_grid *out);

/// The index of the cell that holds a point, or SIZE_MAX outside the grid.
size_t voxels_at(const voxel_grid *grid, const double point[3]);

/// The middle of a cell.
void voxels_center(const voxel_grid *grid, size_t index, double out[3]);

/// Frees what a grid holds and zeroes it.
void voxels_free(voxel_grid *grid);

#endif
