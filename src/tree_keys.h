// SPDX-License-Identifier: Apache-2.0
// The octree's root cube, and the keys of items under it (octree.h says what they are).
#ifndef OCC_TREE_KEYS_H
#define OCC_TREE_KEYS_H

#include "bounds.h"

#include <stdbool.h>

#define OCC_TREE_DEPTH (OCC_TREE_BITS + 1u)

static inline bool occ_root_equals(const occ_root *a, const occ_root *b)
{
    return a->size == b->size && a->origin[0] == b->origin[0] && a->origin[1] == b->origin[1] &&
           a->origin[2] == b->origin[2];
}

// The items: `bounds` fills a block with those of items first, first + 1, ... of `table`, or where
// `rows` is not NULL, with those of items rows[0], rows[1], ...
typedef struct occ_tree_items {
    const void *table;
    void (*bounds)(const void *table, const uint32_t *rows, uint32_t first, uint32_t count,
                   occ_block *block);
} occ_tree_items;

// The root cube of `count` items, listed as rows. Here and below, `rows` NULL means 0, 1, 2, ...
occ_root occ_octree_root(const occ_tree_items *items, const uint32_t *rows, uint32_t count,
                         occ_team *team);

// An item's key under a root.
uint64_t occ_octree_key(const occ_root *root, const float min[3], const float max[3]);

// The keys of items 0 to count - 1.
void occ_octree_keys(const occ_tree_items *items, const occ_root *root, uint32_t count,
                     uint64_t *keys, occ_team *team);

#endif
