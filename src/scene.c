// SPDX-License-Identifier: Apache-2.0
// Making scenes and editing their objects; scene_occluders.c has the occluders. Edits touch only
// tables; occ_scene_commit() (commit.c) follows up with the octrees.
#include "scene_edit.h"

#include "box.h"
#include "log.h"
#include "team.h"

#include <stdatomic.h>
#include <string.h>

#define DEFAULT_LEAF_OBJECTS 64u
#define MOST_LEAF_OBJECTS    1024u

static atomic_uint_least64_t scenes_made;

static void bounds_of_objects(const void *table, const uint32_t *rows, uint32_t first,
                              uint32_t count, occ_block *block)
{
    occ_bounds_of_rows(table, rows, first, count, block);
}

static void bounds_of_occluders(const void *table, const uint32_t *rows, uint32_t first,
                                uint32_t count, occ_block *block)
{
    occ_bounds_of_array(table, rows, first, count, block);
}

occ_tree_items occ_scene_object_items(const occ_scene *scene)
{
    return (occ_tree_items){&scene->boxes, bounds_of_objects};
}

occ_tree_items occ_scene_occluder_items(const occ_scene *scene, uint32_t first)
{
    const occ_box *boxes = occ_scene_occluder_boxes(scene);
    return (occ_tree_items){boxes ? boxes + first : NULL, bounds_of_occluders};
}

// Room for `more` objects. Grows by an eighth at least, so that adding one by one stays linear.
static occ_result reserve_objects(occ_scene *scene, size_t more)
{
    size_t rows = scene->boxes.count + more;
    if (more > OCC_MOST_ITEMS || rows > OCC_MOST_ITEMS) return OCC_ERROR_LIMIT;
    occ_result result = occ_slots_reserve(&scene->hooks, &scene->objects, more);
    if (result || rows <= scene->slot_of.capacity) return result;
    size_t grown = (size_t)scene->slot_of.capacity + scene->slot_of.capacity / 8;
    if (grown < rows) grown = rows;
    result = occ_boxes_reserve(&scene->hooks, &scene->boxes, grown);
    return result ? result : occ_array_reserve(&scene->hooks, &scene->slot_of, grown);
}

occ_result occ_scene_create(const occ_scene_desc *desc, occ_scene **scene)
{
    static const occ_scene_desc defaults;
    if (!scene) return OCC_ERROR_INVALID_ARGUMENT;
    *scene = NULL;
    if (!desc) desc = &defaults;
    occ_hooks hooks;
    occ_result result = occ_hooks_init(&hooks, &desc->allocator, &desc->logger);
    if (result) return occ_fail(&hooks, result, "an allocator needs both of its functions");
    if (desc->leaf_objects > MOST_LEAF_OBJECTS) {
        return occ_fail(&hooks, OCC_ERROR_INVALID_ARGUMENT, "leaf_objects is %u, at most %u",
                        desc->leaf_objects, MOST_LEAF_OBJECTS);
    }
    if (desc->threads > OCC_MOST_THREADS) {
        return occ_fail(&hooks, OCC_ERROR_INVALID_ARGUMENT, "%u threads, at most %u", desc->threads,
                        OCC_MOST_THREADS);
    }
    occ_scene *made = occ_alloc(&hooks, sizeof *made);
    if (!made) return occ_fail(&hooks, OCC_ERROR_OUT_OF_MEMORY, "no memory for a scene");
    *made = (occ_scene){.hooks = hooks,
                        .id = atomic_fetch_add(&scenes_made, 1) + 1,
                        .objects = OCC_SLOTS,
                        .slot_of = OCC_ARRAY(uint32_t),
                        .occluders = OCC_SLOTS,
                        .sheets = OCC_SHEETS,
                        .attached = OCC_ARRAY(occ_attached),
                        .reach = OCC_ARRAY(float),
                        .changed = OCC_ARRAY(uint32_t)};
    occ_octree empty = {.nodes = OCC_ARRAY(occ_node)};
    empty.leaf_items = desc->leaf_objects ? desc->leaf_objects : DEFAULT_LEAF_OBJECTS;
    made->object_tree = made->occluder_tree = empty;
    result = occ_team_create(&made->hooks, occ_threads_offered(desc->threads), &made->team);
    if (!result) result = reserve_objects(made, desc->object_count);
    if (!result) result = occ_scene_reserve_occluders(made, desc->occluder_count, false);
    if (result) {
        occ_fail(&hooks, result, "no memory for %u objects and %u occluders", desc->object_count,
                 desc->occluder_count);
        occ_scene_destroy(made);
        return result;
    }
    *scene = made;
    return OCC_SUCCESS;
}

void occ_scene_destroy(occ_scene *scene)
{
    if (!scene) return;
    occ_hooks hooks = scene->hooks;
    occ_slots_free(&hooks, &scene->objects);
    occ_boxes_free(&hooks, &scene->boxes);
    occ_array_free(&hooks, &scene->slot_of);
    occ_octree_free(&hooks, &scene->object_tree);
    occ_slots_free(&hooks, &scene->occluders);
    occ_occluder_rows_free(&hooks, &scene->occluder_rows);
    occ_sheets_free(&hooks, &scene->sheets);
    occ_octree_free(&hooks, &scene->occluder_tree);
    occ_array_free(&hooks, &scene->attached);
    occ_array_free(&hooks, &scene->reach);
    occ_array_free(&hooks, &scene->changed);
    occ_team_destroy(&hooks, scene->team);
    occ_free(&hooks, scene, sizeof *scene);
}

occ_result occ_scene_missing(const occ_scene *scene, const char *what)
{
    return occ_fail(&scene->hooks, OCC_ERROR_INVALID_ARGUMENT, "%s NULL", what);
}

occ_result occ_scene_check_boxes(const occ_scene *scene, const occ_box *boxes, size_t count,
                                 const char *what)
{
    if (count && !boxes) return occ_scene_missing(scene, "the boxes are");
    if (count > OCC_MOST_ITEMS) {
        return occ_fail(&scene->hooks, OCC_ERROR_LIMIT, "%zu %s", count, what);
    }
    uint32_t bad = occ_boxes_first_bad(boxes, (uint32_t)count, scene->team);
    if (bad == count) return OCC_SUCCESS;
    occ_result result = occ_box_check(&boxes[bad]);
    return occ_fail(&scene->hooks, result, "box %u of %zu %s: %s", bad, count, what,
                    occ_result_message(result));
}

occ_result occ_scene_stale(const occ_scene *scene, const char *what, uint32_t index,
                           uint32_t generation)
{
    return occ_fail(&scene->hooks, OCC_ERROR_STALE_HANDLE, "%s {%u, %u}", what, index, generation);
}

occ_result occ_scene_add_many(occ_scene *scene, const occ_box *boxes, size_t count,
                              occ_object *objects)
{
    if (!scene) return OCC_ERROR_INVALID_ARGUMENT;
    occ_result result = occ_scene_check_boxes(scene, boxes, count, "objects");
    if (result || !count) return result;
    result = reserve_objects(scene, count);
    if (result) return occ_fail(&scene->hooks, result, "no room for %zu more objects", count);
    occ_boxes_put(&scene->boxes, scene->boxes.count, boxes, (uint32_t)count, scene->team);
    for (size_t i = 0; i < count; i++) {
        uint32_t row = scene->boxes.count++;
        uint32_t slot = occ_slots_take(&scene->objects, row);
        ((uint32_t *)scene->slot_of.data)[row] = slot;
        if (objects) objects[i] = (occ_object){slot + 1, scene->objects.generation[slot]};
    }
    scene->slot_of.count = scene->boxes.count;
    scene->objects_reordered = true;
    return OCC_SUCCESS;
}

occ_result occ_scene_add(occ_scene *scene, const occ_box *box, occ_object *object)
{
    if (!scene) return OCC_ERROR_INVALID_ARGUMENT;
    if (!box || !object) return occ_scene_missing(scene, "the box or the object is");
    return occ_scene_add_many(scene, box, 1, object);
}

bool occ_same_key(const occ_octree *tree, const occ_box *a, const occ_box *b)
{
    float min[2][3], max[2][3];
    occ_box_bounds(a, min[0], max[0]);
    occ_box_bounds(b, min[1], max[1]);
    return occ_octree_key(&tree->root, min[0], max[0]) ==
           occ_octree_key(&tree->root, min[1], max[1]);
}

static void mark_row(occ_scene *scene, uint32_t row)
{
    uint32_t *words = scene->changed.data;
    if (!scene->objects_moved) { // the first edit since the commit that these bits speak of
        memset(words, 0, (size_t)scene->changed.count * sizeof *words);
        scene->all_changed = false;
        scene->objects_moved = true;
    }
    uint32_t bit = row / OCC_CHANGE_ROWS;
    words[bit / 32] |= 1u << bit % 32;
}

static void move_object(occ_scene *scene, uint32_t slot, const occ_box *box)
{
    uint32_t row = scene->objects.value[slot];
    if (!scene->objects_reordered) {
        occ_box old = occ_boxes_get(&scene->boxes, row);
        if (occ_same_key(&scene->object_tree, &old, box)) {
            mark_row(scene, row);
        } else {
            scene->objects_reordered = true;
        }
    }
    occ_boxes_set(&scene->boxes, row, box);
}

occ_result occ_scene_move_many(occ_scene *scene, const occ_object *objects, const occ_box *boxes,
                               size_t count)
{
    if (!scene) return OCC_ERROR_INVALID_ARGUMENT;
    if (count && !objects) return occ_scene_missing(scene, "the objects are");
    occ_result result = occ_scene_check_boxes(scene, boxes, count, "to move");
    for (size_t i = 0; i < count && !result; i++) {
        if (!occ_scene_contains(scene, objects[i])) {
            result = occ_scene_stale(scene, "object", objects[i].index, objects[i].generation);
        }
    }
    for (size_t i = 0; i < count && !result; i++)
        move_object(scene, objects[i].index - 1, &boxes[i]);
    return result;
}

occ_result occ_scene_move(occ_scene *scene, occ_object object, const occ_box *box)
{
    return occ_scene_move_many(scene, &object, box, 1);
}

occ_result occ_scene_remove(occ_scene *scene, occ_object object)
{
    if (!scene) return OCC_ERROR_INVALID_ARGUMENT;
    uint32_t slot = occ_slots_find(&scene->objects, object.index, object.generation);
    if (slot == OCC_NO_SLOT)
        return occ_scene_stale(scene, "object", object.index, object.generation);
    ((uint32_t *)scene->slot_of.data)[scene->objects.value[slot]] = OCC_NO_SLOT;
    occ_slots_release(&scene->objects, slot);
    scene->objects_reordered = true;
    scene->owners_removed = true;
    return OCC_SUCCESS;
}

bool occ_scene_contains(const occ_scene *scene, occ_object object)
{
    return scene && occ_slots_find(&scene->objects, object.index, object.generation) != OCC_NO_SLOT;
}

occ_result occ_scene_box(const occ_scene *scene, occ_object object, occ_box *box)
{
    if (!scene) return OCC_ERROR_INVALID_ARGUMENT;
    if (!box) return occ_scene_missing(scene, "the box is");
    if (!occ_scene_contains(scene, object)) {
        return occ_scene_stale(scene, "object", object.index, object.generation);
    }
    *box = occ_boxes_get(&scene->boxes, scene->objects.value[object.index - 1]);
    return OCC_SUCCESS;
}

uint32_t occ_scene_slot_count(const occ_scene *scene)
{
    return scene ? scene->objects.count : 0;
}

occ_result occ_scene_get_stats(const occ_scene *scene, occ_scene_stats *stats)
{
    if (!scene) return OCC_ERROR_INVALID_ARGUMENT;
    if (!stats) return occ_scene_missing(scene, "the stats are");
    *stats = (occ_scene_stats){.objects = scene->objects.taken,
                               .occluders = scene->occluders.taken,
                               .slots = scene->objects.count,
                               .object_nodes = scene->object_tree.nodes.count,
                               .occluder_nodes = scene->occluder_tree.nodes.count,
                               .levels = scene->object_tree.levels,
                               .bytes = scene->hooks.bytes};
    return OCC_SUCCESS;
}
