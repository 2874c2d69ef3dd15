// SPDX-License-Identifier: Apache-2.0
// labels: opencl
// timeout: 120
// Every OpenCL call may fail, with any code: a named error and a reason in the log, nothing held
// that was not held before, nothing under way, and the next try goes well.
#include "kit_cl.h"
#include "support.h"

#include <occlude/opencl.h>

#include <string.h>

enum { OBJECTS = 1200 };

static const cl_int codes[] = {CL_OUT_OF_RESOURCES, CL_MEM_OBJECT_ALLOCATION_FAILURE,
                               CL_DEVICE_NOT_AVAILABLE, -9999};
enum { CODES = (int)(sizeof codes / sizeof *codes) };

static kit_heap heap;
static kit_log record;
static occ_scene *scene;
static occ_view *reference; // OpenMP's
static occ_object objects[OBJECTS];

static void fill_scene(void)
{
    ck_assert_int_eq(occ_scene_create(NULL, &scene), OCC_SUCCESS);
    kit_fill(scene, OBJECTS, 3, 21, objects, NULL);
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
}

static void set_up(void)
{
    heap = (kit_heap){0};
    kit_forget(&record);
    kit_cl_reset();
    fill_scene();
    occ_view_desc desc = {.backend = OCC_BACKEND_OPENMP, .threads = 2};
    ck_assert_int_eq(occ_view_create(&desc, &reference), OCC_SUCCESS);
}

static void tear_down(void)
{
    occ_view_destroy(reference);
    occ_scene_destroy(scene);
    ck_assert_int_eq(kit_cl_state.live, 0);
    ck_assert_uint_eq(heap.blocks, 0);
}

static occ_result create(occ_view **view)
{
    occ_view_desc desc = {.allocator = kit_allocator(&heap),
                          .logger = kit_logger(&record),
                          .backend = OCC_BACKEND_OPENCL};
    return occ_view_create(&desc, view);
}

// A view could not be made: the error is this one, its reason was logged, and nothing is left.
static void check_no_view(occ_result result, occ_result expected, const occ_view *view,
                          const char *reason)
{
    KIT_CHECK(result == expected, "%s is %s", occ_result_name(expected), occ_result_name(result));
    ck_assert_ptr_null(view);
    ck_assert_uint_ge(record.errors, 1);
    KIT_CHECK(kit_logged(&record, occ_result_name(expected)) && kit_logged(&record, reason),
              "the log says \"%s\"", record.text);
    ck_assert_int_eq(kit_cl_state.live, 0);
    ck_assert_uint_eq(heap.blocks, 0);
}

// The view answers as OpenMP does, now that nothing fails.
static void check_works(occ_view *view, uint32_t i)
{
    occ_camera_desc camera = kit_path(i);
    uint64_t calls = kit_cl_state.calls, fail_at = kit_cl_state.fail_at;
    kit_cl_state.fail_at = 0;
    kit_cull(view, scene, &camera, NULL);
    kit_cull(reference, scene, &camera, NULL);
    KIT_CHECK(kit_same_masks(view, reference), "the device's mask is another");
    KIT_CHECK(kit_cl_state.in_flight == 0, "%u commands are under way", kit_cl_state.in_flight);
    kit_cl_state.calls = calls;
    kit_cl_state.fail_at = fail_at;
}

// --- no device -----------------------------------------------------------------------------------

START_TEST(machine_without_opencl_still_culls)
{
    kit_cl_state.no_platform = _i == 0;
    kit_cl_state.zero_platforms = _i == 1;
    kit_cl_state.no_device = _i == 2;
    occ_view *view = reference, *plain;
    occ_result result = create(&view);
    check_no_view(result, OCC_ERROR_NO_DEVICE, view, _i < 2 ? "platform" : "none has a device");
    ck_assert_int_eq(occ_view_create(NULL, &plain), OCC_SUCCESS);
    check_works(plain, 0);
    occ_view_destroy(plain);
}
END_TEST

START_TEST(kernel_that_does_not_compile_is_reported_with_the_compilers_words)
{
    kit_cl_state.broken_kernels = true;
    occ_view *view = reference;
    occ_result result = create(&view);
    check_no_view(result, OCC_ERROR_KERNEL_BUILD, view, "broken.cl");
    ck_assert_uint_ge(record.errors, 2);
    kit_cl_reset();
    ck_assert_int_eq(create(&view), OCC_SUCCESS);
    check_works(view, 1);
    occ_view_destroy(view);
}
END_TEST

START_TEST(device_with_small_work_groups_is_refused)
{
    kit_cl_state.group = 63;
    occ_view *view = reference;
    occ_view_desc desc = {.allocator = kit_allocator(&heap), .logger = kit_logger(&record)};
    occ_cl_desc wide = {.shape = OCC_CL_SHAPE_WIDE};
    occ_result result = occ_cl_view_create(&desc, &wide, &view);
    check_no_view(result, OCC_ERROR_UNSUPPORTED, view, "groups of 63");
    kit_cl_state.group = 64;
    ck_assert_int_eq(occ_cl_view_create(&desc, &wide, &view), OCC_SUCCESS);
    check_works(view, 1);
    occ_view_destroy(view);
}
END_TEST

START_TEST(scene_larger_than_the_largest_buffer_is_out_of_memory)
{
    kit_cl_state.largest = 20000; // of 60 KB of boxes
    occ_view *view;
    ck_assert_int_eq(create(&view), OCC_SUCCESS);
    occ_camera_desc camera = kit_path(2);
    ck_assert_int_eq(occ_cull(view, scene, &camera, NULL), OCC_ERROR_OUT_OF_MEMORY);
    ck_assert(kit_logged(&record, "the device's largest is 20000"));
    ck_assert_int_eq(occ_view_read_mask(view, NULL, 0, NULL), OCC_ERROR_NO_RESULT);
    occ_scene *large = scene; // a smaller scene still fits
    ck_assert_int_eq(occ_scene_create(NULL, &scene), OCC_SUCCESS);
    kit_fill(scene, 100, 10, 3, NULL, NULL);
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
    check_works(view, 2);
    occ_view_destroy(view);
    occ_scene_destroy(large);
}
END_TEST

// --- one call after the other --------------------------------------------------------------------

// What an error of a call amounts to.
static occ_result expected_of(const char *call, cl_int code)
{
    if (strcmp(call, "clBuildProgram") == 0) return OCC_ERROR_KERNEL_BUILD;
    if (strcmp(call, "clGetDeviceIDs") == 0) return OCC_ERROR_NO_DEVICE;
    bool memory = code == CL_OUT_OF_RESOURCES || code == CL_OUT_OF_HOST_MEMORY ||
                  code == CL_MEM_OBJECT_ALLOCATION_FAILURE;
    return memory ? OCC_ERROR_OUT_OF_MEMORY : OCC_ERROR_DEVICE;
}

// Searching for a GPU may fail where any device will do.
static bool may_fail(const char *call)
{
    return strcmp(call, "clGetDeviceIDs") == 0;
}

START_TEST(failed_call_while_a_view_is_made_is_reported)
{
    bool failed = true;
    uint64_t n = 1;
    for (; failed; n++) {
        kit_cl_reset();
        kit_forget(&record);
        kit_cl_state.fail_at = n;
        kit_cl_state.code = codes[_i];
        occ_view *view = reference;
        occ_result result = create(&view);
        failed = kit_cl_state.failures > 0;
        if (failed && result) {
            occ_result expected = expected_of(kit_cl_state.failed, codes[_i]);
            check_no_view(result, expected, view, kit_cl_state.failed);
            continue;
        }
        KIT_CHECK(!failed || may_fail(kit_cl_state.failed), "nobody misses %s",
                  kit_cl_state.failed);
        KIT_CHECK(!result, "%s though no call failed", occ_result_name(result));
        if (!failed) check_works(view, 3);
        occ_view_destroy(view);
    }
    ck_assert_uint_gt(n, 10);
}
END_TEST

// What fails with nothing left to do about it.
static bool is_harmless(const char *call)
{
    return strcmp(call, "clReleaseMemObject") == 0 || strcmp(call, "clFinish") == 0 ||
           strcmp(call, "clEnqueueUnmapMemObject") == 0;
}

// Culls; if a call fails on the way, says so.
static void cull_with_fault_only(occ_view *view, uint32_t i)
{
    occ_camera_desc camera = kit_path(i);
    kit_forget(&record);
    unsigned failures = kit_cl_state.failures;
    occ_result result = occ_cull(view, scene, &camera, NULL);
    KIT_CHECK(kit_cl_state.in_flight == 0, "%u commands are under way after %s",
              kit_cl_state.in_flight, occ_result_name(result));
    if (kit_cl_state.failures > failures && !is_harmless(kit_cl_state.failed)) {
        occ_result expected = expected_of(kit_cl_state.failed, kit_cl_state.code);
        KIT_CHECK(result == expected, "%s: %s", kit_cl_state.failed, occ_result_name(result));
        KIT_CHECK(record.errors && kit_logged(&record, kit_cl_state.failed) &&
                      kit_logged(&record, occ_result_name(expected)),
                  "%s: the log says \"%s\"", kit_cl_state.failed, record.text);
        size_t count;
        ck_assert_int_eq(occ_view_read_mask(view, NULL, 0, &count), OCC_ERROR_NO_RESULT);
    } else {
        KIT_CHECK(!result, "%s though no call failed", occ_result_name(result));
    }
}

// The same, and then goes well.
static void cull_with_fault(occ_view *view, uint32_t i)
{
    cull_with_fault_only(view, i);
    check_works(view, i);
}

static void move_all(float by, uint32_t step)
{
    for (uint32_t i = 0; i < OBJECTS; i += step) {
        occ_box box;
        if (occ_scene_box(scene, objects[i], &box)) continue;
        box.center[1] += by;
        ck_assert_int_eq(occ_scene_move(scene, objects[i], &box), OCC_SUCCESS);
    }
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
}

START_TEST(failed_call_in_a_cull_is_reported_and_the_next_goes_well)
{
    occ_view *view = NULL;
    bool failed = true;
    uint64_t n = 1;
    for (; failed; n++) {
        occ_scene_destroy(scene);
        fill_scene();
        if (!view) ck_assert_int_eq(create(&view), OCC_SUCCESS);
        kit_cl_reset();
        kit_cl_state.fail_at = n;
        kit_cl_state.code = codes[_i];
        cull_with_fault(view, 4); // all boxes travel
        move_all(1e-5f, 400);     // a few rows
        cull_with_fault(view, 5);
        move_all(9.0f, 3); // another order
        cull_with_fault(view, 6);
        failed = kit_cl_state.failures > 0;
        if (n % 9) continue; // the buffers are there from the run before; now and then not
        occ_view_destroy(view);
        view = NULL;
    }
    ck_assert_uint_gt(n, 20);
    occ_view_destroy(view);
}
END_TEST

START_TEST(failure_with_a_larger_scene_does_not_spoil_the_first)
{
    occ_scene *first = scene, *larger;
    ck_assert_int_eq(occ_scene_create(NULL, &larger), OCC_SUCCESS);
    kit_fill(larger, 3 * OBJECTS, 3, 5, NULL, NULL);
    ck_assert_int_eq(occ_scene_commit(larger), OCC_SUCCESS);
    for (uint64_t n = 1; n < 8; n++) { // the calls around the buffer of the boxes
        occ_view *view;
        ck_assert_int_eq(create(&view), OCC_SUCCESS);
        check_works(view, 9); // the boxes of the first are on the device
        kit_cl_reset();
        kit_cl_state.fail_at = n;
        kit_cl_state.code = CL_OUT_OF_RESOURCES;
        scene = larger;
        cull_with_fault_only(view, 9); // their buffer may be gone, or hold half of the others
        scene = first;
        check_works(view, 9);
        ck_assert_uint_eq(kit_cl_state.failures, 1);
        occ_view_destroy(view);
    }
    occ_scene_destroy(larger);
}
END_TEST

START_TEST(view_can_be_destroyed_after_any_failure)
{
    bool failed = true;
    for (uint64_t n = 1; failed; n++) {
        occ_view *view;
        kit_cl_reset();
        ck_assert_int_eq(create(&view), OCC_SUCCESS);
        kit_cl_reset();
        kit_cl_state.fail_at = n;
        kit_cl_state.code = CL_DEVICE_NOT_AVAILABLE;
        occ_camera_desc camera = kit_path(7);
        occ_result result = occ_cull(view, scene, &camera, NULL);
        occ_view_destroy(view); // some of its calls are the n-th, too
        failed = kit_cl_state.failures > 0;
        ck_assert(failed || result == OCC_SUCCESS);
        ck_assert_int_eq(kit_cl_state.live, 0);
        ck_assert_uint_eq(heap.blocks, 0);
    }
}
END_TEST

START_TEST(scene_is_read_only_to_a_failing_device)
{
    occ_view *view;
    ck_assert_int_eq(create(&view), OCC_SUCCESS);
    kit_cl_reset();
    kit_cl_state.fail_at = 1;
    kit_cl_state.code = CL_INVALID_VALUE;
    occ_camera_desc camera = kit_path(8);
    ck_assert_int_eq(occ_cull(view, scene, &camera, NULL), OCC_ERROR_DEVICE);
    ck_assert_int_eq(occ_scene_validate(scene), OCC_SUCCESS);
    check_works(view, 8);
    occ_view_destroy(view);
}
END_TEST

int main(void)
{
    int skipped = test_skip_without_device();
    if (skipped) return skipped;
    Suite *suite = suite_create("cl_faults");
    TCase *device = tcase_create("device");
    tcase_add_checked_fixture(device, set_up, tear_down);
    tcase_add_loop_test(device, machine_without_opencl_still_culls, 0, 3);
    tcase_add_test(device, kernel_that_does_not_compile_is_reported_with_the_compilers_words);
    tcase_add_test(device, device_with_small_work_groups_is_refused);
    tcase_add_test(device, scene_larger_than_the_largest_buffer_is_out_of_memory);
    suite_add_tcase(suite, device);
    TCase *calls = tcase_create("calls");
    tcase_add_checked_fixture(calls, set_up, tear_down);
    tcase_add_loop_test(calls, failed_call_while_a_view_is_made_is_reported, 0, CODES);
    tcase_add_loop_test(calls, failed_call_in_a_cull_is_reported_and_the_next_goes_well, 0, CODES);
    tcase_add_test(calls, failure_with_a_larger_scene_does_not_spoil_the_first);
    tcase_add_test(calls, view_can_be_destroyed_after_any_failure);
    tcase_add_test(calls, scene_is_read_only_to_a_failing_device);
    suite_add_tcase(suite, calls);
    return test_run_suite(suite);
}
