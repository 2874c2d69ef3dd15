// SPDX-License-Identifier: Apache-2.0
// labels: unit property
// What sheets hide, on every backend: what the same flat boxes do, from one side or both; and by
// hand.
#include "kit_sheets.h"
#include "sheet.h"
#include "sheet_stage.h"
#include "support.h"
#include "view_data.h"
#include "worlds.h"

#include <stdlib.h>

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

// --- a sheet that is a flat box ------------------------------------------------------------------

static occ_scene *scene_of(bool sheets, uint64_t seed)
{
    static occ_object objects[OBJECTS];
    kit_random random = {seed};
    occ_scene *scene = stage_scene(seed, objects);
    for (int i = 0; i < OCCLUDERS; i++) {
        occ_box box = kit_flat_box(&random, 90, 30);
        occ_sheet sheet = kit_sheet_of_box(&box);
        occ_object owner = i % 3 ? nobody : objects[kit_below(&random, OBJECTS)];
        if (kit_below(&random, 2)) sheet = kit_sheet_reversed(&sheet);
        occ_result result = sheets ? occ_scene_add_sheet(scene, &sheet, owner, NULL)
                                   : occ_scene_add_occluder(scene, &box, owner, NULL);
        ck_assert_int_eq(result, OCC_SUCCESS);
    }
    stage_commit(scene);
    return scene;
}

START_TEST(sheet_hides_what_the_same_flat_box_hides)
{
    const occ_cull_desc knobs = stage_knobs[_i];
    uint32_t hidden = 0;
    for (uint64_t seed = 1; seed < 4; seed++) {
        occ_scene *boxes = scene_of(false, seed), *sheets = scene_of(true, seed);
        for (uint32_t f = 0; f < FRAMES; f++) {
            occ_camera_desc camera = stage_camera(f);
            uint32_t *of_boxes = kit_crew_cull(&crew, boxes, &camera, &knobs);
            hidden += stage_hidden(crew.view[0]);
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

// --- from one side -------------------------------------------------------------------------------

static bool shows_front(const occ_sheet *sheet, const occ_camera *camera)
{
    double normal[3], side = 0.0;
    occ_sheet_normal(sheet, normal);
    for (int j = 0; j < 3; j++)
        side += normal[j] * (camera->orthographic ? camera->toward[j]
                                                  : camera->eye[j] - (double)sheet->corner[0][j]);
    return side > 0.0;
}

// Sheets of one side hide what those hide of them that show their fronts, and those alone.
START_TEST(sheet_of_one_side_hides_from_its_front_alone)
{
    static occ_object objects[OBJECTS];
    const occ_cull_desc knobs = stage_knobs[_i];
    kit_random random = {23};
    occ_sheet sheets[OCCLUDERS];
    occ_scene *one_sided = stage_scene(4, objects);
    for (int i = 0; i < OCCLUDERS; i++) {
        occ_box box = kit_flat_box(&random, 90, 30);
        sheets[i] = kit_sheet_of_box(&box);
        sheets[i].sides = OCC_SIDES_FRONT;
    }
    ck_assert_int_eq(occ_scene_add_sheets(one_sided, sheets, NULL, OCCLUDERS, NULL), OCC_SUCCESS);
    stage_commit(one_sided);
    uint32_t fronts = 0;
    for (uint32_t f = 0; f < FRAMES; f++) {
        occ_camera_desc camera = stage_camera(f);
        uint32_t *masks[2] = {kit_crew_cull(&crew, one_sided, &camera, &knobs)};
        occ_scene *turned = stage_scene(4, objects);
        for (int i = 0; i < OCCLUDERS; i++) {
            occ_sheet both = sheets[i];
            both.sides = OCC_SIDES_BOTH;
            if (!shows_front(&both, &crew.view[0]->frame.camera)) continue;
            fronts++;
            ck_assert_int_eq(occ_scene_add_sheet(turned, &both, nobody, NULL), OCC_SUCCESS);
        }
        stage_commit(turned);
        masks[1] = kit_crew_cull(&crew, turned, &camera, &knobs);
        ck_assert_msg(kit_same_words(masks[0], masks[1], OBJECTS), "frame %u", f);
        free(masks[0]);
        free(masks[1]);
        occ_scene_destroy(turned);
    }
    ck_assert_uint_gt(fronts, OCCLUDERS * FRAMES / 4);
    ck_assert_uint_lt(fronts, OCCLUDERS * FRAMES * 3 / 4);
    occ_scene_destroy(one_sided);
}
END_TEST

// --- by hand -------------------------------------------------------------------------------------

// Looks along -x from (8, 0, 0) at objects around x = -8, past the plane x = 0.
static bool hides(const occ_sheet *sheet, const occ_box *object, bool own,
                  const occ_cull_desc *knobs)
{
    static const float eye[3] = {8, 0, 0}, target[3] = {0, 0, 0};
    occ_camera_desc camera = kit_look(eye, target);
    occ_scene *scene;
    occ_object handle;
    ck_assert_int_eq(occ_scene_create(NULL, &scene), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_add(scene, object, &handle), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_add_sheet(scene, sheet, own ? handle : nobody, NULL), OCC_SUCCESS);
    stage_commit(scene);
    uint32_t *mask = kit_crew_cull(&crew, scene, &camera, knobs);
    bool hidden = !(mask[0] & 1u);
    ck_assert_uint_eq(stage_hidden(crew.view[0]), hidden);
    free(mask);
    occ_scene_destroy(scene);
    return hidden;
}

// Counterclockwise for the eye.
static const occ_sheet front_triangle = {
    .corner_count = 3, .sides = OCC_SIDES_FRONT, .corner = {{0, -4, -2}, {0, 4, -2}, {0, 0, 5}}};

START_TEST(triangle_hides_what_is_behind_it_and_no_more)
{
    for (int m = 0; m < 2; m++) {
        occ_cull_desc knobs = {.method = m ? OCC_METHOD_FUSED : OCC_METHOD_SINGLE};
        occ_box behind = kit_cube(-8, 0, 1, 1), beside = kit_cube(-8, 5, 6, 1);
        occ_box before = kit_cube(1.5f, 0, 0, 0.25f), touching = kit_cube(-0.25f, 0, 0, 0.25f);
        ck_assert(hides(&front_triangle, &behind, false, &knobs));
        ck_assert(!hides(&front_triangle, &behind, true, &knobs));
        ck_assert(!hides(&front_triangle, &beside, false, &knobs));
        ck_assert(!hides(&front_triangle, &before, false, &knobs));
        ck_assert(!hides(&front_triangle, &touching, false, &knobs));
        occ_sheet back = kit_sheet_reversed(&front_triangle);
        ck_assert(!hides(&back, &behind, false, &knobs));
        back.sides = OCC_SIDES_BOTH;
        ck_assert(hides(&back, &behind, false, &knobs));
    }
}
END_TEST

START_TEST(sheet_without_area_or_seen_edge_on_hides_nothing)
{
    const occ_cull_desc knobs = {.min_area = 1e-30f};
    occ_box speck = kit_cube(-8, 0, 0, 0);
    occ_sheet line = {.corner_count = 4, .corner = {{0, 0, -4}, {0, 0, 4}, {0, 0, 1}, {0, 0, 2}}};
    occ_sheet point = {.corner_count = 3, .corner = {{0}}};
    occ_sheet edge_on = {.corner_count = 3, .corner = {{4, 0, -4}, {-4, 0, -4}, {0, 0, 9}}};
    occ_sheet crossed = {.corner_count = 4,
                         .corner = {{0, -4, -4}, {0, 4, 4}, {0, 4, -4}, {0, -4, 4}}};
    occ_sheet around = {.corner_count = 4,
                        .corner = {{9, -4, -4}, {9, 4, -4}, {-2, 4, 4}, {-2, -4, 4}}};
    ck_assert(!hides(&line, &speck, false, &knobs));
    ck_assert(!hides(&point, &speck, false, &knobs));
    ck_assert(!hides(&edge_on, &speck, false, &knobs));
    ck_assert(!hides(&crossed, &speck, false, &knobs));
    ck_assert(hides(&front_triangle, &speck, false, &knobs));
    ck_assert(
        hides(&around, &speck, false, &knobs)); // it goes on behind the eye, far from its line
}
END_TEST

// A repeated corner is as if it were not there; one that is a float beside it is another.
START_TEST(corners_in_one_place_are_one)
{
    const occ_cull_desc knobs = {.method = OCC_METHOD_FUSED};
    occ_box behind = kit_cube(-8, 0, 1, 1);
    for (uint32_t at = 0; at < 3; at++) {
        occ_sheet twice = {.corner_count = 4, .sides = OCC_SIDES_FRONT};
        for (uint32_t i = 0, from = 0; i < 4; i++) {
            memcpy(twice.corner[i], front_triangle.corner[from], sizeof *twice.corner);
            from += i != at;
        }
        ck_assert(hides(&twice, &behind, false, &knobs));
        twice.corner[at][1] = nextafterf(twice.corner[at][1], 9.0f);
        (void)hides(&twice, &behind, false, &knobs); // may, or may not: no crash, one answer
    }
}
END_TEST

// Its area is 28, seen from 8: 28 / 64 of the squared distance.
START_TEST(smallest_area_is_that_of_the_polygon)
{
    occ_box behind = kit_cube(-8, 0, 1, 1);
    occ_sheet triangle = front_triangle;
    double distance = sqrt(64.0 + 1.0 / 9.0), shown = 28.0 * 8.0 / pow(distance, 3.0);
    occ_cull_desc below = {.min_area = (float)(0.999 * shown)};
    occ_cull_desc above = {.min_area = (float)(1.001 * shown)};
    ck_assert(hides(&triangle, &behind, false, &below));
    ck_assert(!hides(&triangle, &behind, false, &above));
}
END_TEST

static TCase *flat_boxes(void)
{
    TCase *tcase = tcase_create("flat_boxes");
    tcase_add_checked_fixture(tcase, set_up, tear_down);
    tcase_add_loop_test(tcase, sheet_hides_what_the_same_flat_box_hides, 0, KNOBS);
    tcase_add_loop_test(tcase, sheet_of_one_side_hides_from_its_front_alone, 0, KNOBS);
    return tcase;
}

static TCase *by_hand(void)
{
    TCase *tcase = tcase_create("by_hand");
    tcase_add_checked_fixture(tcase, set_up, tear_down);
    tcase_add_test(tcase, triangle_hides_what_is_behind_it_and_no_more);
    tcase_add_test(tcase, sheet_without_area_or_seen_edge_on_hides_nothing);
    tcase_add_test(tcase, corners_in_one_place_are_one);
    tcase_add_test(tcase, smallest_area_is_that_of_the_polygon);
    return tcase;
}

int main(void)
{
    Suite *suite = suite_create("sheet_verdicts");
    suite_add_tcase(suite, flat_boxes());
    suite_add_tcase(suite, by_hand());
    return test_run_suite(suite);
}
