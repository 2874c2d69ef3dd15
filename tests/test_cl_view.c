// SPDX-License-Identifier: Apache-2.0
// labels: opencl
// Views on a device, context or queue that the caller chose.
#include "kit_cl.h"
#include "support.h"

static occ_scene *scene;
static occ_view *host;
static kit_log record;
static cl_device_id device;
static cl_context context;
static cl_command_queue queue;

static void set_up(void)
{
    kit_cl_reset();
    kit_forget(&record);
    cl_platform_id platform;
    cl_uint count;
    cl_int error;
    ck_assert_int_eq(clGetPlatformIDs(1, &platform, &count), CL_SUCCESS);
    ck_assert_int_eq(clGetDeviceIDs(platform, CL_DEVICE_TYPE_ALL, 1, &device, &count), CL_SUCCESS);
    context = clCreateContext(NULL, 1, &device, NULL, NULL, &error);
    ck_assert_int_eq(error, CL_SUCCESS);
    queue = clCreateCommandQueue(context, device, 0, &error);
    ck_assert_int_eq(error, CL_SUCCESS);
    ck_assert_int_eq(occ_scene_create(NULL, &scene), OCC_SUCCESS);
    kit_fill(scene, 1000, 5, 5, NULL, NULL);
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
    ck_assert_int_eq(occ_view_create(NULL, &host), OCC_SUCCESS);
}

static void tear_down(void)
{
    occ_view_destroy(host);
    occ_scene_destroy(scene);
    if (queue) clReleaseCommandQueue(queue);
    if (context) clReleaseContext(context);
    ck_assert_int_eq(kit_cl_state.live, 0);
}

static void check_works(occ_view *view)
{
    for (uint32_t i = 0; i < 3; i++) {
        occ_camera_desc camera = kit_path(i);
        kit_cull(view, scene, &camera, NULL);
        kit_cull(host, scene, &camera, NULL);
        ck_assert(kit_same_masks(view, host));
    }
}

static occ_view *make(const occ_cl_desc *desc)
{
    occ_view *view;
    occ_view_desc view_desc = {.logger = kit_logger(&record), .backend = OCC_BACKEND_PLAIN};
    ck_assert_int_eq(occ_cl_view_create(&view_desc, desc, &view), OCC_SUCCESS);
    ck_assert_ptr_eq(occ_cl_view_device(view), device);
    ck_assert(kit_logged(&record, "OpenCL device: "));
    ck_assert(kit_logged(&record, "view: backend opencl"));
    ck_assert_uint_eq(record.errors, 0);
    return view;
}

START_TEST(view_works_on_the_callers_device)
{
    occ_view *view = make(&(occ_cl_desc){.device = device});
    check_works(view);
    occ_view_destroy(view);
}
END_TEST

START_TEST(view_works_in_the_callers_context)
{
    unsigned created = kit_cl_state.created;
    occ_view *view = make(&(occ_cl_desc){.device = device, .context = context});
    ck_assert_uint_eq(kit_cl_state.created, created + 3); // a queue, a program, a kernel
    check_works(view);
    occ_view_destroy(view);
}
END_TEST

START_TEST(view_works_on_the_callers_queue)
{
    unsigned created = kit_cl_state.created;
    occ_view *view = make(&(occ_cl_desc){.queue = queue});
    ck_assert_uint_eq(kit_cl_state.created, created + 2); // a program, a kernel
    check_works(view);
    occ_view_destroy(view);
}
END_TEST

START_TEST(view_outlives_the_callers_references)
{
    occ_view *on_queue = make(&(occ_cl_desc){.queue = queue});
    occ_view *in_context = make(&(occ_cl_desc){.device = device, .context = context});
    ck_assert_int_eq(clReleaseCommandQueue(queue), CL_SUCCESS);
    ck_assert_int_eq(clReleaseContext(context), CL_SUCCESS);
    queue = NULL;
    context = NULL;
    check_works(on_queue);
    check_works(in_context);
    occ_view_destroy(on_queue);
    check_works(in_context);
    occ_view_destroy(in_context);
}
END_TEST

START_TEST(callers_objects_outlive_the_view)
{
    occ_view_destroy(make(&(occ_cl_desc){.queue = queue}));
    cl_uint references = 0;
    ck_assert_int_eq(clGetCommandQueueInfo(queue, CL_QUEUE_REFERENCE_COUNT, sizeof references,
                                           &references, NULL),
                     CL_SUCCESS);
    ck_assert_uint_eq(references, 1);
    occ_view *view = make(&(occ_cl_desc){.queue = queue});
    check_works(view);
    occ_view_destroy(view);
}
END_TEST

START_TEST(context_without_a_device_is_refused)
{
    occ_view *view = host;
    occ_view_desc view_desc = {.logger = kit_logger(&record)};
    int64_t live = kit_cl_state.live;
    ck_assert_int_eq(occ_cl_view_create(&view_desc, &(occ_cl_desc){.context = context}, &view),
                     OCC_ERROR_INVALID_ARGUMENT);
    ck_assert_ptr_null(view);
    ck_assert(kit_logged(&record, "a context without a device"));
    ck_assert_int_eq(kit_cl_state.live, live);
}
END_TEST

START_TEST(failure_leaves_the_callers_objects_alone)
{
    occ_view_desc view_desc = {.logger = kit_logger(&record)};
    int64_t live = kit_cl_state.live;
    bool failed = true;
    uint64_t n = 1;
    for (; failed; n++) {
        occ_view *view = host;
        kit_cl_reset();
        kit_cl_state.fail_at = n;
        kit_cl_state.code = CL_OUT_OF_RESOURCES;
        occ_result result = occ_cl_view_create(&view_desc, &(occ_cl_desc){.queue = queue}, &view);
        failed = result != OCC_SUCCESS;
        ck_assert_uint_eq(kit_cl_state.failures, failed);
        if (!failed) occ_view_destroy(view);
        ck_assert(!failed || !view);
        ck_assert_int_eq(kit_cl_state.live, live);
    }
    ck_assert_uint_gt(n, 8);
}
END_TEST

START_TEST(nothing_need_be_chosen)
{
    occ_view *view;
    ck_assert_int_eq(occ_cl_view_create(NULL, NULL, &view), OCC_SUCCESS);
    ck_assert_ptr_nonnull(occ_cl_view_device(view));
    check_works(view);
    occ_view_destroy(view);
    ck_assert_int_eq(occ_cl_view_create(NULL, NULL, NULL), OCC_ERROR_INVALID_ARGUMENT);
}
END_TEST

START_TEST(view_without_a_device_has_none)
{
    ck_assert_ptr_null(occ_cl_view_device(host));
    ck_assert_ptr_null(occ_cl_view_device(NULL));
}
END_TEST

int main(void)
{
    int skipped = test_skip_without_device();
    if (skipped) return skipped;
    Suite *suite = suite_create("cl_view");
    TCase *own = tcase_create("own");
    tcase_add_checked_fixture(own, set_up, tear_down);
    tcase_add_test(own, view_works_on_the_callers_device);
    tcase_add_test(own, view_works_in_the_callers_context);
    tcase_add_test(own, view_works_on_the_callers_queue);
    tcase_add_test(own, view_outlives_the_callers_references);
    tcase_add_test(own, callers_objects_outlive_the_view);
    tcase_add_test(own, context_without_a_device_is_refused);
    tcase_add_test(own, failure_leaves_the_callers_objects_alone);
    tcase_add_test(own, nothing_need_be_chosen);
    tcase_add_test(own, view_without_a_device_has_none);
    suite_add_tcase(suite, own);
    return test_run_suite(suite);
}
