// SPDX-License-Identifier: Apache-2.0
#include "soup/sheet_patch.h"

#include "vector.h"

#include <stdlib.h>
#include <string.h>

enum { SMALL_PLANE = 6 }; // a plane with more triangles is left to sheets in a plane
#define NOTHING UINT32_MAX

typedef struct patches {
    occ_hooks *hooks;
    const occ_surface *surface;
    const occ_sheets_desc *desc;
    uint32_t (*beside)[3]; // the one triangle across each side, or NOTHING
    bool *used;
    occ_corner_index index;
    occ_array *found;
} patches;

// A patch while it grows: its outline, as vertices, and its triangles.
typedef struct patch {
    uint32_t corner[OCC_SHEET_CORNERS], corners;
    uint32_t triangle[OCC_SHEET_CORNERS], triangles;
    double area;
} patch;

// --- neighbours ----------------------------------------------------------------------------------

// The side of a triangle that leads from or to these two vertices, or -1 if it is but a part.
static int side_at(const occ_mesh *mesh, uint32_t triangle, uint32_t low, uint32_t high)
{
    const uint32_t *c = mesh->corner[triangle];
    for (int i = 0; i < 3; i++) {
        uint32_t a = c[i], b = c[(i + 1) % 3];
        if ((a == low && b == high) || (a == high && b == low)) return i;
    }
    return -1;
}

static bool is_eligible(const occ_surface *s, uint32_t triangle)
{
    uint32_t plane = s->plane_of[triangle];
    return plane != OCC_NO_PLANE &&
           ((const occ_sheet_plane *)s->planes.data)[plane].count <= SMALL_PLANE;
}

static void find_neighbours(patches *p)
{
    const occ_mesh *mesh = &p->surface->mesh;
    const occ_edges *edges = &p->surface->edges;
    memset(p->beside, 0xff, mesh->triangles * sizeof *p->beside);
    for (uint32_t e = 0; e < edges->count; e++) {
        const occ_edge_use *use = edges->use + edges->first[e];
        if (edges->first[e + 1] - edges->first[e] != 2) continue;
        uint32_t a = use[0].triangle, b = use[1].triangle;
        int i = side_at(mesh, a, use->low, use->high), j = side_at(mesh, b, use->low, use->high);
        if (i < 0 || j < 0 || !is_eligible(p->surface, a) || !is_eligible(p->surface, b)) continue;
        bool opposed = mesh->corner[a][i] == mesh->corner[b][(j + 1) % 3];
        if (p->desc->sides == OCC_SIDES_FRONT && !opposed) continue;
        const uint32_t *labels = p->desc->labels_apart ? p->desc->labels : NULL;
        if (labels && labels[mesh->source[a]] != labels[mesh->source[b]]) continue;
        p->beside[a][i] = b;
        p->beside[b][j] = a;
    }
}

// --- growing -------------------------------------------------------------------------------------

// The sum of the cross products of an outline's corners: its normal, twice as long as its area.
static void normal_of(const occ_mesh *mesh, const patch *p, double n[3])
{
    const float *o = mesh->at[p->corner[0]];
    n[0] = n[1] = n[2] = 0.0;
    for (uint32_t i = 2; i < p->corners; i++) {
        double u[3], v[3], c[3];
        for (int k = 0; k < 3; k++) {
            u[k] = (double)mesh->at[p->corner[i - 1]][k] - (double)o[k];
            v[k] = (double)mesh->at[p->corner[i]][k] - (double)o[k];
        }
        occ_cross(u, v, c);
        for (int k = 0; k < 3; k++)
            n[k] += c[k];
    }
}

// Whether an outline is convex and nearly flat. Sets its area.
static bool is_good(const occ_mesh *mesh, patch *p)
{
    double n[3], low = 0.0, high = 0.0;
    normal_of(mesh, p, n);
    double length = sqrt(occ_dot(n, n));
    if (!(length > 0.0)) return false;
    p->area = 0.5 * length;
    for (uint32_t i = 0; i < p->corners; i++) {
        const float *a = mesh->at[p->corner[i]], *b = mesh->at[p->corner[(i + 1) % p->corners]],
                    *c = mesh->at[p->corner[(i + 2) % p->corners]];
        double u[3], v[3], w[3], turn[3];
        for (int k = 0; k < 3; k++) {
            u[k] = (double)b[k] - (double)a[k];
            v[k] = (double)c[k] - (double)b[k];
            w[k] = (double)a[k] - (double)mesh->at[p->corner[0]][k];
        }
        occ_cross(u, v, turn);
        if (!(occ_dot(turn, n) > 0.0)) return false;
        double height = occ_dot(w, n) / length;
        low = occ_least(low, height);
        high = occ_most(high, height);
    }
    return high - low <= 2.0 * OCC_PATCH_DEPTH * sqrt(p->area);
}

static bool has(const uint32_t *list, uint32_t count, uint32_t item)
{
    for (uint32_t i = 0; i < count; i++)
        if (list[i] == item) return true;
    return false;
}

// The patch with the triangle across one side of one of its triangles, if that makes a good one.
static bool extend(const patches *ps, const patch *old, uint32_t triangle, int side, patch *out)
{
    const occ_mesh *mesh = &ps->surface->mesh;
    uint32_t next = ps->beside[triangle][side];
    if (next == NOTHING || ps->used[next] || has(old->triangle, old->triangles, next)) return false;
    uint32_t a = mesh->corner[triangle][side], b = mesh->corner[triangle][(side + 1) % 3];
    const uint32_t *c = mesh->corner[next];
    uint32_t third = c[0] ^ c[1] ^ c[2] ^ a ^ b;
    if (has(old->corner, old->corners, third)) return false;
    *out = *old;
    for (uint32_t i = 0; i < old->corners; i++) {
        uint32_t p = old->corner[i], q = old->corner[(i + 1) % old->corners];
        if (!(p == a && q == b) && !(p == b && q == a)) continue;
        memmove(out->corner + i + 2, out->corner + i + 1,
                (old->corners - i - 1) * sizeof *out->corner);
        out->corner[i + 1] = third;
        out->corners++;
        out->triangle[out->triangles++] = next;
        return is_good(mesh, out);
    }
    return false;
}

static patch grow_patch(const patches *ps, uint32_t seed)
{
    patch p = {.corners = 3, .triangles = 1};
    memcpy(p.corner, ps->surface->mesh.corner[seed], 3 * sizeof *p.corner);
    p.triangle[0] = seed;
    for (bool grown = true; grown && p.corners < OCC_SHEET_CORNERS;) {
        patch best = p, tried;
        grown = false;
        for (uint32_t i = 0; i < 3 * p.triangles; i++) {
            if (!extend(ps, &p, p.triangle[i / 3], (int)(i % 3), &tried)) continue;
            if (grown && tried.area <= best.area) continue;
            best = tried;
            grown = true;
        }
        p = best;
    }
    return p;
}

// --- all patches ---------------------------------------------------------------------------------

static bool is_in_one_plane(const occ_surface *s, const patch *p)
{
    for (uint32_t i = 1; i < p->triangles; i++)
        if (s->plane_of[p->triangle[i]] != s->plane_of[p->triangle[0]]) return false;
    return true;
}

static occ_result add_patch(patches *ps, const patch *p)
{
    occ_sheet_basis basis;
    occ_found_sheet made = {.sheet = {.corner_count = p->corners, .sides = ps->desc->sides}};
    for (uint32_t i = 0; i < p->corners; i++)
        memcpy(made.sheet.corner[i], ps->surface->mesh.at[p->corner[i]],
               sizeof made.sheet.corner[i]);
    if (!occ_prove_by_corners(ps->surface, ps->desc, &ps->index, &made.sheet, &basis))
        return OCC_SUCCESS;
    made.triangle = basis.triangle;
    made.triangle_count = basis.count;
    made.label = basis.label;
    occ_found_sheet *out = occ_array_push(ps->hooks, ps->found);
    if (!out) return OCC_ERROR_OUT_OF_MEMORY;
    *out = made;
    for (uint32_t i = 0; i < p->triangles; i++)
        ps->used[p->triangle[i]] = true;
    return OCC_SUCCESS;
}

typedef struct seed {
    double area;
    uint32_t triangle;
} seed;

static int by_area(const void *a, const void *b)
{
    const seed *p = a, *q = b;
    if (p->area != q->area) return p->area > q->area ? -1 : 1;
    return p->triangle < q->triangle ? -1 : p->triangle > q->triangle;
}

static occ_result grow_patches(patches *ps)
{
    const occ_surface *s = ps->surface;
    occ_array seeds = OCC_ARRAY(seed);
    occ_result result = OCC_SUCCESS;
    for (uint32_t t = 0; !result && t < s->mesh.triangles; t++) {
        const uint32_t *beside = ps->beside[t];
        if ((beside[0] & beside[1] & beside[2]) == NOTHING) continue;
        patch one = {.corners = 3};
        double n[3];
        memcpy(one.corner, s->mesh.corner[t], 3 * sizeof *one.corner);
        normal_of(&s->mesh, &one, n);
        seed *out = occ_array_push(ps->hooks, &seeds);
        if (!out) result = OCC_ERROR_OUT_OF_MEMORY;
        if (out) *out = (seed){occ_dot(n, n), t};
    }
    const seed *at = seeds.data;
    if (!result && seeds.count) qsort(seeds.data, seeds.count, sizeof *at, by_area);
    for (uint32_t i = 0; !result && i < seeds.count; i++) {
        if (ps->used[at[i].triangle]) continue;
        patch p = grow_patch(ps, at[i].triangle);
        if (!is_in_one_plane(s, &p)) result = add_patch(ps, &p);
    }
    occ_array_free(ps->hooks, &seeds);
    return result;
}

occ_result occ_patches_find(occ_hooks *hooks, const occ_surface *surface,
                            const occ_sheets_desc *desc, bool *used, occ_array *found)
{
    patches ps = {.hooks = hooks, .surface = surface, .desc = desc, .found = found};
    ps.used = used;
    size_t bytes = surface->mesh.triangles * sizeof *ps.beside;
    ps.beside = occ_alloc(hooks, bytes);
    occ_result result = ps.beside ? occ_corner_index_build(hooks, &surface->mesh, &ps.index)
                                  : OCC_ERROR_OUT_OF_MEMORY;
    if (!result) {
        find_neighbours(&ps);
        result = grow_patches(&ps);
    }
    occ_corner_index_free(hooks, &surface->mesh, &ps.index);
    occ_free(hooks, ps.beside, bytes);
    return result;
}
