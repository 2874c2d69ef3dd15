// SPDX-License-Identifier: Apache-2.0
#include "soup/edges.h"

#include "log.h"
#include "soup/sides.h"

#include <stdlib.h>
#include <string.h>

#define MOST_LOOKS ((uint64_t)1 << 28) // at corners that may lie on edges; what is left stays open

// A corner on the inside of an edge. Lists of them are sorted by edge, then from low to high.
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

// --- corners on edges ----------------------------------------------------------------------------

// The ends of open edges, in order along one axis.
typedef struct place {
    float at;
    uint32_t vertex;
} place;

static int by_place(const void *a, const void *b)
{
    const place *p = a, *q = b;
    if (p->at != q->at) return p->at < q->at ? -1 : 1;
    return p->vertex < q->vertex ? -1 : p->vertex > q->vertex;
}

typedef struct seeker {
    occ_hooks *hooks;
    const occ_mesh *mesh;
    place *places[3];
    uint32_t count; // of places along each axis
    uint64_t looks;
    occ_array *cuts;
} seeker;

static bool is_open(const occ_edges *edges, uint32_t e)
{
    return ((edges->first[e + 1] - edges->first[e]) & 1u) != 0;
}

// The first place that is not below `value`.
static uint32_t first_place(const place *places, uint32_t count, float value)
{
    uint32_t first = 0, end = count;
    while (first < end) {
        uint32_t middle = first + (end - first) / 2;
        if (places[middle].at < value) {
            first = middle + 1;
        } else {
            end = middle;
        }
    }
    return first;
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

// Finds the ends of other open edges that lie on this one, along the axis on which fewest may.
static bool cut_edge(seeker *s, uint32_t low, uint32_t high)
{
    const float *a = s->mesh->at[low], *b = s->mesh->at[high];
    uint32_t best = 0, first = 0, fewest = UINT32_MAX;
    for (uint32_t k = 0; k < 3; k++) {
        float from = a[k] < b[k] ? a[k] : b[k], to = a[k] < b[k] ? b[k] : a[k];
        uint32_t start = first_place(s->places[k], s->count, from), end = start;
        uint32_t past = first_place(s->places[k], s->count, to);
        for (end = past; end < s->count && s->places[k][end].at == to; end++)
            s->looks++;
        if (end - start >= fewest) continue;
        fewest = end - start;
        best = k;
        first = start;
    }
    for (uint32_t i = 0; i < fewest && s->looks < MOST_LOOKS; i++, s->looks++) {
        uint32_t v = s->places[best][first + i].vertex;
        if (occ_between(a, b, s->mesh->at[v]) && !add_cut(s, low, high, v)) return false;
    }
    return true;
}

// Notes every vertex of an open edge once.
static void gather_places(seeker *s, const occ_edges *edges, uint8_t *seen)
{
    for (uint32_t e = 0; e < edges->count; e++) {
        if (!is_open(edges, e)) continue;
        const occ_edge_use *u = &edges->use[edges->first[e]];
        for (int i = 0; i < 2; i++) {
            uint32_t v = i ? u->high : u->low;
            if (seen[v]) continue;
            seen[v] = 1;
            for (int k = 0; k < 3; k++)
                s->places[k][s->count] = (place){s->mesh->at[v][k], v};
            s->count++;
        }
    }
    for (int k = 0; k < 3; k++)
        qsort(s->places[k], s->count, sizeof(place), by_place);
}

static occ_result find_cuts(occ_hooks *hooks, const occ_mesh *mesh, const occ_edges *edges,
                            occ_array *cuts)
{
    uint32_t open = 0;
    for (uint32_t e = 0; e < edges->count; e++)
        open += is_open(edges, e);
    if (!open) return OCC_SUCCESS;
    size_t room = 2 * (size_t)open < mesh->vertices ? 2 * (size_t)open : mesh->vertices;
    seeker s = {.hooks = hooks, .mesh = mesh, .cuts = cuts};
    uint8_t *seen = occ_alloc(hooks, mesh->vertices);
    bool fits = seen != NULL;
    for (int k = 0; k < 3; k++) {
        s.places[k] = occ_alloc(hooks, room * sizeof(place));
        fits = fits && s.places[k];
    }
    if (fits) {
        memset(seen, 0, mesh->vertices);
        gather_places(&s, edges, seen);
    }
    for (uint32_t e = 0; fits && e < edges->count && s.looks < MOST_LOOKS; e++) {
        const occ_edge_use *u = &edges->use[edges->first[e]];
        if (is_open(edges, e)) fits = cut_edge(&s, u->low, u->high);
    }
    if (fits && cuts->count) qsort(cuts->data, cuts->count, sizeof(cut), by_edge);
    for (int k = 0; k < 3; k++)
        occ_free(hooks, s.places[k], room * sizeof(place));
    occ_free(hooks, seen, mesh->vertices);
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
