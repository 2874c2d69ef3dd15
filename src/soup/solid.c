// SPDX-License-Identifier: Apache-2.0
#include "soup/solid.h"

#include "soup/sides.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NEARBY 2 // cells around a point within the surface

static bool is_outermost(const occ_voxels *v, const uint32_t at[3])
{
    for (int k = 0; k < 3; k++)
        if (at[k] == 0 || at[k] + 1 == v->grid.size[k]) return true;
    return false;
}

// --- the flood -----------------------------------------------------------------------------------

// Marks what is within `closing` cells along one axis of a cell that has one of `bits`.
static void thicken_line(const occ_voxels *v, size_t first, int axis, uint8_t bits)
{
    uint32_t count = v->grid.size[axis], reach = v->grid.closing, last = UINT32_MAX;
    size_t step = v->step[axis];
    for (uint32_t i = 0; i < count; i++) {
        if (v->state[first + i * step] & bits) last = i;
        if (last != UINT32_MAX && i - last <= reach) v->state[first + i * step] |= OCC_CELL_SEEN;
    }
    last = UINT32_MAX;
    for (uint32_t i = count; i-- > 0;) {
        if (v->state[first + i * step] & bits) last = i;
        if (last != UINT32_MAX && last - i <= reach) v->state[first + i * step] |= OCC_CELL_SEEN;
    }
}

static void seen_to_blocked(const occ_voxels *v)
{
    for (uint32_t c = 0; c < v->count; c++)
        if (v->state[c] & OCC_CELL_SEEN)
            v->state[c] = (uint8_t)((v->state[c] & ~OCC_CELL_SEEN) | OCC_CELL_BLOCKED);
}

// Blocks every cell that is within `closing` cells of a touched one along all axes.
static void block_cells(const occ_voxels *v)
{
    for (int axis = 0; axis < 3; axis++) {
        int p = (axis + 1) % 3, q = (axis + 2) % 3;
        uint8_t bits = axis ? OCC_CELL_BLOCKED : OCC_CELL_TOUCHED;
        for (uint32_t i = 0; i < v->grid.size[p]; i++)
            for (uint32_t j = 0; j < v->grid.size[q]; j++)
                thicken_line(v, i * v->step[p] + j * v->step[q], axis, bits);
        seen_to_blocked(v);
    }
}

static uint32_t push_reached(const occ_voxels *v, uint32_t cell, uint32_t end, uint8_t walls)
{
    if (v->state[cell] & (walls | OCC_CELL_REACHED)) return end;
    v->state[cell] |= OCC_CELL_REACHED;
    v->work[end] = cell;
    return end + 1;
}

// Goes on from the cells work[first, end) to their neighbours, until there are no more or `steps`
// are done. The first `outermost` cells of the list are all those on it that lack a neighbour.
// Returns the new end.
static uint32_t spread(const occ_voxels *v, uint32_t first, uint32_t outermost, uint32_t end,
                       uint32_t steps, uint8_t walls)
{
    for (uint32_t step = 0; step < steps && first < end; step++)
        for (uint32_t stop = end; first < stop; first++) {
            uint32_t at[3] = {1, 1, 1}, cell = v->work[first];
            if (first < outermost) occ_cell_place(v, cell, at);
            for (int k = 0; k < 3; k++) {
                if (at[k] > 0) end = push_reached(v, cell - (uint32_t)v->step[k], end, walls);
                if (at[k] + 1 < v->grid.size[k])
                    end = push_reached(v, cell + (uint32_t)v->step[k], end, walls);
            }
        }
    return end;
}

// Puts all outermost cells on the list, whatever they are: beyond them all is free.
static uint32_t push_outermost(const occ_voxels *v)
{
    uint32_t end = 0, at[3];
    for (at[2] = 0; at[2] < v->grid.size[2]; at[2]++)
        for (at[1] = 0; at[1] < v->grid.size[1]; at[1]++) {
            bool whole = at[2] == 0 || at[2] + 1 == v->grid.size[2] || at[1] == 0 ||
                         at[1] + 1 == v->grid.size[1];
            uint32_t stride = whole ? 1 : v->grid.size[0] - 1;
            for (at[0] = 0; at[0] < v->grid.size[0]; at[0] += stride) {
                uint32_t cell = occ_cell_at(v, at);
                v->state[cell] |= OCC_CELL_REACHED;
                v->work[end++] = cell;
            }
        }
    return end;
}

// --- points of free space ------------------------------------------------------------------------

// Whether a straight line between two points meets a triangle. In doubt it does.
static bool is_cut(const occ_triangles *t, const float p[3], const float q[3])
{
    for (uint32_t i = 0; i < t->count; i++) {
        uint32_t triangle = occ_triangle_at(t, i);
        const float *c[3];
        bool apart = false;
        for (int j = 0; j < 3; j++)
            c[j] = occ_mesh_corner(t->mesh, triangle, j);
        for (int k = 0; k < 3 && !apart; k++) {
            float low = fminf(p[k], q[k]), high = fmaxf(p[k], q[k]);
            apart = (c[0][k] < low && c[1][k] < low && c[2][k] < low) ||
                    (c[0][k] > high && c[1][k] > high && c[2][k] > high);
        }
        if (apart) continue;
        int a = occ_side_of_plane(c[0], c[1], c[2], p), b = occ_side_of_plane(c[0], c[1], c[2], q);
        if (a && a == b) continue;
        bool plus = false, minus = false;
        for (int j = 0; j < 3; j++) {
            int side = occ_side_of_plane(p, q, c[j], c[(j + 1) % 3]);
            plus |= side > 0;
            minus |= side < 0;
        }
        if (!(plus && minus)) return true;
    }
    return false;
}

// The free cells around a point, or those that it can see. Returns how many there are to see.
static uint32_t push_nearby(const occ_voxels *v, const occ_triangles *t, const float point[3],
                            const uint32_t middle[3], bool blind, uint32_t *end)
{
    uint32_t found = 0, at[3];
    for (int i = 0; i < (2 * NEARBY + 1) * (2 * NEARBY + 1) * (2 * NEARBY + 1); i++) {
        int offset[3] = {i % 5 - NEARBY, i / 5 % 5 - NEARBY, i / 25 - NEARBY};
        double to[3], world[3];
        bool inside = true;
        for (int k = 0; k < 3; k++) {
            int64_t place = (int64_t)middle[k] + offset[k];
            inside = inside && place > 0 && place + 1 < (int64_t)v->grid.size[k];
            at[k] = (uint32_t)place;
            to[k] = (double)place + 0.5;
        }
        if (!inside || (v->state[occ_cell_at(v, at)] & OCC_CELL_TOUCHED)) continue;
        occ_voxels_lead_back(v, to, world);
        float q[3] = {(float)world[0], (float)world[1], (float)world[2]};
        if (!blind && is_cut(t, point, q)) continue;
        found++;
        *end = push_reached(v, occ_cell_at(v, at), *end, OCC_CELL_TOUCHED);
    }
    return found;
}

static uint32_t push_point(const occ_voxels *v, const occ_triangles *t, const float point[3],
                           uint32_t end)
{
    double at[3];
    uint32_t cell[3];
    occ_voxels_lead(v, point, at);
    for (int k = 0; k < 3; k++) {
        if (!(at[k] >= 0.0 && at[k] < (double)v->grid.size[k])) return end; // outside, all is free
        cell[k] = (uint32_t)at[k];
    }
    if (is_outermost(v, cell)) return end;
    if (!(v->state[occ_cell_at(v, cell)] & OCC_CELL_TOUCHED))
        return push_reached(v, occ_cell_at(v, cell), end, OCC_CELL_TOUCHED);
    if (!push_nearby(v, t, point, cell, false, &end))
        (void)push_nearby(v, t, point, cell, true, &end);
    return end;
}

static void wall_outermost(const occ_voxels *v, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        v->state[v->work[i]] = OCC_CELL_TOUCHED;
}

void occ_solid_flood(occ_voxels *voxels, const occ_triangles *triangles, bool outside_solid,
                     const float *points, uint32_t count)
{
    uint32_t closing = voxels->grid.closing;
    uint8_t walls = OCC_CELL_TOUCHED;
    if (closing) {
        block_cells(voxels);
        walls |= OCC_CELL_BLOCKED;
    }
    uint32_t outermost = push_outermost(voxels), end = outermost;
    if (outside_solid) {
        wall_outermost(voxels, outermost);
        outermost = end = 0;
    }
    for (uint32_t i = 0; i < count; i++)
        end = push_point(voxels, triangles, points + 3 * (size_t)i, end);
    // A point may be nearer to the surface than the flood gets.
    end = spread(voxels, outermost, outermost, end, closing ? closing + 1 : 0, OCC_CELL_TOUCHED);
    end = spread(voxels, 0, outermost, end, UINT32_MAX, walls);
    if (!closing) return;
    // Back to the surface: all that was reached spreads once more, a few steps.
    (void)spread(voxels, 0, outermost, end, closing + 1, OCC_CELL_TOUCHED);
}

bool occ_solid_encloses(const occ_voxels *voxels, const occ_mesh *mesh)
{
    for (uint32_t i = 0; i < mesh->vertices; i++) {
        double at[3];
        occ_voxels_lead(voxels, mesh->at[i], at);
        for (int k = 0; k < 3; k++)
            if (!(at[k] > 1.0 && at[k] < (double)voxels->grid.size[k] - 1.0)) return false;
    }
    return true;
}

// --- groups --------------------------------------------------------------------------------------

typedef struct group {
    uint32_t cell, count;
} group;

static bool is_solid(uint8_t state)
{
    return !(state & (OCC_CELL_TOUCHED | OCC_CELL_REACHED));
}

static int larger_first(const void *a, const void *b)
{
    const group *p = a, *q = b;
    if (p->count != q->count) return p->count > q->count ? -1 : 1;
    return p->cell < q->cell ? -1 : 1;
}

// Sets a bit in all cells of a group, none of which has it; returns how many there are.
static uint32_t fill_group(const occ_voxels *v, uint32_t cell, uint8_t bit)
{
    uint32_t first = 0, end = 1;
    v->work[0] = cell;
    v->state[cell] |= bit;
    for (; first < end; first++)
        for (int k = 0; k < 6; k++) {
            size_t step = v->step[k / 2];
            uint32_t next = (uint32_t)(k % 2 ? v->work[first] + step : v->work[first] - step);
            if (!is_solid(v->state[next]) || (v->state[next] & bit)) continue;
            v->state[next] |= bit;
            v->work[end++] = next;
        }
    return end;
}

// The largest groups, largest first.
static occ_result list_groups(occ_hooks *hooks, const occ_voxels *v, occ_array *groups)
{
    for (uint32_t c = 0; c < v->count; c++)
        v->state[c] &= OCC_CELL_TOUCHED | OCC_CELL_REACHED;
    for (uint32_t c = 0; c < v->count; c++) {
        if (!is_solid(v->state[c]) || (v->state[c] & OCC_CELL_SEEN)) continue;
        group *g = occ_array_push(hooks, groups);
        if (!g) return OCC_ERROR_OUT_OF_MEMORY;
        *g = (group){c, fill_group(v, c, OCC_CELL_SEEN)};
        if (groups->count < 2 * OCC_MOST_GROUPS) continue;
        qsort(groups->data, groups->count, sizeof(group), larger_first);
        groups->count = OCC_MOST_GROUPS;
    }
    if (groups->count) qsort(groups->data, groups->count, sizeof(group), larger_first);
    if (groups->count > OCC_MOST_GROUPS) groups->count = OCC_MOST_GROUPS;
    return OCC_SUCCESS;
}

static uint8_t one_more(uint8_t a)
{
    return a < UINT8_MAX ? (uint8_t)(a + 1) : a;
}

// The distance from one side: a cell is one further in than the least of the neighbours before it
// (`sign` -1) or after it. Twice, from both sides, gives the distance (Rosenfeld and Pfaltz, 1966).
static void sweep(const occ_voxels *v, int sign)
{
    ptrdiff_t before[13];
    int n = 0;
    for (int i = 14; i < 27; i++)
        before[n++] = sign * ((ptrdiff_t)(i % 3 - 1) + (i / 3 % 3 - 1) * (ptrdiff_t)v->step[1] +
                              (i / 9 - 1) * (ptrdiff_t)v->step[2]);
    for (uint32_t i = 0; i < v->count; i++) {
        uint32_t c = sign < 0 ? i : v->count - 1 - i;
        if (!v->state[c]) continue;
        uint8_t least = UINT8_MAX;
        for (int k = 0; k < 13; k++) {
            uint8_t there = v->state[(ptrdiff_t)c + before[k]];
            if (there < least) least = there;
        }
        if (one_more(least) < v->state[c]) v->state[c] = one_more(least);
    }
}

occ_result occ_solid_settle(occ_hooks *hooks, occ_voxels *voxels, occ_solid_judge judge,
                            void *context)
{
    occ_array groups = OCC_ARRAY(group);
    occ_result result = list_groups(hooks, voxels, &groups);
    const group *g = groups.data;
    for (uint32_t i = 0; !result && i < groups.count; i++) {
        bool kept = false;
        result = judge(context, voxels, g[i].cell, &kept);
        if (!result && kept) (void)fill_group(voxels, g[i].cell, OCC_CELL_BLOCKED);
    }
    occ_array_free(hooks, &groups);
    for (uint32_t c = 0; c < voxels->count; c++)
        voxels->state[c] = voxels->state[c] & OCC_CELL_BLOCKED ? UINT8_MAX : 0;
    sweep(voxels, -1);
    sweep(voxels, 1);
    return result;
}

// The cells [low, high) that a box may hold the middle of.
static void cells_around(const occ_voxels *v, const occ_box *box, uint32_t low[3], uint32_t high[3])
{
    double middle[3];
    occ_voxels_lead(v, box->center, middle);
    for (int k = 0; k < 3; k++) {
        double reach = 0.5, most = (double)v->grid.size[k];
        for (int i = 0; i < 3; i++) {
            double along = 0.0;
            for (int j = 0; j < 3; j++)
                along += (double)v->grid.axis[k][j] * (double)box->axis[i][j];
            reach += fabs(along) / (double)v->grid.cell[k];
        }
        double first = floor(middle[k] - reach), end = floor(middle[k] + reach) + 1.0;
        low[k] = (uint32_t)(first > 0.0 ? occ_least(first, most) : 0.0);
        high[k] = (uint32_t)(end > 0.0 ? occ_least(end, most) : 0.0);
    }
}

bool occ_solid_meets(const occ_voxels *voxels, const occ_ready_box *box)
{
    uint32_t low[3], high[3], at[3];
    cells_around(voxels, &box->box, low, high);
    for (at[2] = low[2]; at[2] < high[2]; at[2]++)
        for (at[1] = low[1]; at[1] < high[1]; at[1]++)
            for (at[0] = low[0]; at[0] < high[0]; at[0]++) {
                double middle[3], world[3];
                if (!is_solid(voxels->state[occ_cell_at(voxels, at)])) continue;
                for (int k = 0; k < 3; k++)
                    middle[k] = at[k] + 0.5;
                occ_voxels_lead_back(voxels, middle, world);
                // Far less off by rounding than half a cell.
                float point[3] = {(float)world[0], (float)world[1], (float)world[2]};
                if (occ_ready_box_holds(box, point)) return true;
            }
    return false;
}

uint32_t occ_solid_sum(occ_voxels *voxels)
{
    uint32_t *s = voxels->work;
    for (uint32_t c = 0; c < voxels->count; c++)
        s[c] = voxels->state[c] != 0;
    for (int k = 0; k < 3; k++) {
        uint32_t step = (uint32_t)voxels->step[k], lines = step * voxels->grid.size[k];
        for (uint32_t first = 0; first < voxels->count; first += lines)
            for (uint32_t c = first + step; c < first + lines; c++)
                s[c] += s[c - step];
    }
    return s[voxels->count - 1];
}
