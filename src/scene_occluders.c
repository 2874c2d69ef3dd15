// SPDX-License-Identifier: Apache-2.0
// Editing the occluders of a scene. A sheet is a row like any other, with its proxy for a box, and
// an entry in the table of sheets.
#include "scene_edit.h"

#include "log.h"
#include "sheet.h"

// A row for each slot is enough: until a commit no slot is used twice.
occ_result occ_scene_reserve_occluders(occ_scene *scene, size_t more, bool sheets)
{
    occ_result result = occ_slots_reserve(&scene->hooks, &scene->occluders, more);
    if (result) return result;
    return occ_occluder_rows_reserve(&scene->hooks, &scene->occluder_rows,
                                     scene->occluders.capacity, sheets);
}

static occ_result reserve_sheets(occ_scene *scene, size_t more_occluders, size_t more_sheets)
{
    occ_result result = occ_scene_reserve_occluders(scene, more_occluders, true);
    return result ? result : occ_sheets_reserve(&scene->hooks, &scene->sheets, more_sheets);
}

void occ_scene_drop_sheet(occ_scene *scene, uint32_t row)
{
    uint32_t index = occ_scene_sheet_of(scene, row);
    if (index == OCC_NO_SLOT) return;
    occ_sheets_release(&scene->sheets, index);
    scene->occluder_rows.sheet_of[row] = OCC_NO_SLOT;
}

// Checks `count` sheets and names the first bad one.
static occ_result check_sheets(const occ_scene *scene, const occ_sheet *sheets, size_t count,
                               const char *what)
{
    if (count && !sheets) return occ_scene_missing(scene, "the sheets are");
    if (count > OCC_MOST_ITEMS) {
        return occ_fail(&scene->hooks, OCC_ERROR_LIMIT, "%zu sheets %s", count, what);
    }
    for (size_t i = 0; i < count; i++) {
        const char *reason;
        occ_result result = occ_sheet_check(&sheets[i], &reason);
        if (result) {
            return occ_fail(&scene->hooks, result, "sheet %zu of %zu %s: %s", i, count, what,
                            reason);
        }
    }
    return OCC_SUCCESS;
}

static occ_result check_owners(const occ_scene *scene, const occ_object *owners, size_t count)
{
    for (size_t i = 0; owners && i < count; i++) {
        if ((owners[i].index || owners[i].generation) && !occ_scene_contains(scene, owners[i])) {
            return occ_scene_stale(scene, "owner", owners[i].index, owners[i].generation);
        }
    }
    return OCC_SUCCESS;
}

// Takes a row and a slot, for which there is room. Returns the row.
static uint32_t add_row(occ_scene *scene, const occ_box *box, const occ_object *owner,
                        occ_occluder *occluder)
{
    occ_occluder_rows *rows = &scene->occluder_rows;
    uint32_t row = rows->count++;
    uint32_t slot = occ_slots_take(&scene->occluders, row);
    rows->boxes[row] = *box;
    rows->slot_of[row] = slot;
    rows->owner_of[row] = owner ? owner->index - 1u : OCC_NO_SLOT; // 0 - 1 is OCC_NO_SLOT
    if (rows->sheet_of) rows->sheet_of[row] = OCC_NO_SLOT;
    if (occluder) *occluder = (occ_occluder){slot + 1, scene->occluders.generation[slot]};
    return row;
}

occ_result occ_scene_add_occluders(occ_scene *scene, const occ_box *boxes, const occ_object *owners,
                                   size_t count, occ_occluder *occluders)
{
    if (!scene) return OCC_ERROR_INVALID_ARGUMENT;
    occ_result result = occ_scene_check_boxes(scene, boxes, count, "occluders");
    if (!result) result = check_owners(scene, owners, count);
    if (result || !count) return result;
    result = occ_scene_reserve_occluders(scene, count, false);
    if (result) return occ_fail(&scene->hooks, result, "no room for %zu more occluders", count);
    for (size_t i = 0; i < count; i++)
        add_row(scene, &boxes[i], owners ? &owners[i] : NULL, occluders ? &occluders[i] : NULL);
    scene->occluders_reordered = true;
    return OCC_SUCCESS;
}

occ_result occ_scene_add_occluder(occ_scene *scene, const occ_box *box, occ_object owner,
                                  occ_occluder *occluder)
{
    return occ_scene_add_occluders(scene, box, &owner, 1, occluder);
}

// Stores the sheet of a row, for which there is room.
static void put_sheet(occ_scene *scene, uint32_t row, const occ_sheet *sheet)
{
    const occ_occluder_rows *rows = &scene->occluder_rows;
    occ_scene_drop_sheet(scene, row);
    rows->sheet_of[row] = occ_sheets_take(&scene->sheets, sheet, rows->slot_of[row]);
}

occ_result occ_scene_add_sheets(occ_scene *scene, const occ_sheet *sheets, const occ_object *owners,
                                size_t count, occ_occluder *occluders)
{
    if (!scene) return OCC_ERROR_INVALID_ARGUMENT;
    occ_result result = check_sheets(scene, sheets, count, "to add");
    if (!result) result = check_owners(scene, owners, count);
    if (result || !count) return result;
    result = reserve_sheets(scene, count, count);
    if (result) return occ_fail(&scene->hooks, result, "no room for %zu more sheets", count);
    for (size_t i = 0; i < count; i++) {
        occ_box proxy = occ_sheet_proxy(&sheets[i]);
        uint32_t row =
            add_row(scene, &proxy, owners ? &owners[i] : NULL, occluders ? &occluders[i] : NULL);
        put_sheet(scene, row, &sheets[i]);
    }
    scene->occluders_reordered = true;
    return OCC_SUCCESS;
}

occ_result occ_scene_add_sheet(occ_scene *scene, const occ_sheet *sheet, occ_object owner,
                               occ_occluder *occluder)
{
    return occ_scene_add_sheets(scene, sheet, &owner, 1, occluder);
}

// The row of an occluder that is there, and whose owner, if it has one, is there too.
static uint32_t find_row(const occ_scene *scene, occ_occluder occluder)
{
    uint32_t slot = occ_slots_find(&scene->occluders, occluder.index, occluder.generation);
    if (slot == OCC_NO_SLOT) return OCC_NO_SLOT;
    uint32_t row = scene->occluders.value[slot], owner = scene->occluder_rows.owner_of[row];
    bool alive = owner == OCC_NO_SLOT || occ_slots_is_taken(&scene->objects, owner);
    return alive ? row : OCC_NO_SLOT;
}

static occ_result gone(const occ_scene *scene, occ_occluder occluder)
{
    return occ_scene_stale(scene, "occluder", occluder.index, occluder.generation);
}

static void move_row(occ_scene *scene, uint32_t row, const occ_box *box)
{
    occ_box *place = scene->occluder_rows.boxes + row;
    scene->occluders_moved = true;
    bool is_free = scene->occluder_rows.owner_of[row] == OCC_NO_SLOT;
    if (!scene->occluders_reordered && is_free &&
        !occ_same_key(&scene->occluder_tree, place, box)) {
        scene->occluders_reordered = true;
    }
    *place = *box;
}

occ_result occ_scene_move_occluder(occ_scene *scene, occ_occluder occluder, const occ_box *box)
{
    if (!scene) return OCC_ERROR_INVALID_ARGUMENT;
    occ_result result = occ_scene_check_boxes(scene, box, 1, "to move");
    if (result) return result;
    uint32_t row = find_row(scene, occluder);
    if (row == OCC_NO_SLOT) return gone(scene, occluder);
    occ_scene_drop_sheet(scene, row);
    move_row(scene, row, box);
    return OCC_SUCCESS;
}

occ_result occ_scene_move_sheet(occ_scene *scene, occ_occluder occluder, const occ_sheet *sheet)
{
    if (!scene) return OCC_ERROR_INVALID_ARGUMENT;
    occ_result result = check_sheets(scene, sheet, 1, "to move");
    if (result) return result;
    uint32_t row = find_row(scene, occluder);
    if (row == OCC_NO_SLOT) return gone(scene, occluder);
    if (!occ_scene_sheet(scene, row)) {
        result = reserve_sheets(scene, 0, 1);
        if (result) return occ_fail(&scene->hooks, result, "no room for one more sheet");
    }
    occ_box proxy = occ_sheet_proxy(sheet);
    put_sheet(scene, row, sheet);
    move_row(scene, row, &proxy);
    return OCC_SUCCESS;
}

occ_result occ_scene_remove_occluder(occ_scene *scene, occ_occluder occluder)
{
    if (!scene) return OCC_ERROR_INVALID_ARGUMENT;
    uint32_t row = find_row(scene, occluder);
    if (row == OCC_NO_SLOT) return gone(scene, occluder);
    occ_scene_drop_sheet(scene, row);
    uint32_t slot = scene->occluder_rows.slot_of[row];
    scene->occluder_rows.slot_of[row] = OCC_NO_SLOT;
    occ_slots_release(&scene->occluders, slot);
    scene->occluders_reordered = true;
    return OCC_SUCCESS;
}

static void tell_owner(const occ_scene *scene, uint32_t row, occ_object *owner)
{
    uint32_t owned_by = scene->occluder_rows.owner_of[row];
    if (!owner) return;
    *owner = (occ_object){0, 0};
    if (owned_by != OCC_NO_SLOT) {
        *owner = (occ_object){owned_by + 1, scene->objects.generation[owned_by]};
    }
}

occ_result occ_scene_occluder_box(const occ_scene *scene, occ_occluder occluder, occ_box *box,
                                  occ_object *owner)
{
    if (!scene) return OCC_ERROR_INVALID_ARGUMENT;
    uint32_t row = find_row(scene, occluder);
    if (row == OCC_NO_SLOT) return gone(scene, occluder);
    if (occ_scene_sheet(scene, row)) {
        return occ_fail(&scene->hooks, OCC_ERROR_INVALID_ARGUMENT, "occluder {%u, %u} is a sheet",
                        occluder.index, occluder.generation);
    }
    if (box) *box = occ_scene_occluder_boxes(scene)[row];
    tell_owner(scene, row, owner);
    return OCC_SUCCESS;
}

occ_result occ_scene_occluder_sheet(const occ_scene *scene, occ_occluder occluder, occ_sheet *sheet,
                                    occ_object *owner)
{
    if (!scene) return OCC_ERROR_INVALID_ARGUMENT;
    uint32_t row = find_row(scene, occluder);
    if (row == OCC_NO_SLOT) return gone(scene, occluder);
    const occ_sheet *found = occ_scene_sheet(scene, row);
    if (!found) {
        return occ_fail(&scene->hooks, OCC_ERROR_INVALID_ARGUMENT, "occluder {%u, %u} is a box",
                        occluder.index, occluder.generation);
    }
    if (sheet) *sheet = *found;
    tell_owner(scene, row, owner);
    return OCC_SUCCESS;
}
