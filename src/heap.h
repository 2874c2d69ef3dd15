// SPDX-License-Identifier: Apache-2.0
// What the walk is yet to look at, nearest first: a binary heap.
#ifndef OCC_HEAP_H
#define OCC_HEAP_H

#include "memory.h"

// A node or an occluder that is still to be looked at.
typedef struct occ_walk_entry {
    float key;      // how near it is; nothing below a node is nearer
    uint32_t index; // of the node, or row of the occluder
    uint32_t what;  // OCC_WALK_*, and the frustum planes that may cut it
} occ_walk_entry;

#define OCC_WALK_NODE     0x00000000u // of the objects
#define OCC_WALK_FREE     0x40000000u // a node of the occluders that nobody owns
#define OCC_WALK_OCCLUDER 0x80000000u
#define OCC_WALK_PLANES   0x0000ffffu

static inline void occ_heap_sift_up(occ_walk_entry *heap, uint32_t i)
{
    occ_walk_entry entry = heap[i];
    for (; i > 0 && heap[(i - 1) / 2].key > entry.key; i = (i - 1) / 2)
        heap[i] = heap[(i - 1) / 2];
    heap[i] = entry;
}

static inline occ_walk_entry occ_heap_pop(occ_array *array)
{
    occ_walk_entry *heap = array->data, first = heap[0], last = heap[--array->count];
    uint32_t i = 0, count = array->count;
    for (uint32_t child = 1; child < count; child = 2 * i + 1) {
        if (child + 1 < count && heap[child + 1].key < heap[child].key) child++;
        if (heap[child].key >= last.key) break;
        heap[i] = heap[child];
        i = child;
    }
    heap[i] = last;
    return first;
}

static inline occ_result occ_heap_push(occ_hooks *hooks, occ_array *heap,
                                       const occ_walk_entry *entry)
{
    occ_walk_entry *place = occ_array_push(hooks, heap);
    if (!place) return OCC_ERROR_OUT_OF_MEMORY;
    *place = *entry;
    occ_heap_sift_up(heap->data, heap->count - 1);
    return OCC_SUCCESS;
}

#endif
