// SPDX-License-Identifier: Apache-2.0
#include "octree.h"

#include "tree_sort.h"

#include <math.h>
#include <string.h>

#define LEVEL_BITS 5u
#define ROOT_STEPS 8.0 // the root's origin is a multiple of its size over this

occ_root occ_octree_root(const occ_tree_items *items, const uint32_t *rows, uint32_t count)
{
    occ_root root = {{0.0, 0.0, 0.0}, 0.0};
    if (!count) return root;
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = 0; i < count; i++) {
        float min[3], max[3];
        items->bounds(items->table, rows ? rows[i] : i, min, max);
        for (int j = 0; j < 3; j++) {
            double middle = 0.5 * ((double)min[j] + (double)max[j]);
            low[j] = fmin(low[j], middle);
            high[j] = fmax(high[j], middle);
        }
    }
    double extent = 0.0, far = 0.0;
    for (int j = 0; j < 3; j++) {
        extent = fmax(extent, high[j] - low[j]);
        far = fmax(far, fmax(fabs(low[j]), fabs(high[j])));
    }
    // Rounding the origin down can cost one step. Far from zero the cube is kept wide enough for
    // its cells to be told apart in double.
    int exponent;
    double least = fmax(extent * (ROOT_STEPS / (ROOT_STEPS - 1.0)), fmax(far * 0x1p-30, 0x1p-100));
    (void)frexp(least, &exponent);
    root.size = ldexp(1.0, exponent);
    double step = root.size / ROOT_STEPS;
    for (int j = 0; j < 3; j++)
        root.origin[j] = floor(low[j] / step) * step;
    return root;
}

// Spreads the low 19 bits so that two zeros follow each.
static uint64_t spread(uint64_t x)
{
    x = (x | x << 32) & 0x001f00000000ffffu;
    x = (x | x << 16) & 0x001f0000ff0000ffu;
    x = (x | x << 8) & 0x100f00f00f00f00fu;
    x = (x | x << 4) & 0x10c30c30c30c30c3u;
    return (x | x << 2) & 0x1249249249249249u;
}

uint64_t occ_octree_key(const occ_root *root, const float min[3], const float max[3])
{
    const double cells = (double)(1u << OCC_TREE_BITS);
    double width = 0.0;
    uint64_t code = 0;
    for (int j = 0; j < 3; j++) {
        double low = (double)min[j], high = (double)max[j];
        double place = (0.5 * (low + high) - root->origin[j]) * (cells / root->size);
        place = place < 0.0 ? 0.0 : place > cells - 1.0 ? cells - 1.0 : place;
        code |= spread((uint64_t)place) << j;
        width = high - low > width ? high - low : width;
    }
    uint64_t level = OCC_TREE_BITS;
    double cell = root->size / cells;
    while (level && cell < width) {
        cell *= 2.0;
        level--;
    }
    uint64_t kept = ~(uint64_t)0 << (3 * (OCC_TREE_BITS - level));
    return (code & kept) << LEVEL_BITS | level;
}

// The level of the smallest cell that holds all items of a sorted range and is not below any of
// their own cells. The first key decides: it has the least level among those that could lie above.
static uint32_t common_level(uint64_t first, uint64_t last)
{
    uint32_t own = (uint32_t)(first & ((1u << LEVEL_BITS) - 1u));
    uint64_t differ = (first ^ last) >> LEVEL_BITS;
    uint32_t level = OCC_TREE_BITS;
    while (differ) {
        differ >>= 3;
        level--;
    }
    return own < level ? own : level;
}

// The first place in [begin, end) whose key is not below `key`.
static uint32_t lower_bound(const occ_tree_entry *entries, uint32_t begin, uint32_t end,
                            uint64_t key)
{
    while (begin < end) {
        uint32_t middle = begin + (end - begin) / 2;
        if (entries[middle].key < key) {
            begin = middle + 1;
        } else {
            end = middle;
        }
    }
    return begin;
}

static bool push_node(occ_hooks *hooks, occ_array *nodes, const occ_tree_entry *entries,
                      uint32_t first, uint32_t end)
{
    occ_node *node = occ_array_push(hooks, nodes);
    if (!node) return false;
    *node = (occ_node){.first = first, .count = end - first};
    node->level = (uint8_t)common_level(entries[first].key, entries[end - 1].key);
    return true;
}

// Appends the children of node `index`. Octants without items have no child.
static bool split(occ_hooks *hooks, occ_array *nodes, const occ_tree_entry *entries, uint32_t index)
{
    occ_node node = ((occ_node *)nodes->data)[index];
    uint32_t end = node.first + node.count;
    if (node.level == OCC_TREE_BITS) return true;
    uint32_t shift = 3 * (OCC_TREE_BITS - node.level - 1u) + LEVEL_BITS;
    uint64_t base = entries[node.first].key >> (shift + 3) << (shift + 3);
    uint32_t begin = lower_bound(entries, node.first, end, base | (node.level + 1u));
    node.child = nodes->count;
    for (uint64_t octant = 0; octant < 8; octant++) {
        uint32_t next =
            octant == 7 ? end : lower_bound(entries, begin, end, base | (octant + 1) << shift);
        if (next > begin) {
            if (!push_node(hooks, nodes, entries, begin, next)) return false;
            node.children++;
        }
        begin = next;
    }
    ((occ_node *)nodes->data)[index] = node;
    return true;
}

static occ_result build_nodes(occ_hooks *hooks, occ_octree *tree, const occ_tree_entry *entries,
                              uint32_t count)
{
    if (!count) return OCC_SUCCESS;
    if (!push_node(hooks, &tree->nodes, entries, 0, count)) return OCC_ERROR_OUT_OF_MEMORY;
    for (uint32_t i = 0; i < tree->nodes.count;) {
        tree->level_first[++tree->levels] = tree->nodes.count;
        for (uint32_t end = tree->nodes.count; i < end; i++) {
            if (occ_octree_nodes(tree)[i].count <= tree->leaf_items) continue;
            if (!split(hooks, &tree->nodes, entries, i)) return OCC_ERROR_OUT_OF_MEMORY;
        }
    }
    return OCC_SUCCESS;
}

occ_result occ_octree_build(occ_hooks *hooks, occ_octree *tree, const occ_tree_items *items,
                            const occ_root *root, uint32_t *rows, uint32_t count)
{
    size_t bytes = (size_t)count * sizeof(occ_tree_entry);
    occ_tree_entry *entries = occ_alloc(hooks, bytes), *spare = occ_alloc(hooks, bytes);
    occ_octree built = {.nodes = OCC_ARRAY(occ_node), .root = *root};
    built.leaf_items = tree->leaf_items;
    occ_result result = count && (!entries || !spare) ? OCC_ERROR_OUT_OF_MEMORY : OCC_SUCCESS;
    if (!result) {
        for (uint32_t i = 0; i < count; i++) {
            float min[3], max[3];
            items->bounds(items->table, rows[i], min, max);
            entries[i] = (occ_tree_entry){occ_octree_key(root, min, max), rows[i]};
        }
        occ_tree_sort(entries, spare, count);
        for (uint32_t i = 0; i < count; i++)
            rows[i] = entries[i].row;
        result = build_nodes(hooks, &built, entries, count);
    }
    occ_free(hooks, entries, bytes);
    occ_free(hooks, spare, bytes);
    if (result) {
        occ_octree_free(hooks, &built);
        return result;
    }
    occ_array_trim(hooks, &built.nodes);
    occ_octree_refit(&built, items, rows);
    occ_octree_free(hooks, tree);
    *tree = built;
    return OCC_SUCCESS;
}

static void widen(float min[3], float max[3], const float low[3], const float high[3])
{
    for (int j = 0; j < 3; j++) {
        min[j] = low[j] < min[j] ? low[j] : min[j];
        max[j] = high[j] > max[j] ? high[j] : max[j];
    }
}

static void tight_bounds(const occ_octree *tree, const occ_node *node, const occ_tree_items *items,
                         const uint32_t *rows, float min[3], float max[3])
{
    for (int j = 0; j < 3; j++) {
        min[j] = INFINITY;
        max[j] = -INFINITY;
    }
    for (uint32_t i = node->first, end = i + occ_node_own(tree, node); i < end; i++) {
        float low[3], high[3];
        items->bounds(items->table, rows ? rows[i] : i, low, high);
        widen(min, max, low, high);
    }
    const occ_node *child = occ_octree_nodes(tree) + node->child;
    for (uint32_t c = 0; c < node->children; c++)
        widen(min, max, child[c].min, child[c].max);
}

void occ_octree_refit(occ_octree *tree, const occ_tree_items *items, const uint32_t *rows)
{
    occ_node *nodes = tree->nodes.data;
    for (uint32_t i = tree->nodes.count; i-- > 0;) // children lie after their parent
        tight_bounds(tree, &nodes[i], items, rows, nodes[i].min, nodes[i].max);
}

void occ_octree_free(occ_hooks *hooks, occ_octree *tree)
{
    uint32_t leaf_items = tree->leaf_items;
    occ_array_free(hooks, &tree->nodes);
    *tree = (occ_octree){.nodes = OCC_ARRAY(occ_node), .leaf_items = leaf_items};
}
