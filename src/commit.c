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
    scene->occluders_reordered = true; // their owners' rows change
    return rebuild_objects(scene);
}

static float largest_reach(const occ_scene *scene, uint32_t first, uint32_t count)
{
    const uint32_t *order = scene->occluder_order.data;
    float most = 0.0f;
    for (uint32_t i = first; i < first + count; i++)
        most = fmaxf(most, occ_occluder_reach(&occ_scene_occluder_boxes(scene)[order[i]]));
    return most;
}

// The largest reach below each node, from the last node to the root.
static void refit_reach(occ_scene *scene)
{
    const occ_octree *tree = &scene->occluder_tree;
    const occ_node *nodes = occ_octree_nodes(tree);
    float *reach = scene->reach.data;
    for (uint32_t n = tree->nodes.count; n-- > 0;) {
        float most = largest_reach(scene, scene->attached_count + nodes[n].first,
                                   occ_node_own(tree, &nodes[n]));
        for (uint32_t c = 0; c < nodes[n].children; c++)
            most = fmaxf(most, reach[nodes[n].child + c]);
        reach[n] = most;
    }
    tree = &scene->object_tree;
    nodes = occ_octree_nodes(tree);
    occ_attached *attached = scene->attached.data;
    for (uint32_t n = tree->nodes.count; n-- > 0;) {
        uint32_t own = attached[n].count;
        float most = 0.0f;
        for (uint32_t c = 0; c < nodes[n].children; c++) {
            const occ_attached *child = &attached[nodes[n].child + c];
            most = fmaxf(most, child->reach);
            own -= child->count;
        }
        attached[n].reach = fmaxf(most, largest_reach(scene, attached[n].first, own));
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

// Sorts the attached occluders by their owners' rows, and lists the free ones after them.
static void list_occluders(occ_scene *scene, uint32_t *place)
{
    const occ_slots *occluders = &scene->occluders;
    uint32_t rows = scene->boxes.count, *order = scene->occluder_order.data, sum = 0;
    memset(place, 0, ((size_t)rows + 1) * sizeof *place);
    for (uint32_t s = 0; s < occluders->count; s++)
        if (occ_slots_is_taken(occluders, s) && occluders->value[s] != OCC_NO_SLOT)
            place[scene->objects.value[occluders->value[s]]]++;
    for (uint32_t row = 0; row <= rows; row++) {
        uint32_t here = place[row];
        place[row] = sum;
        sum += here;
    }
    scene->attached_count = sum;
    const occ_node *nodes = occ_octree_nodes(&scene->object_tree);
    occ_attached *attached = scene->attached.data;
    for (uint32_t n = 0; n < scene->object_tree.nodes.count; n++) {
        attached[n].first = place[nodes[n].first];
        attached[n].count = place[nodes[n].first + nodes[n].count] - attached[n].first;
    }
    for (uint32_t s = 0; s < occluders->count; s++) {
        if (!occ_slots_is_taken(occluders, s)) continue;
        uint32_t owner = occluders->value[s];
        order[owner == OCC_NO_SLOT ? sum++ : place[scene->objects.value[owner]]++] = s;
    }
}

static occ_result rebuild_occluders(occ_scene *scene, const occ_tree_items *items)
{
    uint32_t count = scene->occluders.taken, nodes = scene->object_tree.nodes.count;
    size_t bytes = ((size_t)scene->boxes.count + 1) * sizeof(uint32_t);
    uint32_t *place = occ_alloc(&scene->hooks, bytes);
    occ_result result = place ? OCC_SUCCESS : OCC_ERROR_OUT_OF_MEMORY;
    if (!result) result = occ_array_reserve(&scene->hooks, &scene->occluder_order, count);
    if (!result) result = occ_array_reserve(&scene->hooks, &scene->attached, nodes);
    if (!result) {
        scene->attached.count = nodes;
        scene->occluder_order.count = count;
        list_occluders(scene, place);
        uint32_t *order = (uint32_t *)scene->occluder_order.data + scene->attached_count;
        count -= scene->attached_count;
        occ_root root = occ_octree_root(items, order, count);
        result = occ_octree_build(&scene->hooks, &scene->occluder_tree, items, &root, order, count);
    }
    occ_free(&scene->hooks, place, bytes);
    if (!result) {
        nodes = scene->occluder_tree.nodes.count;
        result = occ_array_reserve(&scene->hooks, &scene->reach, nodes);
        if (!result) scene->reach.count = nodes;
    }
    if (!result) occ_slots_recycle(&scene->occluders);
    return result;
}

static occ_result refit_occluders(occ_scene *scene, const occ_tree_items *items)
{
    if (!scene->occluders_reordered) {
        const uint32_t *order = scene->occluder_order.data;
        order = order ? order + scene->attached_count : NULL;
        occ_root root =
            occ_octree_root(items, order, scene->occluder_order.count - scene->attached_count);
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
    if (slots && !table) return OCC_ERROR_OUT_OF_MEMORY;
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
