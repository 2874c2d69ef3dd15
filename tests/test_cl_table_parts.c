// SPDX-License-Identifier: Apache-2.0
// labels: unit opencl
// timeout: 120
// Tables over several devices, and what they leave on a device: lists, counts and draws.
#include "kit_table.h"

#include "kit_obs.h"
#include "scenes.h"
#include "support.h"

#include <stdlib.h>
#include <string.h>

enum { DEVICES = 2, COUNT = 70000 }; // more than two groups of blocks, and than a tile of a list

static cl_context context;
static cl_device_id devices[DEVICES];
static cl_command_queue queues[DEVICES];
static kit_crowd crowd;
static uint32_t count;

// Sub-devices, or where the device cannot be parted, the device and a second queue of it.
static void open_devices(void)
{
    cl_platform_id platform;
    cl_device_id whole;
    cl_int error;
    const cl_device_partition_property one_each[] = {CL_DEVICE_PARTITION_EQUALLY, 1, 0};
    ck_assert_int_eq(clGetPlatformIDs(1, &platform, NULL), CL_SUCCESS);
    ck_assert_int_eq(clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &whole, NULL), CL_SUCCESS);
    if (clCreateSubDevices(whole, one_each, DEVICES, devices, NULL) != CL_SUCCESS) {
        devices[0] = devices[1] = whole;
    }
    cl_uint different = devices[0] == devices[1] ? 1 : DEVICES;
    context = clCreateContext(NULL, different, devices, NULL, NULL, &error);
    ck_assert_int_eq(error, CL_SUCCESS);
    for (int i = 0; i < DEVICES; i++) {
        queues[i] = clCreateCommandQueue(context, devices[i], 0, &error);
        ck_assert_int_eq(error, CL_SUCCESS);
    }
}

static void set_up(void)
{
    open_devices();
    crowd = kit_make_crowd("city", COUNT);
    count = crowd.file.object_count;
}

static void tear_down(void)
{
    kit_free_crowd(&crowd);
    for (int i = 0; i < DEVICES; i++)
        (void)clReleaseCommandQueue(queues[i]);
    (void)clReleaseContext(context);
    for (int i = 0; i < DEVICES && devices[0] != devices[1]; i++)
        (void)clReleaseDevice(devices[i]);
}

static occ_cl_table *make_table(uint32_t queue_count)
{
    occ_cl_table *table;
    occ_cl_table_desc desc = {.capacity = count, .queues = queues, .queue_count = queue_count};
    ck_assert_int_eq(occ_cl_table_create(&desc, &table), OCC_SUCCESS);
    return table;
}

static occ_camera_desc camera_of(uint32_t frame, double eye[3])
{
    return kit_obs_camera(&crowd.file.frames[frame], eye);
}

// --- several devices -----------------------------------------------------------------------------

START_TEST(rows_on_two_devices_give_the_mask_of_one)
{
    uint32_t *order = _i ? kit_flat_order(crowd.file.objects, count) : NULL;
    kit_flat rows = {.boxes = crowd.file.objects, .count = count, .slot_of = order};
    // A part's groups are the table's: it begins with one.
    occ_cl_table *table = make_table(DEVICES);
    ck_assert_uint_eq(occ_cl_table_parts(table), DEVICES);
    if (_i) {
        ck_assert_int_eq(occ_cl_table_arrange(table, rows.boxes), OCC_SUCCESS);
    } else {
        ck_assert_int_eq(occ_cl_table_write(table, 0, count, rows.boxes), OCC_SUCCESS);
    }
    for (uint32_t f = 0; f < crowd.file.frame_count; f += 15) {
        double eye[3];
        occ_camera_desc camera = camera_of(f, eye);
        (void)kit_table_compare(table, &rows, &crowd, &camera, NULL);
    }
    occ_cl_table_destroy(table);
    free(order);
}
END_TEST

START_TEST(parts_say_which_slots_are_theirs)
{
    occ_cl_table *table = make_table(DEVICES);
    uint32_t next = 0;
    for (uint32_t p = 0; p < occ_cl_table_parts(table); p++) {
        occ_cl_part part;
        ck_assert_int_eq(occ_cl_table_part(table, p, &part), OCC_SUCCESS);
        ck_assert_uint_eq(part.first, next);
        ck_assert_ptr_eq(part.queue, queues[p]);
        ck_assert_ptr_nonnull(part.mask);
        next += part.slots;
    }
    ck_assert_uint_eq(next, count);
    occ_cl_part part;
    ck_assert_int_eq(occ_cl_table_part(table, DEVICES, &part), OCC_ERROR_INVALID_ARGUMENT);
    occ_cl_table_destroy(table);
}
END_TEST

// --- edits ---------------------------------------------------------------------------------------

START_TEST(written_slots_change_and_boxes_that_are_not_finite_are_no_objects)
{
    occ_cl_table *table = make_table(1);
    occ_box *boxes = malloc(count * sizeof *boxes), *staged;
    ck_assert_ptr_nonnull(boxes);
    memcpy(boxes, crowd.file.objects, count * sizeof *boxes);
    kit_flat rows = {.boxes = boxes, .count = count};
    ck_assert_int_eq(occ_cl_table_write(table, 0, count, boxes), OCC_SUCCESS);
    double eye[3];
    occ_camera_desc camera = camera_of(20, eye);
    kit_flat_counts before = kit_table_compare(table, &rows, &crowd, &camera, NULL);
    for (uint32_t i = 100; i < 300; i++)
        boxes[i].center[1] += 200.0f; // above all roofs
    ck_assert_int_eq(occ_cl_table_write(table, 100, 200, boxes + 100), OCC_SUCCESS);
    (void)kit_table_compare(table, &rows, &crowd, &camera, NULL);
    for (uint32_t i = 4000; i < 5000; i++)
        boxes[i].axis[i % 3][i / 3 % 3] = i % 2 ? (float)NAN : -(float)INFINITY;
    ck_assert_int_eq(occ_cl_table_stage(table, 1000, &staged), OCC_SUCCESS);
    memcpy(staged, boxes + 4000, 1000 * sizeof *staged);
    ck_assert_int_eq(occ_cl_table_send(table, 4000, 1000), OCC_SUCCESS);
    kit_flat_counts after = kit_table_compare(table, &rows, &crowd, &camera, NULL);
    ck_assert_uint_lt(after.visible, before.visible + 200);
    ck_assert_int_eq(occ_cl_table_write(table, 4000, 1, boxes + 4000), OCC_ERROR_NOT_FINITE);
    free(boxes);
    occ_cl_table_destroy(table);
}
END_TEST

START_TEST(slots_that_were_never_written_are_not_visible)
{
    occ_cl_table *table = make_table(1);
    double eye[3];
    occ_camera_desc camera = camera_of(0, eye);
    occ_cl_frame frame = {.camera = &camera, .outputs = OCC_CL_HOST_MASK};
    const uint32_t *words;
    size_t size;
    ck_assert_int_eq(occ_cl_table_cull(table, &frame, NULL), OCC_SUCCESS);
    ck_assert_int_eq(occ_cl_table_map_mask(table, &words, &size), OCC_SUCCESS);
    for (size_t w = 0; w < size; w++)
        ck_assert_uint_eq(words[w], 0);
    occ_cl_table_destroy(table);
}
END_TEST

// --- what is left on the device ------------------------------------------------------------------

static void read_words(cl_mem buffer, size_t words, uint32_t *to)
{
    ck_assert_int_eq(
        clEnqueueReadBuffer(queues[0], buffer, CL_TRUE, 0, words * sizeof *to, to, 0, NULL, NULL),
        CL_SUCCESS);
}

START_TEST(list_and_draws_say_what_the_mask_says)
{
    occ_cl_table *table = make_table(1);
    ck_assert_int_eq(occ_cl_table_write(table, 0, count, crowd.file.objects), OCC_SUCCESS);
    uint32_t *draws = malloc(count * 5 * sizeof *draws), *list = calloc(count, sizeof *list);
    ck_assert(draws && list);
    for (uint32_t i = 0; i < 5 * count; i++)
        draws[i] = 1000 + i;
    cl_int error;
    cl_mem memory[2];
    for (int i = 0; i < 2; i++) {
        memory[i] = clCreateBuffer(context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR,
                                   count * 5 * sizeof *draws, draws, &error);
        ck_assert_int_eq(error, CL_SUCCESS);
    }
    double eye[3];
    occ_camera_desc camera = camera_of(30, eye);
    occ_cl_frame frame = {.occluders = crowd.occluders,
                          .camera = &camera,
                          .outputs = OCC_CL_HOST_MASK | OCC_CL_DRAWS | OCC_CL_COMPACT,
                          .draws = memory[0],
                          .compact = memory[1]};
    cl_event done;
    const uint32_t *words;
    size_t size;
    ck_assert_int_eq(occ_cl_table_cull(table, &frame, &done), OCC_SUCCESS);
    ck_assert_int_eq(clWaitForEvents(1, &done), CL_SUCCESS);
    (void)clReleaseEvent(done);
    ck_assert_int_eq(occ_cl_table_map_mask(table, &words, &size), OCC_SUCCESS);
    occ_cl_part part;
    uint32_t visible, at = 0;
    ck_assert_int_eq(occ_cl_table_part(table, 0, &part), OCC_SUCCESS);
    read_words(part.count, 1, &visible);
    ck_assert_uint_gt(visible, 10);
    read_words(part.list, visible, list);
    read_words(memory[0], 5 * count, draws);
    for (uint32_t slot = 0; slot < count; slot++) {
        uint32_t bit = words[slot / 32] >> slot % 32 & 1u;
        KIT_CHECK(draws[5 * slot + 1] == bit, "the draw of slot %u", slot);
        KIT_CHECK(draws[5 * slot] == 1000 + 5 * slot, "another word of slot %u", slot);
        if (bit) KIT_CHECK(at < visible && list[at++] == slot, "slot %u is not listed", slot);
    }
    ck_assert_uint_eq(at, visible);
    read_words(memory[1], 5 * visible, draws);
    for (uint32_t i = 0; i < visible; i++) {
        KIT_CHECK(draws[5 * i] == 1000 + 5 * list[i], "draw %u is another's", i);
        KIT_CHECK(draws[5 * i + 1] == 1, "draw %u has no instance", i);
    }
    for (int i = 0; i < 2; i++)
        (void)clReleaseMemObject(memory[i]);
    free(draws);
    free(list);
    occ_cl_table_destroy(table);
}
END_TEST

START_TEST(wrong_arguments_are_refused)
{
    occ_cl_table *table;
    occ_cl_table_desc desc = {.capacity = 0};
    ck_assert_int_eq(occ_cl_table_create(&desc, &table), OCC_ERROR_INVALID_ARGUMENT);
    ck_assert_ptr_null(table);
    table = make_table(DEVICES);
    double eye[3];
    occ_camera_desc camera = camera_of(0, eye);
    occ_cull_desc pairwise = {.method = OCC_METHOD_PAIRWISE};
    const occ_cl_frame bad[] = {{.camera = NULL},
                                {.camera = &camera, .waits = 1},
                                {.camera = &camera, .outputs = 64},
                                {.camera = &camera, .outputs = OCC_CL_DRAWS}};
    for (unsigned i = 0; i < sizeof bad / sizeof *bad; i++)
        ck_assert_int_eq(occ_cl_table_cull(table, &bad[i], NULL), OCC_ERROR_INVALID_ARGUMENT);
    occ_cl_frame frame = {.camera = &camera, .knobs = &pairwise};
    ck_assert_int_eq(occ_cl_table_cull(table, &frame, NULL), OCC_ERROR_UNSUPPORTED);
    const uint32_t *words;
    size_t size;
    occ_box *staged;
    ck_assert_int_eq(occ_cl_table_map_mask(table, &words, &size), OCC_ERROR_NO_RESULT);
    ck_assert_int_eq(occ_cl_table_stage(table, count + 1, &staged), OCC_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(occ_cl_table_send(table, 0, 1), OCC_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(occ_cl_table_write(table, count, 1, crowd.file.objects),
                     OCC_ERROR_INVALID_ARGUMENT);
    occ_cl_table_destroy(table);
}
END_TEST

int main(void)
{
    int skipped = test_skip_without_device();
    if (skipped) return skipped;
    Suite *suite = suite_create("cl_table_parts");
    TCase *parts = tcase_create("parts");
    tcase_add_checked_fixture(parts, set_up, tear_down);
    tcase_add_loop_test(parts, rows_on_two_devices_give_the_mask_of_one, 0, 2);
    tcase_add_test(parts, parts_say_which_slots_are_theirs);
    tcase_add_test(parts, written_slots_change_and_boxes_that_are_not_finite_are_no_objects);
    tcase_add_test(parts, slots_that_were_never_written_are_not_visible);
    tcase_add_test(parts, list_and_draws_say_what_the_mask_says);
    tcase_add_test(parts, wrong_arguments_are_refused);
    suite_add_tcase(suite, parts);
    return test_run_suite(suite);
}
