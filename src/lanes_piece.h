// SPDX-License-Identifier: Apache-2.0
// Pieces as vectors: kernels/piece.h with the vertices side by side. The operations on a vertex are
// the same in the same order, and so are the bits.
#ifndef OCC_LANES_PIECE_H
#define OCC_LANES_PIECE_H

#include "wide.h"

#include "outline.h"

#include <stdbool.h>

#define VERTEX_LANES 16u

// Vertices beyond `count` are whatever they are.
typedef struct piece_lanes {
    float x[VERTEX_LANES], y[VERTEX_LANES], z[VERTEX_LANES], w[VERTEX_LANES], e[VERTEX_LANES];
    uint32_t count, cuts;
} piece_lanes;

static inline occ_vertex vertex_of(const piece_lanes *piece, uint32_t i)
{
    return (occ_vertex){piece->x[i], piece->y[i], piece->z[i], piece->w[i], piece->e[i]};
}

static inline uint32_t lanes_below(uint32_t count)
{
    return (1u << count) - 1u;
}

// n.v + d w of the vertices from `l` on, as many as there are lanes, and the least that is inside.
static inline fnode vertices_at(const piece_lanes *piece, uint32_t l, const occ_cutter *n,
                                fnode *least)
{
    fnode dw = n->d * load_node(piece->w + l);
    *least = OCC_VERTEX_LEAST(load_node(piece->e + l), dw);
    return OCC_PLANE_AT(n->x, n->y, n->z, dw, load_node(piece->x + l), load_node(piece->y + l),
                        load_node(piece->z + l));
}

#if OCC_WIDTH == 16
// As take(), where all fits into eight lanes.
static inline void take_eight(piece_lanes *part, const piece_lanes *piece, uint32_t first,
                              uint32_t n, const occ_vertex *c, const occ_vertex *d)
{
    const __m256i iota = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    __m256i count = _mm256_set1_epi32((int)piece->count);
    __m256i index = _mm256_add_epi32(iota, _mm256_set1_epi32((int)first - 1));
    __mmask8 over = _mm256_cmpge_epi32_mask(index, count), end = (__mmask8)(1u << (n + 1));
    index = _mm256_mask_sub_epi32(index, over, index, count);
    const float *from[5] = {piece->x, piece->y, piece->z, piece->w, piece->e};
    float *to[5] = {part->x, part->y, part->z, part->w, part->e};
    const float *start = &c->x, *last = &d->x;
    for (uint32_t m = 0; m < 5; m++) {
        __m256 x = _mm256_permutexvar_ps(index, _mm256_loadu_ps(from[m]));
        x = _mm256_mask_broadcastss_ps(x, 1, _mm_load_ss(start + m));
        x = _mm256_mask_broadcastss_ps(x, end, _mm_load_ss(last + m));
        _mm256_storeu_ps(to[m], x);
    }
}
#endif

// Vertex c, then `n` vertices from `first` on, round the polygon, then d. `part` is not `piece`.
static inline void take(piece_lanes *part, const piece_lanes *piece, uint32_t first, uint32_t n,
                        const occ_vertex *c, const occ_vertex *d)
{
    part->count = n + 2;
    part->cuts = piece->cuts + 1;
#if OCC_WIDTH == 16
    if (piece->count <= 8 && n + 2 <= 8) {
        take_eight(part, piece, first, n, c, d);
        return;
    }
#endif
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
}

// As occ_piece_cut(): `piece` becomes what is inside.
static inline int cut_piece(piece_lanes *piece, const occ_cutter *n, piece_lanes *outside)
{
    float at[VERTEX_LANES], level = 0.0f;
    uint32_t count = piece->count, all = lanes_below(count), in = 0;
    for (uint32_t l = 0; l < count; l += OCC_NODE_WIDTH) {
        fnode least, value = vertices_at(piece, l, n, &least);
        uint32_t left = count - l < OCC_NODE_WIDTH ? count - l : OCC_NODE_WIDTH;
        float most = 2.0f * largest_of_node(least, left);
        store_node(at + l, value);
        if (most > level) level = most;
    }
    for (uint32_t l = 0; l < count; l += OCC_NODE_WIDTH)
        in |= above_node(load_node(at + l), splat_node(level)) << l;
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

// The corners of polygon i of the outline: as occ_outline_corner() for each.
static inline bool outline_piece(piece_lanes *piece, const occ_outline *outline, uint32_t i,
                                 const occ_relative_box *box)
{
    uint32_t corner[VERTEX_LANES] = {0}, good = 0;
    memcpy(corner, outline->corner[i], sizeof outline->corner[i]);
    for (uint32_t l = 0; l < outline->corners; l += OCC_NODE_WIDTH) {
        inode codes;
        fnode x, y, z;
        memcpy(&codes, corner + l, sizeof codes);
        corners_of(box, codes, &x, &y, &z);
        fnode most = OCC_FABS(x), next = OCC_FABS(y), last = OCC_FABS(z);
        most = select_node(next > most, next, most);
        most = select_node(last > most, last, most);
        inode exponent = (inode)most >> 23;
        fnode scale = (fnode)((253 - exponent) << 23), e = scale * box->e;
        good |= bits_node((exponent >= 24) & (exponent <= 230) & (e < OCC_VERTEX_WORST)) << l;
        store_node(piece->x + l, x * scale);
        store_node(piece->y + l, y * scale);
        store_node(piece->z + l, z * scale);
        store_node(piece->w + l, scale);
        store_node(piece->e + l, e);
    }
    piece->count = outline->corners;
    piece->cuts = 0;
    return !(lanes_below(outline->corners) & ~good);
}

#endif
