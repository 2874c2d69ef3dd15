// SPDX-License-Identifier: Apache-2.0
// labels: unit opencl
// timeout: 120
// Tables on a device: their masks are plain C's, bit for bit, however the rows are cut up; and what
// they leave on the device says the same.
#include "kit_obs.h"
#include "kit_table.h"
#include "obs.h"
#include "scenes.h"
#include "support.h"

#include <stdlib.h>
#include <string.h>

// --- masks ---------------------------------------------------------------------------------------

static const occ_cull_desc methods[] = {{.method = OCC_METHOD_FUSED},
                                        {.method = OCC_METHOD_SINGLE},
                                        {.method = OCC_METHOD_FRUSTUM},
                                        {.method = OCC_METHOD_FUSED, .min_area = 1e-5f},
                                        {.method = OCC_METHOD_FUSED, .max_occluders = 9}};
enum { METHODS = sizeof methods / sizeof *methods };

static void compare_path(occ_cl_table *table, const kit_flat *rows, const kit_crowd *crowd,
                         kit_flat_counts *sum)
{
    for (uint32_t f = 0; f < crowd->file.frame_count; f += 20) {
        double eye[3];
        occ_camera_desc camera = kit_obs_camera(&crowd->file.frames[f], eye);
        for (int m = 0; m < METHODS; m++) {
            kit_flat_counts counts = kit_table_compare(table, rows, crowd, &camera, &methods[m]);
            sum->visible += counts.visible;
            sum->hidden += counts.hidden;
            sum->unresolved += counts.unresolved;
            sum->blocks_dropped += counts.blocks_dropped;
        }
    }
}

START_TEST(mask_is_plain_cs_on_every_named_scene)
{
    static const uint32_t counts[] = {300, 700, 500, 300, 200};
    kit_crowd crowd = kit_make_crowd(scenes_kinds[_i / 2].name, counts[_i / 2]);
    uint32_t count = crowd.file.object_count;
    kit_flat rows = {.boxes = crowd.file.objects, .count = count};
    kit_flat_counts sum = {0};
    // Other owners than those that stand around their occluders: some would be hidden by their own.
    for (uint32_t i = 0; _i % 2 && i < crowd.file.occluder_count; i++)
        crowd.owners[i] = (crowd.owners[i] + 3 + i % 9) % count;
    occ_cl_table *table = kit_make_table(count, kit_shape(_i));
    ck_assert_int_eq(occ_cl_table_write(table, 0, count, rows.boxes), OCC_SUCCESS);
    compare_path(table, &rows, &crowd, &sum);
    ck_assert_uint_gt(sum.visible, 0);
    ck_assert_uint_gt(sum.hidden, 0);
    occ_cl_table_destroy(table);
    kit_free_crowd(&crowd);
}
END_TEST

START_TEST(arranged_table_keeps_its_slots)
{
    kit_crowd crowd = kit_make_crowd(_i / 2 ? "forest" : "city", 700);
    uint32_t count = crowd.file.object_count;
    uint32_t *order = kit_flat_order(crowd.file.objects, count);
    kit_flat rows = {.boxes = crowd.file.objects, .count = count, .slot_of = order};
    kit_flat_counts sum = {0};
    occ_cl_table *table = kit_make_table(count, kit_shape(_i));
    ck_assert_int_eq(occ_cl_table_arrange(table, rows.boxes), OCC_SUCCESS);
    compare_path(table, &rows, &crowd, &sum);
    ck_assert_uint_gt(sum.unresolved, 0);
    occ_cl_table_destroy(table);
    free(order);
    kit_free_crowd(&crowd);
}
END_TEST

START_TEST(every_size_of_the_last_block_is_tested_whole)
{
    static const uint32_t counts[] = {1, 31, 32, 33, 63, 64, 65, 129, 4095, 4096, 4097};
    kit_crowd crowd = kit_make_crowd("seedscene", 4097);
    double eye[3];
    occ_camera_desc camera = kit_obs_camera(&crowd.file.frames[0], eye);
    kit_flat rows = {.boxes = crowd.file.objects, .count = counts[_i]};
    occ_cl_table *table = kit_make_table(rows.count, kit_shape(_i));
    ck_assert_int_eq(occ_cl_table_write(table, 0, rows.count, rows.boxes), OCC_SUCCESS);
    (void)kit_table_compare(table, &rows, &crowd, &camera, NULL);
    occ_cl_table_destroy(table);
    kit_free_crowd(&crowd);
}
END_TEST

START_TEST(strips_choose_for_a_device_as_for_plain_c)
{
    kit_crowd crowd = kit_make_crowd("city", 700);
    uint32_t count = crowd.file.object_count;
    kit_flat rows = {.boxes = crowd.file.objects, .count = count, .strips = 4};
    kit_flat_counts sum = {0};
    occ_cl_table *table = NULL;
    occ_cl_table_desc desc = {.capacity = count, .strips = 17};
    ck_assert_int_eq(occ_cl_table_create(&desc, &table), OCC_ERROR_INVALID_ARGUMENT);
    desc.strips = rows.strips;
    ck_assert_int_eq(occ_cl_table_create(&desc, &table), OCC_SUCCESS);
    ck_assert_int_eq(occ_cl_table_write(table, 0, count, rows.boxes), OCC_SUCCESS);
    compare_path(table, &rows, &crowd, &sum);
    ck_assert_uint_gt(sum.hidden, 0);
    occ_cl_table_destroy(table);
    kit_free_crowd(&crowd);
}
END_TEST

// Every word of a hundred thousand objects, on the view's kernel and on the table's.
START_TEST(frustum_masks_of_a_large_scene_are_plain_cs)
{
    kit_crowd crowd = kit_make_crowd("city", 100000);
    uint32_t count = crowd.file.object_count;
    kit_flat rows = {.boxes = crowd.file.objects, .count = count};
    occ_cull_desc knobs = {.method = OCC_METHOD_FRUSTUM};
    occ_scene *scene = kit_obs_scene(&crowd.file, NULL, NULL, NULL);
    occ_view_desc desc = {.backend = OCC_BACKEND_PLAIN};
    occ_view *plain, *device;
    ck_assert_int_eq(occ_view_create(&desc, &plain), OCC_SUCCESS);
    ck_assert_int_eq(occ_cl_view_create(NULL, NULL, &device), OCC_SUCCESS);
    occ_cl_table *table = kit_make_table(count, kit_shape(0));
    ck_assert_int_eq(occ_cl_table_write(table, 0, count, rows.boxes), OCC_SUCCESS);
    for (uint32_t f = 0; f < crowd.file.frame_count; f += 12) {
        double eye[3];
        occ_camera_desc camera = kit_obs_camera(&crowd.file.frames[f], eye);
        kit_flat_counts counts = kit_table_compare(table, &rows, &crowd, &camera, &knobs);
        ck_assert_uint_gt(counts.visible, 1000);
        kit_cull(plain, scene, &camera, &knobs);
        kit_cull(device, scene, &camera, &knobs);
        KIT_CHECK(kit_same_masks(plain, device), "the view's mask of frame %u is another", f);
    }
    occ_cl_table_destroy(table);
    occ_view_destroy(plain);
    occ_view_destroy(device);
    occ_scene_destroy(scene);
    kit_free_crowd(&crowd);
}
END_TEST

// More candidates than a CPU's item keeps side by side, for all objects as one range.
START_TEST(long_lists_of_a_view_are_asked_to_their_end)
{
    obs_scene file;
    ck_assert(scenes_make("interior", 20000, 2, &file));
    occ_scene *scene = kit_obs_scene(&file, NULL, NULL, NULL);
    occ_view_desc desc = {.backend = OCC_BACKEND_PLAIN};
    occ_cl_desc shape = {.shape = _i ? OCC_CL_SHAPE_WIDE : OCC_CL_SHAPE_NARROW};
    occ_cull_desc knobs = {.min_area = 1e-9f, .grain = 1000000};
    occ_view *plain, *device;
    occ_view_stats stats;
    uint32_t longest = 0;
    ck_assert_int_eq(occ_view_create(&desc, &plain), OCC_SUCCESS);
    ck_assert_int_eq(occ_cl_view_create(NULL, &shape, &device), OCC_SUCCESS);
    for (uint32_t f = 0; f < file.frame_count; f += 20) {
        double eye[3];
        occ_camera_desc camera = kit_obs_camera(&file.frames[f], eye);
        kit_cull(plain, scene, &camera, &knobs);
        kit_cull(device, scene, &camera, &knobs);
        KIT_CHECK(kit_same_masks(plain, device), "another mask in frame %u", f);
        ck_assert_int_eq(occ_view_get_stats(device, &stats), OCC_SUCCESS);
        longest = stats.occluders_used > longest ? stats.occluders_used : longest;
    }
    ck_assert_uint_gt(longest, 400);
    occ_view_destroy(plain);
    occ_view_destroy(device);
    occ_scene_destroy(scene);
    obs_free(&file);
}
END_TEST

int main(void)
{
    int skipped = test_skip_without_device();
    if (skipped) return skipped;
    Suite *suite = suite_create("cl_table");
    TCase *masks = tcase_create("masks");
    tcase_add_loop_test(masks, mask_is_plain_cs_on_every_named_scene, 0, 10);
    tcase_add_loop_test(masks, arranged_table_keeps_its_slots, 0, 4);
    tcase_add_loop_test(masks, every_size_of_the_last_block_is_tested_whole, 0, 11);
    tcase_add_test(masks, strips_choose_for_a_device_as_for_plain_c);
    tcase_add_loop_test(masks, long_lists_of_a_view_are_asked_to_their_end, 0, 2);
    tcase_add_test(masks, frustum_masks_of_a_large_scene_are_plain_cs);
    suite_add_tcase(suite, masks);
    return test_run_suite(suite);
}
