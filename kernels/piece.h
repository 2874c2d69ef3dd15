// SPDX-License-Identifier: Apache-2.0
// Pieces of an object's outline: convex polygons, and how a plane cuts them.
//
// Why rounding does no harm. A vertex is a point of the object in homogeneous coordinates, (x, y,
// z, w) for (x, y, z) / w. Let V be the true vertex, of which v is what floats make. With the error
// bound E of the object, |n.(v - V)| <= E w + e for every n whose components are at most 1. When an
// edge from b to a is cut, the cut is at c = r (f a + g b) with floats f, g and r that are not
// negative. The true cut is *defined* to be at C = r (f A + g B) with the same f, g and r: that is
// a point of the true edge, and so the true pieces fill the true polygon, whatever they are. Since
// r is at most 1 / (f + g), e grows by what computing c rounds, the same at every cut. E w is taken
// off by moving planes inward by E, once for all vertices. A vertex counts as inside a plane so
// moved if n.v + d w exceeds e and what that sum rounds; then V is inside as well, and a piece all
// of whose vertices are inside lies in the half-space. docs/accuracy.md derives the constants.
#ifndef OCC_PIECE_H
#define OCC_PIECE_H

#include "verdict.h"

#define OCC_PIECE_VERTICES 8u  // what has as many is halved before it is cut
#define OCC_PIECE_CUTS     16u // one after the other on the way to a piece

// What n.v + d w rounds beside its last term: 14 u.
#define OCC_VERTEX_SLACK 0x1p-19f
// What d w rounds, and w did at all cuts: 50 u.
#define OCC_OFFSET_SLACK 0x1p-18f
// What a cut rounds: 10 u.
#define OCC_CUT_SLACK 0x1p-20f
// What E w rounds, and w did at all cuts: 50 u.
#define OCC_OBJECT_SLACK (1.0f + 0x1p-18f)

#ifdef __OPENCL_C_VERSION__
#define OCC_BITS_OF(x)     as_uint(x)
#define OCC_FLOAT_OF(bits) as_float(bits)
#else
#include <string.h>
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

// None of x, y, z is above 1.
typedef struct occ_vertex {
    float x, y, z, w;
} occ_vertex;

typedef struct occ_piece {
    occ_vertex v[OCC_PIECE_VERTICES];
    occ_u32 count;
    occ_u32 cuts; // along the way to it
} occ_piece;

// --- cutting -------------------------------------------------------------------------------------

#define OCC_CUT_OUTSIDE 0 // none of it is inside for certain
#define OCC_CUT_INSIDE  1 // all of it is
#define OCC_CUT_TWO     2
#define OCC_CUT_FAILED  3

// A plane moved inward by the error of the object, and what d w rounds.
typedef struct occ_cutter {
    float x, y, z, d;
} occ_cutter;

// An offset moved inward, given the object's bound E.
#define OCC_CUTTER_OFFSET(d, object)                                                               \
    ((d) - ((object)*OCC_OBJECT_SLACK + OCC_FABS(d) * OCC_OFFSET_SLACK))

// The least n.v + d w for a vertex that is inside, after so many cuts; where the next cut is made,
// so that what it makes is inside; and the least for the sum of three.
#define OCC_VERTEX_LEAST(cuts) (OCC_VERTEX_SLACK + (float)(cuts)*OCC_CUT_SLACK)
#define OCC_CUT_LEVEL(cuts)    (3.0f * OCC_VERTEX_LEAST(cuts))
#define OCC_MIDDLE_LEAST(cuts) (6.0f * OCC_VERTEX_LEAST(cuts))

// Of a plane, turned round if `turn` is -1. (A structure that is returned by value would do;
// oclgrind does not know what LLVM makes of it.)
OCC_FN void occ_cutter_set(occ_cutter *n, OCC_PLANES_OF plane, float turn, float object)
{
    n->x = turn * plane[0];
    n->y = turn * plane[1];
    n->z = turn * plane[2];
    n->d = OCC_CUTTER_OFFSET(turn * plane[3], object);
}

OCC_FN float occ_vertex_at(const occ_vertex *v, const occ_cutter *n)
{
    return OCC_PLANE_AT(n->x, n->y, n->z, n->d * v->w, v->x, v->y, v->z);
}

// About 1 / x, never more but for what it rounds: the same bits on every device, which a quotient
// is not. The first guess is off by an eighth at most, and by a 64th what becomes of it.
#define OCC_RECIPROCAL_GUESS 0x7ef311c7
#define OCC_RECIPROCAL_MOST  0x1p100f // the largest x for which this is so, by far

OCC_FN float occ_reciprocal(float x)
{
    float r = OCC_FLOAT_OF((occ_u32)OCC_RECIPROCAL_GUESS - OCC_BITS_OF(x));
    return r * (2.0f - x * r);
}

// Where the edge from b, outside, to a, inside, comes to `level`. 0 if that point is not inside by
// more than `least`.
OCC_FN int occ_vertex_between(const occ_vertex *a, float at_a, const occ_vertex *b, float at_b,
                              float level, float least, const occ_cutter *n, occ_vertex *c)
{
    float f = level - at_b, g = at_a - level, sum = f + g, r = occ_reciprocal(sum);
    c->x = r * (f * a->x + g * b->x);
    c->y = r * (f * a->y + g * b->y);
    c->z = r * (f * a->z + g * b->z);
    c->w = r * (f * a->w + g * b->w);
    return sum < OCC_RECIPROCAL_MOST && occ_vertex_at(c, n) > least;
}

// Vertices i to end, round the polygon, then c and d.
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
    float least = OCC_VERTEX_LEAST(piece->cuts);
    for (occ_u32 i = 0; i < piece->count; i++)
        if (!(occ_vertex_at(&piece->v[i], n) > least)) return 0;
    return 1;
}

// Cuts a piece in two, just inside the plane. `inside` may be the piece itself.
OCC_FN int occ_piece_cut(const occ_piece *piece, const occ_cutter *n, occ_piece *inside,
                         occ_piece *outside)
{
    float at[OCC_PIECE_VERTICES], level = OCC_CUT_LEVEL(piece->cuts);
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
    float least = OCC_VERTEX_LEAST(piece->cuts + 1);
    occ_vertex c, d;
    if (!occ_vertex_between(&piece->v[first], at[first], &piece->v[enter], at[enter], level, least,
                            n, &c) ||
        !occ_vertex_between(&piece->v[leave], at[leave], &piece->v[last], at[last], level, least, n,
                            &d)) {
        return OCC_CUT_FAILED;
    }
    occ_piece whole = *piece;
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
    part->count = count;
    part->cuts = piece->cuts;
}

#endif
