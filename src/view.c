// SPDX-License-Identifier: Apache-2.0
// Views, and the frame from end to end: select, walk, test, hand over.
#include "view_data.h"

#include "knobs.h"
#include "log.h"

#include <time.h>

#define OVERLAP_OBJECTS 250u // that the test is left with

static double now_ms(void)
{
    struct timespec time;
    (void)timespec_get(&time, TIME_UTC);
    return (double)time.tv_sec * 1e3 + (double)time.tv_nsec * 1e-6;
}

static occ_result make_backend(occ_view *view, const occ_view_desc *desc, const void *cl_desc)
{
    switch (desc->backend) {
    case OCC_BACKEND_OPENMP:
        return occ_backend_openmp_create(&view->hooks, desc->threads, view->frame.lanes,
                                         &view->backend);
    case OCC_BACKEND_PLAIN:
        return occ_backend_plain_create(&view->hooks, &view->backend);
    case OCC_BACKEND_OPENCL:
#ifdef OCC_HAVE_OPENCL
        return occ_backend_opencl_create(&view->hooks, cl_desc, &view->backend);
#else
        (void)cl_desc;
        return occ_fail(&view->hooks, OCC_ERROR_UNSUPPORTED, "this build has no OpenCL");
#endif
    }
    return occ_fail(&view->hooks, OCC_ERROR_INVALID_ARGUMENT, "there is no backend %d",
                    (int)desc->backend);
}

occ_result occ_view_make(const occ_view_desc *desc, const void *cl_desc, occ_view **view)
{
    occ_hooks hooks;
    occ_result result = occ_hooks_init(&hooks, &desc->allocator, &desc->logger);
    if (result) return occ_fail(&hooks, result, "an allocator needs both of its functions");
    if (desc->threads > OCC_MOST_THREADS) {
        return occ_fail(&hooks, OCC_ERROR_INVALID_ARGUMENT, "%u threads, at most %u", desc->threads,
                        OCC_MOST_THREADS);
    }
    occ_view *made = occ_alloc(&hooks, sizeof *made);
    if (!made) return occ_fail(&hooks, OCC_ERROR_OUT_OF_MEMORY, "no memory for a view");
    *made = (occ_view){.hooks = hooks, .mask = OCC_MASK};
    occ_frame_init(&made->frame, &made->hooks, occ_lanes_choose());
    result = make_backend(made, desc, cl_desc);
    if (result) {
        occ_log(&hooks, OCC_LOG_ERROR, "%s: no view was made", occ_result_name(result));
        occ_view_destroy(made);
        return result;
    }
    occ_log(&hooks, OCC_LOG_INFO, "view: backend %s, %s lanes", made->backend->ops->name,
            made->frame.lanes->name);
    *view = made;
    return OCC_SUCCESS;
}

occ_result occ_view_create(const occ_view_desc *desc, occ_view **view)
{
    static const occ_view_desc defaults;
    if (!view) return OCC_ERROR_INVALID_ARGUMENT;
    *view = NULL;
    return occ_view_make(desc ? desc : &defaults, NULL, view);
}

void occ_view_destroy(occ_view *view)
{
    if (!view) return;
    if (view->backend) view->backend->ops->destroy(view->backend);
    occ_frame_free(&view->frame);
    occ_mask_free(&view->hooks, &view->mask);
    occ_hooks hooks = view->hooks;
    occ_free(&hooks, view, sizeof *view);
}

// The knobs must be set.
static occ_result set_camera(occ_view *view, const occ_camera_desc *desc)
{
    const char *reason = "";
    occ_camera *camera = &view->frame.camera;
    occ_result result = occ_camera_init(camera, desc, &reason);
    if (result) return occ_fail(&view->hooks, result, "%s", reason);
    camera->tolerance = (double)view->frame.knobs.tolerance;
    camera->constants.splits = view->frame.knobs.max_splits;
    return OCC_SUCCESS;
}

static occ_result run_test(occ_view *view)
{
    occ_frame *frame = &view->frame;
    occ_tester *backend = view->backend;
    occ_frame_set_job(frame);
    occ_result result = OCC_SUCCESS;
    if (frame->ranges.count) result = backend->ops->test(backend, &frame->job);
    if (!result) result = backend->ops->read(backend, &frame->job);
    return result;
}

typedef struct walk_call {
    occ_frame *frame;
    occ_result result;
    double end;
} walk_call;

static void walk_on(occ_team *team, void *context)
{
    walk_call *call = context;
    call->frame->team = team;
    call->result = occ_walk(call->frame);
    call->frame->team = NULL;
    call->end = now_ms();
}

// The walk and then the test; or both at once where that has been worth while, by how much the last
// frame left to the test.
static occ_result walk_and_test(occ_view *view, double *walked)
{
    occ_frame *frame = &view->frame;
    walk_call call = {.frame = frame};
    bool both = view->backend->ops->overlap && view->tested >= OVERLAP_OBJECTS;
    occ_result sent = view->backend->ops->upload(view->backend, frame->scene);
    if (sent) return sent;
    occ_frame_set_job(frame);
    if (both) {
        view->backend->ops->overlap(view->backend, &frame->job, walk_on, &call);
    } else {
        walk_on(NULL, &call);
    }
    *walked = call.end;
    view->tested = frame->stats.tested;
    if (both) return call.result;
    if (call.result) frame->ranges.count = 0; // what is under way must not outlast the frame
    occ_result result = run_test(view);
    return call.result ? call.result : result;
}

// Scatters the ranges' verdicts, which speak of rows, into the mask, which speaks of slots.
static occ_result hand_over(occ_view *view)
{
    const occ_frame *frame = &view->frame;
    uint32_t words = (uint32_t)OCC_MASK_WORDS(frame->scene->objects.count);
    if (occ_mask_start(&view->hooks, &view->mask, words)) return OCC_ERROR_OUT_OF_MEMORY;
    const occ_range *ranges = frame->ranges.data;
    const occ_verdict *verdicts = frame->verdicts.data;
    const uint32_t *slot_of = occ_scene_slot_of(frame->scene);
    occ_view_stats *stats = &view->frame.stats;
    for (uint32_t i = 0; i < 2 * frame->ranges.count; i++) {
        uint32_t first = ranges[i / 2].first + 32 * (i % 2);
        for (uint32_t bits = verdicts[i / 2].visible[i % 2]; bits; bits &= bits - 1) {
            occ_mask_set(&view->mask, slot_of[first + (uint32_t)__builtin_ctz(bits)]);
            stats->visible++;
        }
        stats->test_outside += (uint32_t)__builtin_popcount(verdicts[i / 2].outside[i % 2]);
    }
    stats->test_hidden = stats->tested - stats->test_outside - stats->visible;
    return OCC_SUCCESS;
}

static occ_result run_frame(occ_view *view)
{
    occ_frame *frame = &view->frame;
    double start = now_ms();
    frame->stats = (occ_view_stats){.objects = frame->scene->objects.taken};
    double walked = start;
    occ_result result = walk_and_test(view, &walked);
    if (!result) result = hand_over(view);
    if (result == OCC_ERROR_OUT_OF_MEMORY) {
        occ_fail(&view->hooks, result, "no memory for the scratch of a frame");
    }
    frame->stats.walk_ms = walked - start;
    frame->stats.test_ms = now_ms() - walked;
    frame->stats.bytes = view->hooks.bytes;
    frame->stats.device_bytes = view->backend->device_bytes;
    return result;
}

occ_result occ_cull(occ_view *view, const occ_scene *scene, const occ_camera_desc *camera,
                    const occ_cull_desc *desc)
{
    if (!view) return OCC_ERROR_INVALID_ARGUMENT;
    view->has_result = false;
    if (!scene || !camera) {
        return occ_fail(&view->hooks, OCC_ERROR_INVALID_ARGUMENT, "the scene or camera is NULL");
    }
    if (!occ_scene_is_committed(scene)) {
        return occ_fail(&view->hooks, OCC_ERROR_NOT_COMMITTED, "call occ_scene_commit() first");
    }
    occ_result result = occ_knobs_init(&view->frame.knobs, desc, &view->hooks);
    if (!result) result = set_camera(view, camera);
    if (result) return result;
    view->frame.scene = scene;
    result = run_frame(view);
    view->frame.scene = NULL;
    if (result) return result;
    view->has_result = true;
    view->scene_id = scene->id;
    view->revision = scene->revision;
    return OCC_SUCCESS;
}
