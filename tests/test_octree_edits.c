// SPDX-License-Identifier: Apache-2.0
// labels: property
// timeout: 120
// Thousands of random edits. After each commit the trees must hold, the scene must be the one that
// is built from the same content in one go, and answer as that does.
#include "kit_model.h"
#include "support.h"

#include <stdlib.h>
#include <string.h>

enum { EDITS = OCC_TEST_SLOWNESS > 1 ? 600 : 1500, SEEDS = 8 };

static occ_view *views[2];

static void set_up(void)
{
    occ_view_desc desc = {.backend = OCC_BACKEND_PLAIN};
    for (int i = 0; i < 2; i++)
        ck_assert_int_eq(occ_view_create(&desc, &views[i]), OCC_SUCCESS);
}

static void tear_down(void)
{
    for (int i = 0; i < 2; i++)
        occ_view_destroy(views[i]);
}

static void cull_both(const occ_scene *a, const occ_scene *b, uint32_t i)
{
    occ_camera_desc camera = kit_path(i);
    occ_cull_desc knobs = {.min_area = i % 3 ? 0.0f : 1e-30f, .grain = i % 4 ? 0 : 1};
    kit_cull(views[0], a, &camera, &knobs);
    kit_cull(views[1], b, &camera, &knobs);
}

// The masks of both views speak of the same objects.
static void check_mask_by_identity(const uint32_t *slot_map)
{
    size_t words[2];
    uint32_t *mask[2] = {kit_mask(views[0], &words[0]), kit_mask(views[1], &words[1])};
    size_t shown = 0, expected = 0;
    for (uint32_t s = 0; s < 32 * words[0]; s++) {
        if (!(mask[0][s / 32] >> s % 32 & 1u)) continue;
        uint32_t other = slot_map[s];
        KIT_CHECK(other / 32 < words[1] && mask[1][other / 32] >> other % 32 & 1u,
                  "slot %u is visible only after the edits", s);
        shown++;
    }
    for (size_t w = 0; w < words[1]; w++)
        expected += (size_t)__builtin_popcount(mask[1][w]);
    KIT_CHECK(shown == expected, "%zu of %zu are visible only without the edits", shown, expected);
    free(mask[0]);
    free(mask[1]);
}

static void compare_with_same_slots(kit_model *model, uint32_t i)
{
    uint32_t slot_map[KIT_MOST];
    occ_scene *fresh = kit_model_rebuild(model, KIT_SAME_SLOTS, slot_map);
    ck_assert_uint_eq(occ_scene_slot_count(fresh), occ_scene_slot_count(model->scene));
    kit_check_same_scene(model->scene, fresh);
    cull_both(model->scene, fresh, i);
    KIT_CHECK(kit_same_masks(views[0], views[1]), "the masks differ");
    occ_scene_destroy(fresh);
}

// Without the gaps the order of the items is the same, though the slots are not.
static void compare_without_gaps(kit_model *model, uint32_t i)
{
    uint32_t slot_map[KIT_MOST];
    occ_scene *fresh = kit_model_rebuild(model, KIT_IN_ORDER, slot_map);
    kit_check_same_tree(&model->scene->object_tree, &fresh->object_tree);
    kit_check_same_occluders(model->scene, fresh);
    for (uint32_t row = 0; row < fresh->boxes.count; row++)
        KIT_CHECK(slot_map[occ_scene_slot_of(model->scene)[row]] == occ_scene_slot_of(fresh)[row],
                  "row %u is another object", row);
    cull_both(model->scene, fresh, i);
    check_mask_by_identity(slot_map);
    occ_scene_destroy(fresh);
}

static void compare_with_another_history(kit_model *model, uint32_t i)
{
    uint32_t slot_map[KIT_MOST];
    occ_scene *fresh = kit_model_rebuild(model, KIT_SHUFFLED, slot_map);
    kit_check_same_tree(&model->scene->object_tree, &fresh->object_tree);
    kit_check_same_tree(&model->scene->occluder_tree, &fresh->occluder_tree);
    cull_both(model->scene, fresh, i);
    check_mask_by_identity(slot_map);
    occ_scene_destroy(fresh);
}

static void edit_and_compare(int seed, void (*compare)(kit_model *model, uint32_t i))
{
    static const uint32_t leaves[] = {1, 4, 16, 0};
    static const uint32_t owned[] = {3, 4, 2, 0}; // of four occluders
    occ_scene_desc desc = {.leaf_objects = leaves[seed % 4]};
    kit_model *model = kit_model_create((uint64_t)seed + 1000, &desc);
    uint32_t commits = 0, most_attached = 0, most_free = 0;
    model->owned = owned[seed / 2 % 4];
    for (uint32_t e = 0; e < EDITS; e++) {
        kit_model_edit(model);
        if (kit_below(&model->random, 20)) continue;
        kit_model_check(model);
        KIT_CHECK(!occ_scene_commit(model->scene), "no commit");
        kit_model_check(model);
        kit_check_trees(model->scene);
        compare(model, commits++);
        uint32_t attached = model->scene->attached_count;
        uint32_t nobodys = model->scene->occluder_rows.count - attached;
        most_attached = attached > most_attached ? attached : most_attached;
        most_free = nobodys > most_free ? nobodys : most_free;
    }
    ck_assert_uint_ge(most_attached, 10 * model->owned);
    ck_assert_uint_ge(most_free, 10 * (4 - model->owned));
    ck_assert_uint_gt(commits, EDITS / 50);
    ck_assert_uint_gt(model->scene->boxes.count, 20);
    kit_model_destroy(model);
}

START_TEST(edited_scene_equals_one_built_with_the_same_slots)
{
    edit_and_compare(_i, compare_with_same_slots);
}
END_TEST

START_TEST(edited_scene_equals_one_built_without_gaps)
{
    edit_and_compare(_i + SEEDS, compare_without_gaps);
}
END_TEST

START_TEST(answers_do_not_depend_on_the_history)
{
    edit_and_compare(_i + 2 * SEEDS, compare_with_another_history);
}
END_TEST

START_TEST(edits_that_undo_each_other_leave_no_trace)
{
    kit_model *model = kit_model_create(77, NULL);
    while (model->object_count < 600)
        kit_model_edit(model);
    ck_assert_int_eq(occ_scene_commit(model->scene), OCC_SUCCESS);
    uint32_t slot_map[KIT_MOST];
    occ_scene *before = kit_model_rebuild(model, KIT_SAME_SLOTS, slot_map);
    for (int round = 0; round < 2; round++) { // away, and back again
        for (uint32_t i = 0; i < model->object_count; i += 3) {
            kit_object *object = &model->objects[i];
            if (!object->alive) continue;
            occ_box box = object->box;
            box.center[0] += round ? 0.0f : 50.0f;
            ck_assert_int_eq(occ_scene_move(model->scene, object->handle, &box), OCC_SUCCESS);
        }
        ck_assert_int_eq(occ_scene_commit(model->scene), OCC_SUCCESS);
        kit_check_trees(model->scene);
    }
    kit_check_same_scene(model->scene, before);
    occ_scene_destroy(before);
    kit_model_destroy(model);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("octree_edits");
    TCase *slots = tcase_create("slots");
    tcase_add_checked_fixture(slots, set_up, tear_down);
    tcase_add_loop_test(slots, edited_scene_equals_one_built_with_the_same_slots, 0, SEEDS);
    tcase_add_test(slots, edits_that_undo_each_other_leave_no_trace);
    suite_add_tcase(suite, slots);
    TCase *gaps = tcase_create("gaps");
    tcase_add_checked_fixture(gaps, set_up, tear_down);
    tcase_add_loop_test(gaps, edited_scene_equals_one_built_without_gaps, 0, SEEDS);
    suite_add_tcase(suite, gaps);
    TCase *history = tcase_create("history");
    tcase_add_checked_fixture(history, set_up, tear_down);
    tcase_add_loop_test(history, answers_do_not_depend_on_the_history, 0, SEEDS);
    suite_add_tcase(suite, history);
    return test_run_suite(suite);
}
