// SPDX-License-Identifier: Apache-2.0
// A convex region is the plane's bounds at first. One rim after the other that reaches into it,
// the nearest to the seed first, is cut off by the line that leaves the most (after Deits and
// Tedrake, Computing large convex regions of obstacle-free space, 2015, with polygons in the place
// of ellipsoids). What is left is rounded to points that are floats, and proven.
#include "soup/sheet_grow.h"

#include "soup/sheet_settle.h"
#include "soup/sides.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_CUTS = 40, ROUNDINGS = 4 };

void occ_grower_init(occ_grower *grower, occ_hooks *hooks, const occ_surface *surface,
                     const occ_sheets_desc *desc)
{
    *grower = (occ_grower){.hooks = hooks,
                           .surface = surface,
                           .desc = desc,
                           .vertices = OCC_ARRAY(uint32_t),
                           .places = {OCC_ARRAY(occ_sheet_place), OCC_ARRAY(occ_sheet_place)},
                           .spots = occ_settle_spots()};
}

// --- a plane made ready --------------------------------------------------------------------------

static int by_number(const void *a, const void *b)
{
    uint32_t p = *(const uint32_t *)a, q = *(const uint32_t *)b;
    return p < q ? -1 : p > q;
}

static occ_result list_vertices(occ_grower *g)
{
    const occ_surface *s = g->surface;
    size_t n = 3 * (size_t)g->plane->count;
    g->vertices.count = 0;
    uint32_t *at = occ_array_extend(g->hooks, &g->vertices, n), kept = 0;
    if (!at) return OCC_ERROR_OUT_OF_MEMORY;
    for (uint32_t i = 0; i < n; i++)
        at[i] = s->mesh.corner[s->triangle[g->plane->first + i / 3]][i % 3];
    qsort(at, n, sizeof *at, by_number);
    for (uint32_t i = 0; i < n; i++)
        if (!i || at[i] != at[i - 1]) at[kept++] = at[i];
    g->vertices.count = kept;
    return OCC_SUCCESS;
}

static void find_bounds(occ_grower *g)
{
    const uint32_t *at = g->vertices.data;
    for (int k = 0; k < 2; k++) {
        g->low[k] = INFINITY;
        g->high[k] = -INFINITY;
    }
    for (uint32_t i = 0; i < g->vertices.count; i++) {
        float p[2];
        occ_sheet_flatten(g->plane, g->surface->mesh.at[at[i]], p);
        for (int k = 0; k < 2; k++) {
            g->low[k] = occ_least(g->low[k], (double)p[k]);
            g->high[k] = occ_most(g->high[k], (double)p[k]);
        }
    }
    g->tolerance = 1e-10 * occ_most(g->high[0] - g->low[0], g->high[1] - g->low[1]);
}

// Whether a triangle of the plane is a segment as seen along an axis of space, which then is along
// the plane.
static bool is_along(const occ_grower *g, uint8_t axis)
{
    float p[3][2];
    uint32_t t = g->surface->triangle[g->plane->first];
    for (int c = 0; c < 3; c++) {
        const float *at = occ_mesh_corner(&g->surface->mesh, t, c);
        p[c][0] = at[(axis + 1) % 3];
        p[c][1] = at[(axis + 2) % 3];
    }
    return occ_turn(p[0], p[1], p[2]) == 0;
}

occ_result occ_grower_start(occ_grower *g, const occ_sheet_plane *plane)
{
    g->plane = plane;
    occ_result result = list_vertices(g);
    if (result) return result;
    find_bounds(g);
    bool u = is_along(g, plane->u), v = is_along(g, plane->v);
    g->lattice = OCC_LATTICE_VERTICES;
    if (u && v) g->lattice = OCC_LATTICE_ALL;
    if (u != v) {
        g->lattice = OCC_LATTICE_COLUMNS;
        g->along = v;
    }
    return g->lattice == OCC_LATTICE_VERTICES ? OCC_SUCCESS : occ_sort_places(g);
}

// --- the region ----------------------------------------------------------------------------------

// Clips a segment to a convex region. Returns how deep the middle of what is left lies in it, or 0.
static double reach_into(const occ_region *r, double a[2], double b[2])
{
    for (uint32_t i = 0; i < r->count; i++) {
        const double *p = r->at[i], *q = r->at[(i + 1) % r->count];
        double e[2] = {q[0] - p[0], q[1] - p[1]};
        double s = e[0] * (a[1] - p[1]) - e[1] * (a[0] - p[0]);
        double t = e[0] * (b[1] - p[1]) - e[1] * (b[0] - p[0]);
        if (s <= 0.0 && t <= 0.0) return 0.0;
        if (s >= 0.0 && t >= 0.0) continue;
        double *out = s < 0.0 ? a : b, share = s / (s - t);
        for (int k = 0; k < 2; k++)
            out[k] = a[k] + share * (b[k] - a[k]);
    }
    double depth = INFINITY;
    for (uint32_t i = 0; i < r->count; i++) {
        const double *p = r->at[i], *q = r->at[(i + 1) % r->count];
        double e[2] = {q[0] - p[0], q[1] - p[1]}, length = sqrt(e[0] * e[0] + e[1] * e[1]);
        double m[2] = {0.5 * (a[0] + b[0]) - p[0], 0.5 * (a[1] + b[1]) - p[1]};
        if (length > 0.0) depth = occ_least(depth, (e[0] * m[1] - e[1] * m[0]) / length);
    }
    return depth;
}

static double squared_distance(const double p[2], const double a[2], const double b[2],
                               double nearest[2])
{
    double e[2] = {b[0] - a[0], b[1] - a[1]}, square = e[0] * e[0] + e[1] * e[1];
    double t = square > 0.0 ? ((p[0] - a[0]) * e[0] + (p[1] - a[1]) * e[1]) / square : 0.0;
    t = t < 0.0 ? 0.0 : t > 1.0 ? 1.0 : t;
    for (int k = 0; k < 2; k++)
        nearest[k] = a[k] + t * e[k];
    double d[2] = {nearest[0] - p[0], nearest[1] - p[1]};
    return d[0] * d[0] + d[1] * d[1];
}

// A rim, and the part of it that is in the region.
typedef struct obstacle {
    double from[2], to[2];
    double a[2], b[2];
} obstacle;

// Whether a rim is beside the bounds of a region.
static bool is_apart(const obstacle *o, const double low[2], const double high[2])
{
    for (int k = 0; k < 2; k++)
        if ((o->a[k] <= low[k] && o->b[k] <= low[k]) || (o->a[k] >= high[k] && o->b[k] >= high[k]))
            return true;
    return false;
}

static bool nearest_obstacle(occ_grower *g, const occ_region *r, const double middle[2],
                             obstacle *out)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (uint32_t i = 0; i < r->count; i++)
        for (int k = 0; k < 2; k++) {
            low[k] = occ_least(low[k], r->at[i][k]);
            high[k] = occ_most(high[k], r->at[i][k]);
        }
    const occ_sheet_rim *rim = (const occ_sheet_rim *)g->surface->rims.data + g->plane->first_rim;
    double least = INFINITY;
    g->work += g->plane->rims;
    for (uint32_t i = 0; i < g->plane->rims; i++) {
        float p[2], q[2];
        obstacle o;
        double nearest[2];
        occ_sheet_flatten(g->plane, g->surface->mesh.at[rim[i].from], p);
        occ_sheet_flatten(g->plane, g->surface->mesh.at[rim[i].to], q);
        for (int k = 0; k < 2; k++) {
            o.from[k] = o.a[k] = (double)p[k];
            o.to[k] = o.b[k] = (double)q[k];
        }
        if (is_apart(&o, low, high)) continue;
        g->work += r->count;
        if (!(reach_into(r, o.a, o.b) > g->tolerance)) continue;
        double distance = squared_distance(middle, o.a, o.b, nearest);
        if (distance >= least) continue;
        least = distance;
        *out = o;
    }
    return least < INFINITY;
}

// A cut along a line with normal n that just leaves an obstacle out, if it leaves the seed in.
static void try_cut(const occ_grower *g, const double n[2], const obstacle *o,
                    const occ_region *seed, const occ_region *region, occ_region *best,
                    double *most)
{
    double reach = n[0] * o->a[0] + n[1] * o->a[1];
    const double *at = o->a;
    if (n[0] * o->b[0] + n[1] * o->b[1] < reach) {
        reach = n[0] * o->b[0] + n[1] * o->b[1];
        at = o->b;
    }
    for (uint32_t i = 0; i < seed->count; i++)
        if (n[0] * seed->at[i][0] + n[1] * seed->at[i][1] > reach + 10.0 * g->tolerance) return;
    occ_region left = *region;
    const double b[2] = {at[0] - n[1], at[1] + n[0]};
    occ_region_cut(&left, at, b);
    double area = occ_region_area(&left);
    if (area <= *most) return;
    *most = area;
    *best = left;
}

static bool cut_off(const occ_grower *g, const obstacle *o, const occ_region *seed,
                    const double middle[2], occ_region *region)
{
    static const double across[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    occ_region best = {.count = 0};
    double most = 0.0, nearest[2];
    const double e[2] = {o->to[0] - o->from[0], o->to[1] - o->from[1]};
    double length = hypot(e[0], e[1]);
    if (length > 0.0) {
        const double own[2] = {e[1] / length, -e[0] / length};
        try_cut(g, own, o, seed, region, &best, &most);
    }
    for (int i = 0; i < 4; i++)
        try_cut(g, across[i], o, seed, region, &best, &most);
    for (uint32_t i = 0; i < seed->count; i++) {
        const double *p = seed->at[i], *q = seed->at[(i + 1) % seed->count];
        const double f[2] = {q[0] - p[0], q[1] - p[1]};
        length = hypot(f[0], f[1]);
        if (!(length > 0.0)) continue;
        const double n[2] = {f[1] / length, -f[0] / length};
        try_cut(g, n, o, seed, region, &best, &most);
    }
    double distance = sqrt(squared_distance(middle, o->a, o->b, nearest));
    if (distance > 0.0) {
        const double n[2] = {(nearest[0] - middle[0]) / distance,
                             (nearest[1] - middle[1]) / distance};
        try_cut(g, n, o, seed, region, &best, &most);
    }
    if (!(most > 0.0)) return false;
    *region = best;
    return true;
}

static bool grow_region(occ_grower *g, const occ_region *seed, occ_region *region)
{
    double middle[2] = {0.0, 0.0};
    for (uint32_t i = 0; i < seed->count; i++)
        for (int k = 0; k < 2; k++)
            middle[k] += seed->at[i][k] / (double)seed->count;
    *region = (occ_region){.count = 4};
    for (int i = 0; i < 4; i++) {
        region->at[i][0] = i == 1 || i == 2 ? g->high[0] : g->low[0];
        region->at[i][1] = i >= 2 ? g->high[1] : g->low[1];
    }
    for (int cuts = 0; cuts < MOST_CUTS; cuts++) {
        obstacle o;
        if (!nearest_obstacle(g, region, middle, &o)) return true;
        if (!cut_off(g, &o, seed, middle, region)) return false;
    }
    return false;
}

// --- the whole -----------------------------------------------------------------------------------

occ_result occ_grower_grow(occ_grower *g, const occ_region *seed, occ_sheet *sheet,
                           occ_sheet_basis *basis, bool *grown)
{
    occ_region region;
    *grown = false;
    *basis = (occ_sheet_basis){0};
    if (!grow_region(g, seed, &region)) return OCC_SUCCESS;
    for (int rounding = 0; rounding < ROUNDINGS && !*grown; rounding++) {
        uint32_t beside;
        bool settled;
        occ_result result = occ_settle_region(g, &region, rounding, sheet, &settled);
        if (result) return result;
        if (!settled) continue;
        *grown = !occ_sheet_shape(sheet, g->desc->sides) &&
                 !occ_prove_in_plane(g->surface, g->desc, g->plane, sheet, basis, &beside);
        g->work += basis->work;
        if (g->lattice == OCC_LATTICE_VERTICES) break; // nothing was rounded
    }
    return OCC_SUCCESS;
}

void occ_grower_free(occ_grower *g)
{
    occ_array_free(g->hooks, &g->vertices);
    occ_array_free(g->hooks, &g->places[0]);
    occ_array_free(g->hooks, &g->places[1]);
    occ_array_free(g->hooks, &g->spots);
}
