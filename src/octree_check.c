// SPDX-License-Identifier: Apache-2.0
// The validation tier of the octree: every invariant, recomputed from the items.
#include "octree.h"

// The bounds of the item at place i of the order.
static void bounds_at(const occ_tree_items *items, const uint32_t *rows, uint32_t i, float min[3],
                      float max[3])
{
    occ_block block;
    items->bounds(items->table, rows ? rows + i : NULL, i, 1, &block);
    for (int j = 0; j < 3; j++) {
        min[j] = block.min[j][0];
        max[j] = block.max[j][0];
    }
}

static const char *check_ranges(const occ_octree *tree, const occ_node *node)
{
    const occ_node *nodes = occ_octree_nodes(tree);
    uint32_t next = node->first + occ_node_own(tree, node), end = node->first + node->count;
    if (!node->count) return "a node has items";
    if (next < node->first || next > end) return "a node's own items come first";
    if (node->children > 8) return "a node has at most eight children";
    if (node->level > OCC_TREE_BITS) return "a node's level is one of cells";
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
        bounds_at(items, rows, i, min, max);
        for (int j = 0; j < 3; j++) {
            tight.min[j] = min[j] < tight.min[j] ? min[j] : tight.min[j];
            tight.max[j] = max[j] > tight.max[j] ? max[j] : tight.max[j];
        }
    }
    for (int j = 0; j < 3; j++) {
        if (!(node->min[j] <= tight.min[j] && tight.max[j] <= node->max[j])) {
            return "an item lies inside its node's bounds";
        }
        if (node->min[j] != tight.min[j] || node->max[j] != tight.max[j]) {
            return "a node's bounds are tight";
        }
    }
    return NULL;
}

static uint64_t key_at(const occ_octree *tree, const occ_tree_items *items, const uint32_t *rows,
                       uint32_t i)
{
    float min[3], max[3];
    bounds_at(items, rows, i, min, max);
    return occ_octree_key(&tree->root, min, max);
}

// The level of the smallest cell that both keys' cells lie in.
static uint32_t level_of_both(uint64_t a, uint64_t b)
{
    uint32_t level = OCC_TREE_BITS;
    while (level && (a ^ b) >> (3 * (OCC_TREE_BITS - level) + 5))
        level--;
    level = (a & 31u) < level ? (uint32_t)(a & 31u) : level;
    return (b & 31u) < level ? (uint32_t)(b & 31u) : level;
}

// The node's cell is the one that its items' keys ask for, and none of them belongs elsewhere.
static const char *check_cells(const occ_octree *tree, const occ_node *node,
                               const occ_tree_items *items, const uint32_t *rows)
{
    uint64_t first = key_at(tree, items, rows, node->first), last = first;
    uint32_t level = OCC_TREE_BITS, own = occ_node_own(tree, node);
    bool is_full = node->count > tree->leaf_items;
    for (uint32_t i = 0; i < node->count; i++) {
        uint64_t key = key_at(tree, items, rows, node->first + i);
        uint32_t both = level_of_both(first, key);
        level = both < level ? both : level;
        if (key < last) return "items lie in ascending order of keys";
        if (i < own && is_full && (key & 31u) != node->level) {
            return "a node with too many items keeps those of its own level only";
        }
        last = key;
    }
    if (level != node->level) return "a node's cell is the smallest that holds its items' cells";
    return node->children && !is_full ? "a node is split only if it has too many items" : NULL;
}

// Among items of one key the one with the smaller name comes first: what the order of insertion was
// cannot show.
static const char *check_ties(const occ_octree *tree, const occ_tree_items *items,
                              const uint32_t *rows, const uint32_t *names, uint32_t count)
{
    for (uint32_t i = 1; i < count; i++) {
        if (names[i] > names[i - 1]) continue;
        if (key_at(tree, items, rows, i) == key_at(tree, items, rows, i - 1)) {
            return "items of one key lie in ascending order of slots";
        }
    }
    return NULL;
}

static bool is_root_of(const occ_octree *tree, const occ_tree_items *items, const uint32_t *rows,
                       uint32_t count)
{
    occ_root root = occ_octree_root(items, rows, count, NULL);
    return occ_root_equals(&root, &tree->root);
}

static const char *check_levels(const occ_octree *tree)
{
    uint32_t next = 1; // where the children of the first node with any must begin
    if (tree->levels > OCC_TREE_DEPTH) return "a level is one of cells";
    if (tree->level_first[0] != 0) return "the first level begins at the first node";
    for (uint32_t level = 0; level < tree->levels; level++) {
        uint32_t begin = tree->level_first[level], end = tree->level_first[level + 1];
        if (begin >= end || end > tree->nodes.count) return "a level has nodes";
        if (next != end) return "a level holds the children of the level above";
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
                                const uint32_t *rows, const uint32_t *names, uint32_t count)
{
    if (!count) return tree->nodes.count ? "a tree without items has no nodes" : NULL;
    if (!tree->nodes.count) return "a tree with items has a root";
    const occ_node *nodes = occ_octree_nodes(tree);
    if (nodes[0].first != 0 || nodes[0].count != count) return "the root holds every item";
    if (!is_root_of(tree, items, rows, count)) return "the root cube is what the items ask for";
    const char *broken = check_levels(tree);
    for (uint32_t i = 0; i < tree->nodes.count && !broken; i++) {
        broken = check_ranges(tree, &nodes[i]);
        if (!broken) broken = check_cells(tree, &nodes[i], items, rows);
        if (!broken) broken = check_bounds(&nodes[i], items, rows);
    }
    return broken ? broken : check_ties(tree, items, rows, names, count);
}
