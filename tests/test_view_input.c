// SPDX-License-Identifier: Apache-2.0
// Bad input to views and culls: refused by name, with a reason in the log and no result.
#include "kit.h"
#include "support.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { OBJECTS = 100 };

static occ_scene *scene;
static occ_view *view;
static kit_log record;
static occ_object objects[OBJECTS];
static occ_occluder occluders[OBJECTS];

static void set_up(void)
{
    kit_forget(&record);
    occ_view_desc desc = {.logger = kit_logger(&record)};
    ck_assert_int_eq(occ_view_create(&desc, &view), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_create(NULL, &scene), OCC_SUCCESS);
    kit_fill(scene, OBJECTS, 1, 31, objects, occluders);
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
}

static void tear_down(void)
{
    occ_view_destroy(view);
    occ_scene_destroy(scene);
}

static void check_refused(const occ_camera_desc *camera, const occ_cull_desc *knobs,
                          occ_result expected, const char *reason)
{
    kit_forget(&record);
    occ_result result = occ_cull(view, scene, camera, knobs);
    KIT_CHECK(result == expected, "%s is %s", occ_result_name(expected), occ_result_name(result));
    KIT_CHECK(record.errors == 1 && kit_logged(&record, occ_result_name(expected)) &&
                  kit_logged(&record, reason),
              "the log says \"%s\"", record.text);
}

static void check_accepted(const occ_camera_desc *camera, const occ_cull_desc *knobs)
{
    kit_cull(view, scene, camera, knobs);
    ck_assert_uint_eq(record.errors, 0);
}

// --- cameras -------------------------------------------------------------------------------------

static const float not_finite[] = {NAN, INFINITY, -INFINITY};

START_TEST(matrix_that_is_not_finite_is_refused)
{
    for (int k = 0; k < 16; k++) {
        occ_camera_desc camera = kit_path(0);
        camera.view_projection[k] = not_finite[_i];
        check_refused(&camera, NULL, OCC_ERROR_NOT_FINITE, "matrix");
    }
}
END_TEST

START_TEST(eye_or_origin_that_is_not_finite_is_refused)
{
    for (int j = 0; j < 3; j++) {
        double point[3] = {1, 2, 3};
        point[j] = (double)not_finite[_i];
        occ_camera_desc camera = kit_path(0);
        camera.eye = point;
        check_refused(&camera, NULL, OCC_ERROR_NOT_FINITE, "eye");
        camera.eye = NULL;
        camera.origin = point;
        check_refused(&camera, NULL, OCC_ERROR_NOT_FINITE, "origin");
    }
}
END_TEST

START_TEST(eye_or_origin_beyond_the_limit_is_refused)
{
    static const double far[] = {1.1e15, -1.1e15, DBL_MAX};
    for (int k = 0; k < 9; k++) {
        double point[3] = {1, 2, 3};
        point[k % 3] = far[k / 3];
        occ_camera_desc camera = kit_path(0);
        camera.eye = point;
        check_refused(&camera, NULL, OCC_ERROR_OUT_OF_RANGE, "eye");
        camera.eye = NULL;
        camera.origin = point;
        check_refused(&camera, NULL, OCC_ERROR_OUT_OF_RANGE, "origin");
    }
}
END_TEST

START_TEST(matrix_without_an_eye_is_refused)
{
    occ_camera_desc camera = {.depth = OCC_DEPTH_ZERO_TO_ONE};
    check_refused(&camera, NULL, OCC_ERROR_DEGENERATE_CAMERA, "singular");
    camera = kit_path(0);
    for (int c = 0; c < 4; c++)
        camera.view_projection[4 * c] = camera.view_projection[4 * c + 1]; // x is y
    check_refused(&camera, NULL, OCC_ERROR_DEGENERATE_CAMERA, "singular");
    camera = kit_path(0);
    for (int r = 0; r < 4; r++)
        camera.view_projection[8 + r] = 0.0f; // nothing depends on z
    check_refused(&camera, NULL, OCC_ERROR_DEGENERATE_CAMERA, "singular");
}
END_TEST

START_TEST(depth_range_that_does_not_exist_is_refused)
{
    occ_camera_desc camera = kit_path(0);
    camera.depth = (occ_depth)3;
    check_refused(&camera, NULL, OCC_ERROR_INVALID_ARGUMENT, "depth");
    camera.depth = (occ_depth)-1;
    check_refused(&camera, NULL, OCC_ERROR_INVALID_ARGUMENT, "depth");
}
END_TEST

START_TEST(missing_scene_or_camera_is_refused)
{
    occ_camera_desc camera = kit_path(0);
    check_refused(NULL, NULL, OCC_ERROR_INVALID_ARGUMENT, "NULL");
    kit_forget(&record);
    ck_assert_int_eq(occ_cull(view, NULL, &camera, NULL), OCC_ERROR_INVALID_ARGUMENT);
    ck_assert_uint_eq(record.errors, 1);
}
END_TEST

// --- knobs ---------------------------------------------------------------------------------------

START_TEST(method_that_does_not_exist_is_refused)
{
    occ_camera_desc camera = kit_path(0);
    occ_cull_desc knobs = {.method = (occ_method)(OCC_METHOD_SINGLE + 1)};
    check_refused(&camera, &knobs, OCC_ERROR_INVALID_ARGUMENT, "method 4");
    knobs.method = (occ_method)-1;
    check_refused(&camera, &knobs, OCC_ERROR_INVALID_ARGUMENT, "method -1");
}
END_TEST

START_TEST(area_that_is_negative_or_unknown_is_refused)
{
    static const float bad[] = {-1e-30f, -INFINITY, NAN};
    occ_camera_desc camera = kit_path(0);
    for (size_t i = 0; i < 3; i++) {
        occ_cull_desc knobs = {.min_area = bad[i]};
        check_refused(&camera, &knobs, OCC_ERROR_INVALID_ARGUMENT, "min_area");
    }
}
END_TEST

START_TEST(preset_that_does_not_exist_is_refused)
{
    occ_camera_desc camera = kit_path(0);
    occ_cull_desc knobs = {.preset = (occ_preset)(OCC_PRESET_THOROUGH + 1)};
    check_refused(&camera, &knobs, OCC_ERROR_INVALID_ARGUMENT, "preset 3");
    knobs.preset = (occ_preset)-1;
    check_refused(&camera, &knobs, OCC_ERROR_INVALID_ARGUMENT, "preset -1");
}
END_TEST

START_TEST(tolerance_that_is_negative_too_large_or_unknown_is_refused)
{
    static const float bad[] = {-1e-30f, -INFINITY, NAN, INFINITY, 0.1000001f, 1};
    occ_camera_desc camera = kit_path(0);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        occ_cull_desc knobs = {.tolerance = bad[i]};
        check_refused(&camera, &knobs, OCC_ERROR_INVALID_ARGUMENT, "tolerance");
    }
}
END_TEST

START_TEST(extreme_knobs_are_accepted)
{
    static const occ_cull_desc extreme[] = {{.min_area = 1e-30f, .grain = 1, .max_occluders = 1},
                                            {.min_area = 0x1p-149f, .max_occluders = UINT32_MAX},
                                            {.min_area = INFINITY, .grain = UINT32_MAX},
                                            {.min_area = FLT_MAX},
                                            {.tolerance = OCC_MAX_TOLERANCE},
                                            {.tolerance = 0x1p-149f, .max_splits = UINT32_MAX},
                                            {.tolerance = -0.0f, .max_splits = 1},
                                            {.min_area = -0.0f}};
    occ_camera_desc camera = kit_path(0);
    for (size_t i = 0; i < sizeof extreme / sizeof *extreme; i++)
        check_accepted(&camera, &extreme[i]);
}
END_TEST

// --- scenes with edits ---------------------------------------------------------------------------

static occ_result edit(int kind)
{
    occ_box box = kit_cube(1, 2, 3, 1), same;
    occ_object object;
    ck_assert_int_eq(occ_scene_box(scene, objects[2], &same), OCC_SUCCESS);
    switch (kind) {
    case 0:
        return occ_scene_add(scene, &box, &object);
    case 1:
        return occ_scene_move(scene, objects[1], &box);
    case 2:
        return occ_scene_move(scene, objects[2], &same); // even if nothing comes of it
    case 3:
        return occ_scene_remove(scene, objects[3]);
    case 4:
        return occ_scene_add_occluder(scene, &box, objects[0], NULL);
    case 5:
        return occ_scene_move_occluder(scene, occluders[0], &box);
    default:
        return occ_scene_remove_occluder(scene, occluders[5]);
    }
}

START_TEST(scene_with_edits_is_refused_until_it_is_committed)
{
    occ_camera_desc camera = kit_path(0);
    check_accepted(&camera, NULL);
    ck_assert_int_eq(edit(_i), OCC_SUCCESS);
    check_refused(&camera, NULL, OCC_ERROR_NOT_COMMITTED, "occ_scene_commit()");
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
    kit_forget(&record);
    check_accepted(&camera, NULL);
}
END_TEST

START_TEST(fresh_scene_needs_no_commit)
{
    occ_scene *empty;
    occ_camera_desc camera = kit_path(0);
    ck_assert_int_eq(occ_scene_create(NULL, &empty), OCC_SUCCESS);
    kit_cull(view, empty, &camera, NULL);
    occ_view_stats stats;
    ck_assert_int_eq(occ_view_get_stats(view, &stats), OCC_SUCCESS);
    ck_assert_uint_eq(stats.objects + stats.visible, 0);
    size_t count = 7;
    ck_assert_int_eq(occ_view_read_mask(view, NULL, 0, &count), OCC_SUCCESS);
    ck_assert_uint_eq(count, 0);
    ck_assert_int_eq(occ_view_read_visible(view, NULL, 0, &count), OCC_SUCCESS);
    occ_scene_destroy(empty);
}
END_TEST

// --- making views --------------------------------------------------------------------------------

static void check_no_view(const occ_view_desc *desc, occ_result expected, const char *reason)
{
    occ_view *made = view;
    kit_forget(&record);
    occ_result result = occ_view_create(desc, &made);
    ck_assert_str_eq(occ_result_name(result), occ_result_name(expected));
    ck_assert_ptr_null(made);
    ck_assert_uint_ge(record.errors, 1);
    KIT_CHECK(kit_logged(&record, reason), "the log says \"%s\"", record.text);
}

START_TEST(backend_that_does_not_exist_is_refused)
{
    occ_view_desc desc = {.logger = kit_logger(&record), .backend = (occ_backend)3};
    check_no_view(&desc, OCC_ERROR_INVALID_ARGUMENT, "backend 3");
    desc.backend = (occ_backend)-1;
    check_no_view(&desc, OCC_ERROR_INVALID_ARGUMENT, "backend -1");
}
END_TEST

START_TEST(too_many_threads_are_refused)
{
    occ_view *made;
    occ_view_desc desc = {.logger = kit_logger(&record), .threads = 1025};
    check_no_view(&desc, OCC_ERROR_INVALID_ARGUMENT, "1025 threads, at most 1024");
    desc.threads = 1024;
    ck_assert_int_eq(occ_view_create(&desc, &made), OCC_SUCCESS);
    occ_view_destroy(made);
}
END_TEST

START_TEST(allocator_with_one_function_is_refused)
{
    kit_heap heap = {0};
    occ_view_desc desc = {.logger = kit_logger(&record), .allocator = kit_allocator(&heap)};
    desc.allocator.free = NULL;
    check_no_view(&desc, OCC_ERROR_INVALID_ARGUMENT, "both of its functions");
    desc.allocator = kit_allocator(&heap);
    desc.allocator.alloc = NULL;
    check_no_view(&desc, OCC_ERROR_INVALID_ARGUMENT, "both of its functions");
    ck_assert_uint_eq(heap.calls, 0);
}
END_TEST

START_TEST(log_says_which_backend_was_chosen)
{
    static const struct {
        occ_backend backend;
        const char *line;
    } chosen[] = {{OCC_BACKEND_OPENMP, "view: backend openmp, "},
                  {OCC_BACKEND_PLAIN, "view: backend plain, "}};
    for (size_t i = 0; i < 2; i++) {
        occ_view *made;
        occ_view_desc desc = {.logger = kit_logger(&record), .backend = chosen[i].backend};
        kit_forget(&record);
        ck_assert_int_eq(occ_view_create(&desc, &made), OCC_SUCCESS);
        ck_assert(kit_logged(&record, chosen[i].line) && kit_logged(&record, " lanes"));
        ck_assert_uint_eq(record.errors, 0);
        occ_view_destroy(made);
    }
}
END_TEST

static TCase *with_fixture(TCase *group)
{
    tcase_add_checked_fixture(group, set_up, tear_down);
    return group;
}

int main(void)
{
    Suite *suite = suite_create("view_input");
    TCase *cameras = with_fixture(tcase_create("cameras"));
    tcase_add_loop_test(cameras, matrix_that_is_not_finite_is_refused, 0, 3);
    tcase_add_loop_test(cameras, eye_or_origin_that_is_not_finite_is_refused, 0, 3);
    tcase_add_test(cameras, eye_or_origin_beyond_the_limit_is_refused);
    tcase_add_test(cameras, matrix_without_an_eye_is_refused);
    tcase_add_test(cameras, depth_range_that_does_not_exist_is_refused);
    tcase_add_test(cameras, missing_scene_or_camera_is_refused);
    suite_add_tcase(suite, cameras);
    TCase *knobs = with_fixture(tcase_create("knobs"));
    tcase_add_test(knobs, method_that_does_not_exist_is_refused);
    tcase_add_test(knobs, area_that_is_negative_or_unknown_is_refused);
    tcase_add_test(knobs, preset_that_does_not_exist_is_refused);
    tcase_add_test(knobs, tolerance_that_is_negative_too_large_or_unknown_is_refused);
    tcase_add_test(knobs, extreme_knobs_are_accepted);
    suite_add_tcase(suite, knobs);
    TCase *edits = with_fixture(tcase_create("edits"));
    tcase_add_loop_test(edits, scene_with_edits_is_refused_until_it_is_committed, 0, 7);
    tcase_add_test(edits, fresh_scene_needs_no_commit);
    suite_add_tcase(suite, edits);
    TCase *views = with_fixture(tcase_create("views"));
    tcase_add_test(views, backend_that_does_not_exist_is_refused);
    tcase_add_test(views, too_many_threads_are_refused);
    tcase_add_test(views, allocator_with_one_function_is_refused);
    tcase_add_test(views, log_says_which_backend_was_chosen);
    suite_add_tcase(suite, views);
    return test_run_suite(suite);
}
