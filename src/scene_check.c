// SPDX-License-Identifier: Apache-2.0
// The validation tier of a scene.
#include "scene_data.h"

#include "box.h"
#include "log.h"
#include "sheet.h"

static const char *check_rows(const occ_scene *scene)
{
    uint32_t count = scene->boxes.count;
    if (scene->objects.released_count) return "a commit recycles the released slots";
    if (count != scene->objects.taken || count != scene->slot_of.count) {
        return "every object has one row";
    }
    for (uint32_t row = 0; row < count; row++) {
        uint32_t slot = occ_scene_slot_of(scene)[row];
        if (slot >= scene->objects.count || !occ_slots_is_taken(&scene->objects, slot)) {
            return "a row belongs to a slot that is taken";
        }
        if (scene->objects.value[slot] != row) return "slots and rows name each other";
        occ_box box = occ_boxes_get(&scene->boxes, row);
        if (occ_box_check(&box)) return "a box is finite and in range";
    }
    if ((uint64_t)scene->changed.count * 32 * OCC_CHANGE_ROWS < count) {
        return "every row has a bit that says whether it changed";
    }
    return NULL;
}

// --- occluders -----------------------------------------------------------------------------------

static bool same_box(const occ_box *a, const occ_box *b)
{
    bool same = true;
    for (int j = 0; j < 3; j++) {
        same = same && a->center[j] == b->center[j];
        for (int k = 0; k < 3; k++)
            same = same && a->axis[k][j] == b->axis[k][j];
    }
    return same;
}

// Of a sheet that its entry is sound and its row has its proxy; of a box that it is sound.
static const char *check_kind(const occ_scene *scene, uint32_t row)
{
    const occ_occluder_rows *rows = &scene->occluder_rows;
    uint32_t index = occ_scene_sheet_of(scene, row);
    const char *reason;
    if (index == OCC_NO_SLOT) {
        bool bad = occ_box_check(&rows->boxes[row]) != OCC_SUCCESS;
        return bad ? "an occluder's box is finite and in range" : NULL;
    }
    if (index >= scene->sheets.entries.count) return "a sheet has an entry";
    const occ_sheet_entry *entry = occ_sheets_at(&scene->sheets, index);
    if (entry->slot != rows->slot_of[row]) return "a sheet's entry is its own";
    if (occ_sheet_check(&entry->sheet, &reason)) return "a sheet is sound";
    for (uint32_t i = entry->sheet.corner_count; i < OCC_SHEET_CORNERS; i++)
        for (int j = 0; j < 3; j++)
            if (entry->sheet.corner[i][j] != 0.0f) return "a sheet is zero where it has no corners";
    const occ_box proxy = occ_sheet_proxy(&entry->sheet);
    return same_box(&proxy, &rows->boxes[row]) ? NULL : "a sheet's row has its proxy";
}

static const char *check_occluder(const occ_scene *scene, uint32_t row)
{
    const occ_occluder_rows *rows = &scene->occluder_rows;
    uint32_t slot = rows->slot_of[row], owner = rows->owner_of[row];
    if (slot >= scene->occluders.count || !occ_slots_is_taken(&scene->occluders, slot)) {
        return "an occluder's row belongs to a slot that is taken";
    }
    if (scene->occluders.value[slot] != row) return "occluders' slots and rows name each other";
    const char *broken = check_kind(scene, row);
    if (broken) return broken;
    if ((owner != OCC_NO_SLOT) != (row < scene->attached_count)) {
        return "occluders that an object owns lie before those that nobody owns";
    }
    if (owner != OCC_NO_SLOT &&
        (owner >= scene->objects.count || !occ_slots_is_taken(&scene->objects, owner))) {
        return "an occluder's owner is there";
    }
    return NULL;
}

static const char *check_occluder_rows(const occ_scene *scene)
{
    const occ_occluder_rows *rows = &scene->occluder_rows;
    const char *broken = occ_sheets_validate(&scene->sheets);
    uint32_t sheets = 0;
    if (scene->occluders.released_count) return "a commit recycles the released slots";
    if (rows->count != scene->occluders.taken) return "every occluder has one row";
    if (scene->attached_count > rows->count) return "attached occluders have rows";
    for (uint32_t row = 0; row < rows->count && !broken; row++) {
        broken = check_occluder(scene, row);
        sheets += occ_scene_sheet_of(scene, row) != OCC_NO_SLOT;
    }
    if (!broken && sheets != scene->sheets.taken) return "every sheet is an occluder";
    for (uint32_t row = 1; row < scene->attached_count && !broken; row++) {
        uint32_t before = occ_scene_owner_row(scene, row - 1);
        uint32_t here = occ_scene_owner_row(scene, row);
        if (before > here) return "attached occluders lie in the order of their owners";
        if (before == here && rows->slot_of[row - 1] > rows->slot_of[row]) {
            return "occluders of one owner lie in ascending order of slots";
        }
    }
    return broken;
}

// How many attached occluders have owners before this row.
static uint32_t attached_before(const occ_scene *scene, uint32_t owner_row)
{
    uint32_t begin = 0, end = scene->attached_count;
    while (begin < end) {
        uint32_t middle = begin + (end - begin) / 2;
        if (occ_scene_owner_row(scene, middle) < owner_row) {
            begin = middle + 1;
        } else {
            end = middle;
        }
    }
    return begin;
}

static float largest_reach(const occ_scene *scene, uint32_t first, uint32_t count)
{
    float most = 0.0f;
    for (uint32_t row = first; row < first + count; row++) {
        float one = occ_occluder_reach(&occ_scene_occluder_boxes(scene)[row]);
        most = one > most ? one : most;
    }
    return most;
}

// Both octrees are sound by now, and so are the rows.
static const char *check_attached(const occ_scene *scene)
{
    const occ_node *nodes = occ_octree_nodes(&scene->object_tree);
    const occ_attached *attached = scene->attached.data;
    if (scene->attached.count != scene->object_tree.nodes.count) {
        return "every node of the objects knows what is attached to it";
    }
    for (uint32_t n = 0; n < scene->attached.count; n++) {
        uint32_t first = attached_before(scene, nodes[n].first);
        uint32_t end = attached_before(scene, nodes[n].first + nodes[n].count);
        if (attached[n].first != first || attached[n].count != end - first) {
            return "what is attached to a node is what its objects own";
        }
        if (attached[n].reach != largest_reach(scene, first, end - first)) {
            return "the reach of what is attached to a node is the largest";
        }
    }
    return NULL;
}

static const char *check_reach(const occ_scene *scene)
{
    const occ_node *nodes = occ_octree_nodes(&scene->occluder_tree);
    const float *reach = scene->reach.data;
    if (scene->reach.count != scene->occluder_tree.nodes.count) return "every node has a reach";
    for (uint32_t n = 0; n < scene->reach.count; n++) {
        uint32_t first = scene->attached_count + nodes[n].first;
        if (reach[n] != largest_reach(scene, first, nodes[n].count)) {
            return "a node's reach is its occluders' largest";
        }
    }
    return NULL;
}

static const char *check_occluders(const occ_scene *scene)
{
    const occ_occluder_rows *rows = &scene->occluder_rows;
    const char *broken = check_occluder_rows(scene);
    if (!broken) broken = check_attached(scene);
    if (broken) return broken;
    uint32_t first = scene->attached_count;
    occ_tree_items items = occ_scene_occluder_items(scene, first);
    const uint32_t *names = rows->count ? rows->slot_of + first : NULL;
    broken = occ_octree_validate(&scene->occluder_tree, &items, NULL, names, rows->count - first);
    return broken ? broken : check_reach(scene);
}

// --- all -----------------------------------------------------------------------------------------

occ_result occ_scene_validate(const occ_scene *scene)
{
    if (!scene) return OCC_ERROR_INVALID_ARGUMENT;
    if (!occ_scene_is_committed(scene)) {
        return occ_fail(&scene->hooks, OCC_ERROR_NOT_COMMITTED, "only a committed scene has trees");
    }
    occ_tree_items objects = occ_scene_object_items(scene);
    const char *broken = occ_slots_validate(&scene->objects);
    if (!broken) broken = occ_slots_validate(&scene->occluders);
    if (!broken) broken = check_rows(scene);
    if (!broken) {
        broken = occ_octree_validate(&scene->object_tree, &objects, NULL, occ_scene_slot_of(scene),
                                     scene->boxes.count);
    }
    if (!broken) broken = check_occluders(scene);
    if (!broken) return OCC_SUCCESS;
    return occ_fail(&scene->hooks, OCC_ERROR_CORRUPT, "it does not hold that %s", broken);
}
