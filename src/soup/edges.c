// SPDX-License-Identifier: Apache-2.0
#include "soup/edges.h"

#include "log.h"
#include "soup/sides.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST_LOOKS ((uint64_t)1 << 28) // for vertices on edges; what is left then stays uncut

// A vertex on the inside of an edge. Lists of them are sorted by edge, then from low to high.
typedef struct cut {
    uint32_t low, high, middle;
    double along; // from low
} cut;

static int by_edge(const void *a, const void *b)
{
    const cut *p = a, *q = b;
    if (p->low != q->low) return p->low < q->low ? -1 : 1;
    if (p->high != q->high) return p->high < q->high ? -1 : 1;
    if (p->along != q->along) return p->along < q->along ? -1 : 1;
    return p->middle < q->middle ? -1 : p->middle > q->middle;
}

static int by_high(const void *a, const void *b)
{
    const occ_edge_use *p = a, *q = b;
    if (p->high != q->high) return p->high < q->high ? -1 : 1;
    return p->triangle < q->triangle ? -1 : p->triangle > q->triangle;
}

// The first cut of an edge, or where it would be.
static uint32_t find_cut(const occ_array *cuts, uint32_t low, uint32_t high)
{
    const cut *at = cuts->data;
    uint32_t first = 0, end = cuts->count;
    while (first < end) {
        uint32_t middle = first + (end - first) / 2;
        bool before = at[middle].low < low || (at[middle].low == low && at[middle].high < high);
        if (before) {
            first = middle + 1;
        } else {
            end = middle;
        }
    }
    return first;
}

// Hands each use of an edge, whole or in pieces, to `take`.
typedef void (*take_use)(occ_edges *edges, uint32_t *cursor, uint32_t a, uint32_t b,
                         uint32_t triangle);

static void count_use(occ_edges *edges, uint32_t *cursor, uint32_t a, uint32_t b, uint32_t triangle)
{
    (void)edges;
    (void)triangle;
    cursor[a < b ? a : b]++;
}

static void store_use(occ_edges *edges, uint32_t *cursor, uint32_t a, uint32_t b, uint32_t triangle)
{
    uint32_t low = a < b ? a : b;
    edges->use[cursor[low]++] = (occ_edge_use){low, a < b ? b : a, triangle};
}

static void each_use(const occ_mesh *mesh, const occ_array *cuts, occ_edges *edges,
                     uint32_t *cursor, take_use take)
{
    const cut *at = cuts->data;
    for (uint32_t t = 0; t < mesh->triangles; t++) {
        for (int i = 0; i < 3; i++) {
            uint32_t a = mesh->corner[t][i], b = mesh->corner[t][(i + 1) % 3];
            uint32_t low = a < b ? a : b, high = a < b ? b : a, from = low;
            uint32_t c = cuts->count ? find_cut(cuts, low, high) : 0;
            for (; c < cuts->count && at[c].low == low && at[c].high == high; c++) {
                take(edges, cursor, from, at[c].middle, t);
                from = at[c].middle;
            }
            take(edges, cursor, from, high, t);
        }
    }
}

// Drops pairs of uses of an edge by one triangle, and notes where edges begin.
static void group_uses(occ_edges *edges)
{
    uint32_t kept = 0;
    edges->count = 0;
    for (uint32_t i = 0; i < edges->uses;) {
        const occ_edge_use u = edges->use[i];
        uint32_t start = kept;
        while (i < edges->uses && edges->use[i].low == u.low && edges->use[i].high == u.high) {
            if (kept > start && edges->use[kept - 1].triangle == edges->use[i].triangle) {
                kept--;
            } else {
                edges->use[kept++] = edges->use[i];
            }
            i++;
        }
        if (kept > start) edges->first[edges->count++] = start;
    }
    edges->first[edges->count] = kept;
    edges->uses = kept;
}

static occ_result build(occ_hooks *hooks, const occ_mesh *mesh, const occ_array *cuts,
                        occ_edges *edges)
{
    uint32_t *cursor = occ_alloc(hooks, (mesh->vertices + (size_t)1) * sizeof *cursor);
    if (!cursor) return OCC_ERROR_OUT_OF_MEMORY;
    memset(cursor, 0, (mesh->vertices + (size_t)1) * sizeof *cursor);
    each_use(mesh, cuts, edges, cursor, count_use);
    size_t uses = 0;
    for (uint32_t v = 0; v < mesh->vertices; v++) {
        uint32_t count = cursor[v];
        cursor[v] = (uint32_t)uses;
        uses += count;
    }
    edges->room = uses + 1;
    edges->use = uses < UINT32_MAX ? occ_alloc(hooks, edges->room * sizeof *edges->use) : NULL;
    edges->first = edges->use ? occ_alloc(hooks, edges->room * sizeof *edges->first) : NULL;
    if (edges->first) {
        edges->uses = (uint32_t)uses;
        each_use(mesh, cuts, edges, cursor, store_use);
        for (uint32_t v = 0, start = 0; v < mesh->vertices; start = cursor[v++])
            qsort(edges->use + start, cursor[v] - start, sizeof *edges->use, by_high);
        group_uses(edges);
    }
    occ_free(hooks, cursor, (mesh->vertices + (size_t)1) * sizeof *cursor);
    if (edges->first) return OCC_SUCCESS;
    occ_edges_free(hooks, edges);
    return OCC_ERROR_OUT_OF_MEMORY;
}

void occ_edges_free(occ_hooks *hooks, occ_edges *edges)
{
    occ_free(hooks, edges->use, edges->room * sizeof *edges->use);
    occ_free(hooks, edges->first, edges->room * sizeof *edges->first);
    *edges = (occ_edges){0};
}

// --- vertices on edges ---------------------------------------------------------------------------

// The vertices, sorted into the cells of a grid: those of cell c are vertex[first[c]] up to
// vertex[first[c + 1]].
typedef struct seeker {
    occ_hooks *hooks;
    const occ_mesh *mesh;
    double scale; // cells for each unit
    uint32_t size[3], cells;
    uint32_t *first, *vertex;
    uint64_t looks;
    occ_array *cuts;
} seeker;

// Which cell a coordinate is in. It never falls where the coordinate rises.
static uint32_t cell_along(const seeker *s, int k, float at)
{
    double cell = ((double)at - (double)s->mesh->min[k]) * s->scale;
    return cell < (double)(s->size[k] - 1) ? (uint32_t)cell : s->size[k] - 1;
}

static uint32_t cell_of(const seeker *s, const float p[3])
{
    uint32_t z = cell_along(s, 2, p[2]) * s->size[1];
    return (z + cell_along(s, 1, p[1])) * s->size[0] + cell_along(s, 0, p[0]);
}

// Cubes, about as many as there are vertices, as fine as if these lay in a plane or finer.
static void choose_cells(seeker *s)
{
    double longest = 0.0, count = (double)s->mesh->vertices;
    for (int k = 0; k < 3; k++)
        longest = occ_most(longest, (double)s->mesh->max[k] - (double)s->mesh->min[k]);
    double fine = sqrt(count);
    for (bool fits = false; !fits; fine *= 0.9) {
        double cells = 1.0;
        s->scale = longest > 0.0 ? fine / longest : 0.0;
        for (int k = 0; k < 3; k++) {
            double extent = (double)s->mesh->max[k] - (double)s->mesh->min[k];
            s->size[k] = (uint32_t)(extent * s->scale) + 1;
            cells *= (double)s->size[k];
        }
        fits = cells <= 2.0 * count + 1.0;
        s->cells = fits ? (uint32_t)cells : 0;
    }
}

static bool sort_vertices(seeker *s)
{
    choose_cells(s);
    s->first = occ_alloc(s->hooks, (s->cells + (size_t)2) * sizeof *s->first);
    s->vertex = occ_alloc(s->hooks, s->mesh->vertices * sizeof *s->vertex);
    if (!s->first || !s->vertex) return false;
    memset(s->first, 0, (s->cells + (size_t)2) * sizeof *s->first);
    // Counted two places on, so that filling leaves each at where its cell begins.
    for (uint32_t v = 0; v < s->mesh->vertices; v++)
        s->first[cell_of(s, s->mesh->at[v]) + 2]++;
    for (uint32_t c = 0; c < s->cells; c++)
        s->first[c + 2] += s->first[c + 1];
    for (uint32_t v = 0; v < s->mesh->vertices; v++)
        s->vertex[s->first[cell_of(s, s->mesh->at[v]) + 1]++] = v;
    return true;
}

static bool add_cut(seeker *s, uint32_t low, uint32_t high, uint32_t middle)
{
    const float *a = s->mesh->at[low], *m = s->mesh->at[middle];
    double along = 0.0;
    for (int k = 0; k < 3; k++) {
        double d = (double)m[k] - (double)a[k];
        along += d < 0.0 ? -d : d;
    }
    cut *c = occ_array_push(s->hooks, s->cuts);
    if (c) *c = (cut){low, high, middle, along};
    return c != NULL;
}

static bool cut_in_cell(seeker *s, uint32_t cell, uint32_t low, uint32_t high)
{
    const float *a = s->mesh->at[low], *b = s->mesh->at[high];
    s->looks++;
    for (uint32_t i = s->first[cell]; i < s->first[cell + 1]; i++, s->looks++)
        if (occ_between(a, b, s->mesh->at[s->vertex[i]]) && !add_cut(s, low, high, s->vertex[i]))
            return false;
    return true;
}

// Finds the vertices that lie on an edge.
static bool cut_edge(seeker *s, uint32_t low, uint32_t high)
{
    const float *a = s->mesh->at[low], *b = s->mesh->at[high];
    uint32_t from[3], to[3];
    for (int k = 0; k < 3; k++) {
        from[k] = cell_along(s, k, a[k] < b[k] ? a[k] : b[k]);
        to[k] = cell_along(s, k, a[k] < b[k] ? b[k] : a[k]);
    }
    for (uint32_t z = from[2]; z <= to[2]; z++)
        for (uint32_t y = from[1]; y <= to[1]; y++)
            for (uint32_t x = from[0]; x <= to[0] && s->looks < MOST_LOOKS; x++)
                if (!cut_in_cell(s, (z * s->size[1] + y) * s->size[0] + x, low, high)) return false;
    return true;
}

static occ_result find_cuts(occ_hooks *hooks, const occ_mesh *mesh, const occ_edges *edges,
                            occ_array *cuts)
{
    seeker s = {.hooks = hooks, .mesh = mesh, .cuts = cuts};
    bool fits = sort_vertices(&s);
    for (uint32_t e = 0; fits && e < edges->count && s.looks < MOST_LOOKS; e++) {
        const occ_edge_use *u = &edges->use[edges->first[e]];
        fits = cut_edge(&s, u->low, u->high);
    }
    if (fits && cuts->count) qsort(cuts->data, cuts->count, sizeof(cut), by_edge);
    occ_free(hooks, s.first, (s.cells + (size_t)2) * sizeof *s.first);
    occ_free(hooks, s.vertex, mesh->vertices * sizeof *s.vertex);
    return fits ? OCC_SUCCESS : OCC_ERROR_OUT_OF_MEMORY;
}

occ_result occ_edges_build(occ_hooks *hooks, const occ_mesh *mesh, occ_edges *edges)
{
    occ_array cuts = OCC_ARRAY(cut);
    *edges = (occ_edges){0};
    occ_result result = build(hooks, mesh, &cuts, edges);
    if (!result) result = find_cuts(hooks, mesh, edges, &cuts);
    if (!result && cuts.count) {
        occ_edges_free(hooks, edges);
        result = build(hooks, mesh, &cuts, edges);
    }
    occ_array_free(hooks, &cuts);
    if (!result) return OCC_SUCCESS;
    occ_edges_free(hooks, edges);
    return occ_fail(hooks, result, "no memory for the edges of %u triangles",
                    (unsigned)mesh->triangles);
}
