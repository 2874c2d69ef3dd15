// SPDX-License-Identifier: Apache-2.0
// Fusion by a work-group: what fusion.h does for an object, with the vertices of a piece, or the
// candidates, side by side. A GPU's item has no memory for a stack of polygons that is anywhere
// near; a group has local memory. Every item goes the same way, so that barriers are met by all,
// and every decision is that of fusion.h.
#include "flat.h"

#define FUSE_ITEMS 32u

// What is known of a candidate.
#define FUSE_TOUCHES 1u // it is not the object's own, and may hold some of it
#define FUSE_BEHIND  2u // all of the object is behind its faces

typedef struct fuse_group {
    occ_piece stack[OCC_FUSION_STACK + 1u]; // the last one is for what a cut leaves over
    occ_piece piece;                        // in hand
    float at[OCC_PIECE_VERTICES];
    occ_vertex cut[2]; // where the outline comes in, and where it goes out
    uint failed, cutting, found, refused;
    uint candidate[OCC_FLAT_LIST];
    occ_outline outline;
} fuse_group;

OCC_FN void copy_piece(__local occ_piece *to, __local const occ_piece *from, uint item)
{
    if (to == from) return;
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item < from->count) to->v[item] = from->v[item];
    if (item == 0) {
        to->count = from->count;
        to->cuts = from->cuts;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
}

// --- cutting -------------------------------------------------------------------------------------

// How far inside the plane each vertex is; every item may ask afterwards.
OCC_FN void measure_piece(__local fuse_group *group, __local const occ_piece *piece,
                          const occ_cutter *n, uint item)
{
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item < piece->count) {
        occ_vertex v = piece->v[item];
        group->at[item] = occ_vertex_at(&v, n);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
}

// Bit i: vertex i is more than `least` inside. (A loop of a fixed length, so that the loads of all
// rounds are under way at once.)
OCC_FN uint vertices_inside(__local const fuse_group *group, uint count, float least)
{
    uint inside = 0;
#pragma unroll
    for (uint i = 0; i < OCC_PIECE_VERTICES; i++)
        if (i < count && group->at[i] > least) inside |= 1u << i;
    return inside;
}

OCC_FN uint lowest_bit(uint bits)
{
    return 31u - clz(bits & (0u - bits));
}

// Items 0 and 1 find where the outline crosses, between the vertices before `first` and `last` and
// those.
OCC_FN void cross_edges(__local fuse_group *group, __local const occ_piece *piece, uint first,
                        uint last, const occ_cutter *n, uint item)
{
    if (item == 0) group->failed = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item < 2u) {
        uint end = item ? last : first, before = (end ? end : piece->count) - 1u;
        uint inner = item ? before : end, outer = item ? end : before;
        occ_vertex a = piece->v[inner], b = piece->v[outer], c;
        if (!occ_vertex_between(&a, group->at[inner], &b, group->at[outer],
                                OCC_CUT_LEVEL(piece->cuts), OCC_VERTEX_LEAST(piece->cuts + 1u), n,
                                &c)) {
            atomic_or(&group->failed, 1u);
        }
        group->cut[item] = c;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
}

// Vertex `item` of a part: `run` vertices from `first` on, then cut `a` and the other one.
OCC_FN occ_vertex part_vertex(__local const fuse_group *group, __local const occ_piece *piece,
                              uint item, uint first, uint run, uint a)
{
    uint i = first + item;
    if (item >= run) return group->cut[item == run ? a : 1u - a];
    return piece->v[i < piece->count ? i : i - piece->count];
}

// Both parts of a piece that has been found to be cut; `inside` may be the piece itself.
OCC_FN void part_piece(__local const fuse_group *group, __local const occ_piece *piece, uint first,
                       uint last, uint in, __local occ_piece *inside, __local occ_piece *outside,
                       uint item)
{
    uint out = piece->count - in, cuts = piece->cuts + 1u;
    occ_vertex v, rest;
    if (item < in + 2u) v = part_vertex(group, piece, item, first, in, 1u);
    if (item < out + 2u) rest = part_vertex(group, piece, item, last, out, 0u);
    barrier(CLK_LOCAL_MEM_FENCE);
    if (item < in + 2u) inside->v[item] = v;
    if (item < out + 2u) outside->v[item] = rest;
    if (item == 0) {
        inside->count = in + 2u;
        outside->count = out + 2u;
        inside->cuts = outside->cuts = cuts;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
}

// As occ_piece_cut(), of a piece that has been measured.
OCC_FN uint cut_piece(__local fuse_group *group, __local const occ_piece *piece,
                      const occ_cutter *n, __local occ_piece *inside, __local occ_piece *outside,
                      uint item)
{
    uint count = piece->count, within = vertices_inside(group, count, OCC_CUT_LEVEL(piece->cuts));
    // Bit i: vertex i is inside and the one before it is not, and the other way round.
    uint before = (within << 1 | within >> (count - 1u)) & ((1u << count) - 1u);
    uint enters = within & ~before, leaves = before & ~within, in = popcount(within);
    if (!in) return OCC_CUT_OUTSIDE;
    if (in == count) return OCC_CUT_INSIDE;
    if (piece->cuts == OCC_PIECE_CUTS || count == OCC_PIECE_VERTICES || popcount(enters) != 1) {
        return OCC_CUT_FAILED;
    }
    uint first = lowest_bit(enters), last = lowest_bit(leaves);
    cross_edges(group, piece, first, last, n, item);
    if (group->failed) return OCC_CUT_FAILED;
    part_piece(group, piece, first, last, in, inside, outside, item);
    return OCC_CUT_TWO;
}

// As occ_piece_halve(), for both halves of the piece in hand.
OCC_FN void halve_piece(__local fuse_group *group, uint depth, uint item)
{
    uint vertices = OCC_PIECE_VERTICES / 2u + 1u, which = item / vertices, i = item % vertices;
    if (which < 2u) {
        __local occ_piece *part = &group->stack[depth + which];
        part->v[i] = group->piece.v[(which * (OCC_PIECE_VERTICES / 2u) + i) % OCC_PIECE_VERTICES];
        if (i == 0) {
            part->count = vertices;
            part->cuts = group->piece.cuts;
        }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
}

// --- candidates ----------------------------------------------------------------------------------

// What there is to know of the block's candidates, once for an object.
OCC_FN void consider_all(__local fuse_group *group, const occ_relative_box *box,
                         __global const occ_shadow *shadows, __global const uint *list, uint count,
                         uint row, uint item)
{
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint i = item; i < count; i += FUSE_ITEMS) {
        __global const occ_shadow *shadow = &shadows[list[i]];
        uint apart = shadow->owner == row, behind = 1u;
        for (uint p = 0; p < shadow->planes && !apart; p++) {
            OCC_PLANES_OF n = shadow->plane[p];
            float s = OCC_PLANE_AT(n[0], n[1], n[2], n[3], box->t[0], box->t[1], box->t[2]);
            float r = occ_box_reach(box, n[0], n[1], n[2]);
            apart = OCC_IS_OUTSIDE(s, r, box->e);
            if (p >= occ_shadow_silhouettes(shadow) && !OCC_IS_INSIDE(s, r, box->e)) behind = 0;
        }
        group->candidate[i] = apart ? 0u : behind ? FUSE_TOUCHES | FUSE_BEHIND : FUSE_TOUCHES;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
}

// As occ_fusion_find(), which goes through the list in order: *faces is only of what comes before
// the one that is found.
OCC_FN uint find_candidate(__local fuse_group *group, __local const occ_piece *top,
                           __global const occ_shadow *shadows, __global const uint *list,
                           uint count, float object, int by_faces, int *faces, uint item)
{
    occ_vertex middle;
    if (item == 0) group->found = group->refused = count;
    barrier(CLK_LOCAL_MEM_FENCE);
    uint third = top->count / OCC_MIDDLE_CORNERS, thirds = 2u * top->count / OCC_MIDDLE_CORNERS;
    occ_vertex a = top->v[0], b = top->v[third], c = top->v[thirds];
    middle.x = (a.x + b.x) + c.x;
    middle.y = (a.y + b.y) + c.y;
    middle.z = (a.z + b.z) + c.z;
    middle.w = (a.w + b.w) + c.w;
    for (uint i = item; i < count; i += FUSE_ITEMS) {
        uint known = group->candidate[i];
        if (!known || !occ_shadow_holds(&shadows[list[i]], &middle, top->cuts, object)) continue;
        if (by_faces || (known & FUSE_BEHIND)) {
            atomic_min(&group->found, i);
            break;
        }
        atomic_min(&group->refused, i);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    uint found = group->found;
    *faces = *faces || group->refused < found;
    barrier(CLK_LOCAL_MEM_FENCE);
    return found;
}

// --- the object ----------------------------------------------------------------------------------

// Which planes of a shadow not all of the piece in hand is inside of, for certain.
OCC_FN uint cutting_planes(__local fuse_group *group, __global const occ_shadow *shadow,
                           float object, uint item)
{
    uint count = group->piece.count;
    float least = OCC_VERTEX_LEAST(group->piece.cuts);
    if (item == 0) group->cutting = 0;
    barrier(CLK_LOCAL_MEM_FENCE);
    for (uint k = item; k < shadow->planes * OCC_PIECE_VERTICES; k += FUSE_ITEMS) {
        uint p = k / OCC_PIECE_VERTICES, i = k % OCC_PIECE_VERTICES;
        occ_cutter n;
        if (i >= count) continue;
        occ_vertex v = group->piece.v[i];
        occ_cutter_set(&n, shadow->plane[p], 1.0f, object);
        if (!(occ_vertex_at(&v, &n) > least)) atomic_or(&group->cutting, 1u << p);
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    return group->cutting;
}

// As occ_fusion_subtract(). Returns the new depth, or OCC_FLAT_OUTSIDE if that cannot be done.
OCC_FN uint subtract(__local fuse_group *group, uint depth, __global const occ_shadow *shadow,
                     float object, uint item)
{
    copy_piece(&group->piece, &group->stack[--depth], item);
    for (uint left = cutting_planes(group, shadow, object, item); left; left &= left - 1u) {
        occ_cutter n;
        occ_cutter_set(&n, shadow->plane[lowest_bit(left)], 1.0f, object);
        if (depth + 2u > OCC_FUSION_STACK) return OCC_FLAT_OUTSIDE;
        measure_piece(group, &group->piece, &n, item);
        float least = OCC_VERTEX_LEAST(group->piece.cuts);
        if (group->piece.count == OCC_PIECE_VERTICES &&
            popcount(vertices_inside(group, OCC_PIECE_VERTICES, least)) != OCC_PIECE_VERTICES) {
            halve_piece(group, depth, item);
            return depth + 2u;
        }
        uint cut = cut_piece(group, &group->piece, &n, &group->piece, &group->stack[depth], item);
        if (cut == OCC_CUT_OUTSIDE || cut == OCC_CUT_FAILED) return OCC_FLAT_OUTSIDE;
        depth += cut == OCC_CUT_TWO;
    }
    return depth;
}

// As occ_fusion_clip(). Returns the new depth.
OCC_FN uint clip_pieces(__local fuse_group *group, uint depth, __global const occ_eye *eye,
                        uint mask, float object, uint item)
{
    for (uint p = 0; p < OCC_SIDE_PLANES; p++) {
        if (!(mask >> p & 1u)) continue;
        occ_cutter beyond;
        occ_cutter_set(&beyond, eye->plane[p], -1.0f, object);
        uint kept = 0;
        for (uint i = 0; i < depth; i++) {
            __local occ_piece *rest = &group->stack[OCC_FUSION_STACK];
            measure_piece(group, &group->stack[i], &beyond, item);
            uint cut = cut_piece(group, &group->stack[i], &beyond, &group->piece, rest, item);
            if (cut == OCC_CUT_INSIDE) continue;
            copy_piece(&group->stack[kept++], cut == OCC_CUT_TWO ? rest : &group->stack[i], item);
        }
        depth = kept;
    }
    return depth;
}

// Puts the outline, or the faces, on the stack. Returns the depth, or 0 if that cannot be.
OCC_FN uint see_outline(__local fuse_group *group, const occ_relative_box *box,
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
        __local occ_piece *piece = &group->stack[i / corners];
        occ_vertex v;
        if (!occ_outline_vertex(box, group->outline.corner[i / corners][i % corners], &v)) {
            atomic_or(&group->failed, 1u);
        }
        piece->v[i % corners] = v;
        if (i % corners == 0) {
            piece->count = corners;
            piece->cuts = 0;
        }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    return group->failed ? 0u : polygons;
}

// As occ_fusion_covers(), from the outline on. *faces: as in fusion.h.
OCC_FN int covers(__local fuse_group *group, const occ_relative_box *box,
                  __global const occ_eye *eye, uint mask, __global const occ_shadow *shadows,
                  __global const uint *list, uint count, int by_faces, int *faces, uint item)
{
    uint depth = see_outline(group, box, eye, by_faces, item);
    *faces = 0;
    if (!depth) return 0;
    depth = clip_pieces(group, depth, eye, mask, box->e, item);
    for (uint split = 0; depth && depth != OCC_FLAT_OUTSIDE; split++) {
        uint i = find_candidate(group, &group->stack[depth - 1u], shadows, list, count, box->e,
                                by_faces, faces, item);
        if (i == count || split == eye->splits) return 0;
        depth = subtract(group, depth, &shadows[list[i]], box->e, item);
    }
    return depth == 0;
}

// As occ_box_fused(), for what occ_flat_object() has left unresolved.
OCC_FN int group_fuses(__local fuse_group *group, const occ_relative_box *box,
                       __global const occ_eye *eye, uint mask, __global const occ_shadow *shadows,
                       __global const uint *list, uint count, uint row, uint item)
{
    int faces;
    consider_all(group, box, shadows, list, count, row, item);
    if (covers(group, box, eye, mask, shadows, list, count, 0, &faces, item)) return 1;
    return faces && covers(group, box, eye, mask, shadows, list, count, 1, &faces, item);
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
        occ_row_relative(&box, boxes, stride, row, &frame->eye);
        int hidden = group_fuses(&group, &box, &frame->eye, state >> 8, OCC_FRAME_SHADOWS(frame),
                                 lists + (size_t)block * OCC_FLAT_LIST, state & 0xffu, row, item);
        if (!hidden && item == 0) {
            uint slot = arranged ? slot_of[row] : row;
            atomic_or(&mask[slot / 32u], 1u << (slot % 32u));
            atomic_inc(&count[OCC_COUNT_VISIBLE]);
        }
    }
}
