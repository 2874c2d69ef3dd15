// SPDX-License-Identifier: Apache-2.0
// The flat test on a device (flat.h). Counts and lists that grow with the answers stay there: the
// kernels after the first are launched for as many work-groups as keep the device busy, and each
// takes one block or object after the other until there are none.
//
// A table: boxes, twelve columns of `stride` rows; bounds, six columns of blocks and then six of
// groups; lists, OCC_FLAT_LIST candidates for each block; states, for each block how many those are
// and, from bit 8 on, which planes of the frustum may cut it.
#include "flat.h"

#define QUARTERS   4u // items to a block of a group, and to an object of a block
#define FLAT_ITEMS (QUARTERS * 64u)
#define NEAR_WORDS (OCC_FLAT_LIST / 32u)

// --- boxes in ------------------------------------------------------------------------------------

// Takes boxes of twelve floats, those of slots first, first + 1, ..., to their rows, and marks the
// groups that they are in. `row_of` says which rows those are where `arranged`, else they are the
// slots; in both cases this table holds those from `row_base` on.
__kernel void occ_flat_unpack(__global const float *raw, uint first, uint count,
                              __global const uint *row_of, uint arranged, uint row_base, uint rows,
                              uint stride, __global float *boxes, __global uint *dirty)
{
    uint i = (uint)get_global_id(0);
    if (i >= count) return;
    uint row = (arranged ? row_of[first + i] : first + i) - row_base;
    if (row >= rows) return;
    __global const float *box = raw + 12u * (size_t)i;
    for (uint c = 0; c < 12u; c++)
        boxes[c * (size_t)stride + row] = box[c];
    if (!occ_flat_is_object(box)) boxes[row] = NAN;
    dirty[row / (OCC_FLAT_ROWS * OCC_FLAT_BLOCKS)] = 1u;
}

// The bounds of a row's box. Bounds of nothing are the wrong way round.
inline void row_bounds(__global const float *boxes, uint stride, uint row, int there, float *least,
                       float *most)
{
    for (uint j = 0; j < 3u; j++) {
        least[j] = INFINITY;
        most[j] = -INFINITY;
        if (!there) continue;
        float low, high;
        occ_flat_extent(boxes[j * (size_t)stride + row], boxes[(3u + j) * (size_t)stride + row],
                        boxes[(6u + j) * (size_t)stride + row],
                        boxes[(9u + j) * (size_t)stride + row], &low, &high);
        if (low <= high) { // not so without an object
            least[j] = low;
            most[j] = high;
        }
    }
}

// The least or the most of what the 64 items of a block have, in each column; every item calls it.
inline void reduce_columns(__local float (*part)[FLAT_ITEMS], uint item)
{
    uint o = item % OCC_FLAT_ROWS;
    for (uint step = OCC_FLAT_ROWS / 2u; step; step /= 2u) {
        barrier(CLK_LOCAL_MEM_FENCE);
        for (uint j = 0; j < 3u && o < step; j++) {
            part[j][item] = fmin(part[j][item], part[j][item + step]);
            part[3u + j][item] = fmax(part[3u + j][item], part[3u + j][item + step]);
        }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
}

// The bounds of a group's blocks and of the group, if any of its rows has changed. The items take
// four blocks at a time, row by row.
__kernel __attribute__((reqd_work_group_size(FLAT_ITEMS, 1, 1))) void
occ_flat_bounds(__global const float *boxes, uint stride, uint rows, uint blocks, uint groups,
                __global float *bounds, __global uint *dirty)
{
    __local float part[OCC_FLAT_BOUNDS][FLAT_ITEMS];
    uint item = (uint)get_local_id(0), group = (uint)get_group_id(0);
    uint column = item % OCC_FLAT_ROWS, quarter = item / OCC_FLAT_ROWS;
    uint changed = dirty[group], end = changed ? OCC_FLAT_BLOCKS : 0u;
    float whole = column < 3u ? INFINITY : -INFINITY; // of this quarter's blocks
    for (uint b = quarter; b < end; b += QUARTERS) {
        uint block = group * OCC_FLAT_BLOCKS + b, row = block * OCC_FLAT_ROWS + column;
        float least[3], most[3];
        row_bounds(boxes, stride, row, row < rows, least, most);
        for (uint j = 0; j < 3u; j++) {
            part[j][item] = least[j];
            part[3u + j][item] = most[j];
        }
        reduce_columns(part, item);
        if (column < OCC_FLAT_BOUNDS) {
            float bound = part[column][item - column];
            whole = column < 3u ? fmin(whole, bound) : fmax(whole, bound);
            if (block < blocks) bounds[column * (size_t)blocks + block] = bound;
        }
        barrier(CLK_LOCAL_MEM_FENCE);
    }
    if (column < OCC_FLAT_BOUNDS) part[column][quarter] = whole;
    barrier(CLK_LOCAL_MEM_FENCE);
    if (end && item < OCC_FLAT_BOUNDS) {
        for (uint q = 1; q < QUARTERS; q++)
            whole = item < 3u ? fmin(whole, part[item][q]) : fmax(whole, part[item][q]);
        bounds[OCC_FLAT_BOUNDS * (size_t)blocks + item * (size_t)groups + group] = whole;
    }
    barrier(CLK_GLOBAL_MEM_FENCE);
    if (item == 0) dirty[group] = 0u;
}

// --- groups and blocks ---------------------------------------------------------------------------

inline void load_node(occ_relative_box *box, __global const float *bounds, uint count, uint index,
                      __global const occ_eye *eye)
{
    float least[3], most[3];
    for (uint j = 0; j < 3u; j++) {
        least[j] = bounds[j * (size_t)count + index];
        most[j] = bounds[(3u + j) * (size_t)count + index];
    }
    occ_flat_node(box, least, most, eye);
}

// Asks every QUARTERS-th of the shadows that touch the group, from the quarter's own on, about a
// block: `near` gets a bit for each that touches it.
inline void ask_block(const occ_relative_box *box, __global const occ_shadow *shadows,
                      __local const uint *touch, uint words, uint quarter, uint first,
                      __local uint *near, __local uint *held)
{
    for (uint w = 0; w < words; w++) {
        for (uint bits = touch[w] & 0x11111111u << quarter; bits; bits &= bits - 1u) {
            uint bit = bits & (0u - bits), index = 32u * w + (31u - clz(bit));
            uint met = occ_flat_meet_node(box, &shadows[index], first, first + OCC_FLAT_ROWS);
            if (met == OCC_MEET_HELD) atomic_or(held, 1u);
            if (met != OCC_MEET_APART) atomic_or(&near[w], bit);
        }
    }
}

// Lists the bits. Returns how many; what is beyond OCC_FLAT_LIST is left out.
inline uint list_bits(__local const uint *near, uint words, __global uint *list)
{
    uint count = 0;
    for (uint w = 0; w < words && count < OCC_FLAT_LIST; w++)
        for (uint bits = near[w]; bits && count < OCC_FLAT_LIST; bits &= bits - 1u)
            list[count++] = 32u * w + (31u - clz(bits & (0u - bits)));
    return count;
}

// An item takes every 256th shadow: does it touch the group, or hold all of it? Returns the planes
// of the frustum that may cut the group.
inline uint touch_group(__global const occ_flat_frame *frame, __global const occ_shadow *shadows,
                        __global const float *bounds, uint groups, uint group, uint item,
                        __local uint *touch, __local uint *held)
{
    uint first = group * OCC_FLAT_BLOCKS * OCC_FLAT_ROWS;
    uint end = first + OCC_FLAT_BLOCKS * OCC_FLAT_ROWS;
    occ_relative_box box;
    load_node(&box, bounds, groups, group, &frame->eye);
    uint planes = occ_flat_cut(&box, &frame->eye, frame->planes);
    if (planes == OCC_FLAT_OUTSIDE) return planes;
    for (uint s = item; s < frame->shadows; s += FLAT_ITEMS) {
        uint met = occ_flat_meet_node(&box, &shadows[s], first, end);
        if (met == OCC_MEET_HELD) atomic_or(held, 1u);
        if (met != OCC_MEET_APART) atomic_or(&touch[s / 32u], 1u << (s % 32u));
    }
    return planes;
}

// A work-group takes a group: which occluders touch it, shadow by shadow, then four items a block.
__kernel __attribute__((reqd_work_group_size(FLAT_ITEMS, 1, 1))) void
occ_flat_blocks(__global const occ_flat_frame *frame, __global const float *bounds, uint blocks,
                uint groups, __global uint *counts, __global uint *open, __global uint *states,
                __global uint *lists, __global uint *mask, uint words)
{
    __local uint touch[OCC_FLAT_WORDS], near[OCC_FLAT_BLOCKS][OCC_FLAT_WORDS + 1u];
    __local uint all_held, held[OCC_FLAT_BLOCKS];
    uint item = (uint)get_local_id(0), group = (uint)get_group_id(0);
    uint b = item % OCC_FLAT_BLOCKS, used = (frame->shadows + 31u) / 32u;
    __global const occ_shadow *shadows = OCC_FRAME_SHADOWS(frame);
    if (group == 0 && item < OCC_COUNTS) counts[(frame->counts ^ 1u) * OCC_COUNTS + item] = 0u;
    for (uint w = (uint)get_global_id(0); w < words; w += (uint)get_global_size(0))
        mask[w] = 0u;
    for (uint w = item; w < OCC_FLAT_WORDS; w += FLAT_ITEMS)
        touch[w] = 0u;
    for (uint w = item / OCC_FLAT_BLOCKS; w < used; w += QUARTERS)
        near[b][w] = 0u;
    if (item < OCC_FLAT_BLOCKS) held[item] = 0u;
    if (item == 0) all_held = 0u;
    barrier(CLK_LOCAL_MEM_FENCE);
    uint planes = touch_group(frame, shadows, bounds + OCC_FLAT_BOUNDS * (size_t)blocks, groups,
                              group, item, touch, &all_held);
    barrier(CLK_LOCAL_MEM_FENCE);
    uint block = group * OCC_FLAT_BLOCKS + b;
    int there = planes != OCC_FLAT_OUTSIDE && !all_held && block < blocks;
    if (there) {
        occ_relative_box box;
        load_node(&box, bounds, blocks, block, &frame->eye);
        planes = occ_flat_cut(&box, &frame->eye, planes);
        there = planes != OCC_FLAT_OUTSIDE;
        if (there) {
            ask_block(&box, shadows, touch, used, item / OCC_FLAT_BLOCKS, block * OCC_FLAT_ROWS,
                      near[b], &held[b]);
        }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    if (there && item < OCC_FLAT_BLOCKS && !held[b]) {
        uint listed = list_bits(near[b], used, lists + (size_t)block * OCC_FLAT_LIST);
        states[block] = listed | planes << 8;
        open[atomic_inc(&counts[frame->counts * OCC_COUNTS + OCC_COUNT_OPEN])] = block;
    }
}

// --- objects -------------------------------------------------------------------------------------

// What is found out about an object, by four items.
#define SEEN_OUTSIDE  1u
#define SEEN_HELD     2u
#define SEEN_CENTERED 4u
#define SEEN_SHOWS    8u

// The first part of occ_flat_object(): an item asks every fourth candidate. `near` gets a bit for
// each that touches the object: no other holds any of its corners.
inline uint ask_object(const occ_relative_box *box, __global const occ_eye *eye, uint planes,
                       __global const occ_shadow *shadows, __global const uint *list, uint count,
                       uint row, uint quarter, __local uint *near)
{
    uint seen = 0;
    int centered = 0;
    if (!(box->t[0] == box->t[0])) return SEEN_OUTSIDE;
    if (quarter == 0 && occ_box_outside(box, eye->plane[0], planes)) return SEEN_OUTSIDE;
    for (uint i = quarter; i < count && !(seen & SEEN_HELD); i += QUARTERS) {
        __global const occ_shadow *shadow = &shadows[list[i]];
        if (shadow->owner == row) continue;
        uint met = occ_flat_meet(box, shadow, &centered);
        if (met == OCC_MEET_HELD) seen |= SEEN_HELD;
        if (met == OCC_MEET_TOUCHES) atomic_or(&near[i / 32u], 1u << (i % 32u));
    }
    return centered ? seen | SEEN_CENTERED : seen;
}

// As occ_box_shows_corners(), of the candidates that touch the object.
inline int shows_corners(const occ_relative_box *box, __global const occ_eye *eye, uint planes,
                         __global const occ_shadow *shadows, __global const uint *list,
                         __local const uint *near, uint first, uint end)
{
    for (uint corner = first; corner < end; corner++) {
        float x, y, z;
        int held = 0;
        occ_box_corner(box, corner, &x, &y, &z);
        if (!occ_point_in_frustum(x, y, z, eye, planes)) continue;
        for (uint w = 0; w < NEAR_WORDS; w++) {
            for (uint bits = near[w]; bits && !held; bits &= bits - 1u) {
                uint i = 32u * w + (31u - clz(bits & (0u - bits)));
                held = occ_shadow_holds_point(&shadows[list[i]], x, y, z, box->e);
            }
        }
        if (!held) return 1;
    }
    return 0;
}

// The verdict as far as that part goes.
inline uint judge_object(const occ_relative_box *box, __global const occ_eye *eye, uint planes,
                         uint seen, uint count, uint fused)
{
    if (seen & SEEN_OUTSIDE) return OCC_OUTSIDE;
    if (seen & SEEN_HELD) return OCC_HIDDEN;
    if (!count || !fused) return OCC_VISIBLE;
    if (!(seen & SEEN_CENTERED) &&
        occ_point_in_frustum(box->t[0], box->t[1], box->t[2], eye, planes)) {
        return OCC_VISIBLE;
    }
    return OCC_UNRESOLVED;
}

// An open block to a work-group, four items to an object.
__kernel __attribute__((reqd_work_group_size(FLAT_ITEMS, 1, 1))) void
occ_flat_objects(__global const occ_flat_frame *frame, __global const float *boxes, uint stride,
                 uint rows, __global uint *counts, __global const uint *open,
                 __global const uint *states, __global const uint *lists,
                 __global const uint *slot_of, uint arranged, __global uint *unresolved,
                 __global uint *mask)
{
    __local uint word[2], visible, left, place, seen[OCC_FLAT_ROWS];
    __local uint near[OCC_FLAT_ROWS][NEAR_WORDS];
    uint item = (uint)get_local_id(0), o = item % OCC_FLAT_ROWS, quarter = item / OCC_FLAT_ROWS;
    __global uint *count = counts + frame->counts * OCC_COUNTS;
    __global const occ_shadow *shadows = OCC_FRAME_SHADOWS(frame);
    uint blocks = count[OCC_COUNT_OPEN];
    for (uint k = (uint)get_group_id(0); k < blocks; k += (uint)get_num_groups(0)) {
        uint block = open[k], state = states[block], row = block * OCC_FLAT_ROWS + o;
        uint planes = state >> 8, listed = state & 0xffu, at = 0;
        __global const uint *list = lists + (size_t)block * OCC_FLAT_LIST;
        occ_relative_box box;
        if (item < OCC_FLAT_ROWS) seen[item] = row < rows ? 0u : SEEN_OUTSIDE;
        if (item < 2u) word[item] = 0u;
        for (uint w = quarter; w < NEAR_WORDS; w += QUARTERS)
            near[o][w] = 0u;
        if (item == 0) visible = left = 0u;
        barrier(CLK_LOCAL_MEM_FENCE);
        if (row < rows) {
            occ_row_relative(&box, boxes, stride, row, &frame->eye);
            uint known =
                ask_object(&box, &frame->eye, planes, shadows, list, listed, row, quarter, near[o]);
            if (known) atomic_or(&seen[o], known);
        }
        barrier(CLK_LOCAL_MEM_FENCE);
        uint verdict = OCC_OUTSIDE;
        if (row < rows)
            verdict = judge_object(&box, &frame->eye, planes, seen[o], listed, frame->fused);
        barrier(CLK_LOCAL_MEM_FENCE);
        if (verdict == OCC_UNRESOLVED && shows_corners(&box, &frame->eye, planes, shadows, list,
                                                       near[o], 2u * quarter, 2u * quarter + 2u)) {
            atomic_or(&seen[o], SEEN_SHOWS);
        }
        barrier(CLK_LOCAL_MEM_FENCE);
        if (verdict == OCC_UNRESOLVED && (seen[o] & SEEN_SHOWS)) verdict = OCC_VISIBLE;
        if (quarter) verdict = OCC_OUTSIDE; // the first speaks for all
        if (verdict == OCC_VISIBLE) {
            uint slot = arranged ? slot_of[row] : row;
            atomic_inc(&visible);
            if (arranged) {
                atomic_or(&mask[slot / 32u], 1u << (slot % 32u));
            } else {
                atomic_or(&word[o / 32u], 1u << (o % 32u));
            }
        }
        if (verdict == OCC_UNRESOLVED) at = atomic_inc(&left);
        barrier(CLK_LOCAL_MEM_FENCE);
        if (item == 0 && left) place = atomic_add(&count[OCC_COUNT_UNRESOLVED], left);
        if (item == 1u && visible) atomic_add(&count[OCC_COUNT_VISIBLE], visible);
        if (item < 2u && !arranged && word[item]) mask[2u * block + item] = word[item];
        barrier(CLK_LOCAL_MEM_FENCE);
        if (verdict == OCC_UNRESOLVED) unresolved[place + at] = row;
        barrier(CLK_LOCAL_MEM_FENCE);
    }
}

// What cutting shows to be visible, an object to an item. Where cutting is done by one item, the
// stack is its own.
__kernel void occ_flat_fuse(__global const occ_flat_frame *frame, __global const float *boxes,
                            uint stride, __global uint *counts, __global const uint *states,
                            __global const uint *lists, __global const uint *slot_of, uint arranged,
                            __global const uint *unresolved, __global uint *mask)
{
    __global uint *count = counts + frame->counts * OCC_COUNTS;
    uint objects = count[OCC_COUNT_UNRESOLVED];
    for (uint i = (uint)get_global_id(0); i < objects; i += (uint)get_global_size(0)) {
        uint row = unresolved[i], block = row / OCC_FLAT_ROWS, state = states[block];
        occ_relative_box box;
        occ_row_relative(&box, boxes, stride, row, &frame->eye);
        if (occ_box_fused(&box, &frame->eye, state >> 8, OCC_FRAME_SHADOWS(frame),
                          lists + (size_t)block * OCC_FLAT_LIST, state & 0xffu, row)) {
            continue;
        }
        uint slot = arranged ? slot_of[row] : row;
        atomic_or(&mask[slot / 32u], 1u << (slot % 32u));
        atomic_inc(&count[OCC_COUNT_VISIBLE]);
    }
}
