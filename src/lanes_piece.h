// SPDX-License-Identifier: Apache-2.0
// Pieces as vectors: kernels/piece.h with the vertices side by side. The operations on a vertex are
// the same in the same order, and so are the bits.
#ifndef OCC_LANES_PIECE_H
#define OCC_LANES_PIECE_H

#include "wide.h"

#include "outline.h"

#define VERTEX_LANES  16u
#define VERTEX_GROUPS ((OCC_PIECE_VERTICES + OCC_WIDTH - 1) / OCC_WIDTH)

// Vertices beyond `count` are whatever they are.
typedef struct piece_lanes {
    float x[VERTEX_LANES], y[VERTEX_LANES], z[VERTEX_LANES], w[VERTEX_LANES], e[VERTEX_LANES];
    uint32_t count, cuts;
} piece_lanes;

static inline occ_vertex vertex_of(const piece_lanes *piece, uint32_t i)
{
    return (occ_vertex){piece->x[i], piece->y[i], piece->z[i], piece->w[i], piece->e[i]};
}

static inline void store_wide(float *to, fwide x)
{
    memcpy(to, &x, sizeof x);
}

// n.v + d w of `OCC_WIDTH` vertices from `l` on, and the least that counts as inside.
static inline fwide vertices_at(const piece_lanes *piece, uint32_t l, const occ_cutter *n,
                                fwide *least)
{
    fwide dw = n->d * load_wide(piece->w + l);
    *least = OCC_VERTEX_LEAST(load_wide(piece->e + l), dw);
    return OCC_PLANE_AT(n->x, n->y, n->z, dw, load_wide(piece->x + l), load_wide(piece->y + l),
                        load_wide(piece->z + l));
}

static inline uint32_t lanes_below(uint32_t count)
{
    return (1u << count) - 1u;
}

// The vertices inside a plane, each for itself.
static inline uint32_t vertices_inside(const piece_lanes *piece, const occ_cutter *n)
{
    uint32_t inside = 0;
    for (uint32_t g = 0; g < VERTEX_GROUPS; g++) {
        fwide least, at = vertices_at(piece, g * OCC_WIDTH, n, &least);
        inside |= bits_wide(at > least) << g * OCC_WIDTH;
    }
    return inside & lanes_below(piece->count);
}

#if OCC_WIDTH == 16
static inline fwide put_in(fwide x, float value, uint32_t lane)
{
    return (fwide)_mm512_mask_broadcastss_ps((__m512)x, (__mmask16)(1u << lane), _mm_set_ss(value));
}
#endif

// Vertex c, then `n` vertices from `first` on, round the polygon, then d. `part` is not `piece`.
static inline void take(piece_lanes *part, const piece_lanes *piece, uint32_t first, uint32_t n,
                        const occ_vertex *c, const occ_vertex *d)
{
#if OCC_WIDTH == 16
    static const iwide iota = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    iwide index = iota + ((int32_t)first - 1);
    int32_t count = (int32_t)piece->count;
    index -= (index >= count) & count;
#define OCC_TAKE(m)                                                                                \
    store_wide(part->m,                                                                            \
               put_in(put_in(permute_wide(load_wide(piece->m), index), c->m, 0), d->m, n + 1))
    OCC_TAKE(x);
    OCC_TAKE(y);
    OCC_TAKE(z);
    OCC_TAKE(w);
    OCC_TAKE(e);
#undef OCC_TAKE
#else
    const float *from[5] = {piece->x, piece->y, piece->z, piece->w, piece->e};
    float *to[5] = {part->x, part->y, part->z, part->w, part->e};
    const float start[5] = {c->x, c->y, c->z, c->w, c->e}, end[5] = {d->x, d->y, d->z, d->w, d->e};
    uint32_t head = piece->count - first < n ? piece->count - first : n;
    for (uint32_t m = 0; m < 5; m++) {
        to[m][0] = start[m];
        for (uint32_t i = 0; i < head; i++)
            to[m][1 + i] = from[m][first + i];
        for (uint32_t i = head; i < n; i++)
            to[m][1 + i] = from[m][i - head];
        to[m][1 + n] = end[m];
    }
#endif
    part->count = n + 2;
    part->cuts = piece->cuts + 1;
}

// As occ_piece_cut(): `piece` becomes what is inside.
static inline int cut_piece(piece_lanes *piece, const occ_cutter *n, piece_lanes *outside)
{
    float at[VERTEX_LANES], level = 0.0f;
    uint32_t count = piece->count, all = lanes_below(count), in = 0;
    fwide value[VERTEX_GROUPS];
    for (uint32_t g = 0; g < VERTEX_GROUPS; g++) {
        fwide least;
        value[g] = vertices_at(piece, g * OCC_WIDTH, n, &least);
        float most = largest_of_wide(2.0f * least, all >> g * OCC_WIDTH);
        if (most > level) level = most;
    }
    for (uint32_t g = 0; g < VERTEX_GROUPS; g++)
        in |= bits_wide(value[g] > level) << g * OCC_WIDTH;
    in &= all;
    if (!in) return OCC_CUT_OUTSIDE;
    if (in == all) return OCC_CUT_INSIDE;
    uint32_t before = (in << 1 | in >> (count - 1)) & all; // bit i: vertex i - 1 is inside
    uint32_t entries = in & ~before, exits = ~in & before & all;
    uint32_t inner = (uint32_t)__builtin_popcount(in);
    if (piece->cuts == OCC_PIECE_CUTS || inner + 2 > OCC_PIECE_VERTICES ||
        count - inner + 2 > OCC_PIECE_VERTICES || (entries & (entries - 1u))) {
        return OCC_CUT_FAILED;
    }
    uint32_t first = (uint32_t)__builtin_ctz(entries), last = (uint32_t)__builtin_ctz(exits);
    uint32_t enter = first ? first - 1 : count - 1, leave = last ? last - 1 : count - 1;
    for (uint32_t g = 0; g < VERTEX_GROUPS; g++)
        store_wide(at + g * OCC_WIDTH, value[g]);
    occ_vertex a = vertex_of(piece, first), b = vertex_of(piece, enter), c, d;
    occ_vertex p = vertex_of(piece, leave), q = vertex_of(piece, last);
    if (!occ_vertex_between(&a, at[first], &b, at[enter], level, n, &c) ||
        !occ_vertex_between(&p, at[leave], &q, at[last], level, n, &d)) {
        return OCC_CUT_FAILED;
    }
    take(outside, piece, last, count - inner, &d, &c);
    piece_lanes whole = *piece;
    take(piece, &whole, first, inner, &c, &d);
    return OCC_CUT_TWO;
}

// As occ_outline_corner() for all corners of polygon i of the outline.
static inline bool outline_piece(piece_lanes *piece, const occ_outline *outline, uint32_t i,
                                 const occ_relative_box *box)
{
    const float *t = box->t, *a = box->a;
    uint32_t corner[VERTEX_LANES] = {0};
    memcpy(corner, outline->corner[i], sizeof outline->corner[i]);
    uint32_t good = 0;
    for (uint32_t g = 0; g * OCC_WIDTH < outline->corners; g++) {
        iwide signs;
        memcpy(&signs, corner + g * OCC_WIDTH, sizeof signs);
        const iwide one = {0}, bit = one - 0x7fffffff - 1;
        fwide s0 = (fwide)((signs << 31 & bit) | 0x3f800000);
        fwide s1 = (fwide)((signs << 30 & bit) | 0x3f800000);
        fwide s2 = (fwide)((signs << 29 & bit) | 0x3f800000);
        fwide x = OCC_CORNER(t[0], s0 * a[0], s1 * a[3], s2 * a[6]);
        fwide y = OCC_CORNER(t[1], s0 * a[1], s1 * a[4], s2 * a[7]);
        fwide z = OCC_CORNER(t[2], s0 * a[2], s1 * a[5], s2 * a[8]);
        fwide most = abs_wide(x);
        most = select_wide(abs_wide(y) > most, abs_wide(y), most);
        most = select_wide(abs_wide(z) > most, abs_wide(z), most);
        iwide exponent = (iwide)most >> 23;
        fwide scale = (fwide)((253 - exponent) << 23), e = scale * box->e;
        good |= bits_wide((exponent >= 24) & (exponent <= 230) & (e < OCC_VERTEX_WORST))
                << g * OCC_WIDTH;
        store_wide(piece->x + g * OCC_WIDTH, x * scale);
        store_wide(piece->y + g * OCC_WIDTH, y * scale);
        store_wide(piece->z + g * OCC_WIDTH, z * scale);
        store_wide(piece->w + g * OCC_WIDTH, scale);
        store_wide(piece->e + g * OCC_WIDTH, e);
    }
    piece->count = outline->corners;
    piece->cuts = 0;
    return !(lanes_below(outline->corners) & ~good);
}

#endif
