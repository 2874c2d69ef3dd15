// SPDX-License-Identifier: Apache-2.0
// A small scene before a camera, the sampled truth of it, and what the judge makes of a result. Who
// includes this includes "settle.h" itself, so that what is behind it gets linked.
#ifndef OCC_TEST_SETTLE_STAGE_H
#define OCC_TEST_SETTLE_STAGE_H

#include "compare_count.h"
#include "kit.h"
#include "settle.h"
#include "truth_sample.h"

#include <check.h>

enum { SIDE = 64, MOST_OBJECTS = 32, MOST_FRAMES = 4 };

// A scene of frames that are all alike, and what is reported of it.
typedef struct stage {
    obs_scene scene;
    truth_result truth;
    vis_result result;
} stage;

typedef struct outcome {
    settle_sums sums;
    compare_sums counts;
} outcome;

static const double at_origin[3] = {0, 0, 0}, along_z[3] = {0, 0, -1};

static inline occ_box block(float x, float y, float z, float half_x, float half_y, float half_z)
{
    return (occ_box){{x, y, z}, {{half_x, 0, 0}, {0, half_y, 0}, {0, 0, half_z}}};
}

static inline stage stage_with(const occ_box *box, int frames)
{
    stage s = {0};
    const occ_box middle = block(0, 0, -5, 1, 1, 1);
    obs_frame frame = obs_look(at_origin, along_z, 1, 1, 0.125, 100);
    for (int i = 0; i < frames; i++)
        obs_add_frame(&s.scene, &frame);
    obs_add_object(&s.scene, box ? box : &middle);
    return s;
}

// An occluder with an owner of its own, behind the camera.
static inline void add_wall(stage *s, const occ_box *box)
{
    const occ_box owner = block(0, 0, 90, 1, 1, 1);
    obs_add_occluder(&s->scene, box, obs_add_object(&s->scene, &owner));
}

// Samples all frames; the bits of `shown` are the objects that the result shows in each.
static inline void sample(stage *s, uint32_t shown)
{
    uint32_t objects = s->scene.object_count, frames = s->scene.frame_count;
    ck_assert(!s->scene.out_of_memory && objects <= MOST_OBJECTS && frames <= MOST_FRAMES);
    ck_assert(truth_create(&s->truth, objects, frames));
    ck_assert(vis_create(&s->result, objects, frames));
    s->truth.width = s->truth.height = SIDE;
    for (uint32_t i = 0; i < frames; i++) {
        s->truth.frames[i] = i;
        const char *complaint =
            truth_sample(&s->scene, i, SIDE, SIDE, s->truth.verdicts + (size_t)i * objects);
        ck_assert_msg(!complaint, "%s", complaint);
        vis_set_frame(&s->result, i, &shown);
    }
}

static inline outcome settle_with(settle *judges, stage *s, settle_limits limits)
{
    outcome found;
    truth_result settled;
    const char *complaint = settle_result(judges, &s->result, limits, &settled, &found.sums);
    ck_assert_msg(!complaint, "%s", complaint);
    found.counts = compare_count(&settled, &s->result, NULL, NULL);
    truth_free(&settled);
    const settle_sums *sums = &found.sums;
    ck_assert_uint_eq(sums->settled, sums->judged_visible + sums->judged_hidden);
    ck_assert_uint_le(sums->settled, limits.disagreed);
    ck_assert_uint_le(sums->agreed_judged, limits.agreed);
    return found;
}

static inline outcome settle_limited(stage *s, uint64_t disagreed, uint64_t agreed)
{
    const settle_limits limits = {disagreed, agreed};
    ck_assert_ptr_null(settle_check(&s->scene, &s->truth));
    settle *judges = settle_create(&s->scene, &s->truth);
    ck_assert_ptr_nonnull(judges);
    outcome found = settle_with(judges, s, limits);
    settle_destroy(judges);
    return found;
}

static inline outcome settle_stage(stage *s)
{
    return settle_limited(s, SETTLE_DEFAULT, 0);
}

static inline void free_stage(stage *s)
{
    obs_free(&s->scene);
    truth_free(&s->truth);
    vis_free(&s->result);
}

// Two sheets before object 0, and between them a gap of that width.
static inline stage stage_with_gap(float gap)
{
    stage s = stage_with(NULL, 1);
    const occ_box left = block(-1.6875f, 0, -3, 2, 4, 0),
                  right = block(2.3125f + gap, 0, -3, 2, 4, 0);
    add_wall(&s, &left);
    add_wall(&s, &right);
    sample(&s, 1);
    ck_assert_uint_eq(s.truth.verdicts[0].flags, TRUTH_IN_FRUSTUM);
    ck_assert(!truth_is_visible(&s.truth.verdicts[0]));
    return s;
}

#endif
