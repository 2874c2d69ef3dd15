// SPDX-License-Identifier: Apache-2.0
// What a scene is made of.
//
//     handle -> slot ---value---> row of `boxes`, in octree order after a commit
//                 ^                 |
//                 +----slot_of------+
//
// Occluders have slots and rows of their own in the same way. A commit puts the rows in the order
// in which the walk reads them:
//
//     | attached: an object owns them; by its row, then by slot | free: in their octree's order |
//      <- attached_count ->
//
// so that the occluders of a subtree of either octree lie side by side.
#ifndef OCC_SCENE_DATA_H
#define OCC_SCENE_DATA_H

#include "boxes.h"
#include "occluder_rows.h"
#include "octree.h"
#include "sheet_table.h"
#include "slots.h"

// What the objects of a subtree own: the occluders in rows [first, first + count).
typedef struct occ_attached {
    uint32_t first, count;
    float reach; // the largest occ_occluder_reach() among them
} occ_attached;

struct occ_scene {
    occ_hooks hooks;
    uint64_t id;       // no other scene of this process has it
    occ_team *team;    // of commits
    uint64_t revision; // counts the commits of the objects: `changed` leads from the one before

    occ_slots objects;
    occ_boxes boxes;
    occ_array slot_of; // uint32_t per row; OCC_NO_SLOT where an object was removed
    occ_octree object_tree;

    occ_slots occluders;
    occ_occluder_rows occluder_rows;
    occ_sheets sheets;        // those of the occluders that are no boxes
    uint32_t attached_count;  // rows from here on are free
    occ_array attached;       // occ_attached per node of the objects' tree
    occ_octree occluder_tree; // of the free ones
    occ_array reach;          // float per node of it: the largest occ_occluder_reach() below

    occ_array
        changed; // uint32_t words: which rows (OCC_CHANGE_ROWS to a bit) the latest commit changed
    bool all_changed;       // or all of them
    bool objects_moved;     // bounds are out of date
    bool objects_reordered; // rows are out of date too
    bool occluders_moved;
    bool occluders_reordered;
    bool owners_removed;
};

static inline bool occ_scene_is_committed(const occ_scene *scene)
{
    return !(scene->objects_moved || scene->objects_reordered || scene->occluders_moved ||
             scene->occluders_reordered || scene->owners_removed);
}

static inline const uint32_t *occ_scene_slot_of(const occ_scene *scene)
{
    return scene->slot_of.data;
}

static inline const occ_box *occ_scene_occluder_boxes(const occ_scene *scene)
{
    return scene->occluder_rows.boxes;
}

// Where the occluder in a row lies among the sheets, or OCC_NO_SLOT: it is a box.
static inline uint32_t occ_scene_sheet_of(const occ_scene *scene, uint32_t row)
{
    const uint32_t *sheet_of = scene->occluder_rows.sheet_of;
    return sheet_of ? sheet_of[row] : OCC_NO_SLOT;
}

// The occluder in a row, if it is a sheet, or NULL.
static inline const occ_sheet *occ_scene_sheet(const occ_scene *scene, uint32_t row)
{
    uint32_t index = occ_scene_sheet_of(scene, row);
    return index == OCC_NO_SLOT ? NULL : &occ_sheets_at(&scene->sheets, index)->sheet;
}

static inline uint32_t occ_scene_free_count(const occ_scene *scene)
{
    return scene->occluder_rows.count - scene->attached_count;
}

// The row of the object that owns the occluder in a row, or OCC_NO_SLOT.
static inline uint32_t occ_scene_owner_row(const occ_scene *scene, uint32_t row)
{
    uint32_t owner = scene->occluder_rows.owner_of[row];
    return owner == OCC_NO_SLOT ? OCC_NO_SLOT : scene->objects.value[owner];
}

// The occluder in a row is a box from here on, if it was a sheet.
void occ_scene_drop_sheet(occ_scene *scene, uint32_t row);

// The occluders' part of a commit, once the objects are in their rows.
occ_result occ_commit_occluders(occ_scene *scene, occ_team *team);

// How the octrees see the two kinds of items. Occluders count from row `first` on.
occ_tree_items occ_scene_object_items(const occ_scene *scene);
occ_tree_items occ_scene_occluder_items(const occ_scene *scene, uint32_t first);

#endif
