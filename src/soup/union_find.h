// SPDX-License-Identifier: Apache-2.0
// Sets that are joined, each known by its least member (Galler and Fischer, Communications of the
// ACM 7, 1964). parent[i] is i at first.
#ifndef OCC_UNION_FIND_H
#define OCC_UNION_FIND_H

#include <stdint.h>

static inline uint32_t occ_union_root(uint32_t *parent, uint32_t i)
{
    while (parent[i] != i) {
        parent[i] = parent[parent[i]];
        i = parent[i];
    }
    return i;
}

static inline void occ_union_join(uint32_t *parent, uint32_t a, uint32_t b)
{
    a = occ_union_root(parent, a);
    b = occ_union_root(parent, b);
    if (a < b) {
        parent[b] = a;
    } else {
        parent[a] = b;
    }
}

#endif
