// SPDX-License-Identifier: Apache-2.0
// timeout: 120
// Every allocation may fail, and after warm-up there is none.
#include "kit_faults.h"
#include "kit_tree.h"
#include "support.h"

START_TEST(failed_allocation_is_reported_and_changes_no_answer)
{
    kit_fail_every_allocation((occ_backend)_i, false, 1);
}
END_TEST

START_TEST(lasting_shortage_is_reported_and_changes_no_answer)
{
    kit_fail_every_allocation((occ_backend)_i, true, 1);
}
END_TEST

START_TEST(frames_after_warm_up_allocate_nothing)
{
    kit_frames_allocate_nothing((occ_backend)_i);
}
END_TEST

// --- by hand -------------------------------------------------------------------------------------

enum { OBJECTS = 150 };

static kit_heap heap;
static kit_log record;
static occ_scene *scene;

static void set_up(void)
{
    heap = (kit_heap){0};
    kit_forget(&record);
    occ_scene_desc desc = {.allocator = kit_allocator(&heap), .logger = kit_logger(&record)};
    ck_assert_int_eq(occ_scene_create(&desc, &scene), OCC_SUCCESS);
    kit_fill(scene, OBJECTS, 2, 1, NULL, NULL);
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
}

static void tear_down(void)
{
    occ_scene_destroy(scene);
    ck_assert_uint_eq(heap.blocks, 0);
}

START_TEST(failed_cull_leaves_no_result)
{
    occ_view *view;
    occ_view_desc desc = {.allocator = kit_allocator(&heap), .logger = kit_logger(&record)};
    ck_assert_int_eq(occ_view_create(&desc, &view), OCC_SUCCESS);
    occ_camera_desc camera = kit_path(0);
    kit_cull(view, scene, &camera, NULL);
    occ_cull_desc all = {.method = OCC_METHOD_PAIRWISE}; // needs more memory than the first
    heap.fail_at = heap.calls + 1;
    ck_assert_int_eq(occ_cull(view, scene, &camera, &all), OCC_ERROR_OUT_OF_MEMORY);
    ck_assert(kit_logged(&record, "OCC_ERROR_OUT_OF_MEMORY: no memory for the scratch of a frame"));
    size_t count = 5;
    occ_view_stats stats;
    ck_assert_int_eq(occ_view_read_mask(view, NULL, 0, &count), OCC_ERROR_NO_RESULT);
    ck_assert_uint_eq(count, 0);
    ck_assert_int_eq(occ_view_get_stats(view, &stats), OCC_ERROR_NO_RESULT);
    occ_view_destroy(view);
}
END_TEST

START_TEST(failed_edit_leaves_the_scene_committed)
{
    occ_box boxes[OBJECTS];
    for (int i = 0; i < OBJECTS; i++)
        boxes[i] = kit_cube(0, 0, 0, 1);
    uint64_t n = 1;
    for (occ_result result = OCC_ERROR_OUT_OF_MEMORY; result; n++) {
        tear_down(); // what an edit reserves before it fails is kept: a fresh scene each time
        set_up();
        heap.fail_at = heap.calls + n;
        result = occ_scene_add_many(scene, boxes, OBJECTS, NULL);
        if (!result) break;
        ck_assert_int_eq(result, OCC_ERROR_OUT_OF_MEMORY);
        ck_assert(kit_logged(&record, "OCC_ERROR_OUT_OF_MEMORY: no room for 150 more objects"));
        kit_check_trees(scene);
    }
    ck_assert_uint_gt(n, 3);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("alloc_faults");
    TCase *faults = tcase_create("faults");
    tcase_add_loop_test(faults, failed_allocation_is_reported_and_changes_no_answer,
                        OCC_BACKEND_OPENMP, OCC_BACKEND_PLAIN + 1);
    tcase_add_loop_test(faults, lasting_shortage_is_reported_and_changes_no_answer,
                        OCC_BACKEND_OPENMP, OCC_BACKEND_PLAIN + 1);
    suite_add_tcase(suite, faults);
    TCase *hand = tcase_create("hand");
    tcase_add_checked_fixture(hand, set_up, tear_down);
    tcase_add_test(hand, failed_cull_leaves_no_result);
    tcase_add_test(hand, failed_edit_leaves_the_scene_committed);
    suite_add_tcase(suite, hand);
    TCase *frames = tcase_create("frames");
    tcase_add_loop_test(frames, frames_after_warm_up_allocate_nothing, OCC_BACKEND_OPENMP,
                        OCC_BACKEND_PLAIN + 1);
    suite_add_tcase(suite, frames);
    return test_run_suite(suite);
}
