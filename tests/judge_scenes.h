// SPDX-License-Identifier: Apache-2.0
// What the judge is asked where the answer is known by hand. The eye is at (8, 0, 0), panels stand
// in the plane x = 0, and what is to be hidden at x = -8, where shadows are twice as large.
#ifndef OCC_TEST_JUDGE_SCENES_H
#define OCC_TEST_JUDGE_SCENES_H

#include "judge.h"
#include "worlds.h"

#include <math.h>

static const double eye_on_x[3] = {8, 0, 0};

static inline occ_box panel(float x, float low_y, float high_y, float low_z, float high_z)
{
    return (occ_box){{x, 0.5f * (low_y + high_y), 0.5f * (low_z + high_z)},
                     {{0, 0, 0}, {0, 0.5f * (high_y - low_y), 0}, {0, 0, 0.5f * (high_z - low_z)}}};
}

static inline occ_box block(float low_x, float high_x, float low_y, float high_y, float low_z,
                            float high_z)
{
    occ_box box = panel(0.5f * (low_x + high_x), low_y, high_y, low_z, high_z);
    box.axis[0][0] = 0.5f * (high_x - low_x);
    return box;
}

// The verdict with and without the filter, which must agree.
static inline bool ask(judge *j, const occ_box *object, const occ_box *occluders, size_t count)
{
    bool seen[2];
    for (int filter = 0; filter < 2; filter++) {
        judge_filter(j, filter == 1);
        judge_set_occluders(j, occluders, NULL, count);
        seen[filter] = judge_sees(j, object, -1);
        ck_assert_int_eq(judge_share(j, object, -1) > 0.0, seen[filter]);
    }
    ck_assert_int_eq(seen[0], seen[1]);
    return seen[0];
}

static inline bool sees_from(const double eye[3], const occ_box *object, const occ_box *occluders,
                             size_t count)
{
    judge *j = judge_of_eye(eye);
    bool seen = ask(j, object, occluders, count);
    judge_free(j);
    return seen;
}

static inline bool sees(const occ_box *object, const occ_box *occluders, size_t count)
{
    return sees_from(eye_on_x, object, occluders, count);
}

#endif
