// SPDX-License-Identifier: Apache-2.0
#include "soup/closed.h"

#include "log.h"
#include "soup/edges.h"
#include "soup/union_find.h"

#include <stdlib.h>
#include <string.h>

// What lives while closed parts are looked for.
typedef struct finder {
    occ_hooks *hooks;
    const occ_mesh *mesh;
    occ_edges edges;
    uint32_t *left;        // for each edge: triangles that are not open
    uint32_t *edge_at;     // edges of each triangle, one after another,
    uint32_t *edges_first; // from here
    uint32_t *parent;      // union-find over triangles, then over patches
    uint32_t *stack;
    size_t triangles;
    occ_closed *closed;
} finder;

static bool finder_init(finder *f)
{
    size_t t = f->triangles;
    f->left = occ_alloc(f->hooks, f->edges.room * sizeof *f->left);
    f->edge_at = occ_alloc(f->hooks, f->edges.room * sizeof *f->edge_at);
    f->edges_first = occ_alloc(f->hooks, (t + 1) * sizeof *f->edges_first);
    f->parent = occ_alloc(f->hooks, t * sizeof *f->parent);
    f->stack = occ_alloc(f->hooks, t * sizeof *f->stack);
    f->closed->patch = occ_alloc(f->hooks, t * sizeof *f->closed->patch);
    return f->left && f->edge_at && f->edges_first && f->parent && f->stack && f->closed->patch;
}

static void finder_free(finder *f)
{
    size_t t = f->triangles;
    occ_free(f->hooks, f->left, f->edges.room * sizeof *f->left);
    occ_free(f->hooks, f->edge_at, f->edges.room * sizeof *f->edge_at);
    occ_free(f->hooks, f->edges_first, (t + 1) * sizeof *f->edges_first);
    occ_free(f->hooks, f->parent, t * sizeof *f->parent);
    occ_free(f->hooks, f->stack, t * sizeof *f->stack);
    occ_edges_free(f->hooks, &f->edges);
}

static void list_edges(finder *f)
{
    const occ_edges *e = &f->edges;
    memset(f->edges_first, 0, (f->triangles + 1) * sizeof *f->edges_first);
    for (uint32_t u = 0; u < e->uses; u++)
        f->edges_first[e->use[u].triangle + 1]++;
    for (size_t t = 0; t < f->triangles; t++)
        f->edges_first[t + 1] += f->edges_first[t];
    for (uint32_t i = 0; i < e->count; i++)
        for (uint32_t u = e->first[i]; u < e->first[i + 1]; u++)
            f->edge_at[f->edges_first[e->use[u].triangle]++] = i;
    memmove(f->edges_first + 1, f->edges_first, f->triangles * sizeof *f->edges_first);
    f->edges_first[0] = 0;
}

// Puts the one triangle that an edge has left on the stack and calls it open.
static void open_last(finder *f, uint32_t edge, uint32_t *depth)
{
    uint32_t *patch = f->closed->patch;
    for (uint32_t u = f->edges.first[edge]; u < f->edges.first[edge + 1]; u++) {
        uint32_t t = f->edges.use[u].triangle;
        if (patch[t] == OCC_OPEN) continue;
        patch[t] = OCC_OPEN;
        f->stack[(*depth)++] = t;
        return;
    }
}

// Takes away triangles that are alone at an edge until there are none.
static void peel(finder *f)
{
    uint32_t depth = 0;
    memset(f->closed->patch, 0, f->triangles * sizeof *f->closed->patch);
    for (uint32_t e = 0; e < f->edges.count; e++)
        f->left[e] = f->edges.first[e + 1] - f->edges.first[e];
    for (uint32_t e = 0; e < f->edges.count; e++) {
        if (f->left[e] == 1) open_last(f, e, &depth);
        while (depth) {
            uint32_t t = f->stack[--depth];
            f->closed->open_triangles++;
            for (uint32_t i = f->edges_first[t]; i < f->edges_first[t + 1]; i++)
                if (--f->left[f->edge_at[i]] == 1) open_last(f, f->edge_at[i], &depth);
        }
    }
}

// Joins triangles into patches and numbers these in order of their first triangle.
static void join_patches(finder *f)
{
    uint32_t *patch = f->closed->patch;
    for (uint32_t t = 0; t < f->triangles; t++)
        f->parent[t] = t;
    for (uint32_t e = 0; e < f->edges.count; e++) {
        if (f->left[e] != 2) continue;
        uint32_t other = OCC_OPEN;
        for (uint32_t u = f->edges.first[e]; u < f->edges.first[e + 1]; u++) {
            uint32_t t = f->edges.use[u].triangle;
            if (patch[t] == OCC_OPEN) continue;
            if (other != OCC_OPEN) occ_union_join(f->parent, other, t);
            other = t;
        }
    }
    for (uint32_t t = 0; t < f->triangles; t++) {
        if (patch[t] == OCC_OPEN) continue;
        uint32_t root = occ_union_root(f->parent, t);
        patch[t] = root == t ? f->closed->patches++ : patch[root];
    }
}

static int by_number(const void *a, const void *b)
{
    uint32_t p = *(const uint32_t *)a, q = *(const uint32_t *)b;
    return p < q ? -1 : p > q;
}

// Writes the patches that an edge has an odd number of times to the stack; returns how many.
static uint32_t patches_at(finder *f, uint32_t edge)
{
    uint32_t count = 0, kept = 0;
    for (uint32_t u = f->edges.first[edge]; u < f->edges.first[edge + 1]; u++) {
        uint32_t p = f->closed->patch[f->edges.use[u].triangle];
        if (p != OCC_OPEN) f->stack[count++] = p;
    }
    qsort(f->stack, count, sizeof *f->stack, by_number);
    for (uint32_t i = 0; i < count; i++) {
        if (kept && f->stack[kept - 1] == f->stack[i]) {
            kept--;
        } else {
            f->stack[kept++] = f->stack[i];
        }
    }
    return kept;
}

// Joins patches that a rule connects, and numbers them anew, cluster by cluster: `parent` becomes
// the new number of each.
static bool join_clusters(finder *f)
{
    occ_closed *c = f->closed;
    for (uint32_t p = 0; p < c->patches; p++)
        f->parent[p] = p;
    for (uint32_t e = 0; e < f->edges.count; e++) {
        uint32_t count = f->left[e] > 2 ? patches_at(f, e) : 0;
        for (uint32_t i = 1; i < count; i++)
            occ_union_join(f->parent, f->stack[0], f->stack[i]);
    }
    for (uint32_t p = 0; p < c->patches; p++) {
        uint32_t root = occ_union_root(f->parent, p);
        if (root == p) {
            occ_cluster *cluster = occ_array_push(f->hooks, &c->clusters);
            if (!cluster) return false;
            *cluster = (occ_cluster){0};
            c->cluster_of[p] = c->clusters.count - 1;
        }
        c->cluster_of[p] = c->cluster_of[root];
        ((occ_cluster *)c->clusters.data)[c->cluster_of[p]].count++;
    }
    occ_cluster *cluster = c->clusters.data;
    uint32_t first = 0;
    for (uint32_t i = 0; i < c->clusters.count; i++) {
        cluster[i].first = first;
        cluster[i].words = (cluster[i].count + 63) / 64;
        first += cluster[i].count;
        cluster[i].count = 0;
    }
    for (uint32_t p = 0; p < c->patches; p++) {
        occ_cluster *own = &cluster[c->cluster_of[p]];
        f->parent[p] = own->first + own->count++;
    }
    return true;
}

static void renumber(finder *f)
{
    occ_closed *c = f->closed;
    for (uint32_t t = 0; t < f->triangles; t++)
        if (c->patch[t] != OCC_OPEN) c->patch[t] = f->parent[c->patch[t]];
    const occ_cluster *cluster = c->clusters.data;
    for (uint32_t i = 0; i < c->clusters.count; i++)
        for (uint32_t p = 0; p < cluster[i].count; p++)
            c->cluster_of[cluster[i].first + p] = i;
}

#define MOST_ROWS (2 * OCC_MOST_PATCHES) // of rules not yet reduced: more than can be left of them

static uint32_t rows_of(uint32_t rules)
{
    return rules < MOST_ROWS ? rules : MOST_ROWS;
}

// Counts the rules of each cluster, reserves room for them, and writes them in the second pass.
static bool write_rules(finder *f)
{
    occ_closed *c = f->closed;
    occ_cluster *cluster = c->clusters.data;
    for (int pass = 0; pass < 2; pass++) {
        size_t words = 0;
        for (uint32_t i = 0; pass && i < c->clusters.count; i++) {
            cluster[i].rules = words;
            if (cluster[i].count <= OCC_MOST_PATCHES)
                words += (size_t)cluster[i].words * rows_of(cluster[i].rule_count);
            cluster[i].rule_count = 0;
        }
        if (pass && words) {
            if (occ_array_reserve(f->hooks, &c->rules, words)) return false;
            memset(c->rules.data, 0, words * sizeof(uint64_t));
            c->rules.count = (uint32_t)words;
        }
        for (uint32_t e = 0; e < f->edges.count; e++) {
            uint32_t count = f->left[e] > 2 ? patches_at(f, e) : 0;
            if (!count) continue;
            occ_cluster *own = &cluster[c->cluster_of[f->stack[0]]];
            if (own->count > OCC_MOST_PATCHES) continue;
            uint64_t *row =
                pass ? (uint64_t *)c->rules.data + own->rules + (size_t)own->words * own->rule_count
                     : NULL;
            own->rule_count++;
            for (uint32_t i = 0; pass && i < count; i++) {
                uint32_t p = f->stack[i] - own->first;
                row[p / 64] |= (uint64_t)1 << p % 64;
            }
            if (pass && own->rule_count == MOST_ROWS) {
                uint64_t *rows = (uint64_t *)c->rules.data + own->rules;
                occ_reduce_rules(rows, &own->rule_count, own->words);
            }
        }
    }
    return true;
}

// Clusters of too many patches count as open.
static void open_large_clusters(finder *f)
{
    occ_closed *c = f->closed;
    const occ_cluster *cluster = c->clusters.data;
    for (uint32_t t = 0; t < f->triangles; t++) {
        if (c->patch[t] == OCC_OPEN) continue;
        if (cluster[c->cluster_of[c->patch[t]]].count <= OCC_MOST_PATCHES) continue;
        c->patch[t] = OCC_OPEN;
        c->open_triangles++;
    }
}

static bool find_closed(finder *f)
{
    occ_closed *c = f->closed;
    if (occ_edges_build(f->hooks, f->mesh, &f->edges) || !finder_init(f)) return false;
    list_edges(f);
    peel(f);
    join_patches(f);
    c->cluster_room = c->patches;
    if (!c->patches) return true;
    c->cluster_of = occ_alloc(f->hooks, c->cluster_room * sizeof *c->cluster_of);
    if (!c->cluster_of || !join_clusters(f)) return false;
    renumber(f);
    if (!write_rules(f)) return false;
    occ_cluster *cluster = c->clusters.data;
    for (uint32_t i = 0; i < c->clusters.count; i++) {
        if (cluster[i].count > OCC_MOST_PATCHES || !cluster[i].rule_count) continue;
        occ_reduce_rules((uint64_t *)c->rules.data + cluster[i].rules, &cluster[i].rule_count,
                         cluster[i].words);
    }
    open_large_clusters(f);
    return true;
}

occ_result occ_closed_build(occ_hooks *hooks, const occ_mesh *mesh, occ_closed *closed)
{
    *closed = (occ_closed){
        .mesh = mesh, .clusters = OCC_ARRAY(occ_cluster), .rules = OCC_ARRAY(uint64_t)};
    finder f = {.hooks = hooks, .mesh = mesh, .triangles = mesh->triangles, .closed = closed};
    bool done = find_closed(&f);
    finder_free(&f);
    if (done) return OCC_SUCCESS;
    occ_closed_free(hooks, closed);
    return occ_fail(hooks, OCC_ERROR_OUT_OF_MEMORY,
                    "no memory for the closed parts of %u triangles", (unsigned)mesh->triangles);
}

void occ_closed_free(occ_hooks *hooks, occ_closed *closed)
{
    if (closed->mesh)
        occ_free(hooks, closed->patch, closed->mesh->triangles * sizeof *closed->patch);
    occ_free(hooks, closed->cluster_of, closed->cluster_room * sizeof *closed->cluster_of);
    occ_array_free(hooks, &closed->clusters);
    occ_array_free(hooks, &closed->rules);
    *closed = (occ_closed){0};
}
