// SPDX-License-Identifier: Apache-2.0
// labels: unit opencl
// oclgrind: yes
// The OpenCL backend against the plain one, on the library's own queue and on the caller's. Scenes
// are small: all of this runs a second time on oclgrind, which interprets the kernels.
#define _POSIX_C_SOURCE 200809L

#include <occlude/opencl.h>

#include "kit_crew.h"
#include "kit_obs.h"
#include "obs.h"
#include "scene_data.h"
#include "scenes.h"
#include "support.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

static occ_view *plain_view(void)
{
    occ_view *view = NULL;
    occ_view_desc desc = {.backend = OCC_BACKEND_PLAIN};
    ck_assert_int_eq(occ_view_create(&desc, &view), OCC_SUCCESS);
    return view;
}

static occ_view *device_view(const occ_cl_desc *desc)
{
    occ_view *view = NULL;
    occ_result result = occ_cl_view_create(NULL, desc, &view);
    ck_assert_msg(result == OCC_SUCCESS, "%s", occ_result_name(result));
    return view;
}

static void compare(occ_view *plain, occ_view *device, const occ_scene *scene,
                    const occ_camera_desc *camera, const occ_cull_desc *knobs)
{
    kit_cull(plain, scene, camera, knobs);
    kit_cull(device, scene, camera, knobs);
    kit_same_answers(plain, device, "OpenCL");
}

static const occ_cl_shape shapes[] = {OCC_CL_SHAPE_WIDE, OCC_CL_SHAPE_NARROW};

// --- scenes --------------------------------------------------------------------------------------

START_TEST(the_devices_mask_is_the_plain_mask_on_every_named_scene)
{
    static const uint32_t counts[] = {80, 80, 200, 80, 80}; // enough for something to be hidden
    static const occ_cull_desc knobs[] = {{.method = OCC_METHOD_SINGLE, .grain = 1},
                                          {.method = OCC_METHOD_SINGLE, .grain = 100000},
                                          {.method = OCC_METHOD_FUSED},
                                          {.method = OCC_METHOD_PAIRWISE}};
    obs_scene file;
    ck_assert(scenes_make(scenes_kinds[_i % 5].name, counts[_i % 5], 2, &file));
    occ_scene *scene = kit_obs_scene(&file, NULL, NULL, NULL);
    occ_cl_desc desc = {.shape = shapes[_i / 5]};
    occ_view *plain = plain_view(), *device = device_view(&desc);
    uint32_t hidden = 0;
    for (uint32_t f = 0; f < file.frame_count; f += 40) {
        double eye[3];
        occ_camera_desc camera = kit_obs_camera(&file.frames[f], eye);
        for (unsigned k = 0; k < sizeof knobs / sizeof *knobs; k++) {
            compare(plain, device, scene, &camera, &knobs[k]);
            hidden += kit_stats(device).test_hidden;
        }
    }
    ck_assert_uint_gt(hidden, 0);
    occ_view_destroy(plain);
    occ_view_destroy(device);
    occ_scene_destroy(scene);
    obs_free(&file);
}
END_TEST

START_TEST(every_size_of_the_last_range_is_tested_whole)
{
    static const uint32_t counts[] = {1, 31, 33, 64, 65, 129};
    occ_view *plain = plain_view(), *device = device_view(&(occ_cl_desc){.shape = shapes[_i]});
    for (unsigned i = 0; i < sizeof counts / sizeof *counts; i++) {
        occ_scene *scene = NULL;
        occ_camera_desc camera = kit_path(3);
        occ_cull_desc knobs = {.method = OCC_METHOD_PAIRWISE};
        ck_assert_int_eq(occ_scene_create(NULL, &scene), OCC_SUCCESS);
        kit_fill(scene, counts[i], 4, counts[i], NULL, NULL);
        ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
        compare(plain, device, scene, &camera, &knobs);
        ck_assert_uint_eq(kit_stats(device).tested, counts[i]);
        occ_scene_destroy(scene);
    }
    occ_view_destroy(plain);
    occ_view_destroy(device);
}
END_TEST

START_TEST(nothing_to_test_is_no_error_and_an_empty_mask)
{
    occ_view *device = device_view(NULL);
    occ_scene *scene = NULL;
    occ_camera_desc camera = kit_path(0);
    ck_assert_int_eq(occ_scene_create(NULL, &scene), OCC_SUCCESS);
    kit_cull(device, scene, &camera, NULL);
    size_t count = 1;
    ck_assert_int_eq(occ_view_read_mask(device, NULL, 0, &count), OCC_SUCCESS);
    ck_assert_uint_eq(count, 0);
    occ_box box = kit_cube(0, 1e6f, 0, 1); // far outside
    occ_object object;
    ck_assert_int_eq(occ_scene_add(scene, &box, &object), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
    kit_cull(device, scene, &camera, NULL);
    ck_assert(!occ_view_is_visible(device, object));
    box = kit_cube(0, 0, 0, 1);
    ck_assert_int_eq(occ_scene_move(scene, object, &box), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
    kit_cull(device, scene, &camera, NULL);
    ck_assert(occ_view_is_visible(device, object));
    occ_scene_destroy(scene);
    occ_view_destroy(device);
}
END_TEST

// --- edits ---------------------------------------------------------------------------------------

// 700 objects lie in three blocks of rows, each of which travels on its own. Not on oclgrind 21.10:
// there, what a copy from the host leaves out of a buffer counts as uninitialised from then on.
static bool takes_partial_copies(void)
{
    return getenv("OCLGRIND_UNINITIALIZED") == NULL;
}

START_TEST(changed_rows_travel_to_the_device)
{
    enum { COUNT = 700 };
    static occ_object objects[COUNT];
    occ_scene *scene = NULL;
    ck_assert_int_eq(occ_scene_create(NULL, &scene), OCC_SUCCESS);
    kit_fill(scene, COUNT, 3, 9, objects, NULL);
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
    occ_view *plain = plain_view(), *device = device_view(NULL);
    kit_random random = {4};
    occ_camera_desc camera = kit_path(0);
    compare(plain, device, scene, &camera, NULL);
    uint32_t *before = kit_mask(device, NULL);
    for (uint32_t round = 0; round < 4; round++) {
        ck_assert_uint_gt(kit_move_within_cells(scene, objects, COUNT, &random), 20);
        ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
        ck_assert_msg(!scene->all_changed, "the moves were to stay within their cells");
        compare(plain, device, scene, &camera, NULL);
    }
    uint32_t *after = kit_mask(device, NULL);
    ck_assert_msg(!kit_same_words(before, after, COUNT), "the moves change no verdict");
    free(before);
    free(after);
    occ_view_destroy(plain);
    occ_view_destroy(device);
    occ_scene_destroy(scene);
}
END_TEST

START_TEST(a_scene_that_shrinks_and_grows_is_followed)
{
    enum { COUNT = 150 };
    static occ_object objects[COUNT];
    occ_scene *scene = NULL;
    ck_assert_int_eq(occ_scene_create(NULL, &scene), OCC_SUCCESS);
    occ_view *plain = plain_view(), *device = device_view(NULL);
    occ_camera_desc camera = kit_path(1);
    for (uint32_t round = 0; round < 3; round++) {
        kit_fill(scene, COUNT * (round + 1), 3, round, NULL, NULL);
        kit_fill(scene, COUNT, 3, round + 50, objects, NULL);
        ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
        compare(plain, device, scene, &camera, NULL);
        for (uint32_t i = 0; i < COUNT; i++)
            ck_assert_int_eq(occ_scene_remove(scene, objects[i]), OCC_SUCCESS);
        ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
        compare(plain, device, scene, &camera, NULL);
    }
    occ_view_destroy(plain);
    occ_view_destroy(device);
    occ_scene_destroy(scene);
}
END_TEST

// --- the caller's device, context and queue ------------------------------------------------------

typedef struct caller {
    cl_device_id device;
    cl_context context;
    cl_command_queue queue;
    occ_scene *scene;
    occ_view *plain;
} caller;

static caller us;

static void begin(void)
{
    cl_platform_id platforms[8];
    cl_uint count = 0;
    ck_assert_int_eq(clGetPlatformIDs(8, platforms, &count), CL_SUCCESS);
    for (cl_uint i = 0; i < count && !us.device; i++)
        (void)clGetDeviceIDs(platforms[i], CL_DEVICE_TYPE_ALL, 1, &us.device, NULL);
    ck_assert_ptr_nonnull(us.device);
    cl_int error;
    us.context = clCreateContext(NULL, 1, &us.device, NULL, NULL, &error);
    ck_assert_int_eq(error, CL_SUCCESS);
    us.queue = clCreateCommandQueue(us.context, us.device, CL_QUEUE_PROFILING_ENABLE, &error);
    ck_assert_int_eq(error, CL_SUCCESS);
    ck_assert_int_eq(occ_scene_create(NULL, &us.scene), OCC_SUCCESS);
    kit_fill(us.scene, 300, 2, 6, NULL, NULL);
    ck_assert_int_eq(occ_scene_commit(us.scene), OCC_SUCCESS);
    us.plain = plain_view();
}

static void end(void)
{
    occ_view_destroy(us.plain);
    occ_scene_destroy(us.scene);
    ck_assert_int_eq(clReleaseCommandQueue(us.queue), CL_SUCCESS);
    ck_assert_int_eq(clReleaseContext(us.context), CL_SUCCESS);
}

static cl_uint queue_holders(void)
{
    cl_uint count = 0;
    ck_assert_int_eq(
        clGetCommandQueueInfo(us.queue, CL_QUEUE_REFERENCE_COUNT, sizeof count, &count, NULL),
        CL_SUCCESS);
    return count;
}

static cl_uint context_holders(void)
{
    cl_uint count = 0;
    ck_assert_int_eq(
        clGetContextInfo(us.context, CL_CONTEXT_REFERENCE_COUNT, sizeof count, &count, NULL),
        CL_SUCCESS);
    return count;
}

// A driver's own threads may let go of what they held a little later.
static bool falls_to(cl_uint (*holders)(void), cl_uint expected)
{
    const struct timespec pause = {0, 10000000};
    for (int i = 0; i < 500 && holders() != expected; i++)
        (void)nanosleep(&pause, NULL);
    return holders() == expected;
}

START_TEST(the_callers_queue_is_used_and_given_back)
{
    cl_uint holders = queue_holders(), context = context_holders();
    occ_cl_desc desc = {.queue = us.queue};
    occ_view *view = device_view(&desc);
    ck_assert_uint_gt(queue_holders(), holders);
    ck_assert_ptr_eq(occ_cl_view_device(view), us.device);
    for (uint32_t i = 0; i < 3; i++) {
        occ_camera_desc camera = kit_path(i);
        compare(us.plain, view, us.scene, &camera, NULL);
        ck_assert_uint_gt(kit_stats(view).tested, 0);
    }
    occ_view_destroy(view);
    ck_assert(falls_to(queue_holders, holders));
    ck_assert(falls_to(context_holders, context));
}
END_TEST

// The queue is in order, so a cull has to wait for what the caller put there before.
START_TEST(what_the_caller_put_on_the_queue_comes_first)
{
    enum { NUMBERS = 4096 };
    static uint32_t sent[NUMBERS], back[NUMBERS];
    cl_int error;
    cl_mem buffer = clCreateBuffer(us.context, CL_MEM_READ_WRITE, sizeof sent, NULL, &error);
    ck_assert_int_eq(error, CL_SUCCESS);
    occ_cl_desc desc = {.queue = us.queue};
    occ_view *view = device_view(&desc);
    occ_camera_desc camera = kit_path(2);
    for (uint32_t i = 0; i < NUMBERS; i++)
        sent[i] = i * 2654435761u;
    cl_event event = NULL;
    error = clEnqueueWriteBuffer(us.queue, buffer, CL_FALSE, 0, sizeof sent, sent, 0, NULL, NULL);
    ck_assert_int_eq(error, CL_SUCCESS);
    error = clEnqueueReadBuffer(us.queue, buffer, CL_FALSE, 0, sizeof back, back, 0, NULL, &event);
    ck_assert_int_eq(error, CL_SUCCESS);
    compare(us.plain, view, us.scene, &camera, NULL);
    cl_int status = CL_QUEUED;
    error = clGetEventInfo(event, CL_EVENT_COMMAND_EXECUTION_STATUS, sizeof status, &status, NULL);
    ck_assert_int_eq(error, CL_SUCCESS);
    ck_assert_msg(status == CL_COMPLETE, "the cull overtook the caller's own commands");
    ck_assert(!memcmp(sent, back, sizeof sent));
    ck_assert_int_eq(clReleaseEvent(event), CL_SUCCESS);
    ck_assert_int_eq(clReleaseMemObject(buffer), CL_SUCCESS);
    occ_view_destroy(view);
}
END_TEST

START_TEST(a_device_or_a_context_of_the_caller_will_do)
{
    occ_camera_desc camera = kit_path(4);
    occ_cl_desc descs[] = {{.device = us.device}, {.device = us.device, .context = us.context}};
    cl_uint holders = context_holders();
    for (int i = 0; i < 2; i++) {
        occ_view *view = device_view(&descs[i]);
        ck_assert_ptr_eq(occ_cl_view_device(view), us.device);
        compare(us.plain, view, us.scene, &camera, NULL);
        ck_assert(i == 0 || context_holders() > holders);
        occ_view_destroy(view);
        ck_assert(falls_to(context_holders, holders));
    }
}
END_TEST

START_TEST(a_shape_that_there_is_not_is_refused)
{
    occ_view *view = (occ_view *)&view;
    occ_cl_desc desc = {.shape = (occ_cl_shape)3};
    ck_assert_int_eq(occ_cl_view_create(NULL, &desc, &view), OCC_ERROR_INVALID_ARGUMENT);
    ck_assert_ptr_null(view);
}
END_TEST

START_TEST(a_context_without_its_device_is_refused_by_name)
{
    kit_log log = {.lines = 0};
    occ_view_desc view_desc = {.logger = kit_logger(&log)};
    occ_cl_desc desc = {.context = us.context};
    occ_view *view = us.plain;
    ck_assert_int_eq(occ_cl_view_create(&view_desc, &desc, &view), OCC_ERROR_INVALID_ARGUMENT);
    ck_assert_ptr_null(view);
    ck_assert_msg(kit_logged(&log, "context"), "%s", log.text);
    ck_assert_int_eq(occ_cl_view_create(&view_desc, &desc, NULL), OCC_ERROR_INVALID_ARGUMENT);
}
END_TEST

START_TEST(only_views_on_a_device_have_one_and_count_its_memory)
{
    ck_assert_ptr_null(occ_cl_view_device(us.plain));
    ck_assert_ptr_null(occ_cl_view_device(NULL));
    occ_view *view = device_view(NULL);
    ck_assert_ptr_nonnull(occ_cl_view_device(view));
    occ_camera_desc camera = kit_path(5);
    compare(us.plain, view, us.scene, &camera, NULL);
    ck_assert_uint_eq(kit_stats(us.plain).device_bytes, 0);
    ck_assert_uint_ge(kit_stats(view).device_bytes, 300 * sizeof(occ_box));
    occ_view_destroy(view);
}
END_TEST

int main(void)
{
    int skip = test_skip_without_device();
    if (skip) return skip;
    // oclgrind's watch over what is uninitialised trips over vectors: there, wide alone
    int shape_count = getenv("OCLGRIND_UNINITIALIZED") ? 1 : 2;
    Suite *suite = suite_create("backend_opencl");
    TCase *scenes = tcase_create("scenes");
    tcase_add_loop_test(scenes, the_devices_mask_is_the_plain_mask_on_every_named_scene, 0,
                        5 * shape_count);
    tcase_add_loop_test(scenes, every_size_of_the_last_range_is_tested_whole, 0, shape_count);
    tcase_add_test(scenes, nothing_to_test_is_no_error_and_an_empty_mask);
    suite_add_tcase(suite, scenes);

    TCase *edits = tcase_create("edits");
    if (takes_partial_copies()) tcase_add_test(edits, changed_rows_travel_to_the_device);
    tcase_add_test(edits, a_scene_that_shrinks_and_grows_is_followed);
    suite_add_tcase(suite, edits);

    TCase *queues = tcase_create("queues");
    tcase_add_checked_fixture(queues, begin, end);
    tcase_add_test(queues, the_callers_queue_is_used_and_given_back);
    tcase_add_test(queues, what_the_caller_put_on_the_queue_comes_first);
    tcase_add_test(queues, a_device_or_a_context_of_the_caller_will_do);
    tcase_add_test(queues, a_shape_that_there_is_not_is_refused);
    tcase_add_test(queues, a_context_without_its_device_is_refused_by_name);
    tcase_add_test(queues, only_views_on_a_device_have_one_and_count_its_memory);
    suite_add_tcase(suite, queues);
    return test_run_suite(suite);
}
