// SPDX-License-Identifier: Apache-2.0
// labels: unit opencl
// oclgrind: yes
// A table's kernels on a crowd that is small enough for oclgrind, which interprets them: both
// shapes, all outputs, and rows in another order than their slots. And a view's kernel for CPUs.
#define _POSIX_C_SOURCE 200809L

#include "kit_table.h"

#include "kit_obs.h"
#include "scenes.h"
#include "support.h"

#include <stdlib.h>

START_TEST(small_crowd_is_culled_as_in_plain_c)
{
    kit_crowd crowd = kit_make_crowd("forest", 100);
    uint32_t count = crowd.file.object_count;
    uint32_t *order = _i / 2 ? kit_flat_order(crowd.file.objects, count) : NULL;
    kit_flat rows = {.boxes = crowd.file.objects, .count = count, .slot_of = order};
    occ_cl_table *table = kit_make_table(count, kit_shape(_i));
    occ_cull_desc knobs = {.min_area = 1e-5f};
    if (order) {
        ck_assert_int_eq(occ_cl_table_arrange(table, rows.boxes), OCC_SUCCESS);
    } else {
        ck_assert_int_eq(occ_cl_table_write(table, 0, count, rows.boxes), OCC_SUCCESS);
    }
    uint32_t unresolved = 0;
    for (uint32_t f = 10; f < 60; f += 25) {
        double eye[3];
        occ_camera_desc camera = kit_obs_camera(&crowd.file.frames[f], eye);
        unresolved += kit_table_compare(table, &rows, &crowd, &camera, &knobs).unresolved;
        occ_cl_frame frame = {.camera = &camera, .outputs = OCC_CL_LIST};
        ck_assert_int_eq(occ_cl_table_cull(table, &frame, NULL), OCC_SUCCESS);
    }
    ck_assert_uint_gt(unresolved, 0);
    occ_cl_table_destroy(table);
    free(order);
    kit_free_crowd(&crowd);
}
END_TEST

// And a view's, by ranges.
START_TEST(small_crowd_is_seen_as_in_plain_c)
{
    obs_scene file;
    ck_assert(scenes_make(_i ? "city" : "forest", 80, 2, &file));
    occ_scene *scene = kit_obs_scene(&file, NULL, NULL, NULL);
    occ_view_desc desc = {.backend = OCC_BACKEND_PLAIN};
    occ_cl_desc narrow = {.shape = OCC_CL_SHAPE_NARROW};
    occ_cull_desc knobs = {.min_area = 1e-5f, .grain = 1000};
    occ_view *plain, *device;
    ck_assert_int_eq(occ_view_create(&desc, &plain), OCC_SUCCESS);
    ck_assert_int_eq(occ_cl_view_create(NULL, &narrow, &device), OCC_SUCCESS);
    for (uint32_t f = 10; f < 60; f += 25) {
        double eye[3];
        occ_camera_desc camera = kit_obs_camera(&file.frames[f], eye);
        kit_cull(plain, scene, &camera, &knobs);
        kit_cull(device, scene, &camera, &knobs);
        KIT_CHECK(kit_same_masks(plain, device), "another mask in frame %u", f);
    }
    occ_view_destroy(plain);
    occ_view_destroy(device);
    occ_scene_destroy(scene);
    obs_free(&file);
}
END_TEST

int main(void)
{
    // oclgrind 21.10 takes what one kernel has written for uninitialised in the next.
    (void)unsetenv("OCLGRIND_UNINITIALIZED");
    int skipped = test_skip_without_device();
    if (skipped) return skipped;
    Suite *suite = suite_create("cl_table_small");
    TCase *crowds = tcase_create("crowds");
    tcase_add_loop_test(crowds, small_crowd_is_culled_as_in_plain_c, 0, 4);
    tcase_add_loop_test(crowds, small_crowd_is_seen_as_in_plain_c, 0, 2);
    suite_add_tcase(suite, crowds);
    return test_run_suite(suite);
}
