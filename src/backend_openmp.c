// SPDX-License-Identifier: Apache-2.0
// Sixteen objects at once, ranges spread over threads. A range's verdict is one word that one
// thread writes, so nothing is shared and the thread count cannot show.
#include "backend.h"

#include "team.h"

#define MANY_RANGES 64u // worth waking the others for

typedef struct openmp_backend {
    occ_tester base;
    const occ_lanes *lanes;
    occ_team *team;
} openmp_backend;

// A backend and the job in hand.
typedef struct openmp_frame {
    const openmp_backend *backend;
    const occ_test_job *job;
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

static occ_result test(occ_tester *base, const occ_test_job *job)
{
    const openmp_backend *backend = (const openmp_backend *)base;
    openmp_frame frame = {backend, job};
    occ_team *team = job->range_count >= MANY_RANGES ? backend->team : NULL;
    if (team) occ_team_wake(team);
    occ_do_parts(team, job->range_count, test_range, &frame);
    if (team) occ_team_rest(team);
    return OCC_SUCCESS;
}

static void overlap(occ_tester *base, const occ_test_job *job,
                    void (*make)(occ_team *team, void *context), void *context)
{
    const openmp_backend *backend = (const openmp_backend *)base;
    openmp_frame frame = {backend, job};
    occ_team_begin(backend->team, test_range, &frame);
    occ_team_wake(backend->team);
    make(backend->team, context);
    occ_team_settle(backend->team);
    occ_team_rest(backend->team);
}

static occ_result read_nothing(occ_tester *backend, const occ_test_job *job)
{
    (void)backend;
    (void)job;
    return OCC_SUCCESS;
}

static void destroy(occ_tester *base)
{
    openmp_backend *backend = (openmp_backend *)base;
    occ_team_destroy(base->hooks, backend->team);
    occ_free(base->hooks, backend, sizeof *backend);
}

occ_result occ_backend_openmp_create(occ_hooks *hooks, uint32_t threads, const occ_lanes *lanes,
                                     occ_tester **backend)
{
    static const occ_backend_ops ops = {"openmp", upload, test, overlap, read_nothing, destroy};
    openmp_backend *made = occ_alloc(hooks, sizeof *made);
    *backend = NULL;
    if (!made) return OCC_ERROR_OUT_OF_MEMORY;
    *made = (openmp_backend){.base = {&ops, hooks, 0}, .lanes = lanes};
    if (occ_team_create(hooks, occ_threads_offered(threads), &made->team)) {
        occ_free(hooks, made, sizeof *made);
        return OCC_ERROR_OUT_OF_MEMORY;
    }
    *backend = &made->base;
    return OCC_SUCCESS;
}
