// SPDX-License-Identifier: Apache-2.0
#include "soup/cuboids.h"

#include <stdlib.h>

// Axes that are grown together, one group after another: bits 0 to 2 are the axes.
#define ORDERS 13
static const uint8_t orders[ORDERS][3] = {{7, 0, 0}, {3, 4, 0}, {5, 2, 0}, {6, 1, 0}, {1, 6, 0},
                                          {2, 5, 0}, {4, 3, 0}, {1, 2, 4}, {1, 4, 2}, {2, 1, 4},
                                          {2, 4, 1}, {4, 1, 2}, {4, 2, 1}};

static bool is_all_solid(const occ_voxels *v, const occ_cuboid *c)
{
    uint64_t cells = 1;
    for (int k = 0; k < 3; k++)
        cells *= c->high[k] - c->low[k];
    return occ_solid_count(v, c->low, c->high) == cells;
}

// Moves one face outward by `by` cells if what that adds is solid.
static bool push_face(const occ_voxels *v, occ_cuboid *c, int face, uint32_t by)
{
    int k = face / 2;
    occ_cuboid slab = *c;
    if (face % 2) {
        if (v->grid.size[k] - 1 - c->high[k] < by) return false;
        slab.low[k] = c->high[k];
        slab.high[k] = c->high[k] + by;
    } else {
        if (c->low[k] <= by) return false;
        slab.high[k] = c->low[k];
        slab.low[k] = c->low[k] - by;
    }
    if (!is_all_solid(v, &slab)) return false;
    if (face % 2) {
        c->high[k] += by;
    } else {
        c->low[k] -= by;
    }
    return true;
}

// Grows the faces of some axes in turn, each by the same number of cells at a time, until none can
// move. Strides halve, so that a face goes as far as it can.
static void grow_axes(const occ_voxels *v, occ_cuboid *c, uint8_t axes, uint32_t stride)
{
    for (; stride; stride /= 2) {
        bool moved = true;
        while (moved) {
            moved = false;
            for (int face = 0; face < 6; face++)
                if (axes >> face / 2 & 1) moved |= push_face(v, c, face, stride);
        }
    }
}

// Alone an axis may take long strides; several would not stay even.
static uint32_t first_stride(const occ_voxels *v, uint8_t axes, uint32_t depth)
{
    if (axes & (axes - 1)) return depth / 4 + 1;
    uint32_t stride = 1, k = axes == 1 ? 0 : axes == 2 ? 1 : 2;
    while (stride < v->grid.size[k] / 2)
        stride *= 2;
    return stride;
}

static void grow_seed(const occ_voxels *v, uint32_t cell, const uint8_t order[3], occ_cuboid *c)
{
    uint32_t at[3], depth = v->state[cell];
    bool even = (order[0] & (order[0] - 1)) != 0;
    occ_cell_place(v, cell, at);
    for (int k = 0; k < 3; k++) {
        // All cells nearer than `depth` are solid.
        uint32_t reach = even && (order[0] >> k & 1) ? depth - 1 : 0;
        c->low[k] = at[k] - reach;
        c->high[k] = at[k] + reach + 1;
    }
    for (int i = 0; i < 3; i++)
        if (order[i]) grow_axes(v, c, order[i], first_stride(v, order[i], depth));
    grow_axes(v, c, 7, 1);
}

// --- seeds ---------------------------------------------------------------------------------------

// The deepest cell of each block of cells; UINT32_MAX where none is solid.
static uint32_t deepest_in(const occ_voxels *v, const uint32_t low[3], uint32_t side)
{
    uint32_t best = UINT32_MAX, at[3], high[3];
    uint8_t depth = 0;
    for (int k = 0; k < 3; k++)
        high[k] = low[k] + side < v->grid.size[k] ? low[k] + side : v->grid.size[k];
    for (at[2] = low[2]; at[2] < high[2]; at[2]++)
        for (at[1] = low[1]; at[1] < high[1]; at[1]++)
            for (at[0] = low[0]; at[0] < high[0]; at[0]++) {
                uint32_t c = occ_cell_at(v, at);
                if (v->state[c] <= depth) continue;
                depth = v->state[c];
                best = c;
            }
    return best;
}

// Appends the deepest cells of blocks of `side` cells; returns how many.
static uint32_t list_seeds(const occ_voxels *v, uint32_t side, uint32_t *seeds)
{
    uint32_t count = 0, low[3];
    for (low[2] = 0; low[2] < v->grid.size[2]; low[2] += side)
        for (low[1] = 0; low[1] < v->grid.size[1]; low[1] += side)
            for (low[0] = 0; low[0] < v->grid.size[0]; low[0] += side) {
                uint32_t seed = deepest_in(v, low, side);
                if (seed == UINT32_MAX) continue;
                if (seeds) seeds[count] = seed;
                count++;
            }
    return count;
}

typedef struct grow_job {
    const occ_voxels *voxels;
    const uint32_t *seeds;
    uint32_t count, parts;
    occ_cuboid *out;
} grow_job;

static void grow_some(void *context, uint32_t part)
{
    const grow_job *job = context;
    uint32_t end = occ_part_first(job->count, job->parts, part + 1);
    for (uint32_t i = occ_part_first(job->count, job->parts, part); i < end; i++)
        for (uint32_t k = 0; k < ORDERS; k++)
            grow_seed(job->voxels, job->seeds[i], orders[k], &job->out[ORDERS * i + k]);
}

static int by_cells(const void *a, const void *b)
{
    const occ_cuboid *p = a, *q = b;
    for (int k = 0; k < 3; k++) {
        if (p->low[k] != q->low[k]) return p->low[k] < q->low[k] ? -1 : 1;
        if (p->high[k] != q->high[k]) return p->high[k] < q->high[k] ? -1 : 1;
    }
    return 0;
}

static uint32_t drop_equal(occ_cuboid *at, uint32_t count)
{
    uint32_t kept = 0;
    qsort(at, count, sizeof *at, by_cells);
    for (uint32_t i = 0; i < count; i++)
        if (!kept || by_cells(&at[kept - 1], &at[i]) != 0) at[kept++] = at[i];
    return kept;
}

occ_result occ_cuboids_find(occ_hooks *hooks, const occ_voxels *voxels, uint32_t seeds,
                            occ_team *team, occ_array *out)
{
    uint32_t side = 2, count;
    while ((count = list_seeds(voxels, side, NULL)) > seeds)
        side += side / 2;
    if (!count) return OCC_SUCCESS;
    uint32_t *list = occ_alloc(hooks, count * sizeof *list);
    occ_cuboid *place = occ_array_extend(hooks, out, (size_t)ORDERS * count);
    if (list && place) {
        grow_job job = {voxels, list, list_seeds(voxels, side, list), OCC_MOST_PARTS, place};
        occ_do_parts(team, job.parts, grow_some, &job);
        out->count += drop_equal(place, ORDERS * count);
    }
    occ_free(hooks, list, count * sizeof *list);
    return list && place ? OCC_SUCCESS : OCC_ERROR_OUT_OF_MEMORY;
}
