// SPDX-License-Identifier: Apache-2.0
#include "soup/sheet_proof.h"

#include "soup/sides.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

occ_sheet_reason occ_sheet_shape(const occ_sheet *sheet, occ_sides sides)
{
    uint32_t n = sheet->corner_count;
    if (n < 3 || n > OCC_SHEET_CORNERS) return OCC_SHEET_MISMADE;
    if (sheet->sides != OCC_SIDES_BOTH && sheet->sides != OCC_SIDES_FRONT) return OCC_SHEET_MISMADE;
    if (sides == OCC_SIDES_FRONT && sheet->sides != OCC_SIDES_FRONT) return OCC_SHEET_MISMADE;
    for (uint32_t i = 0; i < n; i++) {
        const float *a = sheet->corner[i], *b = sheet->corner[(i + 1) % n];
        if (a[0] == b[0] && a[1] == b[1] && a[2] == b[2]) return OCC_SHEET_MISMADE;
    }
    return OCC_SHEET_SOUND;
}

static uint32_t label_of(const occ_sheets_desc *desc, uint32_t source)
{
    return desc->labels ? desc->labels[source] : 0;
}

static void add_to_basis(const occ_surface *s, const occ_sheets_desc *desc, uint32_t triangle,
                         occ_sheet_basis *basis)
{
    uint32_t source = s->mesh.source[triangle], label = label_of(desc, source);
    if (!basis->count++ || source < basis->triangle) basis->triangle = source;
    if (basis->count == 1) basis->label = label;
    if (basis->label != label) basis->label = OCC_NO_LABEL;
}

// --- in a plane ----------------------------------------------------------------------------------

// A convex polygon as its plane is seen, counterclockwise, with its bounds.
typedef struct polygon {
    float at[OCC_SHEET_CORNERS][2];
    uint32_t count;
    float min[2], max[2];
} polygon;

static bool is_in_plane(const occ_surface *s, const occ_sheet_plane *plane, const float *point)
{
    const float *p[3];
    for (int c = 0; c < 3; c++)
        p[c] = occ_mesh_corner(&s->mesh, s->triangle[plane->first], c);
    return occ_side_of_plane(p[0], p[1], p[2], point) == 0;
}

// Lays a sheet's corners out. Of corners that go clockwise the order is turned round.
static occ_sheet_reason lay_out(const occ_sheet_plane *plane, const occ_sheet *sheet, bool *turned,
                                polygon *out)
{
    uint32_t n = out->count = sheet->corner_count;
    int sense = 0;
    *out = (polygon){.count = n, .min = {INFINITY, INFINITY}, .max = {-INFINITY, -INFINITY}};
    for (uint32_t i = 0; i < n; i++) {
        occ_sheet_flatten(plane, sheet->corner[i], out->at[i]);
        for (int k = 0; k < 2; k++) {
            out->min[k] = fminf(out->min[k], out->at[i][k]);
            out->max[k] = fmaxf(out->max[k], out->at[i][k]);
        }
    }
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t k = 0; k < n; k++) {
            int turn = occ_turn(out->at[i], out->at[(i + 1) % n], out->at[k]);
            if (turn && sense && turn != sense) return OCC_SHEET_BENT;
            if (turn) sense = turn;
        }
    *turned = sense < 0;
    for (uint32_t i = 0; i < n / 2 && *turned; i++) {
        float held[2];
        memcpy(held, out->at[i], sizeof held);
        memcpy(out->at[i], out->at[n - 1 - i], sizeof held);
        memcpy(out->at[n - 1 - i], held, sizeof held);
    }
    return sense ? OCC_SHEET_SOUND : OCC_SHEET_FLAT;
}

static bool bounds_apart(const polygon *p, const float (*at)[2], uint32_t count)
{
    for (int k = 0; k < 2; k++) {
        bool below = true, above = true;
        for (uint32_t i = 0; i < count; i++) {
            below = below && at[i][k] <= p->min[k];
            above = above && at[i][k] >= p->max[k];
        }
        if (below || above) return true;
    }
    return false;
}

// Whether a line along an edge of the polygon parts its interior from some points.
static bool parts(const polygon *p, const float (*at)[2], uint32_t count)
{
    for (uint32_t i = 0; i < p->count; i++) {
        bool beyond = true;
        for (uint32_t k = 0; k < count && beyond; k++)
            beyond = occ_turn(p->at[i], p->at[(i + 1) % p->count], at[k]) <= 0;
        if (beyond) return true;
    }
    return false;
}

// Whether no corner of the polygon is on a side of a line: 1 left, -1 right.
static bool is_beside(const polygon *p, const float a[2], const float b[2], int side)
{
    for (uint32_t i = 0; i < p->count; i++)
        if (occ_turn(a, b, p->at[i]) == side) return false;
    return true;
}

// Two convex sets in a plane have no point of their interiors in common if and only if a line along
// an edge of one parts them.
static bool meets_rim(const polygon *p, const float (*at)[2])
{
    if (bounds_apart(p, at, 2)) return false;
    return !is_beside(p, at[0], at[1], 1) && !is_beside(p, at[0], at[1], -1) && !parts(p, at, 2);
}

static bool meets_triangle(const polygon *p, const float (*at)[2], int sense)
{
    if (bounds_apart(p, at, 3)) return false;
    for (int i = 0; i < 3; i++)
        if (is_beside(p, at[i], at[(i + 1) % 3], sense)) return false;
    return !parts(p, at, 3);
}

static bool meets_rims(const occ_surface *s, const occ_sheet_plane *plane, const polygon *p,
                       occ_sheet_basis *basis, uint32_t *beside)
{
    const occ_sheet_rim *rim = (const occ_sheet_rim *)s->rims.data + plane->first_rim;
    for (uint32_t i = 0; i < plane->rims; i++) {
        float at[2][2];
        occ_sheet_flatten(plane, s->mesh.at[rim[i].from], at[0]);
        occ_sheet_flatten(plane, s->mesh.at[rim[i].to], at[1]);
        basis->work += bounds_apart(p, (const float(*)[2])at, 2) ? 1 : 50;
        if (!meets_rim(p, (const float(*)[2])at)) continue;
        *beside = s->mesh.source[rim[i].triangle];
        return true;
    }
    return false;
}

// Whether there is a triangle within the polygon, and all that are there are in the plane and, of
// one-sided ones, turn their front to where that of the plane is.
static bool finds_triangles(const occ_surface *s, const occ_sheets_desc *desc,
                            const occ_sheet_plane *plane, const polygon *p, occ_sheet_basis *basis)
{
    for (uint32_t i = 0; i < plane->count; i++) {
        uint32_t t = s->triangle[plane->first + i];
        float at[3][2];
        for (int c = 0; c < 3; c++)
            occ_sheet_flatten(plane, occ_mesh_corner(&s->mesh, t, c), at[c]);
        int sense = occ_turn(at[0], at[1], at[2]);
        basis->work += bounds_apart(p, (const float(*)[2])at, 3) ? 1 : 50;
        if (!meets_triangle(p, (const float(*)[2])at, sense)) continue;
        if (sense < 0 && desc->sides == OCC_SIDES_FRONT) return false;
        for (int c = 0; c < 3; c++)
            if (!is_in_plane(s, plane, occ_mesh_corner(&s->mesh, t, c))) return false;
        add_to_basis(s, desc, t, basis);
    }
    return basis->count > 0;
}

occ_sheet_reason occ_prove_in_plane(const occ_surface *s, const occ_sheets_desc *desc,
                                    const occ_sheet_plane *plane, const occ_sheet *sheet,
                                    occ_sheet_basis *basis, uint32_t *beside)
{
    polygon p;
    bool turned;
    *basis = (occ_sheet_basis){.triangle = UINT32_MAX};
    for (uint32_t i = 0; i < sheet->corner_count; i++)
        if (!is_in_plane(s, plane, sheet->corner[i])) return OCC_SHEET_OPEN;
    occ_sheet_reason reason = lay_out(plane, sheet, &turned, &p);
    if (reason) return reason;
    if (turned && desc->sides == OCC_SIDES_FRONT) return OCC_SHEET_OPEN; // nothing is drawn there
    if (meets_rims(s, plane, &p, basis, beside)) return OCC_SHEET_OPEN;
    return finds_triangles(s, desc, plane, &p, basis) ? OCC_SHEET_SOUND : OCC_SHEET_OPEN;
}

// --- by corners ----------------------------------------------------------------------------------

static size_t slot_of(const float p[3], size_t slots)
{
    uint64_t h = 0;
    for (int k = 0; k < 3; k++) {
        float positive = p[k] + 0.0f; // -0 becomes 0
        uint32_t bits;
        memcpy(&bits, &positive, sizeof bits);
        h = (h ^ bits) * 0x9e3779b97f4a7c15u;
        h ^= h >> 29;
    }
    return (size_t)(h & (slots - 1));
}

static uint32_t find_vertex(const occ_mesh *mesh, const occ_corner_index *index, const float p[3])
{
    size_t i = slot_of(p, index->slots);
    for (; index->slot[i] != UINT32_MAX; i = (i + 1) & (index->slots - 1)) {
        const float *q = mesh->at[index->slot[i]];
        if (q[0] == p[0] && q[1] == p[1] && q[2] == p[2]) break;
    }
    return index->slot[i];
}

occ_result occ_corner_index_build(occ_hooks *hooks, const occ_mesh *mesh, occ_corner_index *index)
{
    size_t n = mesh->vertices;
    *index = (occ_corner_index){.slots = 16};
    while (index->slots < 2 * n)
        index->slots *= 2;
    index->slot = occ_alloc(hooks, index->slots * sizeof *index->slot);
    index->first = occ_alloc(hooks, (n + 2) * sizeof *index->first);
    index->at = occ_alloc(hooks, 3 * (size_t)mesh->triangles * sizeof *index->at);
    if (!index->slot || !index->first || (!index->at && mesh->triangles)) {
        occ_corner_index_free(hooks, mesh, index);
        return OCC_ERROR_OUT_OF_MEMORY;
    }
    memset(index->slot, 0xff, index->slots * sizeof *index->slot);
    for (uint32_t v = 0; v < n; v++) {
        size_t i = slot_of(mesh->at[v], index->slots);
        while (index->slot[i] != UINT32_MAX)
            i = (i + 1) & (index->slots - 1);
        index->slot[i] = v;
    }
    // Counted two places on, so that filling leaves each at where its vertex begins.
    memset(index->first, 0, (n + 2) * sizeof *index->first);
    for (size_t i = 0; i < 3 * (size_t)mesh->triangles; i++)
        index->first[mesh->corner[i / 3][i % 3] + 2]++;
    for (size_t v = 0; v < n; v++)
        index->first[v + 2] += index->first[v + 1];
    for (size_t i = 0; i < 3 * (size_t)mesh->triangles; i++)
        index->at[index->first[mesh->corner[i / 3][i % 3] + 1]++] = (uint32_t)(i / 3);
    return OCC_SUCCESS;
}

void occ_corner_index_free(occ_hooks *hooks, const occ_mesh *mesh, occ_corner_index *index)
{
    occ_free(hooks, index->slot, index->slots * sizeof *index->slot);
    occ_free(hooks, index->first, (mesh->vertices + (size_t)2) * sizeof *index->first);
    occ_free(hooks, index->at, 3 * (size_t)mesh->triangles * sizeof *index->at);
    *index = (occ_corner_index){0};
}

static bool has_corners(const uint32_t *t, const uint32_t corner[3], bool one_sided)
{
    for (int i = 0; i < 3; i++) {
        if (t[i] != corner[0]) continue;
        uint32_t next = t[(i + 1) % 3], last = t[(i + 2) % 3];
        return (next == corner[1] && last == corner[2]) ||
               (!one_sided && next == corner[2] && last == corner[1]);
    }
    return false;
}

// A triangle with these corners, in this order round if it must turn its front to where they go
// counterclockwise; or UINT32_MAX.
static uint32_t find_triangle(const occ_mesh *mesh, const occ_corner_index *index,
                              const uint32_t corner[3], bool one_sided)
{
    uint32_t least = corner[0], count = UINT32_MAX;
    for (int c = 0; c < 3; c++) {
        uint32_t there = index->first[corner[c] + 1] - index->first[corner[c]];
        if (there >= count) continue;
        least = corner[c];
        count = there;
    }
    for (uint32_t i = index->first[least]; i < index->first[least + 1]; i++)
        if (has_corners(mesh->corner[index->at[i]], corner, one_sided)) return index->at[i];
    return UINT32_MAX;
}

// What fills the part of an outline from corner i to corner j that the line between them cuts off:
// the triangle at that line, with its third corner.
typedef struct filling {
    uint32_t triangle[OCC_SHEET_CORNERS][OCC_SHEET_CORNERS];
    uint32_t third[OCC_SHEET_CORNERS][OCC_SHEET_CORNERS];
} filling;

static bool is_filled(const filling *f, uint32_t i, uint32_t j)
{
    return j == i + 1 || f->triangle[i][j] != UINT32_MAX;
}

// From short parts to long ones: a part is filled if a triangle leaves two that are.
static bool fill(const occ_mesh *mesh, const occ_corner_index *index, const uint32_t *vertex,
                 uint32_t n, bool one_sided, filling *f)
{
    for (uint32_t span = 2; span < n; span++)
        for (uint32_t i = 0; i + span < n; i++) {
            uint32_t j = i + span;
            f->triangle[i][j] = UINT32_MAX;
            for (uint32_t k = i + 1; k < j && f->triangle[i][j] == UINT32_MAX; k++) {
                if (!is_filled(f, i, k) || !is_filled(f, k, j)) continue;
                f->third[i][j] = k;
                const uint32_t corner[3] = {vertex[i], vertex[k], vertex[j]};
                f->triangle[i][j] = find_triangle(mesh, index, corner, one_sided);
            }
        }
    return f->triangle[0][n - 1] != UINT32_MAX;
}

bool occ_prove_by_corners(const occ_surface *s, const occ_sheets_desc *desc,
                          const occ_corner_index *index, const occ_sheet *sheet,
                          occ_sheet_basis *basis)
{
    filling f;
    memset(&f, 0xff, sizeof f); // nothing is filled
    uint32_t vertex[OCC_SHEET_CORNERS] = {0}, n = sheet->corner_count;
    uint32_t part[2 * OCC_SHEET_CORNERS][2] = {{0, n - 1}}, parts_left = 1;
    *basis = (occ_sheet_basis){.triangle = UINT32_MAX};
    for (uint32_t i = 0; i < n; i++) {
        vertex[i] = find_vertex(&s->mesh, index, sheet->corner[i]);
        if (vertex[i] == UINT32_MAX) return false;
    }
    if (!fill(&s->mesh, index, vertex, n, desc->sides == OCC_SIDES_FRONT, &f)) return false;
    while (parts_left) {
        uint32_t i = part[--parts_left][0], j = part[parts_left][1];
        if (j == i + 1) continue;
        uint32_t t = f.triangle[i][j], k = f.third[i][j];
        if (s->plane_of[t] != OCC_NO_PLANE) add_to_basis(s, desc, t, basis);
        part[parts_left][0] = i, part[parts_left++][1] = k;
        part[parts_left][0] = k, part[parts_left++][1] = j;
    }
    return basis->count > 0;
}
