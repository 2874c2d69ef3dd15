// SPDX-License-Identifier: Apache-2.0
// Fusion where an item has vectors: what fusion.h does, with the planes of a shadow, or the
// vertices of a piece, side by side. The operations on each are the same in the same order.
#include "fusion.h"

// Vertices beyond `count` are whatever they are.
typedef struct side_piece {
    float x[OCC_PIECE_VERTICES], y[OCC_PIECE_VERTICES], z[OCC_PIECE_VERTICES];
    float w[OCC_PIECE_VERTICES];
    uint count, cuts;
} side_piece;

typedef struct side_fusion {
    side_piece stack[OCC_FUSION_STACK];
    uint depth;
    int faces; // as in occ_fusion
} side_fusion;

#define SIDE_NEAR 256u

// Candidates: those of a range's list that may matter, in its order. Of a longer list the rest is
// looked at one by one.
typedef struct side_list {
    __global const occ_side_shadow *shadows;
    uint near[SIDE_NEAR];
    uint near_count;
    __global const uint *rest;
    uint rest_count;
} side_list;

inline __global const occ_side_shadow *listed(const side_list *list, uint i)
{
    uint s = i < list->near_count ? list->near[i] : list->rest[i - list->near_count];
    return &list->shadows[s];
}

// Bit l: lane l of a comparison holds.
inline uint side_bits(int8 truth)
{
    truth &= (int8)(1, 2, 4, 8, 16, 32, 64, 128);
    int4 two = truth.lo | truth.hi;
    int2 one = two.lo | two.hi;
    return (uint)(one.x | one.y);
}

inline int side_any(int8 truth)
{
    int4 two = truth.lo | truth.hi;
    int2 one = two.lo | two.hi;
    return (one.x | one.y) != 0;
}

inline uint lowest_of(uint bits)
{
    return 31u - clz(bits & (0u - bits));
}

inline uint bits_below(uint count)
{
    return (1u << count) - 1u;
}

// --- planes side by side -------------------------------------------------------------------------

// Plane p as a cutter.
inline void side_cutter(occ_cutter *n, __global const occ_side_shadow *shadow, uint p, float object)
{
    float d = p == OCC_SIDES ? shadow->last[3] : shadow->plane[3][p];
    n->x = p == OCC_SIDES ? shadow->last[0] : shadow->plane[0][p];
    n->y = p == OCC_SIDES ? shadow->last[1] : shadow->plane[1][p];
    n->z = p == OCC_SIDES ? shadow->last[2] : shadow->plane[2][p];
    n->d = OCC_CUTTER_OFFSET(d, object);
}

inline float8 sides_at(__global const occ_side_shadow *shadow, float8 dw, float x, float y, float z)
{
    return OCC_PLANE_AT(vload8(0, shadow->plane[0]), vload8(0, shadow->plane[1]),
                        vload8(0, shadow->plane[2]), dw, x, y, z);
}

// As occ_shadow_holds().
inline int sides_hold(__global const occ_side_shadow *shadow, const occ_vertex *middle, uint cuts,
                      float object)
{
    float8 d = vload8(0, shadow->plane[3]), dw = OCC_CUTTER_OFFSET(d, object) * middle->w;
    float least = OCC_MIDDLE_LEAST(cuts);
    uint held = side_bits(sides_at(shadow, dw, middle->x, middle->y, middle->z) > least);
    if (shadow->planes & bits_below(OCC_SIDES) & ~held) return 0;
    if (!(shadow->planes >> OCC_SIDES)) return 1;
    occ_cutter n;
    side_cutter(&n, shadow, OCC_SIDES, object);
    return occ_vertex_at(middle, &n) > least;
}

// As occ_box_is_behind().
inline int side_is_behind(const occ_relative_box *box, __global const occ_side_shadow *shadow)
{
    const float *t = box->t, *a = box->a;
    float8 x = vload8(0, shadow->plane[0]), y = vload8(0, shadow->plane[1]);
    float8 z = vload8(0, shadow->plane[2]), d = vload8(0, shadow->plane[3]);
    float8 s = OCC_PLANE_AT(x, y, z, d, t[0], t[1], t[2]);
    float8 r = OCC_REACH_OF_AXIS(x, y, z, a[0], a[1], a[2]);
    r += OCC_REACH_OF_AXIS(x, y, z, a[3], a[4], a[5]);
    r += OCC_REACH_OF_AXIS(x, y, z, a[6], a[7], a[8]);
    uint inside = side_bits(OCC_IS_INSIDE(s, r, box->e));
    if (shadow->faces & bits_below(OCC_SIDES) & ~inside) return 0;
    return !(shadow->faces >> OCC_SIDES) || occ_box_in_shadow(box, shadow->last, 1);
}

// The planes that not all of a piece is inside of.
inline uint sides_that_cut(const side_piece *piece, __global const occ_side_shadow *shadow,
                           float object)
{
    float8 x = vload8(0, shadow->plane[0]), y = vload8(0, shadow->plane[1]);
    float8 z = vload8(0, shadow->plane[2]), d = vload8(0, shadow->plane[3]);
    float least = OCC_VERTEX_LEAST(piece->cuts);
    int8 inside = (int8)(-1);
    uint last = 1u;
    occ_cutter n;
    side_cutter(&n, shadow, OCC_SIDES, object);
    d = OCC_CUTTER_OFFSET(d, object);
    for (uint i = 0; i < piece->count; i++) {
        occ_vertex v = {piece->x[i], piece->y[i], piece->z[i], piece->w[i]};
        float8 dw = d * v.w;
        inside &= OCC_PLANE_AT(x, y, z, dw, v.x, v.y, v.z) > least;
        last = last && occ_vertex_at(&v, &n) > least;
    }
    return shadow->planes & ~(side_bits(inside) | last << OCC_SIDES);
}

// As occ_fusion_find().
inline uint side_find(side_fusion *fusion, const occ_relative_box *box, uint row,
                      const side_list *list, int by_faces)
{
    const side_piece *top = &fusion->stack[fusion->depth - 1u];
    uint b = top->count / OCC_MIDDLE_CORNERS, c = 2u * top->count / OCC_MIDDLE_CORNERS;
    occ_vertex middle;
    middle.x = (top->x[0] + top->x[b]) + top->x[c];
    middle.y = (top->y[0] + top->y[b]) + top->y[c];
    middle.z = (top->z[0] + top->z[b]) + top->z[c];
    middle.w = (top->w[0] + top->w[b]) + top->w[c];
    uint count = list->near_count + list->rest_count;
    for (uint i = 0; i < count; i++) {
        __global const occ_side_shadow *shadow = listed(list, i);
        if (shadow->owner == row || !sides_hold(shadow, &middle, top->cuts, box->e)) continue;
        if (by_faces || side_is_behind(box, shadow)) return i;
        fusion->faces = 1;
    }
    return count;
}

// --- vertices side by side -----------------------------------------------------------------------

inline float8 vertices_at(const side_piece *piece, const occ_cutter *n)
{
    return OCC_PLANE_AT(n->x, n->y, n->z, n->d * vload8(0, piece->w), vload8(0, piece->x),
                        vload8(0, piece->y), vload8(0, piece->z));
}

inline void take_vertex(side_piece *part, const side_piece *piece, uint i)
{
    part->x[part->count] = piece->x[i];
    part->y[part->count] = piece->y[i];
    part->z[part->count] = piece->z[i];
    part->w[part->count++] = piece->w[i];
}

inline void add_vertex(side_piece *part, const occ_vertex *v)
{
    part->x[part->count] = v->x;
    part->y[part->count] = v->y;
    part->z[part->count] = v->z;
    part->w[part->count++] = v->w;
}

// As occ_piece_take().
inline void take_part(side_piece *part, const side_piece *piece, uint i, uint end,
                      const occ_vertex *c, const occ_vertex *d)
{
    part->count = 0;
    part->cuts = piece->cuts + 1u;
    for (; i != end; i = i + 1u == piece->count ? 0 : i + 1u)
        take_vertex(part, piece, i);
    add_vertex(part, c);
    add_vertex(part, d);
}

// Where the edge from vertex b, outside, to vertex a comes to the level of a cut.
inline int side_between(const side_piece *piece, const float *at, uint a, uint b,
                        const occ_cutter *n, occ_vertex *c)
{
    occ_vertex inner = {piece->x[a], piece->y[a], piece->z[a], piece->w[a]};
    occ_vertex outer = {piece->x[b], piece->y[b], piece->z[b], piece->w[b]};
    return occ_vertex_between(&inner, at[a], &outer, at[b], OCC_CUT_LEVEL(piece->cuts),
                              OCC_VERTEX_LEAST(piece->cuts + 1u), n, c);
}

// As occ_piece_cut(): the piece becomes what is inside.
inline int side_cut(side_piece *piece, const occ_cutter *n, side_piece *outside)
{
    float at[OCC_PIECE_VERTICES];
    float8 value = vertices_at(piece, n);
    uint count = piece->count, all = bits_below(count);
    uint in = side_bits(value > OCC_CUT_LEVEL(piece->cuts)) & all;
    if (!in) return OCC_CUT_OUTSIDE;
    if (in == all) return OCC_CUT_INSIDE;
    uint before = (in << 1 | in >> (count - 1u)) & all; // bit i: vertex i - 1 is inside
    uint enters = in & ~before, leaves = before & ~in;
    uint first = lowest_of(enters), last = lowest_of(leaves);
    if (piece->cuts == OCC_PIECE_CUTS || count == OCC_PIECE_VERTICES || enters >> first != 1u) {
        return OCC_CUT_FAILED;
    }
    vstore8(value, 0, at);
    occ_vertex c, d;
    if (!side_between(piece, at, first, (first ? first : count) - 1u, n, &c) ||
        !side_between(piece, at, (last ? last : count) - 1u, last, n, &d)) {
        return OCC_CUT_FAILED;
    }
    side_piece whole = *piece;
    take_part(outside, &whole, last, first, &c, &d);
    take_part(piece, &whole, first, last, &d, &c);
    return OCC_CUT_TWO;
}

// As occ_piece_halve().
inline void side_halve(side_piece *half_of, const side_piece *piece, uint first)
{
    half_of->count = 0;
    half_of->cuts = piece->cuts;
    for (uint i = 0; i <= OCC_PIECE_VERTICES / 2u; i++)
        take_vertex(half_of, piece, (first + i) % OCC_PIECE_VERTICES);
}

// --- the object ----------------------------------------------------------------------------------

// As occ_fusion_subtract().
inline int side_subtract(side_fusion *fusion, __global const occ_side_shadow *shadow, float object)
{
    side_piece piece = fusion->stack[--fusion->depth];
    uint planes = sides_that_cut(&piece, shadow, object);
    for (; planes; planes &= planes - 1u) {
        occ_cutter n;
        side_cutter(&n, shadow, lowest_of(planes), object);
        if (fusion->depth + 2u > OCC_FUSION_STACK) return 0;
        if (piece.count == OCC_PIECE_VERTICES &&
            side_bits(vertices_at(&piece, &n) > OCC_VERTEX_LEAST(piece.cuts)) !=
                bits_below(OCC_PIECE_VERTICES)) {
            side_halve(&fusion->stack[fusion->depth++], &piece, 0);
            side_halve(&fusion->stack[fusion->depth++], &piece, OCC_PIECE_VERTICES / 2u);
            return 1;
        }
        int cut = side_cut(&piece, &n, &fusion->stack[fusion->depth]);
        if (cut == OCC_CUT_OUTSIDE || cut == OCC_CUT_FAILED) return 0;
        fusion->depth += cut == OCC_CUT_TWO;
    }
    return 1;
}

// As occ_fusion_clip().
inline void side_clip(side_fusion *fusion, __global const occ_eye *eye, uint mask, float object)
{
    for (uint p = 0; p < OCC_SIDE_PLANES; p++) {
        if (!(mask >> p & 1u)) continue;
        occ_cutter beyond;
        occ_cutter_set(&beyond, eye->plane[p], -1.0f, object);
        uint kept = 0;
        for (uint i = 0; i < fusion->depth; i++) {
            side_piece lost = fusion->stack[i], rest;
            int cut = side_cut(&lost, &beyond, &rest);
            if (cut == OCC_CUT_INSIDE) continue;
            if (cut == OCC_CUT_TWO) {
                fusion->stack[kept++] = rest;
            } else {
                fusion->stack[kept++] = fusion->stack[i];
            }
        }
        fusion->depth = kept;
    }
}

// As occ_outline_pieces().
inline int side_outline(side_fusion *fusion, const occ_relative_box *box,
                        __global const occ_eye *eye, int by_faces)
{
    occ_outline outline;
    if (!occ_outline_set(&outline, box, eye, by_faces)) return 0;
    fusion->depth = outline.polygons;
    for (uint i = 0; i < outline.polygons; i++) {
        side_piece *piece = &fusion->stack[i];
        piece->count = piece->cuts = 0;
        for (uint k = 0; k < outline.corners; k++) {
            occ_vertex v;
            if (!occ_outline_vertex(box, outline.corner[i][k], &v)) return 0;
            add_vertex(piece, &v);
        }
    }
    return 1;
}

// As occ_fusion_covers(), from the outline on.
inline int sides_cover(side_fusion *fusion, const occ_relative_box *box,
                       __global const occ_eye *eye, uint mask, uint row, const side_list *list,
                       int by_faces)
{
    fusion->faces = 0;
    if (!side_outline(fusion, box, eye, by_faces)) return 0;
    side_clip(fusion, eye, mask, box->e);
    for (uint split = 0; fusion->depth; split++) {
        uint i = side_find(fusion, box, row, list, by_faces);
        if (i == list->near_count + list->rest_count || split == eye->splits ||
            !side_subtract(fusion, listed(list, i), box->e)) {
            return 0;
        }
    }
    return 1;
}

// Those of eight points that are inside all planes of a shadow, of those that are `held` before.
inline int8 points_held(int8 held, __global const occ_side_shadow *shadow, float8 x, float8 y,
                        float8 z, float8 e)
{
    for (uint p = 0; p < shadow->sides; p++) {
        held &= OCC_PLANE_AT(shadow->plane[0][p], shadow->plane[1][p], shadow->plane[2][p],
                             shadow->plane[3][p], x, y, z) > e;
        if ((p & 1u) && !side_any(held)) return held;
    }
    if (!(shadow->planes >> OCC_SIDES)) return held;
    OCC_PLANES_OF n = shadow->last;
    return held & (OCC_PLANE_AT(n[0], n[1], n[2], n[3], x, y, z) > e);
}

// As occ_box_shows_corner(), for all corners at once.
inline int sides_show_corner(const occ_relative_box *box, __global const occ_eye *eye, uint mask,
                             uint row, const side_list *list)
{
    const float8 s0 = (float8)(1, -1, 1, -1, 1, -1, 1, -1);
    const float8 s1 = (float8)(1, 1, -1, -1, 1, 1, -1, -1);
    const float8 s2 = (float8)(1, 1, 1, 1, -1, -1, -1, -1);
    const float *t = box->t, *a = box->a;
    float8 x = OCC_CORNER(t[0], s0 * a[0], s1 * a[3], s2 * a[6]);
    float8 y = OCC_CORNER(t[1], s0 * a[1], s1 * a[4], s2 * a[7]);
    float8 z = OCC_CORNER(t[2], s0 * a[2], s1 * a[5], s2 * a[8]);
    int8 shown = (int8)(-1);
    uint count = list->near_count + list->rest_count;
    for (uint p = 0; p < OCC_SIDE_PLANES; p++) {
        OCC_PLANES_OF n = eye->plane[p];
        if (mask >> p & 1u) shown &= OCC_PLANE_AT(n[0], n[1], n[2], n[3], x, y, z) > 0.0f;
    }
    for (uint i = 0; i < count && side_any(shown); i++) {
        __global const occ_side_shadow *shadow = listed(list, i);
        if (shadow->owner == row) continue;
        shown &= ~points_held(shown, shadow, x, y, z, (float8)(box->e));
    }
    return side_any(shown);
}

// Those of a list that are not apart from a box.
inline void list_near(side_list *to, const side_list *from, const occ_relative_box *box)
{
    const float *t = box->t, *a = box->a;
    uint count = 0;
    for (uint i = 0; i < from->near_count; i++) {
        __global const occ_side_shadow *shadow = listed(from, i);
        float8 x = vload8(0, shadow->plane[0]), y = vload8(0, shadow->plane[1]);
        float8 z = vload8(0, shadow->plane[2]), d = vload8(0, shadow->plane[3]);
        float8 s = OCC_PLANE_AT(x, y, z, d, t[0], t[1], t[2]);
        float8 r = OCC_REACH_OF_AXIS(x, y, z, a[0], a[1], a[2]);
        r += OCC_REACH_OF_AXIS(x, y, z, a[3], a[4], a[5]);
        r += OCC_REACH_OF_AXIS(x, y, z, a[6], a[7], a[8]);
        to->near[count] = from->near[i];
        count += !side_any(OCC_IS_OUTSIDE(s, r, box->e));
    }
    to->shadows = from->shadows;
    to->near_count = count;
    to->rest = from->rest;
    to->rest_count = from->rest_count;
}

// As occ_box_fused(), where a shadow holds the center or the center is not in the picture, and none
// holds all of the box.
inline int sides_hide(const occ_relative_box *box, __global const occ_eye *eye, uint mask, uint row,
                      const side_list *candidates)
{
    side_fusion fusion;
    side_list list;
    list_near(&list, candidates, box);
    if (sides_show_corner(box, eye, mask, row, &list)) return 0;
    if (sides_cover(&fusion, box, eye, mask, row, &list, 0)) return 1;
    return fusion.faces && sides_cover(&fusion, box, eye, mask, row, &list, 1);
}
