// SPDX-License-Identifier: Apache-2.0
#define _DEFAULT_SOURCE // madvise
#include "memory.h"

#include <stdlib.h>
#include <string.h>
#ifdef __linux__
#include <sys/mman.h>
#endif

#if defined(__linux__) && defined(MADV_HUGEPAGE)
#define HUGE_PAGE ((size_t)1 << 21)

// A large block in huge pages, where the system has them: touching it for the first time takes a
// fault for 2 MiB instead of one for 4 KiB.
static void *alloc_huge(size_t size)
{
    void *block = aligned_alloc(HUGE_PAGE, (size + HUGE_PAGE - 1) / HUGE_PAGE * HUGE_PAGE);
    if (block) (void)madvise(block, size / HUGE_PAGE * HUGE_PAGE, MADV_HUGEPAGE);
    return block;
}
#else
#define HUGE_PAGE (SIZE_MAX / 4)

static void *alloc_huge(size_t size)
{
    (void)size;
    return NULL;
}
#endif

static void *default_alloc(size_t size, size_t alignment, void *user_data)
{
    (void)user_data;
#ifdef _WIN32
    return _aligned_malloc(size, alignment);
#else
    if (size >= 2 * HUGE_PAGE && size <= SIZE_MAX - HUGE_PAGE) return alloc_huge(size);
    size_t rounded = (size + alignment - 1) / alignment * alignment; // aligned_alloc demands it
    return rounded < size ? NULL : aligned_alloc(alignment, rounded);
#endif
}

static void default_free(void *pointer, size_t size, void *user_data)
{
    (void)size;
    (void)user_data;
#ifdef _WIN32
    _aligned_free(pointer);
#else
    free(pointer);
#endif
}

occ_result occ_hooks_init(occ_hooks *hooks, const occ_allocator *allocator,
                          const occ_logger *logger)
{
    *hooks = (occ_hooks){.allocator = *allocator, .logger = *logger};
    if (!allocator->alloc != !allocator->free) return OCC_ERROR_INVALID_ARGUMENT;
    if (!allocator->alloc) {
        hooks->allocator = (occ_allocator){.alloc = default_alloc, .free = default_free};
    }
    return OCC_SUCCESS;
}

void *occ_alloc(occ_hooks *hooks, size_t size)
{
    if (!size) return NULL;
    void *pointer = hooks->allocator.alloc(size, OCC_ALIGNMENT, hooks->allocator.user_data);
    if (pointer) hooks->bytes += size;
    return pointer;
}

void occ_free(occ_hooks *hooks, void *pointer, size_t size)
{
    if (!pointer) return;
    hooks->bytes -= size;
    hooks->allocator.free(pointer, size, hooks->allocator.user_data);
}

// Moves the elements to a block for exactly `capacity` of them.
static occ_result array_resize(occ_hooks *hooks, occ_array *array, size_t capacity)
{
    if (capacity > UINT32_MAX || capacity > SIZE_MAX / array->element) return OCC_ERROR_LIMIT;
    void *data = occ_alloc(hooks, capacity * array->element);
    if (!data) return OCC_ERROR_OUT_OF_MEMORY;
    if (array->count) memcpy(data, array->data, (size_t)array->count * array->element);
    occ_free(hooks, array->data, (size_t)array->capacity * array->element);
    array->data = data;
    array->capacity = (uint32_t)capacity;
    return OCC_SUCCESS;
}

occ_result occ_array_reserve(occ_hooks *hooks, occ_array *array, size_t capacity)
{
    if (capacity <= array->capacity) return OCC_SUCCESS;
    return array_resize(hooks, array, capacity);
}

void occ_array_trim(occ_hooks *hooks, occ_array *array)
{
    if (array->capacity - array->count <= array->count / 16) return;
    if (array->count) {
        (void)array_resize(hooks, array, array->count);
    } else {
        occ_array_free(hooks, array);
    }
}

void occ_array_free(occ_hooks *hooks, occ_array *array)
{
    occ_free(hooks, array->data, (size_t)array->capacity * array->element);
    *array = (occ_array){.element = array->element};
}

void *occ_array_extend(occ_hooks *hooks, occ_array *array, size_t more)
{
    if (more > UINT32_MAX) return NULL;
    size_t needed = array->count + (more ? more : 1u); // never NULL for want of elements
    if (needed > array->capacity) {
        size_t capacity = (size_t)array->capacity + array->capacity / 2 + 16;
        if (occ_array_reserve(hooks, array, capacity > needed ? capacity : needed)) return NULL;
    }
    return (char *)array->data + (size_t)array->count * array->element;
}

void *occ_array_push(occ_hooks *hooks, occ_array *array)
{
    void *place = occ_array_extend(hooks, array, 1);
    if (place) array->count++;
    return place;
}
