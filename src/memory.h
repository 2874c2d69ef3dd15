// SPDX-License-Identifier: Apache-2.0
// Allocation and logging hooks: all memory and all log lines of the library pass through here.
#ifndef OCC_MEMORY_H
#define OCC_MEMORY_H

#include <occlude/base.h>

#define OCC_ALIGNMENT 64u

// What a scene or a view was given, and how much it holds.
typedef struct occ_hooks {
    occ_allocator allocator;
    occ_logger logger;
    uint64_t bytes; // allocated and not yet freed
} occ_hooks;

// Fills in the defaults. Fails if only one of the allocator's two functions is given.
occ_result occ_hooks_init(occ_hooks *hooks, const occ_allocator *allocator,
                          const occ_logger *logger);

// 64-byte aligned memory, or NULL. The contents are undefined. `size` 0 gives NULL.
void *occ_alloc(occ_hooks *hooks, size_t size);

// Takes back what occ_alloc() gave. NULL is accepted.
void occ_free(occ_hooks *hooks, void *pointer, size_t size);

// An array that knows its capacity, for elements of any one size.
typedef struct occ_array {
    void *data;
    uint32_t count;
    uint32_t capacity;
    uint32_t element; // bytes
} occ_array;

#define OCC_ARRAY(type) ((occ_array){NULL, 0, 0, (uint32_t)sizeof(type)})

// Makes room for `capacity` elements and keeps the first `count`. On failure nothing changes.
occ_result occ_array_reserve(occ_hooks *hooks, occ_array *array, size_t capacity);

// Gives back what lies beyond `count`, if that is worth a copy. Failure to is harmless.
void occ_array_trim(occ_hooks *hooks, occ_array *array);

void occ_array_free(occ_hooks *hooks, occ_array *array);

// Makes room for `more` elements after the last, growing by half at least, and returns where they
// begin, or NULL. `count` stays.
void *occ_array_extend(occ_hooks *hooks, occ_array *array, size_t more);

// Appends one element and returns it, or NULL.
void *occ_array_push(occ_hooks *hooks, occ_array *array);

#endif
