// SPDX-License-Identifier: Apache-2.0
// An index-based octree. Items are rows of somebody else's table; the tree says in which order they
// are to lie and which ranges of that order its nodes are.
//
// An item belongs to the cell that holds its bounds' middle, on the deepest level whose cells are
// at least half as wide as the bounds (a loose octree: Ulrich, Game Programming Gems 1, 2000). Its
// key is that cell's Morton code (Morton 1966) followed by the level:
//
//     bit 61                      5 4      0
//        | 19 x 3 bits of x, y, z  | level |      cells above level 19 pad their code with zeros
//
// so that in ascending order of keys a cell's own items come first and every subtree is contiguous.
// A node with more than `leaf_items` items keeps those of its own level and splits the rest by the
// next three bits; a chain of cells with a single child each is skipped. Nodes lie breadth first:
// each level is a range of nodes, and siblings are neighbours. Everything is a function of the
// items' bounds and the order in which they are handed in, which breaks ties.
#ifndef OCC_OCTREE_H
#define OCC_OCTREE_H

#include "tree_keys.h"

typedef struct occ_node {
    float min[3]; // tight bounds of all items of the subtree
    float max[3];
    uint32_t first; // the subtree's items are [first, first + count) of the order
    uint32_t count;
    uint32_t child;   // first of the children, which are neighbours
    uint8_t children; // 0 (a leaf) to 8
    uint8_t level;    // of the cell: 0 is the root's
    uint8_t pad[2];
} occ_node;

_Static_assert(sizeof(occ_node) == 40, "nodes are counted in the memory per object");

typedef struct occ_octree {
    occ_array nodes; // of occ_node
    occ_root root;
    uint32_t
        level_first[OCC_TREE_DEPTH + 1]; // nodes of level l: [level_first[l], level_first[l + 1])
    uint32_t levels;
    uint32_t leaf_items;
} occ_octree;

static inline const occ_node *occ_octree_nodes(const occ_octree *tree)
{
    return tree->nodes.data;
}

// How many of a node's items are its own rather than a child's; they come first.
static inline uint32_t occ_node_own(const occ_octree *tree, const occ_node *node)
{
    return node->children ? occ_octree_nodes(tree)[node->child].first - node->first : node->count;
}

// Bytes of scratch memory that building a tree over `count` of a table's items takes.
size_t occ_octree_room(uint32_t table_count, uint32_t count, const occ_team *team);

// Sorts `rows`, which list items of a table of `table_count`, into the tree's order and builds the
// nodes, all but their bounds. On failure the tree is as it was and `rows` is some permutation of
// what it was. `room` is aligned for anything.
occ_result occ_octree_build(occ_hooks *hooks, occ_octree *tree, const occ_tree_items *items,
                            uint32_t table_count, const occ_root *root, uint32_t *rows,
                            uint32_t count, void *room, occ_team *team);

#define OCC_CHANGE_ROWS 256u // places in the order to a bit of `changed`

// Recomputes the bounds of all nodes, or of those that hold an item at a place of which `changed`
// has the bit. rows[i] is the item at place i of the order; NULL means i.
void occ_octree_refit(occ_octree *tree, const occ_tree_items *items, const uint32_t *rows,
                      const uint32_t *changed, occ_team *team);

void occ_octree_free(occ_hooks *hooks, occ_octree *tree);

// NULL, or the name of the first invariant that does not hold. rows as above; names[i] is the slot
// of the item at place i, which breaks ties.
const char *occ_octree_validate(const occ_octree *tree, const occ_tree_items *items,
                                const uint32_t *rows, const uint32_t *names, uint32_t count);

#endif
