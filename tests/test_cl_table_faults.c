// SPDX-License-Identifier: Apache-2.0
// labels: opencl
// timeout: 120
// Every OpenCL call under a table may fail: a named error and a reason in the log, nothing held
// afterwards, and the scene as it was.
#include "kit_cl.h"
#include "support.h"

#include <string.h>

enum { OBJECTS = 5000 };

static kit_heap heap;
static kit_log record;
static occ_scene *occluders;
static occ_box boxes[OBJECTS];

static void set_up(void)
{
    kit_random random = steady_seed(3, "tables");
    heap = (kit_heap){0};
    kit_forget(&record);
    kit_cl_reset();
    for (uint32_t i = 0; i < OBJECTS; i++)
        boxes[i] = kit_box(&random, 100.0f, 2.0f);
    ck_assert_int_eq(occ_scene_create(NULL, &occluders), OCC_SUCCESS);
    for (uint32_t i = 0; i < 60; i++) {
        occ_box box = kit_box(&random, 60.0f, 9.0f);
        occ_occluder handle;
        ck_assert_int_eq(occ_scene_add_occluder(occluders, &box, (occ_object){0}, &handle),
                         OCC_SUCCESS);
    }
    ck_assert_int_eq(occ_scene_commit(occluders), OCC_SUCCESS);
}

static void tear_down(void)
{
    ck_assert_int_eq(occ_scene_validate(occluders), OCC_SUCCESS);
    occ_scene_destroy(occluders);
}

static occ_result create(occ_cl_table **table)
{
    occ_cl_table_desc desc = {
        .allocator = kit_allocator(&heap), .logger = kit_logger(&record), .capacity = OBJECTS};
    return occ_cl_table_create(&desc, table);
}

// Everything that a table is asked for, until something fails.
static occ_result use(occ_cl_table *table, bool arrange)
{
    occ_camera_desc camera = kit_path(2);
    occ_cl_frame frame = {
        .occluders = occluders, .camera = &camera, .outputs = OCC_CL_HOST_MASK | OCC_CL_LIST};
    const uint32_t *words;
    size_t count;
    occ_result result =
        arrange ? occ_cl_table_arrange(table, boxes) : occ_cl_table_write(table, 0, OBJECTS, boxes);
    for (int i = 0; i < 4 && !result; i++) { // pinned memory is taken in turns
        cl_event event;
        result = occ_cl_table_cull(table, &frame, i ? NULL : &event);
        if (!result && !i) (void)clReleaseEvent(event);
    }
    return result ? result : occ_cl_table_map_mask(table, &words, &count);
}

// What fails with nothing left to do about it.
static bool is_harmless(const char *call)
{
    return strncmp(call, "clRelease", 9) == 0 || strcmp(call, "clFinish") == 0 ||
           strcmp(call, "clEnqueueUnmapMemObject") == 0 ||
           strcmp(call, "clGetEventProfilingInfo") == 0;
}

static void check_failure(occ_result result)
{
    const char *call = kit_cl_state.failed;
    // Without a type of device the search goes on.
    if (!result && (is_harmless(call) || strcmp(call, "clGetDeviceIDs") == 0)) return;
    KIT_CHECK(result == OCC_ERROR_DEVICE || result == OCC_ERROR_OUT_OF_MEMORY ||
                  result == OCC_ERROR_KERNEL_BUILD || result == OCC_ERROR_NO_DEVICE,
              "%s: %s", call, occ_result_name(result));
    KIT_CHECK(record.errors > 0, "%s: nothing was logged", call);
}

// Makes a table and uses it while call n fails. Whether there was such a call.
static bool try_call(uint64_t n, cl_int code, bool arrange)
{
    occ_cl_table *table;
    kit_cl_reset();
    kit_forget(&record);
    kit_cl_state.fail_at = n;
    kit_cl_state.code = code;
    occ_result result = create(&table);
    if (!result) result = use(table, arrange);
    bool failed = kit_cl_state.failures > 0;
    if (failed) {
        check_failure(result);
    } else {
        ck_assert_int_eq(result, OCC_SUCCESS);
    }
    occ_cl_table_destroy(table);
    KIT_CHECK(kit_cl_state.live == 0, "call %u, %s: %d are held", (unsigned)n,
              failed ? kit_cl_state.failed : "none", (int)kit_cl_state.live);
    ck_assert_uint_eq(heap.blocks, 0);
    return failed;
}

START_TEST(failed_call_is_reported_and_leaves_nothing_behind)
{
    static const cl_int codes[] = {CL_OUT_OF_RESOURCES, CL_DEVICE_NOT_AVAILABLE};
    uint64_t n = 1;
    while (try_call(n, codes[n % 2], false))
        n++;
    ck_assert_uint_gt(n, 60);
}
END_TEST

START_TEST(failed_call_while_a_table_is_arranged_is_reported)
{
    occ_cl_table *table;
    kit_cl_reset();
    ck_assert_int_eq(create(&table), OCC_SUCCESS);
    uint64_t n = kit_cl_state.calls + 1, last = n + 30; // the rest is as above
    occ_cl_table_destroy(table);
    for (; n < last; n++)
        ck_assert(try_call(n, CL_OUT_OF_RESOURCES, true));
}
END_TEST

START_TEST(kernel_that_does_not_compile_is_reported)
{
    occ_cl_table *table;
    kit_cl_state.broken_kernels = true;
    ck_assert_int_eq(create(&table), OCC_ERROR_KERNEL_BUILD);
    ck_assert(kit_logged(&record, "broken.cl"));
    ck_assert_int_eq(kit_cl_state.live, 0);
}
END_TEST

START_TEST(device_whose_groups_are_too_small_is_refused)
{
    occ_cl_table *table;
    kit_cl_state.group = 32;
    ck_assert_int_eq(create(&table), OCC_ERROR_UNSUPPORTED);
    ck_assert_int_eq(kit_cl_state.live, 0);
}
END_TEST

START_TEST(table_larger_than_the_largest_buffer_is_cut_up)
{
    occ_cl_table *table;
    kit_cl_state.largest = 4096 * sizeof(occ_box);
    ck_assert_int_eq(create(&table), OCC_SUCCESS);
    ck_assert_uint_eq(occ_cl_table_parts(table), 2);
    ck_assert_int_eq(use(table, false), OCC_SUCCESS);
    const uint32_t *words;
    size_t count;
    uint32_t mask[OCC_MASK_WORDS(OBJECTS)];
    ck_assert_int_eq(occ_cl_table_map_mask(table, &words, &count), OCC_SUCCESS);
    memcpy(mask, words, sizeof mask);
    occ_cl_table_destroy(table);
    kit_cl_state.largest = 0;
    ck_assert_int_eq(create(&table), OCC_SUCCESS);
    ck_assert_uint_eq(occ_cl_table_parts(table), 1);
    ck_assert_int_eq(use(table, false), OCC_SUCCESS);
    ck_assert_int_eq(occ_cl_table_map_mask(table, &words, &count), OCC_SUCCESS);
    ck_assert(memcmp(mask, words, sizeof mask) == 0);
    occ_cl_table_destroy(table);
    kit_cl_state.largest = 4095 * sizeof(occ_box);
    kit_forget(&record);
    ck_assert_int_eq(create(&table), OCC_ERROR_OUT_OF_MEMORY);
    ck_assert(kit_logged(&record, "largest buffer"));
    ck_assert_int_eq(kit_cl_state.live, 0);
}
END_TEST

START_TEST(failed_allocation_leaves_nothing_behind)
{
    bool failed = true;
    for (uint64_t n = 1; failed; n++) {
        occ_cl_table *table;
        heap.calls = heap.failures = 0;
        heap.fail_at = n;
        occ_result result = create(&table);
        if (!result) result = use(table, _i);
        failed = heap.failures > 0;
        // Only the list of events, and the compiler's log, are allocated for nothing in particular.
        KIT_CHECK(result == (failed ? OCC_ERROR_OUT_OF_MEMORY : OCC_SUCCESS), "%s",
                  occ_result_name(result));
        occ_cl_table_destroy(table);
        ck_assert_int_eq(kit_cl_state.live, 0);
        ck_assert_uint_eq(heap.blocks, 0);
    }
}
END_TEST

int main(void)
{
    int skipped = test_skip_without_device();
    if (skipped) return skipped;
    Suite *suite = suite_create("cl_table_faults");
    TCase *calls = tcase_create("calls");
    tcase_add_checked_fixture(calls, set_up, tear_down);
    tcase_add_test(calls, failed_call_is_reported_and_leaves_nothing_behind);
    tcase_add_test(calls, failed_call_while_a_table_is_arranged_is_reported);
    tcase_add_test(calls, kernel_that_does_not_compile_is_reported);
    tcase_add_test(calls, device_whose_groups_are_too_small_is_refused);
    tcase_add_test(calls, table_larger_than_the_largest_buffer_is_cut_up);
    tcase_add_loop_test(calls, failed_allocation_leaves_nothing_behind, 0, 2);
    suite_add_tcase(suite, calls);
    return test_run_suite(suite);
}
