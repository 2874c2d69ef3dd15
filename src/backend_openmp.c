// SPDX-License-Identifier: Apache-2.0
// Sixteen objects at once, ranges spread over threads. A range's verdict is one word that one
// thread writes, so nothing is shared and the thread count cannot show.
#include "backend.h"

#ifdef _OPENMP
#include <omp.h>
#endif

typedef struct openmp_backend {
    occ_tester base;
    const occ_lanes *lanes;
    int threads;
} openmp_backend;

static occ_result upload(occ_tester *backend, const occ_scene *scene)
{
    (void)backend;
    (void)scene;
    return OCC_SUCCESS;
}

static void test_range(const openmp_backend *backend, const occ_test_job *job, uint32_t r)
{
    const occ_range *range = &job->ranges[r];
    occ_candidates candidates = {job->shadows, job->wide, job->candidates + range->candidates,
                                 range->candidate_count};
    job->verdicts[r] = backend->lanes->test(&job->scene->boxes, range, job->eye, &candidates);
}

static occ_result test(occ_tester *base, const occ_test_job *job)
{
    const openmp_backend *backend = (const openmp_backend *)base;
    uint32_t count = job->range_count;
#ifdef _OPENMP
    int threads = backend->threads;
#pragma omp parallel for default(none) shared(backend, job, count) num_threads(threads)            \
    schedule(dynamic, 16) if (threads > 1 && count > 64)
#endif
    for (uint32_t r = 0; r < count; r++)
        test_range(backend, job, r);
    return OCC_SUCCESS;
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
    static const occ_backend_ops ops = {"openmp", upload, test, read_nothing, destroy};
    openmp_backend *made = occ_alloc(hooks, sizeof *made);
    *backend = NULL;
    if (!made) return OCC_ERROR_OUT_OF_MEMORY;
    *made = (openmp_backend){.base = {&ops, hooks, 0}, .lanes = lanes, .threads = 1};
#ifdef _OPENMP
    made->threads = threads ? (int)threads : omp_get_max_threads();
#else
    (void)threads;
#endif
    *backend = &made->base;
    return OCC_SUCCESS;
}
