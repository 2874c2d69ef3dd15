// SPDX-License-Identifier: Apache-2.0
#include "soup/sheet_surface.h"

#include "log.h"
#include "soup/sides.h"
#include "soup/triangles.h"
#include "soup/union_find.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// --- triangles that hide -------------------------------------------------------------------------

// The mesh of a soup's opaque triangles, with the numbers that they have in the soup.
static occ_result build_opaque(occ_hooks *hooks, const occ_soup *soup, const bool *see_through,
                               occ_surface *s)
{
    size_t bytes = 3 * sizeof(uint32_t) * (size_t)soup->triangle_count;
    uint32_t *indices = occ_alloc(hooks, bytes), kept = 0;
    if (!indices) return OCC_ERROR_OUT_OF_MEMORY;
    for (uint32_t t = 0; t < soup->triangle_count; t++) {
        if (see_through[t]) continue;
        for (int c = 0; c < 3; c++)
            indices[3 * (size_t)kept + (size_t)c] = occ_soup_index(soup, t, c);
        kept++;
    }
    s->see_through = soup->triangle_count - kept;
    occ_soup opaque = *soup;
    opaque.indices = indices;
    opaque.triangle_count = kept;
    occ_result result = kept ? occ_mesh_build(hooks, &opaque, &s->mesh) : OCC_SUCCESS;
    occ_free(hooks, indices, bytes);
    for (uint32_t t = 0, place = 0, i = 0; !result && i < s->mesh.triangles; t++) {
        if (see_through[t]) continue;
        if (s->mesh.source[i] == place) s->mesh.source[i++] = t;
        place++;
    }
    return result;
}

// The axes of space along which a triangle is seen best, or false if it has no area.
static bool choose_view(const occ_mesh *mesh, uint32_t triangle, occ_sheet_plane *plane)
{
    const float *p[3];
    double e[2][3], size[3];
    for (int c = 0; c < 3; c++)
        p[c] = occ_mesh_corner(mesh, triangle, c);
    for (int k = 0; k < 6; k++)
        e[k / 3][k % 3] = (double)p[1 + k / 3][k % 3] - (double)p[0][k % 3];
    for (int k = 0; k < 3; k++)
        size[k] =
            fabs(e[0][(k + 1) % 3] * e[1][(k + 2) % 3] - e[0][(k + 2) % 3] * e[1][(k + 1) % 3]);
    int drop = size[0] > size[1] ? (size[0] > size[2] ? 0 : 2) : (size[1] > size[2] ? 1 : 2);
    for (int tries = 0; tries < 3; tries++, drop = (drop + 1) % 3) {
        float flat[3][2];
        plane->drop = (uint8_t)drop;
        plane->u = (uint8_t)((drop + 1) % 3);
        plane->v = (uint8_t)((drop + 2) % 3);
        for (int c = 0; c < 3; c++)
            occ_sheet_flatten(plane, p[c], flat[c]);
        int turn = occ_turn(flat[0], flat[1], flat[2]);
        if (!turn) continue;
        if (turn < 0) {
            plane->u = (uint8_t)((drop + 2) % 3);
            plane->v = (uint8_t)((drop + 1) % 3);
        }
        return true;
    }
    return false;
}

// --- pieces --------------------------------------------------------------------------------------

// On which side of the line from an edge's low end to its high end a triangle is, as the plane of
// `view` is seen: 1 left, -1 right. The edge is part of one of the triangle's.
static int side_of_edge(const occ_mesh *mesh, const occ_sheet_plane *view, const occ_edge_use *use)
{
    float a[2], b[2], c[2];
    int turn = 0;
    occ_sheet_flatten(view, mesh->at[use->low], a);
    occ_sheet_flatten(view, mesh->at[use->high], b);
    for (int i = 0; i < 3 && !turn; i++) {
        occ_sheet_flatten(view, occ_mesh_corner(mesh, use->triangle, i), c);
        turn = occ_turn(a, b, c);
    }
    return turn;
}

static bool is_in_plane_of(const occ_mesh *mesh, uint32_t triangle, uint32_t other)
{
    const float *p[3];
    for (int c = 0; c < 3; c++)
        p[c] = occ_mesh_corner(mesh, triangle, c);
    for (int c = 0; c < 3; c++)
        if (occ_side_of_plane(p[0], p[1], p[2], occ_mesh_corner(mesh, other, c))) return false;
    return true;
}

// Whether a triangle's corners go counterclockwise in a view.
static bool faces_front(const occ_mesh *mesh, const occ_sheet_plane *view, uint32_t triangle)
{
    float p[3][2];
    for (int c = 0; c < 3; c++)
        occ_sheet_flatten(view, occ_mesh_corner(mesh, triangle, c), p[c]);
    return occ_turn(p[0], p[1], p[2]) > 0;
}

typedef struct joining {
    occ_surface *surface;
    const uint32_t *source_label; // or NULL: all may be joined
    bool one_sided;
    uint32_t *parent; // sets of triangles
    bool *flat;       // without area
} joining;

// Whether the two triangles at an edge may be in one piece: a plane, a side each, and what the
// caller demands.
static bool may_join(const joining *j, const occ_edge_use *a, const occ_edge_use *b)
{
    const occ_mesh *mesh = &j->surface->mesh;
    occ_sheet_plane view;
    if (j->flat[a->triangle] || j->flat[b->triangle]) return false;
    if (j->source_label &&
        j->source_label[mesh->source[a->triangle]] != j->source_label[mesh->source[b->triangle]])
        return false;
    if (!is_in_plane_of(mesh, a->triangle, b->triangle)) return false;
    if (!choose_view(mesh, a->triangle, &view)) return false;
    if (j->one_sided && !faces_front(mesh, &view, b->triangle)) return false;
    return side_of_edge(mesh, &view, a) != side_of_edge(mesh, &view, b);
}

enum { CROWD = 16 }; // uses of an edge beyond these are not joined over it

// Joins the pairs that have no other choice.
static void join_only_pairs(joining *j, const occ_edge_use *use, uint32_t count)
{
    uint32_t mates[CROWD] = {0}, last[CROWD] = {0};
    for (uint32_t a = 0; a < count; a++)
        for (uint32_t b = a + 1; b < count; b++) {
            if (!may_join(j, &use[a], &use[b])) continue;
            mates[a]++;
            mates[b]++;
            last[a] = b;
            last[b] = a;
        }
    for (uint32_t a = 0; a < count; a++)
        if (mates[a] == 1 && mates[last[a]] == 1)
            occ_union_join(j->parent, use[a].triangle, use[last[a]].triangle);
}

// Joins the others, first come, first served; those first that other edges have joined already.
static void join_any_pairs(joining *j, const occ_edge_use *use, uint32_t count)
{
    bool taken[CROWD] = {false};
    for (int joined = 1; joined >= 0; joined--)
        for (uint32_t a = 0; a < count; a++)
            for (uint32_t b = a + 1; b < count && !taken[a]; b++) {
                if (taken[b] || !may_join(j, &use[a], &use[b])) continue;
                uint32_t p = occ_union_root(j->parent, use[a].triangle),
                         q = occ_union_root(j->parent, use[b].triangle);
                if (joined && p != q) continue;
                taken[a] = taken[b] = true;
                occ_union_join(j->parent, p, q);
            }
}

static void join_all(joining *j)
{
    const occ_edges *edges = &j->surface->edges;
    for (int any = 0; any < 2; any++)
        for (uint32_t e = 0; e < edges->count; e++) {
            const occ_edge_use *use = edges->use + edges->first[e];
            uint32_t count = edges->first[e + 1] - edges->first[e];
            if (count > CROWD) count = CROWD;
            if (any && count > 2) join_any_pairs(j, use, count);
            if (!any && count > 1) join_only_pairs(j, use, count);
        }
}

// --- lists ---------------------------------------------------------------------------------------

static occ_result list_planes(occ_hooks *hooks, const joining *j)
{
    occ_surface *s = j->surface;
    uint32_t n = s->mesh.triangles;
    for (uint32_t t = 0; t < n; t++) {
        uint32_t root = occ_union_root(j->parent, t);
        s->plane_of[t] = OCC_NO_PLANE;
        if (j->flat[t]) continue;
        if (root == t) { // the least of its set
            occ_sheet_plane *plane = occ_array_push(hooks, &s->planes);
            if (!plane) return OCC_ERROR_OUT_OF_MEMORY;
            *plane = (occ_sheet_plane){0};
            (void)choose_view(&s->mesh, t, plane);
            s->plane_of[t] = s->planes.count - 1;
        }
        s->plane_of[t] = s->plane_of[root];
        ((occ_sheet_plane *)s->planes.data)[s->plane_of[t]].count++;
    }
    uint32_t place = 0;
    occ_sheet_plane *planes = s->planes.data;
    for (uint32_t p = 0; p < s->planes.count; p++) {
        planes[p].first = place;
        place += planes[p].count;
        planes[p].count = 0;
    }
    for (uint32_t t = 0; t < n; t++) {
        if (s->plane_of[t] == OCC_NO_PLANE) continue;
        occ_sheet_plane *plane = &planes[s->plane_of[t]];
        s->triangle[plane->first + plane->count++] = t;
    }
    return OCC_SUCCESS;
}

// Rims are found by edge and wanted by plane.
typedef struct loose_rim {
    uint32_t plane;
    occ_sheet_rim rim;
} loose_rim;

static int by_plane(const void *a, const void *b)
{
    const loose_rim *p = a, *q = b;
    if (p->plane != q->plane) return p->plane < q->plane ? -1 : 1;
    if (p->rim.from != q->rim.from) return p->rim.from < q->rim.from ? -1 : 1;
    if (p->rim.to != q->rim.to) return p->rim.to < q->rim.to ? -1 : 1;
    return p->rim.triangle < q->rim.triangle ? -1 : p->rim.triangle > q->rim.triangle;
}

// A triangle of a plane, at the edge that is looked at.
typedef struct plane_use {
    uint32_t plane, triangle;
} plane_use;

static int by_use(const void *a, const void *b)
{
    const plane_use *p = a, *q = b;
    if (p->plane != q->plane) return p->plane < q->plane ? -1 : 1;
    return p->triangle < q->triangle ? -1 : p->triangle > q->triangle;
}

// Adds a rim for the plane of `count` uses of one edge, if it bounds that.
static bool add_rim(occ_hooks *hooks, const occ_surface *s, const occ_edge_use *edge,
                    const plane_use *use, uint32_t count, occ_array *loose)
{
    const occ_sheet_plane *view = &((const occ_sheet_plane *)s->planes.data)[use->plane];
    uint32_t any[2] = {0, 0};
    int more = 0;
    for (uint32_t i = 0; i < count; i++) {
        occ_edge_use one = {edge->low, edge->high, use[i].triangle};
        int side = side_of_edge(&s->mesh, view, &one);
        any[side > 0] = use[i].triangle;
        more += side;
    }
    if (!more) return true;
    loose_rim *out = occ_array_push(hooks, loose);
    if (!out) return false;
    *out = (loose_rim){use->plane, {edge->low, edge->high, any[1]}};
    if (more < 0) out->rim = (occ_sheet_rim){edge->high, edge->low, any[0]};
    return true;
}

static bool rims_of_edge(occ_hooks *hooks, const occ_surface *s, const occ_edge_use *use,
                         uint32_t count, occ_array *scratch, occ_array *loose)
{
    scratch->count = 0;
    if (!occ_array_extend(hooks, scratch, count)) return false;
    plane_use *at = scratch->data;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t plane = s->plane_of[use[i].triangle];
        if (plane != OCC_NO_PLANE) at[kept++] = (plane_use){plane, use[i].triangle};
    }
    if (kept > 1) qsort(at, kept, sizeof *at, by_use);
    for (uint32_t i = 0, end; i < kept; i = end) {
        end = i + 1;
        while (end < kept && at[end].plane == at[i].plane)
            end++;
        if (!add_rim(hooks, s, use, at + i, end - i, loose)) return false;
    }
    return true;
}

static bool find_rims(occ_hooks *hooks, const occ_surface *s, occ_array *loose)
{
    occ_array scratch = OCC_ARRAY(plane_use);
    bool fits = true;
    for (uint32_t e = 0; fits && e < s->edges.count; e++) {
        uint32_t first = s->edges.first[e], count = s->edges.first[e + 1] - first;
        fits = rims_of_edge(hooks, s, s->edges.use + first, count, &scratch, loose);
    }
    occ_array_free(hooks, &scratch);
    return fits;
}

static occ_result list_rims(occ_hooks *hooks, occ_surface *s)
{
    occ_array loose = OCC_ARRAY(loose_rim);
    occ_sheet_plane *planes = s->planes.data;
    bool fits =
        find_rims(hooks, s, &loose) && !occ_array_reserve(hooks, &s->rims, loose.count + (size_t)1);
    if (fits && loose.count) qsort(loose.data, loose.count, sizeof(loose_rim), by_plane);
    for (uint32_t i = 0; fits && i < loose.count; i++) {
        const loose_rim *rim = (const loose_rim *)loose.data + i;
        occ_sheet_plane *plane = &planes[rim->plane];
        if (!plane->rims++) plane->first_rim = i;
        ((occ_sheet_rim *)s->rims.data)[s->rims.count++] = rim->rim;
    }
    occ_array_free(hooks, &loose);
    return fits ? OCC_SUCCESS : OCC_ERROR_OUT_OF_MEMORY;
}

// --- the whole -----------------------------------------------------------------------------------

static occ_result part_surface(occ_hooks *hooks, const occ_sheets_desc *desc, occ_surface *s)
{
    size_t n = s->mesh.triangles;
    joining j = {.surface = s,
                 .source_label = desc->labels_apart ? desc->labels : NULL,
                 .one_sided = desc->sides == OCC_SIDES_FRONT};
    j.parent = occ_alloc(hooks, n * sizeof *j.parent);
    j.flat = occ_alloc(hooks, n * sizeof *j.flat);
    s->plane_of = occ_alloc(hooks, n * sizeof *s->plane_of);
    s->triangle = occ_alloc(hooks, n * sizeof *s->triangle);
    occ_result result = OCC_ERROR_OUT_OF_MEMORY;
    if (j.parent && j.flat && s->plane_of && s->triangle) {
        for (uint32_t t = 0; t < n; t++) {
            occ_sheet_plane view;
            j.parent[t] = t;
            j.flat[t] = !choose_view(&s->mesh, t, &view);
        }
        join_all(&j);
        result = list_planes(hooks, &j);
    }
    occ_free(hooks, j.parent, n * sizeof *j.parent);
    occ_free(hooks, j.flat, n * sizeof *j.flat);
    return result ? result : list_rims(hooks, s);
}

occ_result occ_surface_build(occ_hooks *hooks, const occ_soup *soup, const occ_sheets_desc *desc,
                             occ_surface *surface)
{
    *surface =
        (occ_surface){.planes = OCC_ARRAY(occ_sheet_plane), .rims = OCC_ARRAY(occ_sheet_rim)};
    occ_result result = desc->see_through ? build_opaque(hooks, soup, desc->see_through, surface)
                                          : occ_mesh_build(hooks, soup, &surface->mesh);
    if (!result && surface->mesh.triangles) {
        result = occ_edges_build(hooks, &surface->mesh, &surface->edges);
        if (!result) result = part_surface(hooks, desc, surface);
    }
    if (!result) return OCC_SUCCESS;
    occ_surface_free(hooks, surface);
    if (result != OCC_ERROR_OUT_OF_MEMORY) return result;
    return occ_fail(hooks, result, "no memory for the planes of %u triangles",
                    (unsigned)soup->triangle_count);
}

void occ_surface_free(occ_hooks *hooks, occ_surface *surface)
{
    size_t n = surface->mesh.triangles;
    occ_array_free(hooks, &surface->rims);
    occ_array_free(hooks, &surface->planes);
    occ_free(hooks, surface->triangle, n * sizeof *surface->triangle);
    occ_free(hooks, surface->plane_of, n * sizeof *surface->plane_of);
    occ_edges_free(hooks, &surface->edges);
    occ_mesh_free(hooks, &surface->mesh);
    *surface = (occ_surface){0};
}
