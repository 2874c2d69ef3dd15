// SPDX-License-Identifier: Apache-2.0
// Sixteen objects at once, ranges spread over threads. A range's verdict is one word that one
// thread writes, so nothing is shared and the thread count cannot show.
#include "backend.h"

#include "team.h"

typedef struct openmp_backend {
    occ_tester base;
    const occ_lanes *lanes;
    uint32_t threads;
} openmp_backend;

// A backend, the job in hand, and who makes its ranges.
typedef struct openmp_frame {
    const openmp_backend *backend;
    const occ_test_job *job;
    void (*make)(occ_stream *stream, void *context);
    void *context;
} openmp_frame;

static occ_result upload(occ_tester *backend, const occ_scene *scene)
{
    (void)backend;
    (void)scene;
    return OCC_SUCCESS;
}

static void test_range(void *context, uint32_t r)
{
    const openmp_frame *frame = context;
    const occ_test_job *job = frame->job;
    const occ_range *range = &job->ranges[r];
    occ_candidates candidates = {job->set, job->candidates + range->candidates,
                                 range->candidate_count};
    job->verdicts[r] =
        frame->backend->lanes->test(&job->scene->boxes, range, job->eye, job->screen, &candidates);
}

static void offer_all(occ_stream *stream, void *context)
{
    occ_stream_offer(stream, ((openmp_frame *)context)->job->range_count);
}

static occ_result test(occ_tester *base, const occ_test_job *job)
{
    const openmp_backend *backend = (const openmp_backend *)base;
    openmp_frame frame = {.backend = backend, .job = job};
    uint32_t threads = job->range_count > 64 ? backend->threads : 1;
    occ_with_stream(threads, offer_all, test_range, &frame);
    return OCC_SUCCESS;
}

static void make_ranges(occ_stream *stream, void *context)
{
    openmp_frame *frame = context;
    frame->make(stream, frame->context);
}

static void overlap(occ_tester *base, const occ_test_job *job,
                    void (*make)(occ_stream *stream, void *context), void *context)
{
    const openmp_backend *backend = (const openmp_backend *)base;
    openmp_frame frame = {backend, job, make, context};
    occ_with_stream(backend->threads, make_ranges, test_range, &frame);
}

static occ_result read_nothing(occ_tester *backend, const occ_test_job *job)
{
    (void)backend;
    (void)job;
    return OCC_SUCCESS;
}

static void destroy(occ_tester *backend)
{
    occ_free(backend->hooks, backend, sizeof(openmp_backend));
}

occ_result occ_backend_openmp_create(occ_hooks *hooks, uint32_t threads, const occ_lanes *lanes,
                                     occ_tester **backend)
{
    static const occ_backend_ops ops = {"openmp", upload, test, overlap, read_nothing, destroy};
    openmp_backend *made = occ_alloc(hooks, sizeof *made);
    *backend = NULL;
    if (!made) return OCC_ERROR_OUT_OF_MEMORY;
    *made = (openmp_backend){
        .base = {&ops, hooks, 0}, .lanes = lanes, .threads = occ_threads_offered(threads)};
    *backend = &made->base;
    return OCC_SUCCESS;
}
