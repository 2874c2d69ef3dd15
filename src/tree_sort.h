// SPDX-License-Identifier: Apache-2.0
#ifndef OCC_TREE_SORT_H
#define OCC_TREE_SORT_H

#include "team.h"

#include <stddef.h>
#include <stdint.h>

typedef struct occ_tree_entry {
    uint64_t key;
    uint32_t row;
} occ_tree_entry;

// Bytes of scratch memory that sorting takes.
size_t occ_tree_sort_room(uint32_t count, const occ_team *team);

// Sorts by key, keeping the order of equal keys. `room` is aligned for anything.
void occ_tree_sort(occ_tree_entry *entries, void *room, uint32_t count, occ_team *team);

#endif
