// SPDX-License-Identifier: Apache-2.0
// What a scene is made of.
//
//     handle -> slot ---value---> row of `boxes`, in octree order after a commit
//                 ^                 |
//                 +----slot_of------+
//
// Occluders are looked up one by one: their boxes stay at their slots, and only `occluder_order` is
// sorted. An occluder's slot carries its owner's slot.
#ifndef OCC_SCENE_DATA_H
#define OCC_SCENE_DATA_H

#include "boxes.h"
#include "octree.h"
#include "slots.h"

// What the objects of a subtree own: occluders [first, first + count) of the order.
typedef struct occ_attached {
    uint32_t first, count;
    float reach; // the largest occ_occluder_reach() among them
} occ_attached;

struct occ_scene {
    occ_hooks hooks;
    uint64_t id;       // no other scene of this process has it
    uint32_t threads;  // of a commit
    uint64_t revision; // counts the commits of the objects: `changed` leads from the one before

    occ_slots objects;
    occ_boxes boxes;
    occ_array slot_of; // uint32_t per row; OCC_NO_SLOT where an object was removed
    occ_octree object_tree;

    occ_slots occluders;
    occ_array occluder_boxes; // occ_box per slot
    // uint32_t: slots. First the attached occluders, which an object owns, by their owners' rows;
    // then the free ones, in the order of their tree.
    occ_array occluder_order;
    uint32_t attached_count;
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
    return scene->occluder_boxes.data;
}

// The occluders' part of a commit, once the objects are in their rows.
occ_result occ_commit_occluders(occ_scene *scene, occ_team *team);

// How the octrees see the two kinds of items.
occ_tree_items occ_scene_object_items(const occ_scene *scene);
occ_tree_items occ_scene_occluder_items(const occ_scene *scene);

#endif
