// SPDX-License-Identifier: Apache-2.0
// The reference: one object after the other, in scalar C, straight from verdict.h.
#include "backend.h"

#include "box.h"
#include "fusion.h"

static uint32_t verdict_of(const occ_test_job *job, const occ_range *range, uint32_t row)
{
    const occ_box box = occ_boxes_get(&job->scene->boxes, row);
    const occ_eye *eye = job->eye;
    occ_relative_box relative = occ_box_relative(&box, eye);
    if (occ_box_outside(&relative, eye->plane[0], range->frustum)) return OCC_OUTSIDE;
    const uint32_t *list = job->candidates + range->candidates;
    if (range->fused) {
        return occ_box_fused(&relative, eye, range->frustum, job->set->shadows, list,
                             range->candidate_count, row)
                   ? OCC_HIDDEN
                   : OCC_VISIBLE;
    }
    for (uint32_t c = 0; c < range->candidate_count; c++) {
        const occ_shadow *shadow = &job->set->shadows[list[c]];
        if (shadow->owner == row) continue;
        if (occ_box_in_shadow(&relative, shadow->plane[0], shadow->planes)) return OCC_HIDDEN;
    }
    return OCC_VISIBLE;
}

static occ_result upload(occ_tester *backend, const occ_scene *scene)
{
    (void)backend;
    (void)scene;
    return OCC_SUCCESS;
}

static occ_result test(occ_tester *backend, const occ_test_job *job)
{
    (void)backend;
    for (uint32_t r = 0; r < job->range_count; r++) {
        const occ_range *range = &job->ranges[r];
        occ_verdict verdict = {{0, 0}, {0, 0}};
        for (uint32_t i = 0; i < range->count; i++) {
            uint32_t known = verdict_of(job, range, range->first + i);
            verdict.visible[i / 32] |= (uint32_t)(known == OCC_VISIBLE) << i % 32;
            verdict.outside[i / 32] |= (uint32_t)(known == OCC_OUTSIDE) << i % 32;
        }
        job->verdicts[r] = verdict;
    }
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
    occ_free(backend->hooks, backend, sizeof *backend);
}

occ_result occ_backend_plain_create(occ_hooks *hooks, occ_tester **backend)
{
    static const occ_backend_ops ops = {"plain", upload, test, NULL, read_nothing, destroy};
    *backend = occ_alloc(hooks, sizeof **backend);
    if (!*backend) return OCC_ERROR_OUT_OF_MEMORY;
    **backend = (occ_tester){&ops, hooks, 0};
    return OCC_SUCCESS;
}
