// SPDX-License-Identifier: Apache-2.0
// Bringing the octrees up to date. What an octree looks like is a function of the boxes, the slots
// and the root cube alone, so an edited scene equals one built in the same state.
#include "scene_data.h"

#include "bounds.h"
#include "log.h"

#include <math.h>
#include <string.h>

// The rows of the objects that are there, in the order of their slots.
static void list_rows(const occ_scene *scene, uint32_t *rows)
{
    const occ_slots *slots = &scene->objects;
    if (slots->count && slots->taken == slots->count) {
        memcpy(rows, slots->value, slots->count * sizeof *rows);
        return;
    }
    uint32_t count = 0;
    for (uint32_t s = 0; s < slots->count; s++)
        if (occ_slots_is_taken(slots, s)) rows[count++] = slots->value[s];
}

// The same in ascending order: NULL if that is all rows there are.
static const uint32_t *list_ascending(const occ_scene *scene, uint32_t *rows)
{
    uint32_t count = 0;
    if (scene->objects.taken == scene->boxes.count) return NULL;
    for (uint32_t row = 0; row < scene->boxes.count; row++)
        if (occ_scene_slot_of(scene)[row] != OCC_NO_SLOT) rows[count++] = row;
    return rows;
}

// Puts the tables into the tree's order: row i becomes what row rows[i] was.
typedef struct reorder_job {
    uint32_t *slot_of, *moved, *row_of;
    const uint32_t *rows;
    uint32_t count, parts;
} reorder_job;

static void pick_slots(void *context, uint32_t part)
{
    const reorder_job *job = context;
    uint32_t end = occ_part_first(job->count, job->parts, part + 1);
    for (uint32_t i = occ_part_first(job->count, job->parts, part); i < end; i++)
        job->moved[i] = job->slot_of[job->rows[i]];
}

static void put_slots(void *context, uint32_t part)
{
    const reorder_job *job = context;
    uint32_t end = occ_part_first(job->count, job->parts, part + 1);
    for (uint32_t i = occ_part_first(job->count, job->parts, part); i < end; i++) {
        job->slot_of[i] = job->moved[i];
        job->row_of[job->moved[i]] = i;
    }
}

// Takes scratch memory for `columns` columns of `count` numbers.
static void reorder_tables(occ_scene *scene, occ_team *team, const uint32_t *rows, uint32_t count,
                           void *scratch, uint32_t columns)
{
    occ_boxes_gather(&scene->boxes, rows, count, scratch, columns, team);
    reorder_job job = {scene->slot_of.data, scratch, scene->objects.value, rows, count,
                       occ_parts_of(count)};
    occ_do_parts(team, job.parts, pick_slots, &job);
    occ_do_parts(team, job.parts, put_slots, &job);
    scene->slot_of.count = count;
}

// Sorts the objects and builds their tree. Nothing has changed unless all went well.
static occ_result sort_objects(occ_scene *scene, occ_team *team, uint32_t *rows, uint32_t count,
                               void *room)
{
    occ_tree_items items = occ_scene_object_items(scene);
    const uint32_t *ascending = list_ascending(scene, rows);
    occ_root root = occ_octree_root(&items, ascending, count, team);
    list_rows(scene, rows);
    return occ_octree_build(&scene->hooks, &scene->object_tree, &items, scene->boxes.count, &root,
                            rows, count, room, team);
}

static occ_result rebuild_objects(occ_scene *scene, occ_team *team)
{
    uint32_t count = scene->objects.taken;
    size_t bytes = (size_t)count * sizeof(uint32_t);
    size_t room_bytes = occ_octree_room(scene->boxes.count, count, team);
    size_t words = count / (OCC_CHANGE_ROWS * 32u) + 1u;
    uint32_t *rows = occ_alloc(&scene->hooks, bytes);
    void *room = occ_alloc(&scene->hooks, room_bytes);
    occ_result result = OCC_SUCCESS;
    if (count && (!rows || !room)) result = OCC_ERROR_OUT_OF_MEMORY;
    if (!result) result = occ_array_reserve(&scene->hooks, &scene->changed, words);
    if (!result) result = sort_objects(scene, team, rows, count, room);
    if (!result) {
        size_t columns = count ? room_bytes / bytes : 0;
        reorder_tables(scene, team, rows, count, room,
                       columns < OCC_BOX_COLUMNS ? (uint32_t)columns : OCC_BOX_COLUMNS);
        occ_tree_items items = occ_scene_object_items(scene);
        occ_octree_refit(&scene->object_tree, &items, NULL, NULL, team);
        scene->changed.count = (uint32_t)words;
        scene->all_changed = true;
        occ_slots_recycle(&scene->objects);
    }
    occ_free(&scene->hooks, rows, bytes);
    occ_free(&scene->hooks, room, room_bytes);
    return result;
}

// The cheap path, for moves that left every object in its cell. False: the cells have changed too.
static bool refit_objects(occ_scene *scene, occ_team *team)
{
    occ_tree_items items = occ_scene_object_items(scene);
    occ_root root = occ_octree_root(&items, NULL, scene->boxes.count, team);
    if (!occ_root_equals(&root, &scene->object_tree.root)) return false;
    occ_octree_refit(&scene->object_tree, &items, NULL, scene->changed.data, team);
    return true;
}

static occ_result commit_objects(occ_scene *scene, occ_team *team)
{
    if (!scene->objects_reordered && !scene->objects_moved) {
        if (scene->changed.count) {
            memset(scene->changed.data, 0, (size_t)scene->changed.count * sizeof(uint32_t));
        }
        scene->all_changed = false;
        return OCC_SUCCESS;
    }
    if (!scene->objects_reordered) {
        if (refit_objects(scene, team)) return OCC_SUCCESS;
        scene->objects_reordered = true;
    }
    scene->occluders_reordered = true; // their owners' rows change
    return rebuild_objects(scene, team);
}

// Removes the occluders whose owners are gone.
static void drop_orphans(occ_scene *scene)
{
    occ_occluder_rows *rows = &scene->occluder_rows;
    for (uint32_t row = 0; row < rows->count; row++) {
        uint32_t slot = rows->slot_of[row], owner = rows->owner_of[row];
        if (slot == OCC_NO_SLOT || owner == OCC_NO_SLOT) continue;
        if (occ_slots_is_taken(&scene->objects, owner)) continue;
        occ_scene_drop_sheet(scene, row);
        rows->slot_of[row] = OCC_NO_SLOT;
        occ_slots_release(&scene->occluders, slot);
        scene->occluders_reordered = true;
    }
    scene->owners_removed = false;
}

static occ_result commit_all(occ_scene *scene, occ_team *team)
{
    if (scene->owners_removed) drop_orphans(scene); // before the owners' slots are recycled
    occ_result result = commit_objects(scene, team);
    if (result) return occ_fail(&scene->hooks, result, "no memory to sort the objects");
    scene->objects_moved = scene->objects_reordered = false;
    scene->revision++; // even if the occluders fail: `changed` speaks of this step from here on
    result = occ_commit_occluders(scene, team);
    if (result) return occ_fail(&scene->hooks, result, "no memory to sort the occluders");
    scene->occluders_moved = scene->occluders_reordered = false;
    return OCC_SUCCESS;
}

occ_result occ_scene_commit(occ_scene *scene)
{
    if (!scene) return OCC_ERROR_INVALID_ARGUMENT;
    if (occ_scene_is_committed(scene)) return OCC_SUCCESS;
    uint32_t objects = scene->boxes.count, occluders = scene->occluder_rows.count;
    if (occ_parts_of(objects > occluders ? objects : occluders) < 2) return commit_all(scene, NULL);
    occ_team_wake(scene->team);
    occ_result result = commit_all(scene, scene->team);
    occ_team_rest(scene->team);
    return result;
}
