// SPDX-License-Identifier: Apache-2.0
// A scene and a plain list of what it should hold, edited together at random; and other scenes
// built from the list, to compare with.
#ifndef OCC_TEST_KIT_MODEL_H
#define OCC_TEST_KIT_MODEL_H

#include "kit_tree.h"

enum { KIT_MOST = 4000 };

typedef struct kit_object {
    occ_object handle;
    occ_box box;
    bool alive;
} kit_object;

typedef struct kit_occluder {
    occ_occluder handle;
    bool is_sheet;
    occ_box box; // if it is none
    occ_sheet sheet;
    uint32_t owner; // index of an object, or UINT32_MAX
    bool alive;
} kit_occluder;

typedef struct kit_model {
    occ_scene *scene;
    kit_random random;
    uint32_t owned; // of four occluders that are added, so many are somebody's
    uint32_t object_count, occluder_count; // of all that ever were
    kit_object objects[KIT_MOST];
    kit_occluder occluders[KIT_MOST];
} kit_model;

// An empty scene and list; `owned` is 3.
kit_model *kit_model_create(uint64_t seed, const occ_scene_desc *desc);
void kit_model_destroy(kit_model *model);

// One random edit of both.
void kit_model_edit(kit_model *model);

// Fails the test unless the scene holds what the list says.
void kit_model_check(const kit_model *model);

// How a scene is built from the list.
typedef enum kit_history {
    KIT_SAME_SLOTS, // with objects in the gaps, which are removed again before the first commit
    KIT_IN_ORDER,   // by ascending slots, without gaps
    KIT_SHUFFLED    // in any order, with commits in between
} kit_history;

// Builds and commits a scene with what the list holds. slot_map[slot in the model's scene] is set
// to the slot in the new one, or OCC_NO_SLOT; it has room for KIT_MOST elements.
occ_scene *kit_model_rebuild(kit_model *model, kit_history history, uint32_t *slot_map);

#endif
