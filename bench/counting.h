// SPDX-License-Identifier: Apache-2.0
/// @file
/// An allocator for the library that counts.
#ifndef OCC_BENCH_COUNTING_H
#define OCC_BENCH_COUNTING_H

#include <occlude/base.h>

/// What was asked of it. Calls come from one thread (see occ_allocator).
typedef struct counting_heap {
    uint64_t calls; ///< Allocations ever made.
    uint64_t bytes; ///< Held now.
    uint64_t peak;  ///< The most ever held.
} counting_heap;

/// Hooks that count into `heap`, which must outlive them.
occ_allocator counting_allocator(counting_heap *heap);

#endif
