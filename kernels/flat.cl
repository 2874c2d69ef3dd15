// SPDX-License-Identifier: Apache-2.0
// The flat test on a device (flat.h). Counts and lists that grow with the answers stay there: the
// kernels after the first are launched for as many work-groups as keep the device busy, and each
// takes one block or object after the other until there are none.
//
// A table: boxes, twelve columns of `stride` rows; bounds, six columns of blocks and then six of
// groups; lists, OCC_FLAT_LIST candidates for each block; states, for each block how many those are
// and, from bit 8 on, which planes of the frustum may cut it.
#include "flat.h"

#define FRAME_SHADOWS(frame) ((__global const occ_shadow *)((frame) + 1))

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

// The least or the most of what the items have, in column `column`; every item calls it.
inline void reduce_columns(__local float (*part)[OCC_FLAT_ROWS], uint item)
{
    for (uint step = OCC_FLAT_ROWS / 2u; step; step /= 2u) {
        barrier(CLK_LOCAL_MEM_FENCE);
        for (uint j = 0; j < 3u && item < step; j++) {
            part[j][item] = fmin(part[j][item], part[j][item + step]);
            part[3u + j][item] = fmax(part[3u + j][item], part[3u + j][item + step]);
        }
    }
    barrier(CLK_LOCAL_MEM_FENCE);
}

// The bounds of a group's blocks and of the group, if any of its rows has changed. The items take
// the rows of a block side by side.
__kernel __attribute__((reqd_work_group_size(OCC_FLAT_ROWS, 1, 1))) void
occ_flat_bounds(__global const float *boxes, uint stride, uint rows, uint blocks, uint groups,
                __global float *bounds, __global uint *dirty)
{
    __local float part[OCC_FLAT_BOUNDS][OCC_FLAT_ROWS];
    uint item = (uint)get_local_id(0), group = (uint)get_group_id(0);
    uint changed = dirty[group], end = changed ? OCC_FLAT_BLOCKS : 0u;
    float whole = item < 3u ? INFINITY : -INFINITY; // of column `item`
    for (uint b = 0; b < end; b++) {
        uint block = group * OCC_FLAT_BLOCKS + b, row = block * OCC_FLAT_ROWS + item;
        float least[3], most[3];
        row_bounds(boxes, stride, row, row < rows, least, most);
        for (uint j = 0; j < 3u; j++) {
            part[j][item] = least[j];
            part[3u + j][item] = most[j];
        }
        reduce_columns(part, item);
        if (item < OCC_FLAT_BOUNDS) {
            float bound = part[item][0];
            whole = item < 3u ? fmin(whole, bound) : fmax(whole, bound);
            if (block < blocks) bounds[item * (size_t)blocks + block] = bound;
        }
        barrier(CLK_LOCAL_MEM_FENCE);
    }
    if (end && item < OCC_FLAT_BOUNDS) {
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

// Lists the occluders that touch a block, of those that touch its group. Returns how many, or
// OCC_FLAT_OUTSIDE if one holds all of it.
inline uint list_block(const occ_relative_box *box, __global const occ_shadow *shadows,
                       __local const uint *touch, uint words, uint first, __global uint *list)
{
    uint count = 0;
    for (uint w = 0; w < words; w++) {
        for (uint bits = touch[w]; bits; bits &= bits - 1u) {
            uint index = 32u * w + (31u - clz(bits & (0u - bits)));
            uint met = occ_flat_meet_node(box, &shadows[index], first, first + OCC_FLAT_ROWS);
            if (met == OCC_MEET_HELD) return OCC_FLAT_OUTSIDE;
            if (met == OCC_MEET_APART || count == OCC_FLAT_LIST) continue;
            list[count++] = index;
        }
    }
    return count;
}

// An item takes every 64th shadow: does it touch the group, or hold all of it? Returns the planes
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
    for (uint s = item; s < frame->shadows; s += OCC_FLAT_BLOCKS) {
        uint met = occ_flat_meet_node(&box, &shadows[s], first, end);
        if (met == OCC_MEET_HELD) atomic_or(held, 1u);
        if (met != OCC_MEET_APART) atomic_or(&touch[s / 32u], 1u << (s % 32u));
    }
    return planes;
}

// A work-group takes a group: which occluders touch it, shadow by shadow, then an item a block.
__kernel __attribute__((reqd_work_group_size(OCC_FLAT_BLOCKS, 1, 1))) void
occ_flat_blocks(__global const occ_flat_frame *frame, __global const float *bounds, uint rows,
                uint blocks, uint groups, __global uint *counts, __global uint *open,
                __global uint *states, __global uint *lists, __global uint *mask, uint words)
{
    __local uint touch[OCC_FLAT_WORDS];
    __local uint held;
    uint item = (uint)get_local_id(0), group = (uint)get_group_id(0);
    __global const occ_shadow *shadows = FRAME_SHADOWS(frame);
    if (group == 0 && item < OCC_COUNTS) counts[(frame->counts ^ 1u) * OCC_COUNTS + item] = 0u;
    for (uint w = (uint)get_global_id(0); w < words; w += (uint)get_global_size(0))
        mask[w] = 0u;
    for (uint w = item; w < OCC_FLAT_WORDS; w += OCC_FLAT_BLOCKS)
        touch[w] = 0u;
    if (item == 0) held = 0u;
    barrier(CLK_LOCAL_MEM_FENCE);
    uint planes = touch_group(frame, shadows, bounds + OCC_FLAT_BOUNDS * (size_t)blocks, groups,
                              group, item, touch, &held);
    barrier(CLK_LOCAL_MEM_FENCE);
    uint block = group * OCC_FLAT_BLOCKS + item;
    if (planes == OCC_FLAT_OUTSIDE || held || block >= blocks) return;
    occ_relative_box box;
    load_node(&box, bounds, blocks, block, &frame->eye);
    planes = occ_flat_cut(&box, &frame->eye, planes);
    if (planes == OCC_FLAT_OUTSIDE) return;
    uint listed = list_block(&box, shadows, touch, (frame->shadows + 31u) / 32u,
                             block * OCC_FLAT_ROWS, lists + (size_t)block * OCC_FLAT_LIST);
    if (listed == OCC_FLAT_OUTSIDE) return;
    states[block] = listed | planes << 8;
    open[atomic_inc(&counts[frame->counts * OCC_COUNTS + OCC_COUNT_OPEN])] = block;
}

// --- objects -------------------------------------------------------------------------------------

inline void load_row(occ_relative_box *box, __global const float *boxes, uint stride, uint row,
                     __global const occ_eye *eye)
{
    for (uint j = 0; j < 3u; j++) {
        float coordinate = boxes[j * (size_t)stride + row];
        box->t[j] = OCC_RELATIVE(coordinate, eye->high[j], eye->low[j]);
    }
    for (uint k = 0; k < 9u; k++)
        box->a[k] = boxes[(3u + k) * (size_t)stride + row];
    box->e = occ_box_slack(box, eye->slack_floor);
}

// An open block to a work-group, an object to an item.
__kernel __attribute__((reqd_work_group_size(OCC_FLAT_ROWS, 1, 1))) void
occ_flat_objects(__global const occ_flat_frame *frame, __global const float *boxes, uint stride,
                 uint rows, __global uint *counts, __global const uint *open,
                 __global const uint *states, __global const uint *lists,
                 __global const uint *slot_of, uint arranged, __global uint *unresolved,
                 __global uint *mask)
{
    __local uint word[2], seen, left, place;
    uint item = (uint)get_local_id(0);
    __global uint *count = counts + frame->counts * OCC_COUNTS;
    uint blocks = count[OCC_COUNT_OPEN];
    for (uint o = (uint)get_group_id(0); o < blocks; o += (uint)get_num_groups(0)) {
        uint block = open[o], state = states[block], row = block * OCC_FLAT_ROWS + item;
        if (item < 2u) word[item] = 0u;
        if (item == 2u) seen = left = 0u;
        barrier(CLK_LOCAL_MEM_FENCE);
        uint known = OCC_OUTSIDE, at = 0;
        if (row < rows) {
            occ_relative_box box;
            load_row(&box, boxes, stride, row, &frame->eye);
            known = occ_flat_object(&box, &frame->eye, state >> 8, FRAME_SHADOWS(frame),
                                    lists + (size_t)block * OCC_FLAT_LIST, state & 0xffu, row,
                                    frame->fused);
        }
        if (known == OCC_VISIBLE) {
            atomic_inc(&seen);
            uint slot = arranged ? slot_of[row] : row;
            if (arranged) {
                atomic_or(&mask[slot / 32u], 1u << (slot % 32u));
            } else {
                atomic_or(&word[item / 32u], 1u << (item % 32u));
            }
        }
        if (known == OCC_UNRESOLVED) at = atomic_inc(&left);
        barrier(CLK_LOCAL_MEM_FENCE);
        if (item == 0 && left) place = atomic_add(&count[OCC_COUNT_UNRESOLVED], left);
        if (item == 1u && seen) atomic_add(&count[OCC_COUNT_VISIBLE], seen);
        if (item < 2u && !arranged && word[item]) mask[2u * block + item] = word[item];
        barrier(CLK_LOCAL_MEM_FENCE);
        if (known == OCC_UNRESOLVED) unresolved[place + at] = row;
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
        load_row(&box, boxes, stride, row, &frame->eye);
        if (occ_box_fused(&box, &frame->eye, state >> 8, FRAME_SHADOWS(frame),
                          lists + (size_t)block * OCC_FLAT_LIST, state & 0xffu, row)) {
            continue;
        }
        uint slot = arranged ? slot_of[row] : row;
        atomic_or(&mask[slot / 32u], 1u << (slot % 32u));
        atomic_inc(&count[OCC_COUNT_VISIBLE]);
    }
}
