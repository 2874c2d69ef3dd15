// SPDX-License-Identifier: Apache-2.0
// Pieces of an object's outline: convex polygons, and how a plane cuts them.
//
// Why rounding does no harm. A vertex is a point of the object in homogeneous coordinates, (x, y,
// z, w) for (x, y, z) / w. Let V be the true vertex, of which v is what floats make. A piece has a
// bound e for all its vertices: |n.(v - V)| <= e for every n whose components are at most 1. When
// an edge from b to a is cut, the cut is at c = f a + g b with floats f and g that are not
// negative. The true cut is *defined* to be at C = f A + g B with the same f and g: that is a point
// of the true edge, and so the true pieces fill the true polygon, whatever f and g are; and |n.(c -
// C)| is at most (f + g) e and what computing c rounds. A vertex counts as inside a plane if n.v +
// d w exceeds e and what that sum rounds; then V is inside as well, and a piece all of whose
// vertices are inside lies in the half-space. docs/accuracy.md derives the constants.
#ifndef OCC_PIECE_H
#define OCC_PIECE_H

#include "verdict.h"

#define OCC_PIECE_VERTICES 8u  // what has as many is halved before it is cut
#define OCC_PIECE_CUTS     16u // one after the other on the way to a piece

// What n.v + d w rounds beside its last term: 14 u.
#define OCC_VERTEX_SLACK 0x1p-19f
// What d w rounds, and w did at all cuts: 50 u.
#define OCC_OFFSET_SLACK 0x1p-18f
// What a cut rounds for each unit of f and g: 6 u.
#define OCC_CUT_SLACK 0x1p-20f
// A vertex that is less exact than this is of no use.
#define OCC_VERTEX_WORST 0x1p-12f

#ifdef __OPENCL_C_VERSION__
#define OCC_GLOBAL         __global
#define OCC_BITS_OF(x)     as_uint(x)
#define OCC_FLOAT_OF(bits) as_float(bits)
#else
#include <string.h>
#define OCC_GLOBAL
static inline uint32_t OCC_BITS_OF(float x)
{
    uint32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static inline float OCC_FLOAT_OF(uint32_t bits)
{
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}
#endif

// The largest of x, y, z is in [1/2, 1).
typedef struct occ_vertex {
    float x, y, z, w;
} occ_vertex;

typedef struct occ_piece {
    occ_vertex v[OCC_PIECE_VERTICES];
    float e; // bounds the error of every vertex
    float w; // at least that of every vertex
    occ_u32 count;
    occ_u32 cuts; // along the way to it
} occ_piece;

// Times a power of two, so that the largest of x, y, z is in [1/2, 1), and its bound e likewise. 0
// if that cannot be.
OCC_FN int occ_vertex_scale(occ_vertex *v, float *e)
{
    float most = OCC_FABS(v->x);
    if (OCC_FABS(v->y) > most) most = OCC_FABS(v->y);
    if (OCC_FABS(v->z) > most) most = OCC_FABS(v->z);
    occ_u32 exponent = OCC_BITS_OF(most) >> 23;
    if (exponent < 24u || exponent > 230u) return 0;
    float scale = OCC_FLOAT_OF((253u - exponent) << 23);
    v->x *= scale;
    v->y *= scale;
    v->z *= scale;
    v->w *= scale;
    *e *= scale;
    return *e < OCC_VERTEX_WORST;
}

// Makes a piece's bounds hold for one more vertex.
OCC_FN void occ_piece_admit(occ_piece *piece, const occ_vertex *v, float e)
{
    if (e > piece->e) piece->e = e;
    if (v->w > piece->w) piece->w = v->w;
}

// --- cutting -------------------------------------------------------------------------------------

#define OCC_CUT_OUTSIDE 0 // none of it is inside for certain
#define OCC_CUT_INSIDE  1 // all of it is
#define OCC_CUT_TWO     2
#define OCC_CUT_FAILED  3

// A plane, turned round if `turn` is -1.
typedef struct occ_cutter {
    float x, y, z, d;
} occ_cutter;

// The least n.v + d w for a vertex that is inside, given e and d w; where cuts are made, so that
// what they make is inside; and the least for the sum of three.
#define OCC_VERTEX_LEAST(e, dw) ((e) + OCC_VERTEX_SLACK + OCC_FABS(dw) * OCC_OFFSET_SLACK)
#define OCC_CUT_LEVEL(e, dw)    (2.0f * OCC_VERTEX_LEAST(e, dw))
#define OCC_MIDDLE_LEAST(e, dw)                                                                    \
    (2.0f * ((e) + 3.0f * OCC_VERTEX_SLACK + OCC_FABS(dw) * OCC_OFFSET_SLACK))

// What a cut adds to the bound, before it is scaled.
#define OCC_CUT_BOUND(f, g, e) (((f) + (g)) * ((e) + OCC_CUT_SLACK) * (1.0f + 0x1p-20f))

OCC_FN float occ_vertex_at(const occ_vertex *v, const occ_cutter *n)
{
    return OCC_PLANE_AT(n->x, n->y, n->z, n->d * v->w, v->x, v->y, v->z);
}

// Where the edge from b, outside, to a, inside, comes to `level`, and its bound, which is *e
// before. 0 if that point is not inside.
OCC_FN int occ_vertex_between(const occ_vertex *a, float at_a, const occ_vertex *b, float at_b,
                              float level, const occ_cutter *n, occ_vertex *c, float *e)
{
    float f = level - at_b, g = at_a - level;
    c->x = f * a->x + g * b->x;
    c->y = f * a->y + g * b->y;
    c->z = f * a->z + g * b->z;
    c->w = f * a->w + g * b->w;
    *e = OCC_CUT_BOUND(f, g, *e);
    return occ_vertex_scale(c, e) && occ_vertex_at(c, n) > OCC_VERTEX_LEAST(*e, n->d * c->w);
}

// Vertices i to end, round the polygon, then c and d. The bounds are as before.
OCC_FN void occ_piece_take(occ_piece *part, const occ_piece *piece, occ_u32 i, occ_u32 end,
                           const occ_vertex *c, const occ_vertex *d)
{
    occ_u32 count = 0;
    for (; i != end; i = i + 1 == piece->count ? 0 : i + 1)
        part->v[count++] = piece->v[i];
    part->v[count++] = *c;
    part->v[count++] = *d;
    part->count = count;
    part->cuts = piece->cuts + 1;
    part->e = piece->e;
    part->w = piece->w;
}

// Where the vertices go in, and where out again: the first that is inside, and the first that is
// outside after it. 0 unless there is one of each.
OCC_FN int occ_piece_crossings(const float *at, occ_u32 count, float level, occ_u32 *first,
                               occ_u32 *last)
{
    occ_u32 entries = 0;
    for (occ_u32 i = 0, before = count - 1; i < count; before = i++) {
        int was_in = at[before] > level, is_in = at[i] > level;
        if (!was_in && is_in) *first = i;
        if (was_in && !is_in) *last = i;
        entries += !was_in && is_in;
    }
    return entries == 1;
}

// All vertices are inside a plane for certain.
OCC_FN int occ_piece_is_inside(const occ_piece *piece, const occ_cutter *n)
{
    float level = OCC_CUT_LEVEL(piece->e, n->d * piece->w);
    for (occ_u32 i = 0; i < piece->count; i++)
        if (!(occ_vertex_at(&piece->v[i], n) > level)) return 0;
    return 1;
}

// Cuts a piece in two, just inside the plane. `inside` may be the piece itself.
OCC_FN int occ_piece_cut(const occ_piece *piece, const occ_cutter *n, occ_piece *inside,
                         occ_piece *outside)
{
    float at[OCC_PIECE_VERTICES], level = OCC_CUT_LEVEL(piece->e, n->d * piece->w);
    occ_u32 count = piece->count, in = 0, first = 0, last = 0;
    for (occ_u32 i = 0; i < count; i++) {
        at[i] = occ_vertex_at(&piece->v[i], n);
        in += at[i] > level;
    }
    if (!in) return OCC_CUT_OUTSIDE;
    if (in == count) return OCC_CUT_INSIDE;
    if (piece->cuts == OCC_PIECE_CUTS || count == OCC_PIECE_VERTICES ||
        !occ_piece_crossings(at, count, level, &first, &last)) {
        return OCC_CUT_FAILED;
    }
    occ_u32 enter = first ? first - 1 : count - 1, leave = last ? last - 1 : count - 1;
    float e_c = piece->e, e_d = piece->e;
    occ_vertex c, d;
    if (!occ_vertex_between(&piece->v[first], at[first], &piece->v[enter], at[enter], level, n, &c,
                            &e_c) ||
        !occ_vertex_between(&piece->v[leave], at[leave], &piece->v[last], at[last], level, n, &d,
                            &e_d)) {
        return OCC_CUT_FAILED;
    }
    occ_piece whole = *piece;
    occ_piece_admit(&whole, &c, e_c);
    occ_piece_admit(&whole, &d, e_d);
    occ_piece_take(outside, &whole, last, first, &c, &d);
    occ_piece_take(inside, &whole, first, last, &d, &c);
    return OCC_CUT_TWO;
}

// Vertices from `first` on, which is 0 or half of them, and the one after: half of a piece of
// eight.
OCC_FN void occ_piece_halve(occ_piece *part, const occ_piece *piece, occ_u32 first)
{
    occ_u32 count = OCC_PIECE_VERTICES / 2 + 1;
    for (occ_u32 i = 0; i < count; i++)
        part->v[i] = piece->v[(first + i) % OCC_PIECE_VERTICES];
    part->e = piece->e;
    part->w = piece->w;
    part->count = count;
    part->cuts = piece->cuts;
}

#endif
