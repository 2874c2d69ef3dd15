// SPDX-License-Identifier: Apache-2.0
#include "soup/grow.h"

#include "box.h"
#include "rounding.h"

#include <math.h>
#include <string.h>

#define REACH       3.0    // cells that a face may move
#define LEAST_STEP  0x1p-8 // cells
#define NEAR_MARGIN 0.25   // cells; where cells are smallest, floats are 2^-5 of one apart

// --- from cells to the world ---------------------------------------------------------------------

static bool is_aligned(const occ_inner_grid *g)
{
    for (int j = 0; j < 3; j++)
        for (int k = 0; k < 3; k++)
            if (g->axis[j][k] != (j == k ? 1.0f : 0.0f)) return false;
    return true;
}

static bool aligned_box(const occ_inner_grid *g, const double low[3], const double high[3],
                        occ_box *box)
{
    memset(box, 0, sizeof *box);
    for (int k = 0; k < 3; k++) {
        double a = (low[k] + (double)g->origin[k]) * (double)g->cell[k];
        double b = (high[k] + (double)g->origin[k]) * (double)g->cell[k];
        box->center[k] = occ_nearest(0.5 * (a + b));
        double left = (double)box->center[k] - a, right = b - (double)box->center[k];
        double half = left < right ? left : right;
        if (!(half > 0.0)) return false;
        box->axis[k][k] = occ_round_down(half);
    }
    return true;
}

// From and to are in cells.
static bool world_box(const occ_voxels *v, const double low[3], const double high[3], occ_box *box)
{
    double middle[3], center[3];
    if (is_aligned(&v->grid)) {
        if (!aligned_box(&v->grid, low, high, box)) return false;
        return !occ_box_check(box);
    }
    for (int k = 0; k < 3; k++)
        middle[k] = 0.5 * (low[k] + high[k]);
    occ_voxels_lead_back(v, middle, center);
    for (int j = 0; j < 3; j++) {
        box->center[j] = occ_nearest(center[j]);
        for (int k = 0; k < 3; k++)
            box->axis[k][j] =
                occ_nearest(v->inverse[j][k] * 0.5 * (high[k] - low[k]) * (1.0 - 0x1p-20));
    }
    return !occ_box_check(box);
}

static void cell_bounds(const occ_cuboid *cells, double low[3], double high[3])
{
    for (int k = 0; k < 3; k++) {
        low[k] = cells->low[k];
        high[k] = cells->high[k];
    }
}

bool occ_grow_start(const occ_voxels *voxels, const occ_cuboid *cells, occ_box *box)
{
    double low[3], high[3];
    cell_bounds(cells, low, high);
    return world_box(voxels, low, high, box);
}

// --- growing -------------------------------------------------------------------------------------

typedef struct grower {
    const occ_voxels *voxels;
    const occ_mesh *mesh;
    const occ_near_triangle *near;
    uint32_t count;
    double low[3], high[3]; // the best so far, in cells,
    occ_box box;            // and in the world
    double least[3], most[3];
} grower;

// Whether a box may be; else `*stopper` is a triangle that enters it, or NULL.
static bool is_free(grower *g, const double low[3], const double high[3], occ_box *box,
                    const occ_near_triangle **stopper)
{
    occ_ready_box ready;
    *stopper = NULL;
    if (!world_box(g->voxels, low, high, box)) return false;
    occ_ready_box_make(box, &ready);
    if (ready.flat) return false;
    for (uint32_t i = 0; i < g->count; i++) {
        const occ_near_triangle *n = &g->near[i];
        bool apart = false;
        for (int k = 0; k < 3; k++)
            apart |= n->low[k] > high[k] + NEAR_MARGIN || n->high[k] < low[k] - NEAR_MARGIN;
        if (apart) continue;
        const float *corner[3];
        for (int c = 0; c < 3; c++)
            corner[c] = occ_mesh_corner(g->mesh, n->triangle, c);
        if (!occ_ready_box_entered(&ready, corner)) continue;
        *stopper = n;
        return false;
    }
    return true;
}

// Puts a face somewhere, if a box may be there.
static bool try_face(grower *g, int face, double at, const occ_near_triangle **stopper)
{
    double low[3], high[3];
    occ_box box;
    memcpy(low, g->low, sizeof low);
    memcpy(high, g->high, sizeof high);
    if (face % 2) {
        high[face / 2] = at;
    } else {
        low[face / 2] = at;
    }
    if (!is_free(g, low, high, &box, stopper)) return false;
    memcpy(g->low, low, sizeof low);
    memcpy(g->high, high, sizeof high);
    g->box = box;
    return true;
}

// Moves a face by a step; or, if a triangle stops that, to where the triangle begins.
static bool move_face(grower *g, int face, double step)
{
    int k = face / 2;
    double from = face % 2 ? g->high[k] : g->low[k];
    double to = face % 2 ? occ_least(from + step, g->most[k]) : occ_most(from - step, g->least[k]);
    const occ_near_triangle *stopper;
    if (fabs(to - from) < LEAST_STEP) return false;
    if (try_face(g, face, to, &stopper)) return true;
    if (!stopper) return false;
    double edge = face % 2 ? stopper->low[k] : stopper->high[k];
    bool ahead = face % 2 ? edge > from && edge < to : edge < from && edge > to;
    if (!ahead || fabs(edge - from) < LEAST_STEP * 0.5) return false;
    return try_face(g, face, edge, &stopper);
}

static void move_faces(grower *g)
{
    double step = 1.0;
    while (step >= LEAST_STEP) {
        bool moved = true;
        while (moved) {
            moved = false;
            for (int face = 0; face < 6; face++)
                moved |= move_face(g, face, step);
        }
        step *= 0.5;
    }
}

static occ_result gather_near(occ_hooks *hooks, const occ_voxels *v, const occ_triangles *t,
                              const grower *g, occ_array *room)
{
    room->count = 0;
    for (uint32_t i = 0; i < t->count; i++) {
        occ_near_triangle n = {{INFINITY, INFINITY, INFINITY},
                               {-INFINITY, -INFINITY, -INFINITY},
                               occ_triangle_at(t, i)};
        bool apart = false;
        for (int c = 0; c < 3; c++) {
            double at[3];
            occ_voxels_lead(v, occ_mesh_corner(t->mesh, n.triangle, c), at);
            for (int k = 0; k < 3; k++) {
                n.low[k] = occ_least(n.low[k], at[k]);
                n.high[k] = occ_most(n.high[k], at[k]);
            }
        }
        for (int k = 0; k < 3; k++)
            apart |= n.low[k] > g->most[k] + 1.0 || n.high[k] < g->least[k] - 1.0;
        if (apart) continue;
        occ_near_triangle *place = occ_array_push(hooks, room);
        if (!place) return OCC_ERROR_OUT_OF_MEMORY;
        *place = n;
    }
    return OCC_SUCCESS;
}

// The box of cells, or where its rounding does not fit, one a little smaller.
static bool start(grower *g)
{
    const occ_near_triangle *stopper;
    double shrink = 0x1p-6;
    for (int i = 0; i < 4; i++, shrink *= 2.0) {
        if (is_free(g, g->low, g->high, &g->box, &stopper)) return true;
        for (int k = 0; k < 3; k++) {
            g->low[k] += shrink;
            g->high[k] -= shrink;
        }
    }
    return false;
}

occ_result occ_grow_box(occ_hooks *hooks, const occ_voxels *voxels, const occ_triangles *triangles,
                        const occ_cuboid *cells, occ_array *room, occ_box *box, bool *grown)
{
    grower g = {.voxels = voxels, .mesh = triangles->mesh};
    cell_bounds(cells, g.low, g.high);
    for (int k = 0; k < 3; k++) {
        g.least[k] = g.low[k] - REACH;
        g.most[k] = g.high[k] + REACH;
    }
    *grown = false;
    if (gather_near(hooks, voxels, triangles, &g, room)) return OCC_ERROR_OUT_OF_MEMORY;
    g.near = room->data;
    g.count = room->count;
    if (!start(&g)) return OCC_SUCCESS;
    move_faces(&g);
    *box = g.box;
    *grown = true;
    return OCC_SUCCESS;
}

uint32_t occ_find_intruder(const occ_triangles *triangles, const occ_box *box)
{
    float min[3], max[3];
    occ_ready_box ready;
    occ_box_bounds(box, min, max);
    occ_ready_box_make(box, &ready);
    for (uint32_t i = 0; i < triangles->count; i++) {
        uint32_t t = occ_triangle_at(triangles, i);
        const float *corner[3];
        bool apart = false;
        for (int c = 0; c < 3; c++)
            corner[c] = occ_mesh_corner(triangles->mesh, t, c);
        for (int k = 0; k < 3 && !apart; k++)
            apart = (corner[0][k] < min[k] && corner[1][k] < min[k] && corner[2][k] < min[k]) ||
                    (corner[0][k] > max[k] && corner[1][k] > max[k] && corner[2][k] > max[k]);
        if (!apart && occ_ready_box_entered(&ready, corner)) return t;
    }
    return UINT32_MAX;
}
