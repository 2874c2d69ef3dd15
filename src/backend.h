// SPDX-License-Identifier: Apache-2.0
// Where the objects of the open ranges are tested. All backends give the same verdicts bit for bit:
// they evaluate verdict.h, on numbers from one place.
#ifndef OCC_BACKEND_H
#define OCC_BACKEND_H

#include "lanes.h"
#include "scene_data.h"
#include "team.h"

#include <occlude/cull.h>

// One frame's work. Everything belongs to the view and is only read, but for the verdicts.
typedef struct occ_test_job {
    const occ_scene *scene;
    const occ_eye *eye;
    const occ_screen *screen;
    const occ_shadow_set *set;
    const occ_range *ranges;
    uint32_t range_count;
    const uint32_t *candidates; // the ranges' lists, one after the other
    uint32_t candidate_count;
    occ_verdict *verdicts; // one per range: what the backend writes
} occ_test_job;

typedef struct occ_tester occ_tester;

typedef struct occ_backend_ops {
    const char *name;
    // Makes the scene's boxes reachable, sending what changed since the last call.
    occ_result (*upload)(occ_tester *backend, const occ_scene *scene);
    // Starts the test of all ranges.
    occ_result (*test)(occ_tester *backend, const occ_test_job *job);
    // Runs make(team, context) and tests the job's ranges as they are offered. NULL if the
    // backend tests only what is complete.
    void (*overlap)(occ_tester *backend, const occ_test_job *job,
                    void (*make)(occ_team *team, void *context), void *context);
    // Waits for it; the job's verdicts are valid afterwards.
    occ_result (*read)(occ_tester *backend, const occ_test_job *job);
    void (*destroy)(occ_tester *backend);
} occ_backend_ops;

// What every backend begins with.
struct occ_tester {
    const occ_backend_ops *ops;
    occ_hooks *hooks;
    uint64_t device_bytes;
};

// Each makes a backend that lives until ops->destroy(). `hooks` stays the view's.
occ_result occ_backend_plain_create(occ_hooks *hooks, occ_tester **backend);
occ_result occ_backend_openmp_create(occ_hooks *hooks, uint32_t threads, const occ_lanes *lanes,
                                     occ_tester **backend);
// `desc` is an occ_cl_desc or NULL; only opencl.h knows what that is.
occ_result occ_backend_opencl_create(occ_hooks *hooks, const void *desc, occ_tester **backend);

#endif
