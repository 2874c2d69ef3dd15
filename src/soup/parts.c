// SPDX-License-Identifier: Apache-2.0
#include "soup/parts.h"

#include "log.h"
#include "soup/union_find.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST_CUTS 64u // of one piece in a row; a pathological nest of pieces stays one part

// What hangs together by its vertices.
typedef struct piece {
    float min[3], max[3];
    uint32_t root; // the least vertex
    uint32_t part;
} piece;

typedef struct cutter {
    occ_hooks *hooks;
    piece *pieces;
    occ_array *parts;
} cutter;

static void extend(float min[3], float max[3], const float low[3], const float high[3])
{
    for (int k = 0; k < 3; k++) {
        min[k] = fminf(min[k], low[k]);
        max[k] = fmaxf(max[k], high[k]);
    }
}

#define BY_LOWEST(axis)                                                                            \
    static int by_lowest_##axis(const void *a, const void *b)                                      \
    {                                                                                              \
        const piece *p = a, *q = b;                                                                \
        if (p->min[axis] != q->min[axis]) return p->min[axis] < q->min[axis] ? -1 : 1;             \
        return p->root < q->root ? -1 : 1;                                                         \
    }
BY_LOWEST(0)
BY_LOWEST(1)
BY_LOWEST(2)

static bool add_part(cutter *c, uint32_t first, uint32_t end)
{
    occ_part *part = occ_array_push(c->hooks, c->parts);
    if (!part) return false;
    *part =
        (occ_part){.min = {INFINITY, INFINITY, INFINITY}, .max = {-INFINITY, -INFINITY, -INFINITY}};
    for (uint32_t i = first; i < end; i++) {
        c->pieces[i].part = c->parts->count - 1;
        extend(part->min, part->max, c->pieces[i].min, c->pieces[i].max);
    }
    return true;
}

static bool cut(cutter *c, uint32_t first, uint32_t end, uint32_t axis, uint32_t vain,
                uint32_t depth);

// Cuts the pieces [first, end) wherever a plane across an axis has room between them. `vain` axes
// before this one had none. The recursion is MOST_CUTS deep at most.
static bool cut(cutter *c, uint32_t first, uint32_t end, uint32_t axis, uint32_t vain,
                uint32_t depth)
{
    static int (*const order[3])(const void *, const void *) = {by_lowest_0, by_lowest_1,
                                                                by_lowest_2};
    if (end - first == 1 || vain == 3 || depth == MOST_CUTS) return add_part(c, first, end);
    qsort(c->pieces + first, end - first, sizeof *c->pieces, order[axis]);
    float reach = c->pieces[first].max[axis];
    uint32_t start = first;
    for (uint32_t i = first + 1; i < end; i++) {
        if (c->pieces[i].min[axis] > reach) {
            if (!cut(c, start, i, (axis + 1) % 3, 1, depth + 1)) return false;
            start = i;
        }
        reach = fmaxf(reach, c->pieces[i].max[axis]);
    }
    uint32_t next = start == first ? vain + 1 : 1;
    return cut(c, start, end, (axis + 1) % 3, next, depth + 1);
}

// Numbers the pieces in order of their least vertex; `piece_of` has a number for each vertex.
static uint32_t number_pieces(const occ_mesh *mesh, uint32_t *piece_of)
{
    for (uint32_t v = 0; v < mesh->vertices; v++)
        piece_of[v] = v;
    for (uint32_t t = 0; t < mesh->triangles; t++) {
        occ_union_join(piece_of, mesh->corner[t][0], mesh->corner[t][1]);
        occ_union_join(piece_of, mesh->corner[t][1], mesh->corner[t][2]);
    }
    for (uint32_t v = 0; v < mesh->vertices; v++)
        piece_of[v] = occ_union_root(piece_of, v);
    uint32_t count = 0;
    for (uint32_t v = 0; v < mesh->vertices; v++) // a root comes before what hangs from it
        piece_of[v] = piece_of[v] == v ? count++ : piece_of[piece_of[v]];
    return count;
}

static void bound_pieces(const occ_mesh *mesh, const uint32_t *piece_of, piece *pieces,
                         uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        pieces[i] =
            (piece){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, i, 0};
    for (uint32_t v = 0; v < mesh->vertices; v++) {
        piece *p = &pieces[piece_of[v]];
        extend(p->min, p->max, mesh->at[v], mesh->at[v]);
    }
}

// Sorts the triangles by part; a part without triangles (of vertices whose triangles were all
// skipped) stays empty.
static void deal_triangles(const occ_mesh *mesh, const uint32_t *piece_of, const uint32_t *part_of,
                           occ_parts *parts)
{
    occ_part *part = parts->part.data;
    for (uint32_t t = 0; t < mesh->triangles; t++)
        part[part_of[piece_of[mesh->corner[t][0]]]].count++;
    uint32_t first = 0;
    for (uint32_t i = 0; i < parts->part.count; i++) {
        part[i].first = first;
        first += part[i].count;
        part[i].count = 0;
    }
    for (uint32_t t = 0; t < mesh->triangles; t++) {
        occ_part *p = &part[part_of[piece_of[mesh->corner[t][0]]]];
        parts->triangle[p->first + p->count++] = t;
    }
}

static bool cut_pieces(occ_hooks *hooks, const occ_mesh *mesh, bool whole, uint32_t *piece_of,
                       occ_parts *parts)
{
    uint32_t count = number_pieces(mesh, piece_of);
    piece *pieces = occ_alloc(hooks, count * sizeof *pieces);
    uint32_t *part_of = occ_alloc(hooks, count * sizeof *part_of);
    cutter c = {hooks, pieces, &parts->part};
    bool done = pieces && part_of;
    if (done) {
        bound_pieces(mesh, piece_of, pieces, count);
        done = whole ? add_part(&c, 0, count) : cut(&c, 0, count, 0, 0, 0);
    }
    if (done) {
        for (uint32_t i = 0; i < count; i++)
            part_of[pieces[i].root] = pieces[i].part;
        deal_triangles(mesh, piece_of, part_of, parts);
    }
    occ_free(hooks, pieces, count * sizeof *pieces);
    occ_free(hooks, part_of, count * sizeof *part_of);
    return done;
}

occ_result occ_parts_build(occ_hooks *hooks, const occ_mesh *mesh, bool whole, occ_parts *parts)
{
    *parts = (occ_parts){.part = OCC_ARRAY(occ_part), .triangles = mesh->triangles};
    if (!mesh->triangles) return OCC_SUCCESS;
    size_t size = mesh->vertices * sizeof(uint32_t);
    uint32_t *piece_of = occ_alloc(hooks, size);
    parts->triangle = occ_alloc(hooks, mesh->triangles * sizeof *parts->triangle);
    bool done = piece_of && parts->triangle && cut_pieces(hooks, mesh, whole, piece_of, parts);
    occ_free(hooks, piece_of, size);
    if (done) return OCC_SUCCESS;
    occ_parts_free(hooks, parts);
    return occ_fail(hooks, OCC_ERROR_OUT_OF_MEMORY, "no memory for the parts of a mesh");
}

void occ_parts_free(occ_hooks *hooks, occ_parts *parts)
{
    occ_array_free(hooks, &parts->part);
    occ_free(hooks, parts->triangle, parts->triangles * sizeof *parts->triangle);
    parts->triangle = NULL;
}
