// SPDX-License-Identifier: Apache-2.0
// From a mask to the ascending list of its bits, in three launches: how many bits there are in each
// tile of words, where each tile's begin, and the list. And arguments for indirect draws.
#define LIST_ITEMS 256u
#define LIST_WORDS 8u // to an item
#define LIST_TILE  (LIST_ITEMS * LIST_WORDS)
#define DRAW_WORDS 5u // count, instance count, first, base vertex, base instance

inline uint bits_of_item(__global const uint *mask, uint words, uint first)
{
    uint bits = 0;
    for (uint w = first; w < first + LIST_WORDS && w < words; w++)
        bits += popcount(mask[w]);
    return bits;
}

// Turns numbers into what stands before each; returns the sum of all. Every item calls it.
inline uint sums_before(__local uint *number, uint item)
{
    for (uint step = 1; step < LIST_ITEMS; step *= 2u) {
        barrier(CLK_LOCAL_MEM_FENCE);
        uint before = item >= step ? number[item - step] : 0u;
        barrier(CLK_LOCAL_MEM_FENCE);
        number[item] += before;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    uint sum = number[LIST_ITEMS - 1u], before = item ? number[item - 1u] : 0u;
    barrier(CLK_LOCAL_MEM_FENCE);
    number[item] = before;
    barrier(CLK_LOCAL_MEM_FENCE);
    return sum;
}

__kernel __attribute__((reqd_work_group_size(LIST_ITEMS, 1, 1))) void
occ_list_tiles(__global const uint *mask, uint words, __global uint *tiles)
{
    __local uint number[LIST_ITEMS];
    uint item = (uint)get_local_id(0), tile = (uint)get_group_id(0);
    number[item] = bits_of_item(mask, words, tile * LIST_TILE + item * LIST_WORDS);
    uint sum = sums_before(number, item);
    if (item == 0) tiles[tile] = sum;
}

// One work-group. The sum of all tiles goes to `visible`.
__kernel __attribute__((reqd_work_group_size(LIST_ITEMS, 1, 1))) void
occ_list_places(__global uint *tiles, uint count, __global uint *visible)
{
    __local uint number[LIST_ITEMS];
    uint item = (uint)get_local_id(0), before = 0;
    for (uint first = 0; first < count; first += LIST_ITEMS) {
        uint tile = first + item;
        number[item] = tile < count ? tiles[tile] : 0u;
        uint sum = sums_before(number, item);
        if (tile < count) tiles[tile] = before + number[item];
        before += sum;
    }
    if (item == 0) *visible = before;
}

__kernel __attribute__((reqd_work_group_size(LIST_ITEMS, 1, 1))) void
occ_list_write(__global const uint *mask, uint words, __global const uint *tiles, uint slot_base,
               __global uint *list)
{
    __local uint number[LIST_ITEMS];
    uint item = (uint)get_local_id(0), tile = (uint)get_group_id(0);
    uint first = tile * LIST_TILE + item * LIST_WORDS;
    number[item] = bits_of_item(mask, words, first);
    (void)sums_before(number, item);
    uint place = tiles[tile] + number[item];
    for (uint w = first; w < first + LIST_WORDS && w < words; w++)
        for (uint bits = mask[w]; bits; bits &= bits - 1u)
            list[place++] = slot_base + 32u * w + (31u - clz(bits & (0u - bits)));
}

// Draws of all slots: what is not visible has no instance.
__kernel void occ_draw_counts(__global const uint *mask, uint slots, uint slot_base,
                              __global uint *draws)
{
    uint slot = (uint)get_global_id(0);
    if (slot >= slots) return;
    draws[(size_t)DRAW_WORDS * (slot_base + slot) + 1u] = mask[slot / 32u] >> (slot % 32u) & 1u;
}

// Draws of the visible slots alone, side by side.
__kernel void occ_draw_compact(__global const uint *list, __global const uint *visible,
                               __global const uint *draws, __global uint *compact)
{
    uint end = *visible;
    for (uint i = (uint)get_global_id(0); i < end; i += (uint)get_global_size(0))
        for (uint w = 0; w < DRAW_WORDS; w++)
            compact[(size_t)DRAW_WORDS * i + w] = draws[(size_t)DRAW_WORDS * list[i] + w];
}
