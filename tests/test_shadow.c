// SPDX-License-Identifier: Apache-2.0
// labels: unit property oracle
// timeout: 120
// Shadows of single occluders against the exact judge: never a verdict of "hidden" that the judge
// does not share, and none left out that is clear.
#include "oracle.h"

#include "frame.h"
#include "shadow.h"
#include "support.h"
#include "worlds.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// --- one object, one occluder --------------------------------------------------------------------

// A camera whose near plane goes through the eye, so that it cuts nothing away.
static const float all_that_is_ahead[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, -1, 0, 0, 0, 0};

static void set_eye(occ_frame *frame, const double eye[3])
{
    occ_camera_desc desc = {.depth = OCC_DEPTH_ZERO_TO_ONE, .eye = eye};
    const char *reason = "";
    memcpy(desc.view_projection, all_that_is_ahead, sizeof all_that_is_ahead);
    ck_assert_int_eq(occ_camera_init(&frame->camera, &desc, &reason), OCC_SUCCESS);
    ck_assert(!frame->camera.clips_near);
}

// The number of planes of the occluder's shadow, 0 if it has none.
static uint32_t planes_of(const occ_frame *frame, const occ_box *occluder)
{
    occ_shadow shadow;
    if (!occ_shadow_init(&shadow, &frame->camera, occluder, OCC_NOBODY)) return 0;
    return shadow.planes;
}

static bool hides(const occ_frame *frame, const occ_box *occluder, const occ_box *object)
{
    occ_shadow shadow;
    if (!occ_shadow_init(&shadow, &frame->camera, occluder, OCC_NOBODY)) return false;
    occ_relative_box box = occ_frame_relative(frame, object);
    return occ_box_in_shadow(&box, shadow.plane[0], shadow.planes);
}

static bool hides_from(double x, double y, double z, const occ_box *occluder, const occ_box *object)
{
    occ_frame frame = {.hooks = NULL};
    const double eye[3] = {x, y, z};
    set_eye(&frame, eye);
    return hides(&frame, occluder, object);
}

static uint32_t planes_from(double x, double y, double z, const occ_box *occluder)
{
    occ_frame frame = {.hooks = NULL};
    const double eye[3] = {x, y, z};
    set_eye(&frame, eye);
    return planes_of(&frame, occluder);
}

static double distance(const double a[3], const double b[3])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                (a[2] - b[2]) * (a[2] - b[2]));
}

// An aligned box that holds the object with room to spare on every side.
static occ_box with_margin(const occ_box *object, const double eye[3], double part)
{
    occ_box wide = {.axis = {{0}}};
    double center[3], reach = 0.0;
    for (int j = 0; j < 3; j++) {
        wide.center[j] = object->center[j];
        center[j] = (double)object->center[j];
        for (int k = 0; k < 3; k++)
            wide.axis[j][j] += fabsf(object->axis[k][j]);
        reach += (double)wide.axis[j][j];
    }
    float more = (float)((distance(center, eye) + reach) * part);
    for (int j = 0; j < 3; j++)
        wide.axis[j][j] += more;
    return wide;
}

// --- random duels --------------------------------------------------------------------------------

typedef struct duel {
    double eye[3];
    occ_box occluder, object;
} duel;

// A point of the occluder, as often as not on its rim or on a face.
static void pick_point(kit_random *random, const occ_box *box, double out[3])
{
    for (int j = 0; j < 3; j++)
        out[j] = (double)box->center[j];
    for (int k = 0; k < 3; k++) {
        double u = world_between(random, -1, 1);
        if (kit_below(random, 2)) u = u < 0.0 ? -1.0 : 1.0;
        for (int j = 0; j < 3; j++)
            out[j] += u * (double)box->axis[k][j];
    }
}

// An object with one corner next to the line from the eye through a point of the occluder, and the
// others nearer to the shadow's middle.
static void place_object(kit_random *random, duel *d)
{
    double rim[3], corner[3], inward[3], nothing[3] = {0, 0, 0};
    pick_point(random, &d->occluder, rim);
    double factor = 1.0 + world_scale(random, 1e-7, 10);
    for (int j = 0; j < 3; j++) {
        corner[j] = d->eye[j] + factor * (rim[j] - d->eye[j]);
        double middle = d->eye[j] + factor * ((double)d->occluder.center[j] - d->eye[j]);
        inward[j] = middle - corner[j];
    }
    double nudge = world_scale(random, 1e-9, 1) * (kit_below(random, 4) ? 1.0 : -1.0);
    double size = distance(corner, d->eye) * world_scale(random, 1e-6, 0.3);
    world_shape shape = (world_shape)kit_below(random, WORLD_SHAPES);
    d->object = world_box(random, shape, nothing, size);
    for (int j = 0; j < 3; j++)
        corner[j] += nudge * inward[j];
    for (int k = 0; k < 3; k++) {
        double along = 0.0;
        for (int j = 0; j < 3; j++)
            along += (double)d->object.axis[k][j] * inward[j];
        for (int j = 0; j < 3; j++)
            corner[j] += (along < 0.0 ? -1.0 : 1.0) * (double)d->object.axis[k][j];
    }
    for (int j = 0; j < 3; j++)
        d->object.center[j] = (float)corner[j];
}

static duel make_duel(kit_random *random)
{
    duel d;
    double scale = world_scale(random, 1e-6, 1e6), there[3], aside[3], center[3];
    double offset = kit_below(random, 3) ? world_scale(random, 0.01 * scale, 1e7) : 0.0;
    world_direction(random, there);
    world_direction(random, aside);
    double away = scale * world_scale(random, 0.1, 30);
    for (int j = 0; j < 3; j++) {
        center[j] = offset * there[j];
        d.eye[j] = center[j] + away * aside[j];
        if (kit_below(random, 4) == 0) d.eye[j] = (double)(float)d.eye[j];
    }
    world_shape shape = (world_shape)kit_below(random, WORLD_SHAPES);
    d.occluder = world_box(random, shape, center, scale);
    // As often as not the eye is special: level with a face, or in line with an edge.
    for (int k = 0; k < 3 && kit_below(random, 4) == 0; k++)
        for (int j = 0; j < 3; j++)
            d.eye[j] += kit_below(random, 2) ? 0.0 : (double)d.occluder.axis[k][j];
    place_object(random, &d);
    return d;
}

typedef struct tally {
    unsigned hidden, clear, missed;
} tally;

static void fight(const duel *d, unsigned number, tally *sum)
{
    occ_frame frame = {.hooks = NULL};
    set_eye(&frame, d->eye);
    bool hidden = hides(&frame, &d->occluder, &d->object);
    occ_box wide = with_margin(&d->object, d->eye, 1e-4);
    oracle *judge = oracle_of_eye(d->eye);
    if (hidden) {
        sum->hidden++;
        ck_assert_msg(oracle_box(judge, &d->object, &d->occluder) == ORACLE_HIDDEN,
                      "duel %u: hidden, but it can be seen", number);
    }
    bool clear = oracle_box(judge, &wide, &d->occluder) == ORACLE_HIDDEN;
    sum->clear += clear;
    sum->missed += clear && !hidden;
    oracle_free(judge);
}

enum { DUELS = 30000 };

static void fight_all(uint64_t seed)
{
    kit_random random = {seed};
    tally sum = {0, 0, 0};
    for (unsigned i = 0; i < WORLD_SHARE(DUELS); i++) {
        duel d = make_duel(&random);
        fight(&d, i, &sum);
    }
    printf("%u duels: %u hidden, %u clearly so, %u of these missed\n", WORLD_SHARE(DUELS),
           sum.hidden, sum.clear, sum.missed);
    ck_assert_uint_gt(sum.hidden, WORLD_SHARE(DUELS) / 10);
    ck_assert_uint_gt(sum.clear, WORLD_SHARE(DUELS) / 20);
    ck_assert_uint_le(sum.missed * 1000, sum.clear);
}

START_TEST(no_random_shadow_holds_what_can_be_seen_and_clear_cases_are_found)
{
    fight_all((uint64_t)_i + 1);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("shadow");
    TCase *duels = tcase_create("duels");
    tcase_add_loop_test(duels, no_random_shadow_holds_what_can_be_seen_and_clear_cases_are_found, 0, 4);
    suite_add_tcase(suite, duels);
    (void)planes_from; (void)hides_from;
    return test_run_suite(suite);
}
