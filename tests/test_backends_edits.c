// SPDX-License-Identifier: Apache-2.0
// labels: unit property
// What was moved, added and removed is so on every backend after the next commit, and masks stay
// bit-identical. The OpenCL backend is sent only what changed.
#include "kit_crew.h"
#include "kit_obs.h"
#include "obs.h"
#include "scene_data.h"
#include "scenes.h"
#include "support.h"

#include <stdlib.h>

static kit_crew crew;

static void gather(void)
{
    kit_crew_gather(&crew);
}

static void dismiss(void)
{
    kit_crew_dismiss(&crew);
}

enum { OBJECTS = 3000 / OCC_TEST_SLOWNESS };

static const occ_scene_desc small_leaves = {.leaf_objects = 4};
static const occ_cull_desc single = {.method = OCC_METHOD_SINGLE};
static const occ_cull_desc pairwise = {.method = OCC_METHOD_PAIRWISE};

typedef struct edited {
    obs_scene file;
    occ_scene *scene;
    occ_object *objects;
    occ_occluder *occluders;
    occ_camera_desc camera;
    double eye[3];
    kit_random random;
} edited;

static void begin_edits(edited *e, const occ_scene_desc *desc)
{
    ck_assert(scenes_make("city", OBJECTS, 1, &e->file));
    e->objects = calloc(e->file.object_count, sizeof *e->objects);
    e->occluders = calloc(e->file.occluder_count, sizeof *e->occluders);
    ck_assert(e->objects && e->occluders);
    e->scene = kit_obs_scene(&e->file, desc, e->objects, e->occluders);
    e->camera = kit_obs_camera(&e->file.frames[7], e->eye);
    e->random = (kit_random){5};
}

static void end_edits(edited *e)
{
    occ_scene_destroy(e->scene);
    free(e->objects);
    free(e->occluders);
    obs_free(&e->file);
}

static occ_box box_of(const edited *e, uint32_t i)
{
    occ_box box;
    ck_assert_int_eq(occ_scene_box(e->scene, e->objects[i], &box), OCC_SUCCESS);
    return box;
}

static void move(edited *e, uint32_t i, const occ_box *box)
{
    ck_assert_int_eq(occ_scene_move(e->scene, e->objects[i], box), OCC_SUCCESS);
}

static void move_within_cells(edited *e)
{
    uint32_t moved = kit_move_within_cells(e->scene, e->objects, e->file.object_count, &e->random);
    ck_assert_uint_gt(moved, e->file.object_count / 20);
}

static void move_far(edited *e)
{
    for (int i = 0; i < 150; i++) {
        uint32_t a = kit_below(&e->random, e->file.object_count);
        uint32_t b = kit_below(&e->random, e->file.object_count);
        occ_box box[2] = {box_of(e, a), box_of(e, b)};
        move(e, a, &box[1]);
        move(e, b, &box[0]);
    }
}

static void move_occluders(edited *e)
{
    for (uint32_t i = 0; i < e->file.occluder_count; i += 2) {
        occ_box box;
        if (occ_scene_occluder_box(e->scene, e->occluders[i], &box, NULL)) continue; // its owner
        box.center[1] -= 3.0f;                                                       // is gone
        ck_assert_int_eq(occ_scene_move_occluder(e->scene, e->occluders[i], &box), OCC_SUCCESS);
    }
}

// So that they are sorted again.
static void replace_occluder(edited *e)
{
    uint32_t i = kit_below(&e->random, e->file.occluder_count);
    occ_box box;
    occ_object owner;
    if (occ_scene_occluder_box(e->scene, e->occluders[i], &box, &owner)) return;
    ck_assert_int_eq(occ_scene_remove_occluder(e->scene, e->occluders[i]), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_add_occluder(e->scene, &box, owner, &e->occluders[i]), OCC_SUCCESS);
}

static void replace(edited *e)
{
    for (int i = 0; i < 200; i++) {
        uint32_t a = kit_below(&e->random, e->file.object_count);
        occ_box box = box_of(e, a);
        ck_assert_int_eq(occ_scene_remove(e->scene, e->objects[a]), OCC_SUCCESS);
        box.center[0] += kit_between(&e->random, -20, 20);
        ck_assert_int_eq(occ_scene_add(e->scene, &box, &e->objects[a]), OCC_SUCCESS);
    }
}

static void move_and_commit_twice(edited *e)
{
    move_within_cells(e);
    ck_assert_int_eq(occ_scene_commit(e->scene), OCC_SUCCESS);
    occ_box box = box_of(e, 0);
    move(e, 0, &box);
}

START_TEST(edits_reach_every_backend)
{
    static void (*const edits[])(edited *) = {move_within_cells, move_far, move_occluders, replace,
                                              move_and_commit_twice};
    enum { EDITS = sizeof edits / sizeof *edits };
    edited e;
    begin_edits(&e, &small_leaves);
    uint32_t *before = kit_crew_cull(&crew, e.scene, &e.camera, &single);
    unsigned telling = 0; // edits that changed a verdict
    for (unsigned round = 0; round < 3 * EDITS; round++) {
        uint32_t slots = occ_scene_slot_count(e.scene);
        edits[round % EDITS](&e);
        ck_assert_int_eq(occ_scene_commit(e.scene), OCC_SUCCESS);
        if (edits[round % EDITS] == move_within_cells)
            ck_assert_msg(!e.scene->all_changed, "the moves were to stay within their cells");
        uint32_t *after = kit_crew_cull(&crew, e.scene, &e.camera, &single);
        telling += !kit_same_words(before, after, slots);
        free(before);
        before = after;
        free(kit_crew_cull(&crew, e.scene, &e.camera, &pairwise));
    }
    ck_assert_uint_gt(telling, 2 * EDITS);
    free(before);
    end_edits(&e);
}
END_TEST

START_TEST(a_commit_that_fails_half_way_loses_no_change)
{
    kit_heap heap = {.calls = 0};
    occ_scene_desc desc = {.allocator = kit_allocator(&heap), .leaf_objects = 4};
    edited e;
    begin_edits(&e, &desc);
    free(kit_crew_cull(&crew, e.scene, &e.camera, &pairwise));
    bool failed = true;
    for (uint64_t n = 1; failed; n++) {
        move_within_cells(&e);
        move_occluders(&e);
        replace_occluder(&e);
        heap.fail_at = heap.calls + n;
        occ_result result = occ_scene_commit(e.scene);
        heap.fail_at = 0;
        failed = result == OCC_ERROR_OUT_OF_MEMORY;
        ck_assert_msg(failed || result == OCC_SUCCESS, "%s", occ_result_name(result));
        ck_assert_msg(failed || n > 1, "no allocation failed");
        if (failed) ck_assert_int_eq(occ_scene_commit(e.scene), OCC_SUCCESS);
        free(kit_crew_cull(&crew, e.scene, &e.camera, &pairwise));
    }
    end_edits(&e);
}
END_TEST

START_TEST(a_view_that_changes_between_scenes_sees_the_one_it_is_given)
{
    obs_scene file;
    ck_assert(scenes_make("soup", OBJECTS, 1, &file));
    occ_scene *scene = kit_obs_scene(&file, &small_leaves, NULL, NULL);
    edited e;
    begin_edits(&e, &small_leaves);
    double eye[3];
    occ_camera_desc away = kit_obs_camera(&file.frames[0], eye);
    for (int i = 0; i < 3; i++) {
        free(kit_crew_cull(&crew, scene, &away, &single));
        free(kit_crew_cull(&crew, e.scene, &e.camera, &single));
        occ_scene_destroy(scene); // and another takes its place, often at the same address
        scene = kit_obs_scene(i % 2 ? &file : &e.file, &small_leaves, NULL, NULL);
        free(kit_crew_cull(&crew, scene, &e.camera, &single));
        occ_scene_destroy(scene);
        scene = kit_obs_scene(&file, &small_leaves, NULL, NULL);
    }
    occ_scene_destroy(scene);
    end_edits(&e);
    obs_free(&file);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("backends_edits");
    TCase *edits = tcase_create("edits");
    tcase_add_checked_fixture(edits, gather, dismiss);
    tcase_add_test(edits, edits_reach_every_backend);
    tcase_add_test(edits, a_commit_that_fails_half_way_loses_no_change);
    tcase_add_test(edits, a_view_that_changes_between_scenes_sees_the_one_it_is_given);
    suite_add_tcase(suite, edits);
    return test_run_suite(suite);
}
