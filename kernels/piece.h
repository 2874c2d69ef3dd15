// SPDX-License-Identifier: Apache-2.0
// Pieces of an object's outline: convex polygons, and how a plane cuts them.
//
// Why rounding does no harm. A vertex is a point of the object in homogeneous coordinates, (x, y,
// z, w) for (x, y, z) / w. Let V be the true vertex, of which v is what floats make. Every vertex
// has a bound e: |n.(v - V)| <= e for every n whose components are at most 1. When an edge from b
// to a is cut, the cut is at c = f a + g b with floats f and g that are not negative. The true cut
// is *defined* to be at C = f A + g B with the same f and g: that is a point of the true edge, and
// so the true pieces fill the true polygon, whatever f and g are; and |n.(c - C)| is at most f e_a
// + g e_b and what computing c rounds. A vertex counts as inside a plane if n.v + d w exceeds e and
// what that sum rounds; then V is inside as well, and a piece all of whose vertices are inside lies
// in the half-space. docs/accuracy.md derives the constants.
#ifndef OCC_PIECE_H
#define OCC_PIECE_H

#include "verdict.h"

#define OCC_PIECE_VERTICES 12u
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
    float e;
} occ_vertex;

typedef struct occ_piece {
    occ_vertex v[OCC_PIECE_VERTICES];
    occ_u32 count;
    occ_u32 cuts; // along the way to it
} occ_piece;

// Times a power of two, so that the largest of x, y, z is in [1/2, 1). 0 if that cannot be.
OCC_FN int occ_vertex_scale(occ_vertex *v)
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
    v->e *= scale;
    return v->e < OCC_VERTEX_WORST;
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

// The least n.v + d w for a vertex that is inside, given e and d w; and for the sum of three.
#define OCC_VERTEX_LEAST(e, dw) ((e) + OCC_VERTEX_SLACK + OCC_FABS(dw) * OCC_OFFSET_SLACK)
#define OCC_MIDDLE_LEAST(e, dw)                                                                    \
    (2.0f * ((e) + 3.0f * OCC_VERTEX_SLACK + OCC_FABS(dw) * OCC_OFFSET_SLACK))

OCC_FN float occ_vertex_least(const occ_vertex *v, const occ_cutter *n)
{
    return OCC_VERTEX_LEAST(v->e, n->d * v->w);
}

OCC_FN float occ_vertex_at(const occ_vertex *v, const occ_cutter *n)
{
    return OCC_PLANE_AT(n->x, n->y, n->z, n->d * v->w, v->x, v->y, v->z);
}

// Where the edge from b, outside, to a, inside, comes to `level`. 0 if that point is not inside.
OCC_FN int occ_vertex_between(const occ_vertex *a, float at_a, const occ_vertex *b, float at_b,
                              float level, const occ_cutter *n, occ_vertex *c)
{
    float f = level - at_b, g = at_a - level;
    c->x = f * a->x + g * b->x;
    c->y = f * a->y + g * b->y;
    c->z = f * a->z + g * b->z;
    c->w = f * a->w + g * b->w;
    c->e = (f * (a->e + OCC_CUT_SLACK) + g * (b->e + OCC_CUT_SLACK)) * (1.0f + 0x1p-20f);
    return occ_vertex_scale(c) && occ_vertex_at(c, n) > occ_vertex_least(c, n);
}

// Vertices i to end, round the polygon, between c and d.
OCC_FN void occ_piece_take(occ_piece *part, const occ_piece *piece, occ_u32 i, occ_u32 end,
                           const occ_vertex *c, const occ_vertex *d)
{
    part->count = 0;
    part->cuts = piece->cuts + 1;
    part->v[part->count++] = *c;
    for (; i != end; i = i + 1 == piece->count ? 0 : i + 1)
        part->v[part->count++] = piece->v[i];
    part->v[part->count++] = *d;
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

// Cuts a piece in two, just inside the plane. `inside` may be the piece itself.
OCC_FN int occ_piece_cut(const occ_piece *piece, const occ_cutter *n, occ_piece *inside,
                         occ_piece *outside)
{
    float at[OCC_PIECE_VERTICES], level = 0.0f;
    occ_u32 count = piece->count, in = 0, first = 0, last = 0;
    for (occ_u32 i = 0; i < count; i++) {
        at[i] = occ_vertex_at(&piece->v[i], n);
        float least = 2.0f * occ_vertex_least(&piece->v[i], n);
        if (least > level) level = least;
    }
    for (occ_u32 i = 0; i < count; i++)
        in += at[i] > level;
    if (!in) return OCC_CUT_OUTSIDE;
    if (in == count) return OCC_CUT_INSIDE;
    if (piece->cuts == OCC_PIECE_CUTS || in + 2 > OCC_PIECE_VERTICES ||
        count - in + 2 > OCC_PIECE_VERTICES ||
        !occ_piece_crossings(at, count, level, &first, &last)) {
        return OCC_CUT_FAILED;
    }
    occ_u32 enter = first ? first - 1 : count - 1, leave = last ? last - 1 : count - 1;
    occ_vertex c, d;
    if (!occ_vertex_between(&piece->v[first], at[first], &piece->v[enter], at[enter], level, n,
                            &c) ||
        !occ_vertex_between(&piece->v[leave], at[leave], &piece->v[last], at[last], level, n, &d)) {
        return OCC_CUT_FAILED;
    }
    occ_piece kept;
    occ_piece_take(&kept, piece, first, last, &c, &d);
    occ_piece_take(outside, piece, last, first, &d, &c);
    *inside = kept;
    return OCC_CUT_TWO;
}

#endif
