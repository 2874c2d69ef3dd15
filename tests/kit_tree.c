// SPDX-License-Identifier: Apache-2.0
#include "kit_tree.h"

#include "box.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// A tree with its items in order, and what a visit of all nodes has seen.
typedef struct visit {
    const occ_octree *tree;
    const occ_box *items;
    uint32_t count;
    unsigned *seen; // how often each item was some node's own
    uint32_t nodes;
    uint32_t next[OCC_TREE_DEPTH + 1]; // the node that each level's list goes on with
} visit;

static double low_end(const occ_box *box, int j)
{
    return (double)box->center[j] - fabs((double)box->axis[0][j]) - fabs((double)box->axis[1][j]) -
           fabs((double)box->axis[2][j]);
}

static double high_end(const occ_box *box, int j)
{
    return (double)box->center[j] + fabs((double)box->axis[0][j]) + fabs((double)box->axis[1][j]) +
           fabs((double)box->axis[2][j]);
}

// The widest side of the bounds, which decides how deep an item goes.
static double width(const occ_box *box)
{
    float min[3], max[3];
    occ_box_bounds(box, min, max);
    double most = 0.0;
    for (int j = 0; j < 3; j++)
        most = fmax(most, (double)max[j] - (double)min[j]);
    return most;
}

static double cell_size(const visit *v, uint32_t level)
{
    return ldexp(v->tree->root.size, -(int)level);
}

// Which cell of a level the middle of an item's bounds lies in.
static void cell_of(const visit *v, const occ_box *box, uint32_t level, double cell[3])
{
    float min[3], max[3];
    occ_box_bounds(box, min, max);
    double most = ldexp(1.0, (int)level) - 1.0;
    for (int j = 0; j < 3; j++) {
        double middle = 0.5 * ((double)min[j] + (double)max[j]);
        double place = floor((middle - v->tree->root.origin[j]) / cell_size(v, level));
        cell[j] = fmin(fmax(place, 0.0), most);
    }
}

static bool same_cell(const visit *v, const occ_box *a, const occ_box *b, uint32_t level)
{
    double x[3], y[3];
    cell_of(v, a, level, x);
    cell_of(v, b, level, y);
    return x[0] == y[0] && x[1] == y[1] && x[2] == y[2];
}

// Every item inside, and the bounds no wider than the items.
static void check_bounds(const visit *v, const occ_node *node)
{
    for (int j = 0; j < 3; j++) {
        double low = INFINITY, high = -INFINITY;
        float min = INFINITY, max = -INFINITY;
        for (uint32_t i = node->first; i < node->first + node->count; i++) {
            float ends[2][3];
            occ_box_bounds(&v->items[i], ends[0], ends[1]);
            min = fminf(min, ends[0][j]);
            max = fmaxf(max, ends[1][j]);
            low = fmin(low, low_end(&v->items[i], j));
            high = fmax(high, high_end(&v->items[i], j));
        }
        KIT_CHECK((double)node->min[j] <= low && (double)node->max[j] >= high,
                  "an item sticks out of its node");
        KIT_CHECK(node->min[j] == min && node->max[j] == max, "a node's bounds are not tight");
        double size = fmax(fabs(low), fabs(high)) + (high - low);
        KIT_CHECK(low - (double)node->min[j] <= size * 0x1p-21 + 0x1p-148 &&
                      (double)node->max[j] - high <= size * 0x1p-21 + 0x1p-148,
                  "a node's bounds are too wide");
    }
}

// Items stay at the level that their size deserves.
static void check_sizes(const visit *v, const occ_node *node, uint32_t own)
{
    double cell = cell_size(v, node->level);
    for (uint32_t i = node->first; i < node->first + node->count; i++) {
        double wide = width(&v->items[i]);
        KIT_CHECK(node->level == 0 || wide <= cell, "an item is wider than its cell");
        KIT_CHECK(same_cell(v, &v->items[node->first], &v->items[i], node->level),
                  "two items of a node lie in two cells");
        bool is_own = i < node->first + own;
        bool keeps = node->children || node->count > v->tree->leaf_items;
        if (is_own && keeps && node->level < OCC_TREE_BITS) {
            KIT_CHECK(wide > 0.5 * cell, "an item stays above the level its size deserves");
        }
    }
    for (int j = 0; j < 3 && node->level; j++) {
        double extent = (double)node->max[j] - (double)node->min[j];
        KIT_CHECK(extent <= 2.0 * cell * (1.0 + 0x1p-20) + 0x1p-140 +
                                fabs((double)node->max[j]) * 0x1p-20,
                  "a node is wider than twice its cell");
    }
}

// The children's ranges follow the node's own items without gap or overlap, one octant each.
static uint32_t check_children(const visit *v, const occ_node *node)
{
    const occ_node *child = occ_octree_nodes(v->tree) + node->child;
    KIT_CHECK(node->children <= 8, "a node has %d children", node->children);
    if (!node->children) return node->count;
    KIT_CHECK(node->child + node->children <= v->tree->nodes.count, "a child is no node");
    KIT_CHECK(node->count > v->tree->leaf_items, "a node is split without need");
    uint32_t own = child[0].first - node->first, end = child[0].first;
    KIT_CHECK(own <= node->count, "a child begins outside its parent");
    for (uint32_t c = 0; c < node->children; c++) {
        KIT_CHECK(child[c].first == end, "children's ranges do not meet");
        KIT_CHECK(child[c].level > node->level, "a child is no smaller than its parent");
        end += child[c].count;
        for (uint32_t d = 0; d < c; d++)
            KIT_CHECK(!same_cell(v, &v->items[child[c].first], &v->items[child[d].first],
                                 node->level + 1u),
                      "two children share an octant");
    }
    KIT_CHECK(end == node->first + node->count, "a count is not the sum of its parts");
    return own;
}

static void visit_node(visit *v, uint32_t index, uint32_t depth)
{
    const occ_node *node = occ_octree_nodes(v->tree) + index;
    KIT_CHECK(depth < v->tree->levels, "a node is deeper than the levels");
    KIT_CHECK(v->next[depth]++ == index, "node %u is not next in the list of its level", index);
    KIT_CHECK(node->count && node->first < v->count && node->count <= v->count - node->first,
              "a range is empty or leaves the table");
    KIT_CHECK(node->level <= OCC_TREE_BITS, "there is no such cell");
    v->nodes++;
    uint32_t own = check_children(v, node);
    for (uint32_t i = 0; i < own; i++)
        v->seen[node->first + i]++;
    check_bounds(v, node);
    check_sizes(v, node, own);
    for (uint32_t c = 0; c < node->children; c++)
        visit_node(v, node->child + c, depth + 1);
}

static void check_tree(const occ_octree *tree, const occ_box *items, uint32_t count)
{
    visit v = {.tree = tree, .items = items, .count = count};
    if (!count) {
        KIT_CHECK(tree->nodes.count == 0 && tree->levels == 0, "nothing has nodes");
        return;
    }
    const occ_node *root = occ_octree_nodes(tree);
    KIT_CHECK(tree->nodes.count > 0, "there is no root");
    KIT_CHECK(root->first == 0 && root->count == count, "the root does not hold every item");
    KIT_CHECK(tree->levels <= OCC_TREE_DEPTH, "there are too many levels");
    memcpy(v.next, tree->level_first, sizeof v.next);
    v.seen = calloc(count, sizeof *v.seen);
    KIT_CHECK(v.seen, "out of memory");
    visit_node(&v, 0, 0);
    KIT_CHECK(v.nodes == tree->nodes.count, "a node has no parent");
    for (uint32_t i = 0; i < count; i++)
        KIT_CHECK(v.seen[i] == 1, "item %u is in %u nodes", i, v.seen[i]);
    KIT_CHECK(tree->level_first[0] == 0, "the first level does not begin at the root");
    for (uint32_t l = 0; l < tree->levels; l++) {
        KIT_CHECK(v.next[l] == tree->level_first[l + 1], "the list of level %u is incomplete", l);
        KIT_CHECK(tree->level_first[l] < tree->level_first[l + 1], "level %u is empty", l);
    }
    free(v.seen);
}

// Slots and rows name each other, and the order of the occluders is a permutation.
static void check_tables(const occ_scene *scene)
{
    uint32_t rows = scene->boxes.count, taken = 0;
    KIT_CHECK(scene->slot_of.count == rows, "a row has no slot");
    for (uint32_t s = 0; s < scene->objects.count; s++) {
        if (!(scene->objects.generation[s] & 1u)) continue;
        uint32_t row = scene->objects.value[s];
        KIT_CHECK(row < rows && occ_scene_slot_of(scene)[row] == s, "slot %u has no row", s);
        taken++;
    }
    KIT_CHECK(taken == rows, "%u objects have %u rows", taken, rows);
    uint32_t slots = scene->occluders.count, placed = scene->occluder_order.count;
    const uint32_t *order = scene->occluder_order.data;
    unsigned *seen = calloc(slots + 1, sizeof *seen);
    KIT_CHECK(seen, "out of memory");
    for (uint32_t i = 0; i < placed; i++) {
        KIT_CHECK(order[i] < slots, "an occluder is not there");
        seen[order[i]]++;
    }
    for (uint32_t s = 0; s < slots; s++)
        KIT_CHECK(seen[s] == (scene->occluders.generation[s] & 1u), "occluder %u is in %u places",
                  s, seen[s]);
    free(seen);
}

void kit_check_trees(const occ_scene *scene)
{
    check_tables(scene);
    uint32_t objects = scene->boxes.count, occluders = scene->occluder_order.count;
    uint32_t most = objects > occluders ? objects : occluders;
    occ_box *items = malloc((most + 1) * sizeof *items);
    KIT_CHECK(items, "out of memory");
    for (uint32_t i = 0; i < objects; i++)
        items[i] = occ_boxes_get(&scene->boxes, i);
    check_tree(&scene->object_tree, items, objects);
    for (uint32_t i = 0; i < occluders; i++) {
        uint32_t slot = ((const uint32_t *)scene->occluder_order.data)[i];
        items[i] = occ_scene_occluder_boxes(scene)[slot];
    }
    check_tree(&scene->occluder_tree, items, occluders);
    free(items);
    occ_result result = occ_scene_validate(scene);
    KIT_CHECK(result == OCC_SUCCESS, "the validator says %s", occ_result_name(result));
}

void kit_check_same_tree(const occ_octree *a, const occ_octree *b)
{
    KIT_CHECK(kit_same_bits(&a->root, &b->root, sizeof a->root), "the root cubes differ");
    KIT_CHECK(a->levels == b->levels && a->leaf_items == b->leaf_items, "the levels differ");
    KIT_CHECK(kit_same_bits(a->level_first, b->level_first, sizeof a->level_first),
              "the lists of levels differ");
    KIT_CHECK(a->nodes.count == b->nodes.count, "%u nodes are not %u", a->nodes.count,
              b->nodes.count);
    for (uint32_t i = 0; i < a->nodes.count; i++)
        KIT_CHECK(kit_same_bits(&occ_octree_nodes(a)[i], &occ_octree_nodes(b)[i], sizeof(occ_node)),
                  "node %u differs", i);
}

static bool same_array(const occ_array *a, const occ_array *b)
{
    return a->count == b->count &&
           (!a->count || kit_same_bits(a->data, b->data, (size_t)a->count * a->element));
}

void kit_check_same_scene(const occ_scene *a, const occ_scene *b)
{
    kit_check_same_tree(&a->object_tree, &b->object_tree);
    kit_check_same_tree(&a->occluder_tree, &b->occluder_tree);
    KIT_CHECK(same_array(&a->slot_of, &b->slot_of), "the order of the objects differs");
    KIT_CHECK(same_array(&a->occluder_order, &b->occluder_order), "that of the occluders differs");
    KIT_CHECK(same_array(&a->reach, &b->reach), "how far the occluders reach differs");
    for (uint32_t i = 0; i < a->boxes.count; i++) {
        occ_box x = occ_boxes_get(&a->boxes, i), y = occ_boxes_get(&b->boxes, i);
        KIT_CHECK(kit_same_bits(&x, &y, sizeof x), "box %u differs", i);
    }
}

const occ_node *kit_node_of(const occ_scene *scene, occ_object object)
{
    uint32_t row = scene->objects.value[occ_object_slot(object)];
    const occ_node *nodes = occ_octree_nodes(&scene->object_tree), *node = nodes;
    for (bool found = false; !found;) {
        found = true;
        for (uint32_t c = 0; c < node->children && found; c++) {
            const occ_node *child = nodes + node->child + c;
            if (row - child->first >= child->count) continue;
            node = child;
            found = false;
        }
    }
    return node;
}
