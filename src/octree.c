// SPDX-License-Identifier: Apache-2.0
#include "octree.h"

#include "tree_sort.h"

#include <math.h>
#include <string.h>

// The level of the smallest cell that holds all items of a sorted range and is not below any of
// their own cells. The first key decides: it has the least level among those that could lie above.
static uint32_t common_level(uint64_t first, uint64_t last)
{
    uint32_t own = (uint32_t)(first & ((1u << OCC_LEVEL_BITS) - 1u));
    uint64_t differ = (first ^ last) >> OCC_LEVEL_BITS;
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
    uint32_t shift = 3 * (OCC_TREE_BITS - node.level - 1u) + OCC_LEVEL_BITS;
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

// --- sorting -------------------------------------------------------------------------------------

typedef struct entries_job {
    const uint64_t *keys;
    const uint32_t *rows;
    uint32_t *sorted; // rows too
    occ_tree_entry *entries;
    uint32_t count, parts;
} entries_job;

static void fill_entries(void *context, uint32_t part)
{
    const entries_job *job = context;
    uint32_t end = occ_part_first(job->count, job->parts, part + 1);
    for (uint32_t i = occ_part_first(job->count, job->parts, part); i < end; i++)
        job->entries[i] = (occ_tree_entry){job->keys[job->rows[i]], job->rows[i]};
}

static void list_sorted(void *context, uint32_t part)
{
    const entries_job *job = context;
    uint32_t end = occ_part_first(job->count, job->parts, part + 1);
    for (uint32_t i = occ_part_first(job->count, job->parts, part); i < end; i++)
        job->sorted[i] = job->entries[i].row;
}

// Sorts the rows, and leaves their entries.
static void sort_items(const occ_tree_items *items, uint32_t table_count, const occ_root *root,
                       uint32_t *rows, uint32_t count, occ_tree_entry *entries, occ_team *team)
{
    void *spare = entries + count; // first for the keys, then for sorting
    occ_octree_keys(items, root, table_count, spare, team);
    entries_job job = {.keys = spare, .rows = rows, .count = count, .parts = occ_parts_of(count)};
    job.entries = entries;
    job.sorted = rows;
    occ_do_parts(team, job.parts, fill_entries, &job);
    occ_tree_sort(entries, spare, count, team);
    occ_do_parts(team, job.parts, list_sorted, &job);
}

size_t occ_octree_room(uint32_t table_count, uint32_t count, const occ_team *team)
{
    size_t keys = (size_t)table_count * sizeof(uint64_t);
    size_t spare = occ_tree_sort_room(count, team);
    return (size_t)count * sizeof(occ_tree_entry) + (keys > spare ? keys : spare);
}

occ_result occ_octree_build(occ_hooks *hooks, occ_octree *tree, const occ_tree_items *items,
                            uint32_t table_count, const occ_root *root, uint32_t *rows,
                            uint32_t count, void *room, occ_team *team)
{
    occ_tree_entry *entries = room;
    if (count) sort_items(items, table_count, root, rows, count, entries, team);
    occ_octree built = {.nodes = OCC_ARRAY(occ_node), .root = *root};
    built.leaf_items = tree->leaf_items;
    occ_result result = build_nodes(hooks, &built, entries, count);
    if (result) {
        occ_octree_free(hooks, &built);
        return result;
    }
    occ_array_trim(hooks, &built.nodes);
    occ_octree_free(hooks, tree);
    *tree = built;
    return OCC_SUCCESS;
}

// --- bounds --------------------------------------------------------------------------------------

static void widen(occ_node *node, const float low[3], const float high[3])
{
    for (int j = 0; j < 3; j++) {
        node->min[j] = low[j] < node->min[j] ? low[j] : node->min[j];
        node->max[j] = high[j] > node->max[j] ? high[j] : node->max[j];
    }
}

typedef struct refit_job {
    const occ_octree *tree;
    const occ_tree_items *items;
    const uint32_t *rows, *changed;
    uint32_t parts;
} refit_job;

static bool has_changed(const uint32_t *changed, const occ_node *node)
{
    uint32_t last = (node->first + node->count - 1) / OCC_CHANGE_ROWS;
    for (uint32_t bit = node->first / OCC_CHANGE_ROWS; bit <= last; bit++)
        if (changed[bit / 32] >> bit % 32 & 1u) return true;
    return false;
}

// The bounds of a node's own items.
static void bound_own(const refit_job *job, occ_node *node)
{
    for (int j = 0; j < 3; j++) {
        node->min[j] = INFINITY;
        node->max[j] = -INFINITY;
    }
    occ_block block;
    uint32_t end = node->first + occ_node_own(job->tree, node);
    for (uint32_t i = node->first; i < end; i += OCC_BLOCK) {
        uint32_t count = end - i < OCC_BLOCK ? end - i : OCC_BLOCK;
        const uint32_t *rows = job->rows ? job->rows + i : NULL;
        job->items->bounds(job->items->table, rows, i, count, &block);
        for (uint32_t k = 0; k < count; k++) {
            const float low[3] = {block.min[0][k], block.min[1][k], block.min[2][k]};
            const float high[3] = {block.max[0][k], block.max[1][k], block.max[2][k]};
            widen(node, low, high);
        }
    }
}

static void bound_part(void *context, uint32_t part)
{
    const refit_job *job = context;
    occ_node *nodes = job->tree->nodes.data;
    uint32_t count = job->tree->nodes.count, end = occ_part_first(count, job->parts, part + 1);
    for (uint32_t i = occ_part_first(count, job->parts, part); i < end; i++)
        if (!job->changed || has_changed(job->changed, &nodes[i])) bound_own(job, &nodes[i]);
}

void occ_octree_refit(occ_octree *tree, const occ_tree_items *items, const uint32_t *rows,
                      const uint32_t *changed, occ_team *team)
{
    occ_node *nodes = tree->nodes.data;
    if (!tree->nodes.count) return;
    refit_job job = {tree, items, rows, changed, occ_parts_of(nodes[0].count)};
    occ_do_parts(team, job.parts, bound_part, &job);
    for (uint32_t i = tree->nodes.count; i-- > 0;) // children lie after their parent
        for (uint32_t c = 0; c < nodes[i].children; c++)
            widen(&nodes[i], nodes[nodes[i].child + c].min, nodes[nodes[i].child + c].max);
}

void occ_octree_free(occ_hooks *hooks, occ_octree *tree)
{
    uint32_t leaf_items = tree->leaf_items;
    occ_array_free(hooks, &tree->nodes);
    *tree = (occ_octree){.nodes = OCC_ARRAY(occ_node), .leaf_items = leaf_items};
}
