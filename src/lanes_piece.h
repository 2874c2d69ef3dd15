// SPDX-License-Identifier: Apache-2.0
// Pieces as vectors: kernels/piece.h with the vertices side by side. The operations on a vertex are
// the same in the same order, and so are the bits.
#ifndef OCC_LANES_PIECE_H
#define OCC_LANES_PIECE_H

#include "wide.h"

#include "outline.h"

#include <stdbool.h>

// Vertices beyond `count` are whatever they are.
typedef struct piece_lanes {
    float x[OCC_PIECE_VERTICES], y[OCC_PIECE_VERTICES], z[OCC_PIECE_VERTICES];
    float w[OCC_PIECE_VERTICES];
    uint32_t count, cuts;
} piece_lanes;

static inline uint32_t lanes_below(uint32_t count)
{
    return (1u << count) - 1u;
}

// n.v + d w of the vertices from `l` on, as many as there are lanes.
static inline fnode vertices_at(const piece_lanes *piece, uint32_t l, const occ_cutter *n)
{
    return OCC_PLANE_AT(n->x, n->y, n->z, n->d * load_node(piece->w + l), load_node(piece->x + l),
                        load_node(piece->y + l), load_node(piece->z + l));
}

// The vertices that are inside a plane, and n.v + d w of all.
static inline uint32_t vertices_inside(const piece_lanes *piece, const occ_cutter *n, float level,
                                       float *at)
{
    uint32_t in = 0;
    for (uint32_t l = 0; l < OCC_PIECE_VERTICES; l += OCC_NODE_WIDTH) {
        fnode value = vertices_at(piece, l, n);
        store_node(at + l, value);
        in |= above_node(value, splat_node(level)) << l;
    }
    return in & lanes_below(piece->count);
}

// As occ_piece_is_inside().
static inline bool is_inside(const piece_lanes *piece, const occ_cutter *n)
{
    float at[OCC_PIECE_VERTICES];
    uint32_t in = vertices_inside(piece, n, OCC_VERTEX_LEAST(piece->cuts), at);
    return in == lanes_below(piece->count);
}

// Where a polygon goes into a plane's inner side, from `enter` to `first`, and out, from `leave` to
// `last`.
typedef struct crossings {
    uint32_t first, enter, leave, last;
    uint32_t inside; // how many vertices are
} crossings;

// As occ_piece_crossings().
static inline bool find_crossings(crossings *at, uint32_t in, uint32_t count)
{
    uint32_t all = lanes_below(count);
    uint32_t before = (in << 1 | in >> (count - 1)) & all; // bit i: vertex i - 1 is inside
    uint32_t entries = in & ~before, exits = ~in & before;
    at->first = (uint32_t)__builtin_ctz(entries);
    at->last = (uint32_t)__builtin_ctz(exits);
    at->enter = (at->first ? at->first : count) - 1;
    at->leave = (at->last ? at->last : count) - 1;
    at->inside = (uint32_t)__builtin_popcount(in);
    return !(entries & (entries - 1u));
}

// What a cut makes: lanes 0 and 2 are where the polygon goes out, lane 1 where it goes in.
typedef struct fresh_lanes {
    fnode x, y, z, w;
} fresh_lanes;

// Three of eight floats.
static inline fnode pick(const float *from, uint32_t a, uint32_t b)
{
#if OCC_NODE_WIDTH == 8
    return permute_node(load_node(from), (inode){(int)a, (int)b, (int)a});
#else
    return (fnode){from[a], from[b], from[a]};
#endif
}

// As occ_reciprocal().
static inline fnode reciprocal(fnode x)
{
    fnode r = (fnode)(OCC_RECIPROCAL_GUESS - (inode)x);
    return r * (2.0f - x * r);
}

// As occ_vertex_between(), for both crossings.
static inline bool make_fresh(fresh_lanes *fresh, const piece_lanes *piece, const float *at,
                              const crossings *cross, float level, const occ_cutter *n)
{
    uint32_t a0 = cross->leave, a1 = cross->first, b0 = cross->last, b1 = cross->enter;
    fnode f = level - pick(at, b0, b1), g = pick(at, a0, a1) - level, sum = f + g;
    fnode r = reciprocal(sum);
    fresh->x = r * (f * pick(piece->x, a0, a1) + g * pick(piece->x, b0, b1));
    fresh->y = r * (f * pick(piece->y, a0, a1) + g * pick(piece->y, b0, b1));
    fresh->z = r * (f * pick(piece->z, a0, a1) + g * pick(piece->z, b0, b1));
    fresh->w = r * (f * pick(piece->w, a0, a1) + g * pick(piece->w, b0, b1));
    fnode value = OCC_PLANE_AT(n->x, n->y, n->z, n->d * fresh->w, fresh->x, fresh->y, fresh->z);
    uint32_t good = above_node(value, splat_node(OCC_VERTEX_LEAST(piece->cuts + 1)));
    return (good & above_node(splat_node(OCC_RECIPROCAL_MOST), sum) & 3u) == 3u;
}

// Vertices from `first` on, `n` of them, round the polygon, and then two of the fresh ones, from
// lane `lane` on. `part` may be the piece.
static inline void take(piece_lanes *part, const piece_lanes *piece, uint32_t first, uint32_t n,
                        const fresh_lanes *fresh, uint32_t lane)
{
    const float *from[4] = {piece->x, piece->y, piece->z, piece->w};
    float *to[4] = {part->x, part->y, part->z, part->w};
    const fnode *added = &fresh->x;
#if OCC_NODE_WIDTH == 8
    const inode iota = {0, 1, 2, 3, 4, 5, 6, 7};
    int count = (int)piece->count;
    inode index = iota + (int)first, beyond = iota + (int)(OCC_PIECE_VERTICES + lane - n);
    index -= (index >= count) & count;
    index = (inode)select_node(iota < (int)n, (fnode)index, (fnode)beyond);
    for (uint32_t m = 0; m < 4; m++)
        store_node(to[m], permute_two(load_node(from[m]), added[m], index));
#else
    uint32_t head = piece->count - first < n ? piece->count - first : n;
    for (uint32_t m = 0; m < 4; m++) {
        float old[OCC_PIECE_VERTICES];
        memcpy(old, from[m], sizeof old);
        for (uint32_t i = 0; i < head; i++)
            to[m][i] = old[first + i];
        for (uint32_t i = head; i < n; i++)
            to[m][i] = old[i - head];
        to[m][n] = added[m][lane];
        to[m][n + 1] = added[m][lane + 1];
    }
#endif
    part->count = n + 2;
}

// As occ_piece_cut(): `piece` becomes what is inside.
static inline int cut_piece(piece_lanes *piece, const occ_cutter *n, piece_lanes *outside)
{
    float at[OCC_PIECE_VERTICES], level = OCC_CUT_LEVEL(piece->cuts);
    uint32_t count = piece->count, in = vertices_inside(piece, n, level, at);
    crossings cross;
    fresh_lanes fresh;
    if (!in) return OCC_CUT_OUTSIDE;
    if (in == lanes_below(count)) return OCC_CUT_INSIDE;
    if (piece->cuts == OCC_PIECE_CUTS || count == OCC_PIECE_VERTICES ||
        !find_crossings(&cross, in, count) || !make_fresh(&fresh, piece, at, &cross, level, n)) {
        return OCC_CUT_FAILED;
    }
    piece->cuts++;
    outside->cuts = piece->cuts;
    take(outside, piece, cross.last, count - cross.inside, &fresh, 1);
    take(piece, piece, cross.first, cross.inside, &fresh, 0);
    return OCC_CUT_TWO;
}

// As occ_piece_halve().
static inline void halve_piece(piece_lanes *half, const piece_lanes *piece, uint32_t first)
{
    *half = *piece;
    half->count = OCC_PIECE_VERTICES / 2 + 1;
    for (uint32_t i = 0; i < half->count; i++) {
        uint32_t k = (first + i) % OCC_PIECE_VERTICES;
        half->x[i] = piece->x[k];
        half->y[i] = piece->y[k];
        half->z[i] = piece->z[k];
        half->w[i] = piece->w[k];
    }
}

// The corners of a box whose signs are in `codes`: bit k is set where it is at -axis[k].
static inline void corners_of(const occ_relative_box *box, inode codes, fnode *x, fnode *y,
                              fnode *z)
{
    const float *t = box->t, *a = box->a;
    const inode one = {0}, bit = one - 0x7fffffff - 1;
    fnode s0 = (fnode)((codes << 31 & bit) | 0x3f800000);
    fnode s1 = (fnode)((codes << 30 & bit) | 0x3f800000);
    fnode s2 = (fnode)((codes << 29 & bit) | 0x3f800000);
    *x = OCC_CORNER(t[0], s0 * a[0], s1 * a[3], s2 * a[6]);
    *y = OCC_CORNER(t[1], s0 * a[1], s1 * a[4], s2 * a[7]);
    *z = OCC_CORNER(t[2], s0 * a[2], s1 * a[5], s2 * a[8]);
}

// What brings the largest of x, y, z to [1/2, 1). Where it can.
static inline inode scale_of(fnode x, fnode y, fnode z, fnode *scale)
{
    fnode most = OCC_FABS(x), next = OCC_FABS(y), last = OCC_FABS(z);
    most = select_node(next > most, next, most);
    most = select_node(last > most, last, most);
    inode exponent = (inode)most >> 23;
    *scale = (fnode)((253 - exponent) << 23);
    return (exponent >= 24) & (exponent <= 230);
}

// The corners of polygon i of the outline, as occ_outline_pieces() has them.
static inline bool outline_piece(piece_lanes *piece, const occ_outline *outline, uint32_t i,
                                 const occ_relative_box *box)
{
    uint32_t corner[OCC_PIECE_VERTICES] = {0}, good = 0;
    memcpy(corner, outline->corner[i], sizeof outline->corner[i]);
    for (uint32_t l = 0; l < OCC_PIECE_VERTICES; l += OCC_NODE_WIDTH) {
        inode codes;
        fnode x, y, z, scale;
        memcpy(&codes, corner + l, sizeof codes);
        corners_of(box, codes, &x, &y, &z);
        good |= bits_node(scale_of(x, y, z, &scale)) << l;
        store_node(piece->x + l, x * scale);
        store_node(piece->y + l, y * scale);
        store_node(piece->z + l, z * scale);
        store_node(piece->w + l, scale);
    }
    piece->count = outline->corners;
    piece->cuts = 0;
    return !(lanes_below(outline->corners) & ~good);
}

#endif
