// SPDX-License-Identifier: Apache-2.0
// labels: unit opencl
// oclgrind: yes
// timeout: 120
// Tables on a device: their masks are plain C's, bit for bit, however the rows are cut up; and what
// they leave on the device says the same.
#include "kit_flat.h"
#include "kit_obs.h"
#include "obs.h"
#include "scenes.h"
#include "support.h"

#include <occlude/opencl.h>

#include <stdlib.h>
#include <string.h>

// A scene's occluders without its objects, and whose they are.
typedef struct table_scene {
    obs_scene file;
    occ_scene *occluders;
    uint32_t *owners;
} table_scene;

static table_scene make_crowd(const char *name, uint32_t count)
{
    table_scene made;
    ck_assert(scenes_make(name, count, 2, &made.file));
    uint32_t occluders = made.file.occluder_count;
    made.owners = calloc(occluders + 1, sizeof *made.owners);
    ck_assert_ptr_nonnull(made.owners);
    ck_assert_int_eq(occ_scene_create(NULL, &made.occluders), OCC_SUCCESS);
    for (uint32_t i = 0; i < occluders; i++) {
        occ_occluder handle;
        made.owners[i] = made.file.occluders[i].owner;
        ck_assert_int_eq(occ_scene_add_occluder(made.occluders, &made.file.occluders[i].box,
                                                (occ_object){0}, &handle),
                         OCC_SUCCESS);
    }
    ck_assert_int_eq(occ_scene_commit(made.occluders), OCC_SUCCESS);
    return made;
}

static void free_crowd(table_scene *crowd)
{
    occ_scene_destroy(crowd->occluders);
    free(crowd->owners);
    obs_free(&crowd->file);
}

// PoCL 3.1 takes minutes to compile kernels with as many barriers as the wide ones have.
static occ_cl_shape shape_of(int i)
{
    cl_platform_id platform;
    char name[64] = "";
    ck_assert_int_eq(clGetPlatformIDs(1, &platform, NULL), CL_SUCCESS);
    (void)clGetPlatformInfo(platform, CL_PLATFORM_NAME, sizeof name - 1, name, NULL);
    if (strcmp(name, "Portable Computing Language") == 0) return OCC_CL_SHAPE_AUTO;
    return i % 2 ? OCC_CL_SHAPE_WIDE : OCC_CL_SHAPE_NARROW;
}

static occ_cl_table *make_table(uint32_t capacity, occ_cl_shape shape)
{
    occ_cl_table *table = NULL;
    occ_cl_table_desc desc = {.capacity = capacity, .shape = shape};
    occ_result result = occ_cl_table_create(&desc, &table);
    ck_assert_msg(result == OCC_SUCCESS, "%s", occ_result_name(result));
    return table;
}

// One frame on the device against the same in plain C.
static kit_flat_counts compare(occ_cl_table *table, const kit_flat *rows, const table_scene *crowd,
                               const occ_camera_desc *camera, const occ_cull_desc *knobs)
{
    occ_cl_frame frame = {.occluders = crowd->occluders,
                          .owners = crowd->owners,
                          .camera = camera,
                          .knobs = knobs,
                          .outputs = OCC_CL_HOST_MASK};
    const uint32_t *words;
    size_t count;
    kit_flat_counts counts;
    ck_assert_int_eq(occ_cl_table_cull(table, &frame, NULL), OCC_SUCCESS);
    ck_assert_int_eq(occ_cl_table_map_mask(table, &words, &count), OCC_SUCCESS);
    uint32_t *expected =
        kit_flat_mask(rows, crowd->occluders, crowd->owners, camera, knobs, &counts);
    ck_assert_uint_eq(count, OCC_MASK_WORDS(rows->count));
    for (size_t w = 0; w < count; w++)
        KIT_CHECK(words[w] == expected[w], "word %zu is %08x, plain C's %08x", w, words[w],
                  expected[w]);
    free(expected);
    return counts;
}

// --- masks ---------------------------------------------------------------------------------------

static const occ_cull_desc methods[] = {{.method = OCC_METHOD_FUSED},
                                        {.method = OCC_METHOD_SINGLE},
                                        {.method = OCC_METHOD_FRUSTUM},
                                        {.method = OCC_METHOD_FUSED, .min_area = 1e-5f},
                                        {.method = OCC_METHOD_FUSED, .max_occluders = 9}};
enum { METHODS = sizeof methods / sizeof *methods };

static void compare_path(occ_cl_table *table, const kit_flat *rows, const table_scene *crowd,
                         kit_flat_counts *sum)
{
    for (uint32_t f = 0; f < crowd->file.frame_count; f += 20) {
        double eye[3];
        occ_camera_desc camera = kit_obs_camera(&crowd->file.frames[f], eye);
        for (int m = 0; m < METHODS; m++) {
            kit_flat_counts counts = compare(table, rows, crowd, &camera, &methods[m]);
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
    table_scene crowd = make_crowd(scenes_kinds[_i / 2].name, counts[_i / 2]);
    uint32_t count = crowd.file.object_count;
    kit_flat rows = {.boxes = crowd.file.objects, .count = count};
    kit_flat_counts sum = {0};
    occ_cl_table *table = make_table(count, shape_of(_i));
    ck_assert_int_eq(occ_cl_table_write(table, 0, count, rows.boxes), OCC_SUCCESS);
    compare_path(table, &rows, &crowd, &sum);
    ck_assert_uint_gt(sum.visible, 0);
    ck_assert_uint_gt(sum.hidden, 0);
    occ_cl_table_destroy(table);
    free_crowd(&crowd);
}
END_TEST

START_TEST(arranged_table_keeps_its_slots)
{
    table_scene crowd = make_crowd(_i / 2 ? "forest" : "city", 700);
    uint32_t count = crowd.file.object_count;
    uint32_t *order = kit_flat_order(crowd.file.objects, count);
    kit_flat rows = {.boxes = crowd.file.objects, .count = count, .slot_of = order};
    kit_flat_counts sum = {0};
    occ_cl_table *table = make_table(count, shape_of(_i));
    ck_assert_int_eq(occ_cl_table_arrange(table, rows.boxes), OCC_SUCCESS);
    compare_path(table, &rows, &crowd, &sum);
    ck_assert_uint_gt(sum.unresolved, 0);
    occ_cl_table_destroy(table);
    free(order);
    free_crowd(&crowd);
}
END_TEST

START_TEST(every_size_of_the_last_block_is_tested_whole)
{
    static const uint32_t counts[] = {1, 31, 32, 33, 63, 64, 65, 129, 4095, 4096, 4097};
    table_scene crowd = make_crowd("seedscene", 4097);
    double eye[3];
    occ_camera_desc camera = kit_obs_camera(&crowd.file.frames[0], eye);
    kit_flat rows = {.boxes = crowd.file.objects, .count = counts[_i]};
    occ_cl_table *table = make_table(rows.count, shape_of(_i));
    ck_assert_int_eq(occ_cl_table_write(table, 0, rows.count, rows.boxes), OCC_SUCCESS);
    (void)compare(table, &rows, &crowd, &camera, NULL);
    occ_cl_table_destroy(table);
    free_crowd(&crowd);
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
    suite_add_tcase(suite, masks);
    return test_run_suite(suite);
}
