// SPDX-License-Identifier: Apache-2.0
#include "counting.h"

#include <stdlib.h>

static void *counting_alloc(size_t size, size_t alignment, void *user_data)
{
    counting_heap *heap = user_data;
    if (size > SIZE_MAX - alignment) return NULL;
    // aligned_alloc() wants a multiple of the alignment.
    void *pointer = aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
    if (!pointer) return NULL;
    heap->calls++;
    heap->bytes += size;
    if (heap->bytes > heap->peak) heap->peak = heap->bytes;
    return pointer;
}

static void counting_free(void *pointer, size_t size, void *user_data)
{
    counting_heap *heap = user_data;
    heap->bytes -= size;
    free(pointer);
}

occ_allocator counting_allocator(counting_heap *heap)
{
    return (occ_allocator){counting_alloc, counting_free, heap};
}
