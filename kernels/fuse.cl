// SPDX-License-Identifier: Apache-2.0
// Fusion by a work-group: what fusion.h does for an object, with the vertices of a piece, or the
// candidates, side by side. A GPU's item has no memory for a stack of polygons that is anywhere
// near; a group has local memory. Every item goes the same way, so that barriers are met by all,
// and every decision is that of fusion.h.
#include "flat.h"

#define FUSE_ITEMS 32u

typedef struct fuse_piece {
    float x[OCC_PIECE_VERTICES], y[OCC_PIECE_VERTICES], z[OCC_PIECE_VERTICES];
    float w[OCC_PIECE_VERTICES], e[OCC_PIECE_VERTICES];
    uint count, cuts;
} fuse_piece;

typedef struct fuse_group {
    fuse_piece stack[OCC_FUSION_STACK + 1u];
    fuse_piece piece; // in hand
    float at[OCC_PIECE_VERTICES], least[OCC_PIECE_VERTICES];
    float cut[2][5]; // where the edge comes in, and where it goes out
    uint failed;
    uint planes[OCC_FLAT_LIST]; // that cut the object, of each candidate
    uint faces, held, found;
    occ_outline outline;
} fuse_group;

inline void get_vertex(occ_vertex *v, __local const fuse_piece *piece, uint i)
{
    v->x = piece->x[i];
    v->y = piece->y[i];
    v->z = piece->z[i];
    v->w = piece->w[i];
    v->e = piece->e[i];
}

inline void put_vertex(__local fuse_piece *piece, uint i, const occ_vertex *v)
{
    piece->x[i] = v->x;
    piece->y[i] = v->y;
    piece->z[i] = v->z;
    piece->w[i] = v->w;
    piece->e[i] = v->e;
}

inline void copy_piece(__local fuse_piece *to, __local const fuse_piece *from, uint item)
{
    occ_vertex v;
    if (to == from) return;
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item < from->count) {
        get_vertex(&v, from, item);
        put_vertex(to, item, &v);
    }
    if (item == 0) {
        to->count = from->count;
        to->cuts = from->cuts;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
}

// --- cutting -------------------------------------------------------------------------------------

// What all items know of a cut.
typedef struct fuse_crossing {
    float level;
    uint in, entries, first, last;
} fuse_crossing;

// (Loops of a fixed length, so that the loads of all rounds are under way at once.)
inline void find_crossing(__local const fuse_group *group, uint count, fuse_crossing *cross)
{
    float level = 0.0f;
    uint inside = 0;
#pragma unroll
    for (uint i = 0; i < OCC_PIECE_VERTICES; i++) {
        float least = i < count ? 2.0f * group->least[i] : 0.0f;
        if (least > level) level = least;
    }
#pragma unroll
    for (uint i = 0; i < OCC_PIECE_VERTICES; i++)
        if (i < count && group->at[i] > level) inside |= 1u << i;
    // Bit i: vertex i is inside and the one before it is not, and the other way round.
    uint before = (inside << 1 | inside >> (count - 1u)) & ((1u << count) - 1u);
    uint enters = inside & ~before, leaves = before & ~inside;
    cross->level = level;
    cross->in = popcount(inside);
    cross->entries = popcount(enters);
    cross->first = enters ? 31u - clz(enters & (0u - enters)) : 0u;
    cross->last = leaves ? 31u - clz(leaves & (0u - leaves)) : 0u;
}

// Vertex `item` of the part that begins with cut `a`, goes on with `run` vertices from `first`, and
// ends with the other cut.
inline void part_vertex(__local const fuse_group *group, __local const fuse_piece *piece, uint item,
                        uint a, uint first, uint run, occ_vertex *v)
{
    if (item > 0 && item <= run) {
        uint i = first + item - 1u;
        get_vertex(v, piece, i < piece->count ? i : i - piece->count);
        return;
    }
    __local const float *cut = group->cut[item ? 1u - a : a];
    v->x = cut[0];
    v->y = cut[1];
    v->z = cut[2];
    v->w = cut[3];
    v->e = cut[4];
}

// Items 0 and 1 find where the edges cross.
inline void cross_edges(__local fuse_group *group, __local const fuse_piece *piece,
                        const fuse_crossing *cross, const occ_cutter *n, uint item)
{
    if (item > 1u) return;
    uint count = piece->count;
    uint inner = item ? (cross->last ? cross->last : count) - 1u : cross->first;
    uint outer = item ? cross->last : (cross->first ? cross->first : count) - 1u;
    occ_vertex a, b, c;
    get_vertex(&a, piece, inner);
    get_vertex(&b, piece, outer);
    if (!occ_vertex_between(&a, group->at[inner], &b, group->at[outer], cross->level, n, &c)) {
        atomic_or(&group->failed, 1u);
    }
    __local float *cut = group->cut[item];
    cut[0] = c.x;
    cut[1] = c.y;
    cut[2] = c.z;
    cut[3] = c.w;
    cut[4] = c.e;
}

// As occ_piece_cut(). `inside` may be the piece itself.
inline uint cut_piece(__local fuse_group *group, __local fuse_piece *piece, const occ_cutter *n,
                      __local fuse_piece *inside, __local fuse_piece *outside, uint item)
{
    barrier(CLK_LOCAL_MEM_FENCE);
    uint count = piece->count, cuts = piece->cuts;
    occ_vertex v, rest;
    if (item < count) {
        get_vertex(&v, piece, item);
        group->at[item] = occ_vertex_at(&v, n);
        group->least[item] = occ_vertex_least(&v, n);
    }
    if (item == 0) group->failed = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    fuse_crossing cross;
    find_crossing(group, count, &cross);
    uint in = cross.in, out = count - in, result = OCC_CUT_TWO;
    if (!in) {
        result = OCC_CUT_OUTSIDE;
    } else if (!out) {
        result = OCC_CUT_INSIDE;
    } else if (cuts == OCC_PIECE_CUTS || in + 2u > OCC_PIECE_VERTICES ||
               out + 2u > OCC_PIECE_VERTICES || cross.entries != 1u) {
        result = OCC_CUT_FAILED;
    } else {
        cross_edges(group, piece, &cross, n, item);
        barrier(CLK_LOCAL_MEM_FENCE);
        if (item < in + 2u) part_vertex(group, piece, item, 0u, cross.first, in, &v);
        if (item < out + 2u) part_vertex(group, piece, item, 1u, cross.last, out, &rest);
        if (group->failed) result = OCC_CUT_FAILED;
        barrier(CLK_LOCAL_MEM_FENCE);
        if (result == OCC_CUT_TWO) {
            if (item < in + 2u) put_vertex(inside, item, &v);
            if (item < out + 2u) put_vertex(outside, item, &rest);
            if (item == 0) {
                inside->count = in + 2u;
                outside->count = out + 2u;
                inside->cuts = outside->cuts = cuts + 1u;
            }
        }
        barrier(CLK_LOCAL_MEM_FENCE);
    }
    return result;
}

// --- candidates ----------------------------------------------------------------------------------

// Fusion takes the first that touch the object, and no more than it has room for.
inline void drop_surplus(__local fuse_group *group, uint count)
{
    uint taken = 0;
    for (uint i = 0; i < count; i++) {
        if (taken == OCC_FUSION_CANDIDATES) group->planes[i] = 0;
        taken += group->planes[i] != 0;
    }
}

// As occ_fusion_consider(), for all of a block's list. Candidates that do not touch the object have
// no planes.
inline void consider_all(__local fuse_group *group, const occ_relative_box *box,
                         __global const occ_shadow *shadows, __global const uint *list, uint count,
                         uint row, uint item)
{
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item == 0) group->faces = group->held = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint i = item; i < count; i += FUSE_ITEMS) {
        __global const occ_shadow *shadow = &shadows[list[i]];
        uint cutting = 0, apart = shadow->owner == row;
        for (uint p = 0; p < shadow->planes && !apart; p++) {
            OCC_PLANES_OF n = shadow->plane[p];
            float s = OCC_PLANE_AT(n[0], n[1], n[2], n[3], box->t[0], box->t[1], box->t[2]);
            float r = occ_box_reach(box, n[0], n[1], n[2]);
            apart = OCC_IS_OUTSIDE(s, r, box->e);
            if (!OCC_IS_INSIDE(s, r, box->e)) cutting |= 1u << p;
        }
        if (!apart && !cutting) atomic_or(&group->held, 1u);
        group->planes[i] = apart ? 0u : cutting;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item == 0 && count > OCC_FUSION_CANDIDATES) drop_surplus(group, count);
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint i = item; i < count; i += FUSE_ITEMS)
        if (group->planes[i] >> occ_shadow_silhouettes(&shadows[list[i]])) {
            atomic_or(&group->faces, 1u);
        }
    barrier(CLK_LOCAL_MEM_FENCE);
}

// As occ_fusion_find().
inline uint find_candidate(__local fuse_group *group, __local const fuse_piece *top,
                           __global const occ_shadow *shadows, __global const uint *list,
                           uint count, int by_faces, uint item)
{
    occ_vertex a, b, c, middle;
    get_vertex(&a, top, 0);
    get_vertex(&b, top, top->count / OCC_MIDDLE_CORNERS);
    get_vertex(&c, top, 2u * top->count / OCC_MIDDLE_CORNERS);
    middle.x = (a.x + b.x) + c.x;
    middle.y = (a.y + b.y) + c.y;
    middle.z = (a.z + b.z) + c.z;
    middle.w = (a.w + b.w) + c.w;
    middle.e = (a.e + b.e) + c.e;
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item == 0) group->found = count;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint i = item; i < count; i += FUSE_ITEMS) {
        uint planes = group->planes[i];
        __global const occ_shadow *shadow = &shadows[list[i]];
        if (!planes || (!by_faces && planes >> occ_shadow_silhouettes(shadow))) continue;
        if (!occ_shadow_holds(shadow, planes, &middle)) continue;
        atomic_min(&group->found, i);
        break;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    return group->found;
}

// --- the object ----------------------------------------------------------------------------------

// As occ_fusion_subtract(). Returns the new depth, or OCC_FLAT_OUTSIDE if that cannot be done.
inline uint subtract(__local fuse_group *group, uint depth, __global const occ_shadow *shadow,
                     uint planes, uint item)
{
    copy_piece(&group->piece, &group->stack[--depth], item);
    for (; planes; planes &= planes - 1u) {
        occ_cutter n;
        occ_cutter_set(&n, shadow->plane[31u - clz(planes & (0u - planes))], 1.0f);
        if (depth == OCC_FUSION_STACK) return OCC_FLAT_OUTSIDE;
        uint cut = cut_piece(group, &group->piece, &n, &group->piece, &group->stack[depth], item);
        if (cut == OCC_CUT_OUTSIDE || cut == OCC_CUT_FAILED) return OCC_FLAT_OUTSIDE;
        depth += cut == OCC_CUT_TWO;
    }
    return depth;
}

// As occ_fusion_clip(). Returns the new depth.
inline uint clip_pieces(__local fuse_group *group, uint depth, __global const occ_eye *eye,
                        uint mask, uint item)
{
    for (uint p = 0; p < OCC_SIDE_PLANES; p++) {
        if (!(mask >> p & 1u)) continue;
        occ_cutter beyond;
        occ_cutter_set(&beyond, eye->plane[p], -1.0f);
        uint kept = 0;
        for (uint i = 0; i < depth; i++) {
            __local fuse_piece *rest = &group->stack[OCC_FUSION_STACK];
            uint cut = cut_piece(group, &group->stack[i], &beyond, &group->piece, rest, item);
            if (cut == OCC_CUT_INSIDE) continue;
            copy_piece(&group->stack[kept++], cut == OCC_CUT_TWO ? rest : &group->stack[i], item);
        }
        depth = kept;
    }
    return depth;
}

// Puts the outline, or the faces, on the stack. Returns the depth, or 0 if that cannot be.
inline uint see_outline(__local fuse_group *group, const occ_relative_box *box,
                        __global const occ_eye *eye, int by_faces, uint item)
{
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item == 0) {
        occ_outline outline;
        group->failed = !occ_outline_set(&outline, box, eye, by_faces);
        group->outline = outline;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    uint failed = group->failed, polygons = group->outline.polygons;
    uint corners = group->outline.corners;
    barrier(CLK_LOCAL_MEM_FENCE);
    if (failed) return 0;
    for (uint i = item; i < polygons * corners; i += FUSE_ITEMS) {
        __local fuse_piece *piece = &group->stack[i / corners];
        occ_vertex v;
        if (!occ_outline_corner(box, group->outline.corner[i / corners][i % corners], &v)) {
            atomic_or(&group->failed, 1u);
        }
        put_vertex(piece, i % corners, &v);
        if (i % corners == 0) {
            piece->count = corners;
            piece->cuts = 0;
        }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    return group->failed ? 0u : polygons;
}

// As occ_fusion_covers(), from the outline on.
inline int covers(__local fuse_group *group, const occ_relative_box *box,
                  __global const occ_eye *eye, uint mask, __global const occ_shadow *shadows,
                  __global const uint *list, uint count, int by_faces, uint item)
{
    uint depth = see_outline(group, box, eye, by_faces, item), split = 0;
    if (!depth) return 0;
    depth = clip_pieces(group, depth, eye, mask, item);
    for (; depth && depth != OCC_FLAT_OUTSIDE; split++) {
        uint i =
            find_candidate(group, &group->stack[depth - 1u], shadows, list, count, by_faces, item);
        if (i == count || split == eye->splits) return 0;
        depth = subtract(group, depth, &shadows[list[i]], group->planes[i], item);
    }
    return depth == 0;
}

// As occ_box_fused(), for what occ_flat_object() has left unresolved.
inline int group_fuses(__local fuse_group *group, const occ_relative_box *box,
                       __global const occ_eye *eye, uint mask, __global const occ_shadow *shadows,
                       __global const uint *list, uint count, uint row, uint item)
{
    consider_all(group, box, shadows, list, count, row, item);
    uint held = group->held, faces = group->faces;
    if (held) return 1;
    if (covers(group, box, eye, mask, shadows, list, count, 0, item)) return 1;
    return faces && covers(group, box, eye, mask, shadows, list, count, 1, item);
}

// As occ_flat_fuse().
__kernel __attribute__((reqd_work_group_size(FUSE_ITEMS, 1, 1))) void
occ_flat_fuse_group(__global const occ_flat_frame *frame, __global const float *boxes, uint stride,
                    __global uint *counts, __global const uint *states, __global const uint *lists,
                    __global const uint *slot_of, uint arranged, __global const uint *unresolved,
                    __global uint *mask)
{
    __local fuse_group group;
    __global uint *count = counts + frame->counts * OCC_COUNTS;
    uint item = (uint)get_local_id(0), objects = count[OCC_COUNT_UNRESOLVED];
    for (uint i = (uint)get_group_id(0); i < objects; i += (uint)get_num_groups(0)) {
        uint row = unresolved[i], block = row / OCC_FLAT_ROWS, state = states[block];
        occ_relative_box box;
        load_row(&box, boxes, stride, row, &frame->eye);
        int hidden = group_fuses(&group, &box, &frame->eye, state >> 8, FRAME_SHADOWS(frame),
                                 lists + (size_t)block * OCC_FLAT_LIST, state & 0xffu, row, item);
        if (!hidden && item == 0) {
            uint slot = arranged ? slot_of[row] : row;
            atomic_or(&mask[slot / 32u], 1u << (slot % 32u));
            atomic_inc(&count[OCC_COUNT_VISIBLE]);
        }
    }
}
