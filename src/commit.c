// SPDX-License-Identifier: Apache-2.0
// Bringing the octrees up to date. What an octree looks like is a function of the boxes, the slots
// and the root cube alone, so an edited scene equals one built in the same state.
#include "scene_data.h"

#include "log.h"
#include "rounding.h"

#include <math.h>
#include <string.h>

float occ_occluder_reach(const occ_box *box)
{
    double area = 0.0;
    for (int k = 0; k < 3; k++) {
        const float *a = box->axis[k], *b = box->axis[(k + 1) % 3];
        double x = (double)a[1] * (double)b[2] - (double)a[2] * (double)b[1];
        double y = (double)a[2] * (double)b[0] - (double)a[0] * (double)b[2];
        double z = (double)a[0] * (double)b[1] - (double)a[1] * (double)b[0];
        area += 4.0 * sqrt(x * x + y * y + z * z);
    }
    return area < 1e38 ? occ_round_up(area * (1.0 + 0x1p-40)) : 3e38f;
}

// The bounds of every item of a table, made once for the root, the keys and the nodes.
typedef struct bounds {
    float min[3], max[3];
} bounds;

static void read_bounds(const void *table, uint32_t row, float min[3], float max[3])
{
    const bounds *b = (const bounds *)table + row;
    memcpy(min, b->min, sizeof b->min);
    memcpy(max, b->max, sizeof b->max);
}

// `table` has room for `rows` elements; which of them are read is up to the tree.
static occ_tree_items cache_bounds(const occ_tree_items *items, uint32_t rows, bounds *table)
{
    for (uint32_t row = 0; row < rows; row++)
        items->bounds(items->table, row, table[row].min, table[row].max);
    return (occ_tree_items){table, read_bounds};
}

// The rows of the objects that are there, in the order of their slots.
static void list_rows(const occ_scene *scene, uint32_t *rows)
{
    uint32_t count = 0;
    for (uint32_t s = 0; s < scene->objects.count; s++)
        if (occ_slots_is_taken(&scene->objects, s)) rows[count++] = scene->objects.value[s];
}

// Puts the tables into the tree's order: row i becomes what row rows[i] was.
static void reorder_tables(occ_scene *scene, const uint32_t *rows, uint32_t count, void *scratch)
{
    uint32_t *slot_of = scene->slot_of.data, *moved = scratch;
    occ_boxes_gather(&scene->boxes, rows, count, scratch);
    for (uint32_t i = 0; i < count; i++)
        moved[i] = slot_of[rows[i]];
    for (uint32_t i = 0; i < count; i++) {
        slot_of[i] = moved[i];
        scene->objects.value[moved[i]] = i;
    }
    scene->slot_of.count = count;
}

static occ_result sort_objects(occ_scene *scene, uint32_t *rows, uint32_t count, bounds *table)
{
    occ_tree_items items = occ_scene_object_items(scene);
    items = cache_bounds(&items, scene->boxes.count, table);
    list_rows(scene, rows);
    occ_root root = occ_octree_root(&items, rows, count);
    return occ_octree_build(&scene->hooks, &scene->object_tree, &items, &root, rows, count);
}

static occ_result rebuild_objects(occ_scene *scene)
{
    uint32_t count = scene->objects.taken;
    size_t bytes = (size_t)count * sizeof(uint32_t);
    size_t table_bytes = (size_t)scene->boxes.count * sizeof(bounds);
    size_t words = count / (OCC_CHANGE_ROWS * 32u) + 1u;
    uint32_t *rows = occ_alloc(&scene->hooks, bytes), *scratch = occ_alloc(&scene->hooks, bytes);
    bounds *table = occ_alloc(&scene->hooks, table_bytes);
    occ_result result = OCC_SUCCESS;
    if (count && (!rows || !scratch || !table)) result = OCC_ERROR_OUT_OF_MEMORY;
    if (!result) result = occ_array_reserve(&scene->hooks, &scene->changed, words);
    if (!result) result = sort_objects(scene, rows, count, table);
    if (!result) {
        reorder_tables(scene, rows, count, scratch);
        scene->changed.count = (uint32_t)words;
        scene->all_changed = true;
        occ_slots_recycle(&scene->objects);
    }
    occ_free(&scene->hooks, rows, bytes);
    occ_free(&scene->hooks, scratch, bytes);
    occ_free(&scene->hooks, table, table_bytes);
    return result;
}

// The cheap path, for moves that left every object in its cell. False: the cells have changed too.
static occ_result refit_objects(occ_scene *scene, bool *fits)
{
    size_t bytes = (size_t)scene->boxes.count * sizeof(bounds);
    bounds *table = occ_alloc(&scene->hooks, bytes);
    if (!table) return OCC_ERROR_OUT_OF_MEMORY;
    occ_tree_items items = occ_scene_object_items(scene);
    items = cache_bounds(&items, scene->boxes.count, table);
    occ_root root = occ_octree_root(&items, NULL, scene->boxes.count);
    *fits = occ_root_equals(&root, &scene->object_tree.root);
    if (*fits) occ_octree_refit(&scene->object_tree, &items, NULL);
    occ_free(&scene->hooks, table, bytes);
    return OCC_SUCCESS;
}

static occ_result commit_objects(occ_scene *scene)
{
    bool fits = false;
    if (!scene->objects_reordered && !scene->objects_moved) {
        if (scene->changed.count) {
            memset(scene->changed.data, 0, (size_t)scene->changed.count * sizeof(uint32_t));
        }
        scene->all_changed = false;
        return OCC_SUCCESS;
    }
    if (!scene->objects_reordered) {
        occ_result result = refit_objects(scene, &fits);
        if (result || fits) return result;
        scene->objects_reordered = true;
    }
    return rebuild_objects(scene);
}

// The largest reach below each node, from the last node to the root.
static void refit_reach(occ_scene *scene)
{
    const occ_octree *tree = &scene->occluder_tree;
    const occ_node *nodes = occ_octree_nodes(tree);
    const uint32_t *order = scene->occluder_order.data;
    float *reach = scene->reach.data;
    for (uint32_t n = tree->nodes.count; n-- > 0;) {
        float most = 0.0f;
        for (uint32_t i = 0, own = occ_node_own(tree, &nodes[n]); i < own; i++) {
            uint32_t slot = order[nodes[n].first + i];
            most = fmaxf(most, occ_occluder_reach(&occ_scene_occluder_boxes(scene)[slot]));
        }
        for (uint32_t c = 0; c < nodes[n].children; c++)
            most = fmaxf(most, reach[nodes[n].child + c]);
        reach[n] = most;
    }
}

// Removes the occluders whose owners are gone.
static void drop_orphans(occ_scene *scene)
{
    for (uint32_t s = 0; s < scene->occluders.count; s++) {
        uint32_t owner = scene->occluders.value[s];
        if (!occ_slots_is_taken(&scene->occluders, s) || owner == OCC_NO_SLOT) continue;
        if (occ_slots_is_taken(&scene->objects, owner)) continue;
        occ_slots_release(&scene->occluders, s);
        scene->occluders_reordered = true;
    }
    scene->owners_removed = false;
}

static uint32_t list_occluders(const occ_scene *scene, uint32_t *slots)
{
    uint32_t count = 0;
    for (uint32_t s = 0; s < scene->occluders.count; s++)
        if (occ_slots_is_taken(&scene->occluders, s)) slots[count++] = s;
    return count;
}

static occ_result rebuild_occluders(occ_scene *scene, const occ_tree_items *items)
{
    uint32_t count = scene->occluders.taken;
    occ_result result = occ_array_reserve(&scene->hooks, &scene->occluder_order, count);
    if (result) return result;
    uint32_t *order = scene->occluder_order.data;
    scene->occluder_order.count = list_occluders(scene, order);
    occ_root root = occ_octree_root(items, order, count);
    result = occ_octree_build(&scene->hooks, &scene->occluder_tree, items, &root, order, count);
    if (!result) {
        uint32_t nodes = scene->occluder_tree.nodes.count;
        result = occ_array_reserve(&scene->hooks, &scene->reach, nodes);
        if (!result) scene->reach.count = nodes;
    }
    if (!result) occ_slots_recycle(&scene->occluders);
    return result;
}

static occ_result refit_occluders(occ_scene *scene, const occ_tree_items *items)
{
    const uint32_t *order = scene->occluder_order.data;
    if (!scene->occluders_reordered) {
        occ_root root = occ_octree_root(items, order, scene->occluder_order.count);
        if (occ_root_equals(&root, &scene->occluder_tree.root)) {
            occ_octree_refit(&scene->occluder_tree, items, order);
            return OCC_SUCCESS;
        }
        scene->occluders_reordered = true;
    }
    return rebuild_occluders(scene, items);
}

static occ_result commit_occluders(occ_scene *scene)
{
    if (!scene->occluders_reordered && !scene->occluders_moved) return OCC_SUCCESS;
    uint32_t slots = scene->occluders.count;
    size_t bytes = (size_t)slots * sizeof(bounds);
    bounds *table = occ_alloc(&scene->hooks, bytes);
    if (!table) return OCC_ERROR_OUT_OF_MEMORY;
    occ_tree_items items = occ_scene_occluder_items(scene);
    items = cache_bounds(&items, slots, table);
    occ_result result = refit_occluders(scene, &items);
    if (!result) refit_reach(scene);
    occ_free(&scene->hooks, table, bytes);
    return result;
}

occ_result occ_scene_commit(occ_scene *scene)
{
    if (!scene) return OCC_ERROR_INVALID_ARGUMENT;
    if (occ_scene_is_committed(scene)) return OCC_SUCCESS;
    if (scene->owners_removed) drop_orphans(scene); // before the owners' slots are recycled
    occ_result result = commit_objects(scene);
    if (result) return occ_fail(&scene->hooks, result, "no memory to sort the objects");
    scene->objects_moved = scene->objects_reordered = false;
    scene->revision++; // even if the occluders fail: `changed` speaks of this step from here on
    result = commit_occluders(scene);
    if (result) return occ_fail(&scene->hooks, result, "no memory to sort the occluders");
    scene->occluders_moved = scene->occluders_reordered = false;
    return OCC_SUCCESS;
}
