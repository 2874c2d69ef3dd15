// SPDX-License-Identifier: Apache-2.0
// labels: unit property
// Sheets in whole frames: what they hide, on every backend.
#include "kit_crew.h"
#include "kit_sheets.h"
#include "support.h"

#include <stdlib.h>

enum { OBJECTS = 3000, OCCLUDERS = 90, FRAMES = 12 };

static const occ_object nobody = {0, 0};
static kit_crew crew;

static void set_up(void)
{
    kit_crew_gather(&crew);
}

static void tear_down(void)
{
    kit_crew_dismiss(&crew);
}

static occ_scene *make_scene(uint64_t seed, occ_object *objects)
{
    occ_scene *scene;
    ck_assert_int_eq(occ_scene_create(NULL, &scene), OCC_SUCCESS);
    kit_fill(scene, OBJECTS, 0, seed, objects, NULL);
    return scene;
}

static void commit(occ_scene *scene)
{
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_validate(scene), OCC_SUCCESS);
}

static uint32_t hidden_in(occ_view *view)
{
    occ_view_stats stats = kit_stats(view);
    return stats.walk_hidden + stats.test_hidden;
}

// --- a sheet that is a flat box ------------------------------------------------------------------

static occ_scene *scene_of(bool sheets, uint64_t seed)
{
    static occ_object objects[OBJECTS];
    kit_random random = {seed};
    occ_scene *scene = make_scene(seed, objects);
    for (int i = 0; i < OCCLUDERS; i++) {
        occ_box box = kit_flat_box(&random, 90, 30);
        occ_sheet sheet = kit_sheet_of_box(&box);
        occ_object owner = i % 3 ? nobody : objects[kit_below(&random, OBJECTS)];
        if (kit_below(&random, 2)) sheet = kit_sheet_reversed(&sheet);
        occ_result result = sheets ? occ_scene_add_sheet(scene, &sheet, owner, NULL)
                                   : occ_scene_add_occluder(scene, &box, owner, NULL);
        ck_assert_int_eq(result, OCC_SUCCESS);
    }
    commit(scene);
    return scene;
}

START_TEST(sheet_hides_what_the_same_flat_box_hides)
{
    occ_cull_desc knobs = {.method = _i % 2 ? OCC_METHOD_FUSED : OCC_METHOD_SINGLE};
    if (_i < 2) knobs.min_area = 1e-12f;
    uint32_t hidden = 0;
    for (uint64_t seed = 1; seed < 4; seed++) {
        occ_scene *boxes = scene_of(false, seed), *sheets = scene_of(true, seed);
        for (uint32_t f = 0; f < FRAMES; f++) {
            occ_camera_desc camera = kit_path(f);
            uint32_t *of_boxes = kit_crew_cull(&crew, boxes, &camera, &knobs);
            hidden += hidden_in(crew.view[0]);
            uint32_t *of_sheets = kit_crew_cull(&crew, sheets, &camera, &knobs);
            ck_assert_msg(kit_same_words(of_boxes, of_sheets, OBJECTS), "seed %u, frame %u",
                          (unsigned)seed, f);
            free(of_boxes);
            free(of_sheets);
        }
        occ_scene_destroy(boxes);
        occ_scene_destroy(sheets);
    }
    ck_assert_uint_gt(hidden, 1000);
}
END_TEST

static TCase *flat_boxes(void)
{
    TCase *tcase = tcase_create("flat_boxes");
    tcase_add_checked_fixture(tcase, set_up, tear_down);
    tcase_add_loop_test(tcase, sheet_hides_what_the_same_flat_box_hides, 0, 4);
    return tcase;
}

int main(void)
{
    Suite *suite = suite_create("sheet_verdicts");
    suite_add_tcase(suite, flat_boxes());
    return test_run_suite(suite);
}
