// SPDX-License-Identifier: Apache-2.0
// The trial itself: what it counts when truth and answer differ, and what it says of worlds that
// the library refuses.
#include "trial.h"

#include "support.h"

#include <math.h>
#include <occlude/occlude.h>
#include <string.h>

static trial_bench *bench;

static void open_bench(void)
{
    bench = trial_open(OCC_BACKEND_PLAIN, 0);
    ck_assert_ptr_nonnull(bench);
}

static void close_bench(void)
{
    trial_close(bench);
}

static occ_box brick(float x, float y, float z, float half)
{
    return (occ_box){{x, y, z}, {{half, 0, 0}, {0, half, 0}, {0, 0, half}}};
}

// A wall, something behind it, something beside it, and something behind the camera.
static family_world wall(void)
{
    static const float eye[3] = {0, 0, 0}, ahead[3] = {0, 0, -1};
    family_world world = {.object_count = 3, .occluder_count = 1};
    world.camera = world_camera(eye, ahead, NULL);
    world.objects[0] = brick(0, 0, -20, 1);
    world.objects[1] = brick(6, 0, -20, 1);
    world.objects[2] = brick(0, 0, 20, 1);
    world.occluders[0] = (world_occluder){brick(0, 0, -10, 2), -1};
    return world;
}

START_TEST(fates_are_what_can_be_known_by_hand)
{
    family_world world = wall();
    trial_fate fates[FAMILY_OBJECTS];
    trial_effort effort = {0, 0};
    ck_assert(trial_judge(&world, fates, &effort));
    ck_assert_int_eq(fates[0], TRIAL_HIDDEN);
    ck_assert_int_eq(fates[1], TRIAL_SEEN);
    ck_assert_int_eq(fates[2], TRIAL_OUTSIDE);
    ck_assert_uint_gt(effort.signs, 0);
    world.occluders[0].owner = 0;
    ck_assert(trial_judge(&world, fates, NULL));
    ck_assert_int_eq(fates[0], TRIAL_SEEN);
}
END_TEST

static trial_tally tally_of(const family_world *world, const trial_fate *fates, occ_method method)
{
    trial_tally tally = {0};
    const occ_cull_desc knobs = trial_knobs(method);
    ck_assert(trial_run(bench, world, fates, &knobs, &tally));
    ck_assert_uint_eq(tally.worlds, 1);
    ck_assert_uint_eq(tally.verdicts, world->object_count);
    ck_assert_uint_eq(tally.outside + tally.hidden + tally.seen, tally.verdicts);
    return tally;
}

START_TEST(true_answers_count_as_nothing_else)
{
    family_world world = wall();
    const trial_fate fates[] = {TRIAL_HIDDEN, TRIAL_SEEN, TRIAL_OUTSIDE};
    trial_tally tally = tally_of(&world, fates, OCC_METHOD_SINGLE);
    ck_assert_uint_eq(trial_mask(bench), 2);
    ck_assert_uint_eq(tally.false_hidden + tally.missed + tally.generous, 0);
    tally = tally_of(&world, fates, OCC_METHOD_FRUSTUM);
    ck_assert_uint_eq(trial_mask(bench), 3);
    ck_assert_uint_eq(tally.missed, 1);
    ck_assert_uint_eq(tally.false_hidden + tally.generous, 0);
}
END_TEST

// As if the library were wrong: the truth is another.
START_TEST(what_is_seen_but_left_out_is_false_hidden_hidden_or_outside)
{
    family_world world = wall();
    const trial_fate fates[] = {TRIAL_SEEN, TRIAL_HIDDEN, TRIAL_SEEN};
    trial_tally tally = tally_of(&world, fates, OCC_METHOD_SINGLE), twice = tally;
    ck_assert_uint_eq(tally.false_hidden, 2);
    ck_assert_uint_eq(tally.missed, 1);
    trial_add(&twice, &tally);
    ck_assert_uint_eq(twice.false_hidden, 4);
    ck_assert_uint_eq(twice.verdicts, 6);
    const trial_fate nowhere[] = {TRIAL_OUTSIDE, TRIAL_OUTSIDE, TRIAL_OUTSIDE};
    tally = tally_of(&world, nowhere, OCC_METHOD_SINGLE);
    ck_assert_uint_eq(tally.generous, 1);
    ck_assert_uint_eq(tally.false_hidden + tally.missed, 0);
}
END_TEST

START_TEST(a_refused_world_is_an_error_and_counts_nothing)
{
    family_world world = wall();
    trial_tally tally = {0};
    const trial_fate fates[FAMILY_OBJECTS] = {TRIAL_SEEN};
    const occ_cull_desc knobs = trial_knobs(OCC_METHOD_SINGLE);
    world.objects[1].center[0] = NAN;
    ck_assert(!trial_run(bench, &world, fates, &knobs, &tally));
    ck_assert_int_eq(trial_error(bench), OCC_ERROR_NOT_FINITE);
    world = wall();
    memset(world.camera.view_projection, 0, sizeof world.camera.view_projection);
    ck_assert(!trial_run(bench, &world, fates, &knobs, &tally));
    ck_assert_int_eq(trial_error(bench), OCC_ERROR_DEGENERATE_CAMERA);
    ck_assert(!trial_judge(&world, (trial_fate[FAMILY_OBJECTS]){TRIAL_SEEN}, NULL));
    ck_assert_uint_eq(tally.worlds + tally.verdicts, 0);
}
END_TEST

START_TEST(a_backend_that_is_not_there_opens_no_bench)
{
    ck_assert_ptr_null(trial_open((occ_backend)99, 0));
    trial_close(NULL);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("trial");
    TCase *counting = tcase_create("counting");
    tcase_add_checked_fixture(counting, open_bench, close_bench);
    tcase_add_test(counting, fates_are_what_can_be_known_by_hand);
    tcase_add_test(counting, true_answers_count_as_nothing_else);
    tcase_add_test(counting, what_is_seen_but_left_out_is_false_hidden_hidden_or_outside);
    tcase_add_test(counting, a_refused_world_is_an_error_and_counts_nothing);
    tcase_add_test(counting, a_backend_that_is_not_there_opens_no_bench);
    suite_add_tcase(suite, counting);
    return test_run_suite(suite);
}
