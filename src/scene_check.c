// SPDX-License-Identifier: Apache-2.0
// The validation tier of a scene.
#include "scene_data.h"

#include "box.h"
#include "log.h"

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

static const char *check_occluders(const occ_scene *scene)
{
    uint32_t count = scene->occluder_order.count;
    const uint32_t *order = scene->occluder_order.data;
    if (scene->occluders.released_count) return "a commit recycles the released slots";
    if (count != scene->occluders.taken) return "every occluder has one place in the order";
    if (scene->reach.count != scene->occluder_tree.nodes.count) return "every node has a reach";
    for (uint32_t i = 0; i < count; i++) {
        uint32_t slot = order[i];
        if (slot >= scene->occluders.count || !occ_slots_is_taken(&scene->occluders, slot)) {
            return "the order names occluders that are there";
        }
        if (occ_box_check(&occ_scene_occluder_boxes(scene)[slot])) {
            return "a box is finite and in range";
        }
        uint32_t owner = scene->occluders.value[slot];
        if (owner != OCC_NO_SLOT &&
            (owner >= scene->objects.count || !occ_slots_is_taken(&scene->objects, owner))) {
            return "an occluder's owner is there";
        }
    }
    return NULL;
}

// Each node's reach is the largest of its occluders'.
static const char *check_reach(const occ_scene *scene)
{
    const occ_node *nodes = occ_octree_nodes(&scene->occluder_tree);
    const uint32_t *order = scene->occluder_order.data;
    const float *reach = scene->reach.data;
    for (uint32_t n = 0; n < scene->occluder_tree.nodes.count; n++) {
        float most = 0.0f;
        for (uint32_t i = nodes[n].first; i < nodes[n].first + nodes[n].count; i++) {
            float one = occ_occluder_reach(&occ_scene_occluder_boxes(scene)[order[i]]);
            most = one > most ? one : most;
        }
        if (reach[n] != most) return "a node's reach is its occluders' largest";
    }
    return NULL;
}

occ_result occ_scene_validate(const occ_scene *scene)
{
    if (!scene) return OCC_ERROR_INVALID_ARGUMENT;
    if (!occ_scene_is_committed(scene)) {
        return occ_fail(&scene->hooks, OCC_ERROR_NOT_COMMITTED, "only a committed scene has trees");
    }
    occ_tree_items objects = occ_scene_object_items(scene);
    occ_tree_items occluders = occ_scene_occluder_items(scene);
    const uint32_t *order = scene->occluder_order.data;
    const char *broken = occ_slots_validate(&scene->objects);
    if (!broken) broken = occ_slots_validate(&scene->occluders);
    if (!broken) broken = check_rows(scene);
    if (!broken) broken = check_occluders(scene);
    if (!broken) {
        broken = occ_octree_validate(&scene->object_tree, &objects, NULL, occ_scene_slot_of(scene),
                                     scene->boxes.count);
    }
    if (!broken) {
        broken = occ_octree_validate(&scene->occluder_tree, &occluders, order, order,
                                     scene->occluder_order.count);
    }
    if (!broken) broken = check_reach(scene);
    if (!broken) return OCC_SUCCESS;
    return occ_fail(&scene->hooks, OCC_ERROR_CORRUPT, "it does not hold that %s", broken);
}
