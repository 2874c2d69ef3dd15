// SPDX-License-Identifier: Apache-2.0
/// @file
/// A binary tree of bounds over solids, for single rays: does any solid but an owner's own stop
/// this ray?
#ifndef OCC_BENCH_TRUTH_TREE_H
#define OCC_BENCH_TRUTH_TREE_H

#include "truth_shape.h"

typedef struct truth_node truth_node;

/// A tree over solids that must outlive it. All zero is none; truth_tree_free() it when done.
typedef struct truth_tree {
    const truth_solid *solids;
    uint32_t *order;
    truth_node *nodes;
    uint32_t count;
} truth_tree;

/// False when memory runs out.
bool truth_tree_make(truth_tree *tree, const truth_solid *solids, uint32_t count);

void truth_tree_free(truth_tree *tree);

/// No solid, and no owner.
#define TRUTH_NONE UINT32_MAX

/// The part of a ray to search, and whose solids do not count.
typedef struct truth_query {
    double origin[3], direction[3];
    double low, high;
    uint32_t owner;
} truth_query;

/// A solid of another owner that the ray enters between `low` and `high`, or TRUTH_NONE.
uint32_t truth_tree_find(const truth_tree *tree, const truth_query *query);

#endif
