// SPDX-License-Identifier: Apache-2.0
// The validation tier of the octree: every invariant, recomputed from the items.
#include "octree.h"

#include <string.h>

static const char *check_ranges(const occ_octree *tree, const occ_node *node)
{
    const occ_node *nodes = occ_octree_nodes(tree);
    uint32_t next = node->first + occ_node_own(tree, node), end = node->first + node->count;
    if (!node->count) return "a node has items";
    if (next < node->first || next > end) return "a node's own items come first";
    if (node->children > 8) return "a node has at most eight children";
    for (uint32_t c = 0; c < node->children; c++) {
        const occ_node *child = &nodes[node->child + c];
        if (child->first != next)
            return "children's ranges follow each other without gap or overlap";
        if (child->level <= node->level) return "a child's cell is smaller than its parent's";
        next += child->count;
    }
    return next == end ? NULL : "a node's count is the sum of its own and its children's";
}

static const char *check_bounds(const occ_node *node, const occ_tree_items *items,
                                const uint32_t *rows)
{
    occ_node tight = *node;
    for (int j = 0; j < 3; j++) {
        tight.min[j] = 3e38f;
        tight.max[j] = -3e38f;
    }
    for (uint32_t i = node->first; i < node->first + node->count; i++) {
        float min[3], max[3];
        items->bounds(items->table, rows ? rows[i] : i, min, max);
        for (int j = 0; j < 3; j++) {
            tight.min[j] = min[j] < tight.min[j] ? min[j] : tight.min[j];
            tight.max[j] = max[j] > tight.max[j] ? max[j] : tight.max[j];
        }
    }
    for (int j = 0; j < 3; j++) {
        if (tight.min[j] < node->min[j] || tight.max[j] > node->max[j]) {
            return "an item lies inside its node's bounds";
        }
        if (tight.min[j] > node->min[j] || tight.max[j] < node->max[j]) {
            return "a node's bounds are tight";
        }
    }
    return NULL;
}

// Every key of the node's items agrees with the node's cell, and none belongs higher up.
static const char *check_cells(const occ_octree *tree, const occ_node *node,
                               const occ_tree_items *items, const uint32_t *rows)
{
    uint32_t shift = 3 * (OCC_TREE_BITS - node->level) + 5;
    uint64_t cell = 0, last = 0;
    for (uint32_t i = node->first; i < node->first + node->count; i++) {
        float min[3], max[3];
        items->bounds(items->table, rows ? rows[i] : i, min, max);
        uint64_t key = occ_octree_key(&tree->root, min, max);
        if (i == node->first) cell = key >> shift;
        if (key >> shift != cell) return "an item lies in its node's cell";
        if ((key & 31u) < node->level) return "an item is not below the level its size deserves";
        if (key < last) return "items lie in ascending order of keys";
        last = key;
    }
    return NULL;
}

static const char *check_levels(const occ_octree *tree)
{
    uint32_t next = 1; // where the children of the first node with any must begin
    if (tree->level_first[0] != 0) return "the first level begins at the first node";
    for (uint32_t level = 0; level < tree->levels; level++) {
        uint32_t begin = tree->level_first[level], end = tree->level_first[level + 1];
        if (begin >= end) return "a level has nodes";
        if (level && next < end) return "every node but the root has a parent on the level above";
        for (uint32_t i = begin; i < end; i++) {
            const occ_node *node = &occ_octree_nodes(tree)[i];
            if (!node->children) continue;
            if (node->child != next) return "level lists are ordered";
            next += node->children;
        }
    }
    if (next != tree->nodes.count || tree->level_first[tree->levels] != tree->nodes.count) {
        return "level lists are complete";
    }
    return NULL;
}

const char *occ_octree_validate(const occ_octree *tree, const occ_tree_items *items,
                                const uint32_t *rows, uint32_t count)
{
    if (!count) return tree->nodes.count ? "a tree without items has no nodes" : NULL;
    if (!tree->nodes.count) return "a tree with items has a root";
    const occ_node *nodes = occ_octree_nodes(tree);
    if (nodes[0].first != 0 || nodes[0].count != count) return "the root holds every item";
    const char *broken = check_levels(tree);
    for (uint32_t i = 0; i < tree->nodes.count && !broken; i++) {
        broken = check_ranges(tree, &nodes[i]);
        if (!broken && nodes[i].children == 0 && nodes[i].count > tree->leaf_items &&
            occ_node_own(tree, &nodes[i]) != nodes[i].count) {
            broken = "a leaf holds at most as many items as asked for";
        }
        if (!broken) broken = check_cells(tree, &nodes[i], items, rows);
        if (!broken) broken = check_bounds(&nodes[i], items, rows);
    }
    return broken;
}
