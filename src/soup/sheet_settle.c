// SPDX-License-Identifier: Apache-2.0
#include "soup/sheet_settle.h"

#include "soup/sides.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_HULL = 64 }; // corners of a hull before it is reduced to those of a sheet

// A point in the plane as it is seen, with its third coordinate.
typedef struct spot {
    float at[2], drop;
} spot;

occ_array occ_settle_spots(void)
{
    return OCC_ARRAY(spot);
}

// --- places --------------------------------------------------------------------------------------

static int by_place(const void *a, const void *b)
{
    const occ_sheet_place *p = a, *q = b;
    return p->at < q->at ? -1 : p->at > q->at;
}

occ_result occ_sort_places(occ_grower *g)
{
    const uint32_t *vertex = g->vertices.data;
    uint32_t n = g->vertices.count;
    for (int k = 0; k < 2; k++) {
        g->places[k].count = 0;
        occ_sheet_place *place = occ_array_extend(g->hooks, &g->places[k], n);
        if (!place) return OCC_ERROR_OUT_OF_MEMORY;
        for (uint32_t i = 0; i < n; i++) {
            const float *at = g->surface->mesh.at[vertex[i]];
            place[i] = (occ_sheet_place){at[k ? g->plane->v : g->plane->u], at[g->plane->drop]};
        }
        qsort(place, n, sizeof *place, by_place);
        uint32_t kept = 0;
        for (uint32_t i = 0; i < n; i++)
            if (!i || place[i].at != place[i - 1].at) place[kept++] = place[i];
        g->places[k].count = kept;
    }
    return OCC_SUCCESS;
}

// The first place that is not below a value.
static uint32_t find_place(const occ_grower *g, int k, double value)
{
    const occ_sheet_place *place = g->places[k].data;
    uint32_t first = 0, end = g->places[k].count;
    while (first < end) {
        uint32_t middle = first + (end - first) / 2;
        if ((double)place[middle].at < value) {
            first = middle + 1;
        } else {
            end = middle;
        }
    }
    return first;
}

// A coordinate as a float: a vertex's, if one is next to it; else rounded towards the middle.
static float settle(const occ_grower *g, int k, double value, double middle, int rounding)
{
    static const int steps[] = {0, 1, 4, 32};
    double slack = 10.0 * g->tolerance;
    uint32_t i = find_place(g, k, value - slack);
    if (i < g->places[k].count) {
        float at = ((const occ_sheet_place *)g->places[k].data)[i].at;
        if ((double)at <= value + slack) return at;
    }
    float out = (float)value, inward = value < middle ? INFINITY : -INFINITY;
    if (value < middle ? (double)out < value : (double)out > value) out = nextafterf(out, inward);
    for (int step = 0; step < steps[rounding]; step++)
        out = nextafterf(out, inward);
    return out + 0.0f; // -0 becomes 0
}

// --- points that a sheet may have for corners ----------------------------------------------------

static bool add_spot(occ_grower *g, float u, float v, float drop)
{
    spot *out = occ_array_push(g->hooks, &g->spots);
    if (out) *out = (spot){{u, v}, drop};
    return out != NULL;
}

static bool spots_of_corners(occ_grower *g, const occ_region *r, const double middle[2],
                             int rounding)
{
    float drop = ((const occ_sheet_place *)g->places[0].data)[0].drop;
    for (uint32_t i = 0; i < r->count; i++)
        if (!add_spot(g, settle(g, 0, r->at[i][0], middle[0], rounding),
                      settle(g, 1, r->at[i][1], middle[1], rounding), drop))
            return false;
    return true;
}

// Where a region is above a place of its coordinate `across`: from low to high.
static bool chord(const occ_region *r, int across, double at, double *low, double *high)
{
    *low = INFINITY;
    *high = -INFINITY;
    for (uint32_t i = 0; i < r->count; i++) {
        const double *p = r->at[i], *q = r->at[(i + 1) % r->count];
        double s = p[across] - at, t = q[across] - at;
        if ((s < 0.0 && t < 0.0) || (s > 0.0 && t > 0.0)) continue;
        double share = s == t ? 0.0 : s / (s - t);
        double on = p[!across] + share * (q[!across] - p[!across]);
        *low = occ_least(*low, on);
        *high = occ_most(*high, on);
        if (s != t) continue;
        *low = occ_least(*low, q[!across]);
        *high = occ_most(*high, q[!across]);
    }
    return *low < *high;
}

static bool spots_of_columns(occ_grower *g, const occ_region *r, const double middle[2],
                             int rounding)
{
    int along = g->along, across = !along;
    const occ_sheet_place *place = g->places[across].data;
    double from = INFINITY, to = -INFINITY, slack = 10.0 * g->tolerance;
    for (uint32_t i = 0; i < r->count; i++) {
        from = occ_least(from, r->at[i][across]);
        to = occ_most(to, r->at[i][across]);
    }
    for (uint32_t i = find_place(g, across, from - slack);
         i < g->places[across].count && (double)place[i].at <= to + slack; i++) {
        double low, high, at = occ_most(from, occ_least((double)place[i].at, to));
        if (!chord(r, across, at, &low, &high)) continue;
        const float end[2] = {settle(g, along, low, middle[along], rounding),
                              settle(g, along, high, middle[along], rounding)};
        for (int k = 0; k < 2; k++)
            if (!add_spot(g, along ? place[i].at : end[k], along ? end[k] : place[i].at,
                          place[i].drop))
                return false;
    }
    return true;
}

static bool spots_of_vertices(occ_grower *g, const occ_region *r)
{
    const uint32_t *vertex = g->vertices.data;
    g->work += g->vertices.count;
    for (uint32_t i = 0; i < g->vertices.count; i++) {
        const float *at = g->surface->mesh.at[vertex[i]];
        float p[2];
        bool inside = true;
        occ_sheet_flatten(g->plane, at, p);
        for (uint32_t k = 0; k < r->count && inside; k++) {
            const double *a = r->at[k], *b = r->at[(k + 1) % r->count];
            double e[2] = {b[0] - a[0], b[1] - a[1]};
            double height = e[0] * ((double)p[1] - a[1]) - e[1] * ((double)p[0] - a[0]);
            inside = height >= -10.0 * g->tolerance * (fabs(e[0]) + fabs(e[1]));
        }
        if (inside && !add_spot(g, p[0], p[1], at[g->plane->drop])) return false;
    }
    return true;
}

// --- their hull ----------------------------------------------------------------------------------

static int by_position(const void *a, const void *b)
{
    const spot *p = a, *q = b;
    if (p->at[0] != q->at[0]) return p->at[0] < q->at[0] ? -1 : 1;
    return p->at[1] < q->at[1] ? -1 : p->at[1] > q->at[1];
}

// The hull of sorted spots, counterclockwise, without corners in line (Andrew, Another efficient
// algorithm for convex hulls in two dimensions, 1979).
static uint32_t make_hull(const spot *in, uint32_t count, spot *out)
{
    uint32_t n = 0;
    for (int half = 0; half < 2; half++) {
        uint32_t start = n;
        for (uint32_t i = 0; i < count; i++) {
            const spot *next = &in[half ? count - 1 - i : i];
            while (n >= start + 2 && occ_turn(out[n - 2].at, out[n - 1].at, next->at) <= 0)
                n--;
            if (n > start && !by_position(&out[n - 1], next)) continue;
            out[n++] = *next;
        }
        if (n) n--; // it begins the other half
    }
    return n;
}

// Twice the area that a hull loses without a corner.
static double loss_of(const spot *hull, uint32_t count, uint32_t corner)
{
    const float *p = hull[corner].at, *a = hull[(corner + count - 1) % count].at,
                *b = hull[(corner + 1) % count].at;
    return ((double)p[0] - (double)a[0]) * ((double)b[1] - (double)a[1]) -
           ((double)p[1] - (double)a[1]) * ((double)b[0] - (double)a[0]);
}

static uint32_t reduce_hull(spot *hull, uint32_t count)
{
    if (count > MOST_HULL) { // evenly
        for (uint32_t i = 0; i < MOST_HULL; i++)
            hull[i] = hull[(uint64_t)i * count / MOST_HULL];
        count = MOST_HULL;
    }
    for (; count > OCC_SHEET_CORNERS; count--) {
        uint32_t least = 0;
        for (uint32_t i = 1; i < count; i++)
            if (loss_of(hull, count, i) < loss_of(hull, count, least)) least = i;
        memmove(hull + least, hull + least + 1, (count - least - 1) * sizeof *hull);
    }
    return count;
}

static bool add_spots(occ_grower *g, const occ_region *region, int rounding)
{
    double middle[2] = {0.0, 0.0};
    for (uint32_t i = 0; i < region->count; i++)
        for (int k = 0; k < 2; k++)
            middle[k] += region->at[i][k] / (double)region->count;
    g->spots.count = 0;
    if (g->lattice == OCC_LATTICE_VERTICES) return spots_of_vertices(g, region);
    if (g->lattice == OCC_LATTICE_COLUMNS) return spots_of_columns(g, region, middle, rounding);
    return spots_of_corners(g, region, middle, rounding);
}

occ_result occ_settle_region(occ_grower *g, const occ_region *region, int rounding,
                             occ_sheet *sheet, bool *settled)
{
    *settled = false;
    if (!add_spots(g, region, rounding)) return OCC_ERROR_OUT_OF_MEMORY;
    uint32_t count = g->spots.count;
    if (count < 3) return OCC_SUCCESS;
    if (!occ_array_extend(g->hooks, &g->spots, count + (size_t)2)) return OCC_ERROR_OUT_OF_MEMORY;
    spot *in = g->spots.data, *hull = in + count;
    qsort(in, count, sizeof *in, by_position);
    uint32_t corners = reduce_hull(hull, make_hull(in, count, hull));
    if (corners < 3) return OCC_SUCCESS;
    *sheet = (occ_sheet){.corner_count = corners, .sides = g->desc->sides};
    for (uint32_t i = 0; i < corners; i++) {
        sheet->corner[i][g->plane->u] = hull[i].at[0];
        sheet->corner[i][g->plane->v] = hull[i].at[1];
        sheet->corner[i][g->plane->drop] = hull[i].drop;
    }
    *settled = true;
    return OCC_SUCCESS;
}
