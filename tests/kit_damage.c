// SPDX-License-Identifier: Apache-2.0
#include "kit_damage.h"

#include "kit_model.h"

occ_scene *kit_victim;

static kit_model *model;
static occ_scene sound; // what was in it before the damage
static kit_log record;

void kit_damage_set_up(void)
{
    kit_forget(&record);
    occ_scene_desc desc = {.leaf_objects = 4, .logger = kit_logger(&record)};
    model = kit_model_create(4711, &desc);
    while (model->object_count < 300 || model->occluder_count < 60)
        kit_model_edit(model);
    kit_victim = model->scene;
    occ_box crowd[60]; // what random edits may lack: depth, and boxes that are alike
    kit_random random = {1};
    for (int i = 0; i < 60; i++)
        crowd[i] = i < 50 ? kit_box(&random, 20, 0.1f) : kit_cube(7, 7, 7, 0.25f);
    occ_object objects[60];
    ck_assert_int_eq(occ_scene_add_many(kit_victim, crowd, 60, objects), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_add_occluders(kit_victim, crowd, NULL, 60, NULL), OCC_SUCCESS);
    for (int i = 0; i < 60; i++) // three to an owner, and several owners to the last node
        objects[i] = objects[i / 3 * 3];
    ck_assert_int_eq(occ_scene_add_occluders(kit_victim, crowd, objects + 30, 30, NULL),
                     OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_commit(kit_victim), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_validate(kit_victim), OCC_SUCCESS);
    ck_assert_uint_eq(record.errors, 0);
    sound = *kit_victim;
}

void kit_damage_mend(void)
{
    *kit_victim = sound;
}

void kit_damage_tear_down(void)
{
    kit_damage_mend(); // the arrays are freed by the sizes they had
    kit_model_destroy(model);
}

void kit_damage_check(const char *what)
{
    kit_forget(&record);
    occ_result result = occ_scene_validate(kit_victim);
    KIT_CHECK(result == OCC_ERROR_CORRUPT, "%s: %s", what, occ_result_name(result));
    KIT_CHECK(record.errors == 1 && kit_logged(&record, "OCC_ERROR_CORRUPT: it does not hold that"),
              "%s: the log says \"%s\"", what, record.text);
}
