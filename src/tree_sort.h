// SPDX-License-Identifier: Apache-2.0
#ifndef OCC_TREE_SORT_H
#define OCC_TREE_SORT_H

#include <stdint.h>

typedef struct occ_tree_entry {
    uint64_t key;
    uint32_t row;
} occ_tree_entry;

// Sorts by key, keeping the order of equal keys. `spare` has room for `count` entries.
void occ_tree_sort(occ_tree_entry *entries, occ_tree_entry *spare, uint32_t count);

#endif
