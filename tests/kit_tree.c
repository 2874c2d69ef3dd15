// SPDX-License-Identifier: Apache-2.0
#include "kit_tree.h"

#include "box.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST_CELLS 2.0 // an item is at most that many of its cells wide

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
        KIT_CHECK(node->level == 0 || wide <= MOST_CELLS * cell,
                  "an item is too wide for its cell");
        KIT_CHECK(same_cell(v, &v->items[node->first], &v->items[i], node->level),
                  "two items of a node lie in two cells");
        bool is_own = i < node->first + own;
        bool keeps = node->children || node->count > v->tree->leaf_items;
        if (is_own && keeps && node->level < OCC_TREE_BITS) {
            KIT_CHECK(wide > 0.5 * MOST_CELLS * cell,
                      "an item stays above the level its size deserves");
        }
    }
    for (int j = 0; j < 3 && node->level; j++) {
        double extent = (double)node->max[j] - (double)node->min[j];
        KIT_CHECK(extent <= (1.0 + MOST_CELLS) * cell * (1.0 + 0x1p-20) + 0x1p-140 +
                                fabs((double)node->max[j]) * 0x1p-20,
                  "a node sticks out of its cell too far");
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

// Slots and rows name each other.
static void check_slots(const occ_slots *slots, const uint32_t *slot_of, uint32_t rows)
{
    uint32_t taken = 0;
    for (uint32_t s = 0; s < slots->count; s++) {
        if (!(slots->generation[s] & 1u)) continue;
        uint32_t row = slots->value[s];
        KIT_CHECK(row < rows && slot_of[row] == s, "slot %u has no row", s);
        taken++;
    }
    KIT_CHECK(taken == rows, "%u slots have %u rows", taken, rows);
}

// --- occluders -----------------------------------------------------------------------------------

// What the occluders say that a node knows of them.
typedef struct summary {
    uint32_t first, count;
    float reach;
} summary;

// Adds an occluder in `row` to all nodes on the way down to `item`.
static void add_to_nodes(const occ_octree *tree, summary *of_nodes, uint32_t item, uint32_t row,
                         float reach)
{
    const occ_node *nodes = occ_octree_nodes(tree);
    for (uint32_t n = 0, next = 0; next != UINT32_MAX; n = next) {
        summary *s = &of_nodes[n];
        KIT_CHECK(!s->count || s->first + s->count == row, "rows of node %u do not meet", n);
        if (!s->count++) s->first = row;
        s->reach = fmaxf(s->reach, reach);
        next = UINT32_MAX;
        for (uint32_t c = nodes[n].child; c < nodes[n].child + nodes[n].children; c++)
            if (item - nodes[c].first < nodes[c].count) next = c;
    }
}

// Those that an object owns come first, by its row and then by slot.
static void check_occluder_order(const occ_scene *scene)
{
    const occ_occluder_rows *rows = &scene->occluder_rows;
    KIT_CHECK(scene->attached_count <= rows->count, "more are attached than there are");
    uint64_t last = 0;
    for (uint32_t i = 0; i < rows->count; i++) {
        uint32_t owner = rows->owner_of[i];
        KIT_CHECK((owner == OCC_NO_SLOT) == (i >= scene->attached_count),
                  "occluder %u is not where those of its kind are", i);
        if (owner == OCC_NO_SLOT) continue;
        KIT_CHECK(owner < scene->objects.count && scene->objects.generation[owner] & 1u,
                  "the owner of occluder %u is gone", i);
        uint64_t here = (uint64_t)scene->objects.value[owner] << 32 | rows->slot_of[i];
        KIT_CHECK(i == 0 || last < here, "occluder %u is out of order", i);
        last = here;
    }
}

static void check_attached(const occ_scene *scene)
{
    const occ_octree *tree = &scene->object_tree;
    const occ_occluder_rows *rows = &scene->occluder_rows;
    summary *of_nodes = calloc(tree->nodes.count + 1, sizeof *of_nodes);
    uint32_t *ends = calloc(scene->boxes.count + 1, sizeof *ends); // of what rows before own
    KIT_CHECK(of_nodes && ends, "out of memory");
    for (uint32_t i = 0; i < scene->attached_count; i++) {
        uint32_t owner = scene->objects.value[rows->owner_of[i]];
        add_to_nodes(tree, of_nodes, owner, i, occ_occluder_reach(&rows->boxes[i]));
        ends[owner + 1] = i + 1;
    }
    for (uint32_t row = 0; row < scene->boxes.count; row++)
        ends[row + 1] = ends[row + 1] > ends[row] ? ends[row + 1] : ends[row];
    KIT_CHECK(scene->attached.count == tree->nodes.count, "a node does not know its occluders");
    for (uint32_t n = 0; n < tree->nodes.count; n++) {
        const occ_attached *known = (const occ_attached *)scene->attached.data + n;
        KIT_CHECK(known->first == ends[occ_octree_nodes(tree)[n].first] &&
                      known->count == of_nodes[n].count,
                  "node %u has occluders [%u, %u)", n, known->first, known->first + known->count);
        KIT_CHECK(!known->count || known->first == of_nodes[n].first, "node %u: others' rows", n);
        KIT_CHECK(known->reach == of_nodes[n].reach, "node %u: the reach is another", n);
    }
    free(of_nodes);
    free(ends);
}

static void check_reach(const occ_scene *scene)
{
    const occ_octree *tree = &scene->occluder_tree;
    const float *reach = scene->reach.data;
    uint32_t first = scene->attached_count;
    summary *of_nodes = calloc(tree->nodes.count + 1, sizeof *of_nodes);
    KIT_CHECK(of_nodes, "out of memory");
    for (uint32_t i = first; i < scene->occluder_rows.count; i++)
        add_to_nodes(tree, of_nodes, i - first, i,
                     occ_occluder_reach(&scene->occluder_rows.boxes[i]));
    KIT_CHECK(scene->reach.count == tree->nodes.count, "a node has no reach");
    for (uint32_t n = 0; n < tree->nodes.count; n++)
        KIT_CHECK(reach[n] == of_nodes[n].reach, "node %u reaches another distance", n);
    free(of_nodes);
}

// --- scenes --------------------------------------------------------------------------------------

void kit_check_trees(const occ_scene *scene)
{
    const occ_occluder_rows *rows = &scene->occluder_rows;
    uint32_t objects = scene->boxes.count;
    KIT_CHECK(scene->slot_of.count == objects, "a row has no slot");
    check_slots(&scene->objects, occ_scene_slot_of(scene), objects);
    check_slots(&scene->occluders, rows->slot_of, rows->count);
    check_occluder_order(scene);
    occ_box *items = malloc((objects + 1) * sizeof *items);
    KIT_CHECK(items, "out of memory");
    for (uint32_t i = 0; i < objects; i++)
        items[i] = occ_boxes_get(&scene->boxes, i);
    check_tree(&scene->object_tree, items, objects);
    free(items);
    uint32_t free_count = rows->count - scene->attached_count;
    check_tree(&scene->occluder_tree, free_count ? rows->boxes + scene->attached_count : NULL,
               free_count);
    check_attached(scene);
    check_reach(scene);
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

void kit_check_same_occluders(const occ_scene *a, const occ_scene *b)
{
    const occ_occluder_rows *x = &a->occluder_rows, *y = &b->occluder_rows;
    kit_check_same_tree(&a->occluder_tree, &b->occluder_tree);
    KIT_CHECK(x->count == y->count && a->attached_count == b->attached_count,
              "there are more or fewer occluders");
    for (uint32_t i = 0; i < x->count; i++) {
        const occ_sheet *one = occ_scene_sheet(a, i), *other = occ_scene_sheet(b, i);
        KIT_CHECK(kit_same_bits(&x->boxes[i], &y->boxes[i], sizeof *x->boxes),
                  "occluder %u differs", i);
        KIT_CHECK(!one == !other && (!one || kit_same_bits(one, other, sizeof *one)),
                  "sheet %u differs", i);
    }
    KIT_CHECK(same_array(&a->attached, &b->attached), "what is attached to nodes differs");
    KIT_CHECK(same_array(&a->reach, &b->reach), "how far the occluders reach differs");
}

void kit_check_same_scene(const occ_scene *a, const occ_scene *b)
{
    kit_check_same_tree(&a->object_tree, &b->object_tree);
    kit_check_same_occluders(a, b);
    KIT_CHECK(same_array(&a->slot_of, &b->slot_of), "the order of the objects differs");
    const occ_occluder_rows *x = &a->occluder_rows, *y = &b->occluder_rows;
    for (uint32_t i = 0; i < x->count; i++)
        KIT_CHECK(x->slot_of[i] == y->slot_of[i] && x->owner_of[i] == y->owner_of[i],
                  "row %u holds another occluder", i);
    for (uint32_t i = 0; i < a->boxes.count; i++) {
        occ_box one = occ_boxes_get(&a->boxes, i), other = occ_boxes_get(&b->boxes, i);
        KIT_CHECK(kit_same_bits(&one, &other, sizeof one), "box %u differs", i);
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
