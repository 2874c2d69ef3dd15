// SPDX-License-Identifier: Apache-2.0
#include "soup/voxels.h"

#include <math.h>
#include <string.h>

#define THIN_CELLS   24.0   // across the thinnest extent, if other extents can spare them
#define MOST_ACROSS  0x1p19 // the magnitude of a coordinate, in cells
#define MOST_CLOSING 64u    // cells

static double dot(const float a[3], const float p[3])
{
    return (double)a[0] * (double)p[0] + (double)a[1] * (double)p[1] + (double)a[2] * (double)p[2];
}

// m * 2^e with m from 8 to 15, not below `edge`.
static double round_edge(double edge)
{
    int exponent;
    double m = ceil(frexp(edge, &exponent) * 16.0); // 8 to 16
    return ldexp(m, exponent - 4);
}

static double cells_along(double extent, double edge)
{
    return floor(extent / edge) + 6.0; // two are begun, and two lie outside at each end
}

// The cube root, rounded down. (cbrt() may differ from one C library to the next.)
static double cube_root(double most)
{
    double root = 1.0;
    while ((root + 1.0) * (root + 1.0) * (root + 1.0) <= most)
        root += 1.0;
    return root;
}

// Edges of cells for an extent, `most` in all: cubes, but thin extents get THIN_CELLS.
static bool choose_edges(const double extent[3], const double least[3], double most, double edge[3])
{
    double longest = occ_most(extent[0], occ_most(extent[1], extent[2]));
    if (!(longest > 0.0)) return false;
    double size = longest / cube_root(most), thin = occ_least(THIN_CELLS, cube_root(most) / 3.0);
    for (int step = 0; step < 400; step++, size *= 1.0 + 0x1p-5) {
        double count = 1.0;
        for (int k = 0; k < 3; k++) {
            double own = occ_least(size, extent[k] / thin);
            edge[k] = round_edge(occ_most(occ_most(own, least[k]), longest * 0x1p-19));
            count *= cells_along(extent[k], edge[k]);
        }
        if (count <= most) return true;
    }
    return false;
}

static void frame_extent(const occ_triangles *t, const float axis[3][3], double low[3],
                         double high[3])
{
    for (int k = 0; k < 3; k++) {
        low[k] = INFINITY;
        high[k] = -INFINITY;
    }
    for (uint32_t i = 0; i < t->count; i++)
        for (int c = 0; c < 3; c++) {
            const float *p = occ_mesh_corner(t->mesh, occ_triangle_at(t, i), c);
            for (int k = 0; k < 3; k++) {
                double at = dot(axis[k], p);
                low[k] = occ_least(low[k], at);
                high[k] = occ_most(high[k], at);
            }
        }
}

// The surface is thickened by as many cells as `max_hole` leaves room for.
static void choose_closing(float max_hole, occ_inner_grid *grid)
{
    occ_voxels v = {0};
    if (!(max_hole > 0.0f)) return;
    while (grid->closing < MOST_CLOSING) {
        grid->closing++;
        if (!occ_voxels_set(&v, grid) || v.grid.hole > max_hole) {
            grid->closing--;
            return;
        }
    }
}

bool occ_grid_plan(const occ_triangles *triangles, const float axis[3][3], uint32_t most,
                   float max_hole, occ_inner_grid *grid)
{
    double low[3], high[3], extent[3], least[3], edge[3];
    frame_extent(triangles, axis, low, high);
    for (int k = 0; k < 3; k++) {
        extent[k] = high[k] - low[k];
        least[k] = occ_most(fabs(low[k]), fabs(high[k])) / MOST_ACROSS;
    }
    if (!choose_edges(extent, least, (double)most, edge)) return false;
    *grid = (occ_inner_grid){0};
    memcpy(grid->axis, axis, sizeof grid->axis);
    for (int k = 0; k < 3; k++) {
        grid->cell[k] = (float)edge[k];
        if ((double)grid->cell[k] != edge[k]) return false; // less than floats can say
        // What lies in the boundary of a cell touches the next one too; beyond that is free space.
        grid->origin[k] = (int32_t)floor(low[k] / edge[k]) - 2;
        grid->size[k] = (uint32_t)((int32_t)floor(high[k] / edge[k]) + 3 - grid->origin[k]);
    }
    choose_closing(max_hole, grid);
    occ_voxels v = {0};
    if (!occ_voxels_set(&v, grid)) return false;
    grid->hole = v.grid.hole;
    return true;
}
