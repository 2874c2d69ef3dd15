// SPDX-License-Identifier: Apache-2.0
#include "truth_tree.h"

#include <math.h>
#include <stdlib.h>

enum { LEAF_SOLIDS = 4, DEEPEST = 64 };

// Children of node i are i + 1 and `other`; a leaf has solids order[first] and on.
struct truth_node {
    double low[3], high[3];
    uint32_t first, count, other; // count 0: not a leaf
};

static double middle_of(const truth_tree *tree, uint32_t place, int axis)
{
    return tree->solids[tree->order[place]].center[axis];
}

// Bounds a little wider than the solids', so that no rounding loses one.
static void bound(const truth_tree *tree, uint32_t first, uint32_t count, truth_node *node)
{
    for (int k = 0; k < 3; k++) {
        node->low[k] = INFINITY;
        node->high[k] = -INFINITY;
    }
    for (uint32_t i = first; i < first + count; i++) {
        const truth_solid *solid = &tree->solids[tree->order[i]];
        for (int k = 0; k < 3; k++) {
            double reach = solid->half[k] + 1e-12 * (fabs(solid->center[k]) + solid->half[k]);
            node->low[k] = fmin(node->low[k], solid->center[k] - reach);
            node->high[k] = fmax(node->high[k], solid->center[k] + reach);
        }
    }
}

static int widest_axis(const truth_tree *tree, uint32_t first, uint32_t count)
{
    int widest = 0;
    double width[3];
    for (int k = 0; k < 3; k++) {
        double low = INFINITY, high = -INFINITY;
        for (uint32_t i = first; i < first + count; i++) {
            low = fmin(low, middle_of(tree, i, k));
            high = fmax(high, middle_of(tree, i, k));
        }
        width[k] = high - low;
        if (width[k] > width[widest]) widest = k;
    }
    return widest;
}

// Puts the places so that those before `middle` are not above it, and those after not below
// (C. A. R. Hoare, Algorithm 65: Find, 1961).
static void partition(truth_tree *tree, uint32_t first, uint32_t count, uint32_t middle, int axis)
{
    int64_t low = first, high = (int64_t)first + count - 1;
    while (low < high) {
        double pivot = middle_of(tree, middle, axis);
        int64_t i = low, j = high;
        while (i <= j) {
            while (middle_of(tree, (uint32_t)i, axis) < pivot)
                i++;
            while (pivot < middle_of(tree, (uint32_t)j, axis))
                j--;
            if (i > j) break;
            uint32_t kept = tree->order[i];
            tree->order[i++] = tree->order[j];
            tree->order[j--] = kept;
        }
        if (j < (int64_t)middle) low = i;
        if ((int64_t)middle < i) high = j;
    }
}

// Recurses as deep as the logarithm of the count: halves are equal.
static void split(truth_tree *tree, uint32_t first, uint32_t count)
{
    truth_node *node = &tree->nodes[tree->count++];
    bound(tree, first, count, node);
    node->first = first;
    node->count = count <= LEAF_SOLIDS ? count : 0;
    if (count <= LEAF_SOLIDS) return;
    uint32_t half = count / 2;
    partition(tree, first, count, first + half, widest_axis(tree, first, count));
    split(tree, first, half);
    node->other = tree->count;
    split(tree, first + half, count - half);
}

bool truth_tree_make(truth_tree *tree, const truth_solid *solids, uint32_t count)
{
    *tree = (truth_tree){.solids = solids};
    tree->order = malloc(((size_t)count + 1) * sizeof *tree->order);
    tree->nodes = malloc(((size_t)count + 1) * sizeof *tree->nodes);
    if (!tree->order || !tree->nodes) {
        truth_tree_free(tree);
        return false;
    }
    for (uint32_t i = 0; i < count; i++)
        tree->order[i] = i;
    if (count > 0) split(tree, 0, count);
    return true;
}

void truth_tree_free(truth_tree *tree)
{
    free(tree->order);
    free(tree->nodes);
    *tree = (truth_tree){0};
}

static bool meets(const truth_node *node, const truth_query *query, const double inverse[3])
{
    double enter = query->low, leave = query->high;
    for (int k = 0; k < 3; k++) {
        double a = (node->low[k] - query->origin[k]) * inverse[k];
        double b = (node->high[k] - query->origin[k]) * inverse[k];
        enter = fmax(enter, fmin(a, b)); // fmin and fmax pass over what is not a number
        leave = fmin(leave, fmax(a, b));
    }
    return enter <= leave * (1.0 + 1e-12);
}

static uint32_t search_leaf(const truth_tree *tree, const truth_node *node,
                            const truth_query *query)
{
    for (uint32_t i = node->first; i < node->first + node->count; i++) {
        const truth_solid *solid = &tree->solids[tree->order[i]];
        if (solid->owner != query->owner &&
            truth_enter(solid, query->origin, query->direction, query->low, query->high) < INFINITY)
            return tree->order[i];
    }
    return TRUTH_NONE;
}

uint32_t truth_tree_find(const truth_tree *tree, const truth_query *query)
{
    uint32_t stack[DEEPEST], size = 0;
    double inverse[3];
    for (int k = 0; k < 3; k++)
        inverse[k] = 1.0 / query->direction[k];
    if (tree->count > 0) stack[size++] = 0;
    while (size > 0) {
        uint32_t place = stack[--size];
        const truth_node *node = &tree->nodes[place];
        if (!meets(node, query, inverse)) continue;
        if (node->count == 0) {
            stack[size++] = node->other;
            stack[size++] = place + 1;
            continue;
        }
        uint32_t found = search_leaf(tree, node, query);
        if (found != TRUTH_NONE) return found;
    }
    return TRUTH_NONE;
}
