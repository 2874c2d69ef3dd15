// SPDX-License-Identifier: Apache-2.0
#define _DEFAULT_SOURCE // madvise
#include "counting.h"

#include <stdlib.h>
#ifdef __linux__
#include <sys/mman.h>
#endif

// As the library allocates where it is given no allocator: large blocks in huge pages.
static void *alloc_like_the_library(size_t size, size_t alignment)
{
    const size_t huge = (size_t)1 << 21;
    if (size >= 2 * huge && size <= SIZE_MAX - huge) alignment = huge;
    // aligned_alloc() wants a multiple of the alignment.
    void *block = aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
#ifdef MADV_HUGEPAGE
    if (block && alignment == huge) (void)madvise(block, size / huge * huge, MADV_HUGEPAGE);
#endif
    return block;
}

static void *counting_alloc(size_t size, size_t alignment, void *user_data)
{
    counting_heap *heap = user_data;
    if (size > SIZE_MAX - alignment) return NULL;
    void *pointer = alloc_like_the_library(size, alignment);
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
