// SPDX-License-Identifier: Apache-2.0
// The judge of many occluders before directions, boxes of eyes and clip planes, where the answer is
// known by hand.
#include "judge_scenes.h"

#include "support.h"

// --- directions ----------------------------------------------------------------------------------

START_TEST(a_direction_casts_parallel_shadows)
{
    static const double toward[3] = {1, 0, 0};
    occ_box panels[2] = {panel(0, -4, 0, -4, 4), panel(1e6f, 0, 4, -4, 4)};
    occ_box wall = block(-1e6f, -8, -4, 4, -4, 4), before = block(1e6f, 2e6f, -4, 4, -4, 4);
    judge *j = judge_of_direction(toward);
    ck_assert(!ask(j, &wall, panels, 2));
    ck_assert(ask(j, &before, panels, 2));
    wall.axis[1][1] = nextafterf(4, 5);
    ck_assert(ask(j, &wall, panels, 2));
    judge_free(j);
}
END_TEST

// --- boxes of eyes -------------------------------------------------------------------------------

static judge_sight from_box(const occ_box *eyes, const occ_box *object, const occ_box *occluder)
{
    judge_sight exact = judge_single_from(eyes, object, occluder, false);
    ck_assert_int_eq(judge_single_from(eyes, object, occluder, true), exact);
    return exact;
}

START_TEST(hidden_from_every_eye_in_a_box)
{
    occ_box eyes = kit_cube(8, 0, 0, 1), wall = panel(0, -4, 4, -4, 4);
    // The narrowest shadow: from (9, 1) past (0, 4), on a line with slope -1 / 3.
    occ_box small = panel(-8, -6.5f, 6.5f, -6.5f, 6.5f), exact = panel(-9, -7, 7, -7, 7);
    occ_box more = panel(-9, -7, nextafterf(7, 8), -7, 7);
    more.center[1] = nextafterf(0, 1);
    more.axis[1][1] = 7;
    ck_assert_int_eq(from_box(&eyes, &small, &wall), JUDGE_HIDDEN);
    ck_assert_int_eq(from_box(&eyes, &exact, &wall), JUDGE_GRAZED);
    ck_assert_int_eq(from_box(&eyes, &more, &wall), JUDGE_SEEN);
    occ_box flush = kit_cube(-7, 0, 0, 7);
    ck_assert_int_eq(from_box(&eyes, &flush, &wall), JUDGE_SEEN);
    flush = block(-9, 0, -4, 4, -4, 4); // its face is the sheet
    ck_assert_int_eq(from_box(&eyes, &flush, &wall), JUDGE_GRAZED);
    occ_box within = kit_cube(0, 0, 0, 8.0f);
    ck_assert_int_eq(from_box(&within, &small, &wall),
                     JUDGE_SEEN); // the occluder is among the eyes
}
END_TEST

// A corner of the occluder reaches into the box of eyes, though all 64 segments meet it.
START_TEST(an_occluder_among_the_eyes_hides_nothing)
{
    occ_box eyes = kit_cube(0, 0, 0, 1), object = {{-9, 0, 0}, {{0}}};
    occ_box wedge = {{-4.5f, 0, 0}, {{2, 2, 0}, {2, -2, 0}, {0, 0, 4}}}; // an edge at x = -0.5
    ck_assert_int_eq(from_box(&eyes, &object, &wedge), JUDGE_SEEN);
    wedge.center[0] = -5; // touches
    ck_assert_int_eq(from_box(&eyes, &object, &wedge), JUDGE_SEEN);
    wedge.center[0] = -5.0001f;
    object.center[0] = -10;
    ck_assert_int_eq(from_box(&eyes, &object, &wedge), JUDGE_HIDDEN);
}
END_TEST

// --- clip planes ---------------------------------------------------------------------------------

// From (8, 0, 0) along -x, 90 degrees, near plane at x = 7, far plane at infinity: w = 8 - x, clip
// x = z, clip y = y, clip z = w - 1, from 0.
static judge *quarter_view(const double *eye)
{
    occ_camera_desc camera = {
        .view_projection = {0, 0, -1, -1, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 7, 8},
        .depth = OCC_DEPTH_ZERO_TO_ONE,
        .eye = eye,
    };
    judge *j = judge_of_camera(&camera);
    ck_assert_ptr_nonnull(j);
    return j;
}

START_TEST(inside_crossing_and_outside)
{
    judge *j = quarter_view(NULL);
    occ_box inside = kit_cube(0, 0, 0, 1), crossing = kit_cube(0, 8, 0, 1);
    occ_box touching = kit_cube(-1, 11, 0, 1), beyond = kit_cube(20, 0, 0, 1);
    occ_box corner = kit_cube(7.5f, 0, 0, 0.5f), rim = kit_cube(7.5f, 0, 0, 0.75f);
    occ_box all = kit_cube(0, 0, 0, 100), beside = kit_cube(7, 3, 3, 1.5f);
    ck_assert_int_eq(judge_frustum(j, &inside), JUDGE_INSIDE);
    ck_assert_int_eq(judge_frustum(j, &crossing), JUDGE_CROSSING);
    ck_assert_int_eq(judge_frustum(j, &touching), JUDGE_OUTSIDE); // (-2, 10, z) is on a plane
    ck_assert_int_eq(judge_frustum(j, &beyond), JUDGE_OUTSIDE);
    ck_assert_int_eq(judge_frustum(j, &corner), JUDGE_OUTSIDE); // its face is in the near plane
    ck_assert_int_eq(judge_frustum(j, &rim), JUDGE_CROSSING);
    ck_assert_int_eq(judge_frustum(j, &all), JUDGE_CROSSING);
    ck_assert_int_eq(judge_frustum(j, &beside), JUDGE_CROSSING); // (5.5, 1.5, 1.5) is in
    occ_box dot = {{7, 1, 1}, {{0}}}, line = {{7, 2, 0}, {{0, 1, 0}, {0}, {0}}};
    ck_assert_int_eq(judge_frustum(j, &dot), JUDGE_INSIDE);
    ck_assert_int_eq(judge_frustum(j, &line), JUDGE_OUTSIDE); // its end is on a plane
    judge_free(j);
}
END_TEST

// Outside of no single plane, and yet outside: it passes the near corner of the frustum.
START_TEST(outside_though_no_plane_tells)
{
    judge *j = quarter_view(NULL);
    occ_box beam = {{7.125f, 1.125f, 0}, {{0.5f, -1, 0}, {0.03125f, 0.015625f, 0}, {0, 0, 0.5f}}};
    ck_assert_int_eq(judge_frustum(j, &beam), JUDGE_OUTSIDE);
    ck_assert(!ask(j, &beam, NULL, 0));
    beam.center[0] = 6.9375f;
    ck_assert_int_eq(judge_frustum(j, &beam), JUDGE_CROSSING);
    ck_assert(ask(j, &beam, NULL, 0));
    judge_free(j);
}
END_TEST

START_TEST(what_is_seen_must_be_inside)
{
    judge *j = quarter_view(NULL);
    occ_box wall = panel(-8, 0, 32, -4, 4), below = panel(0, 0, 8, -2, 2);
    ck_assert(
        !ask(j, &wall, &below, 1)); // at x = -8 the view ends at y = 16, and so does the shadow
    occ_box less = panel(0, 0, nextafterf(8, 0), -2, 2);
    less.center[1] = nextafterf(4, 0);
    less.axis[1][1] = 4;
    ck_assert(ask(j, &wall, &less, 1));
    occ_box outside = panel(-8, 16, 32, -4, 4);
    ck_assert(!ask(j, &outside, NULL, 0));
    outside.center[1] = nextafterf(24, 0);
    ck_assert(ask(j, &outside, NULL, 0));
    judge_free(j);
}
END_TEST

START_TEST(the_near_plane_opens_objects_and_occluders)
{
    judge *j = quarter_view(NULL);
    occ_box object = block(-8, 7.5f, -0.5f, 0.5f, -0.5f, 0.5f), shield = panel(6.5f, -4, 4, -4, 4);
    ck_assert(ask(j, &object, &shield, 1)); // its cut at x = 7 is before the shield
    occ_box at_near = panel(7, -4, 4, -4, 4), before = panel(7.25f, -4, 4, -4, 4);
    ck_assert(!ask(j, &object, &at_near, 1));
    ck_assert(ask(j, &object, &before, 1)); // it is not drawn
    // A ramp from (7.5, -1) to (6.5, 1): the near plane leaves what is above y = 0.
    occ_box ramp = {{7, 0, 0}, {{-0.5f, 1, 0}, {0, 0, 4}, {0, 0, 0}}};
    occ_box above = panel(-8, 0, 8, -8, 8), across = panel(-8, -0.125f, 8, -8, 8);
    ck_assert(!ask(j, &above, &ramp, 1));
    ck_assert(ask(j, &across, &ramp, 1));
    judge_free(j);
}
END_TEST

START_TEST(planes_are_carried_to_a_given_eye)
{
    static const double elsewhere[3] = {1e6 + 0x1p-30, 0, 0};
    judge *j = quarter_view(elsewhere);
    occ_box inside = kit_cube(1e6f - 8, 0, 0, 1), outside = kit_cube(0, 2e6f, 0, 1);
    occ_box ahead = kit_cube(1e6f + 1, 0, 0, 1), away = kit_cube(1e6f + 8, 0, 0, 1);
    ck_assert_int_eq(judge_frustum(j, &inside), JUDGE_INSIDE);
    ck_assert_int_eq(judge_frustum(j, &outside), JUDGE_OUTSIDE);
    ck_assert_int_eq(judge_frustum(j, &ahead), JUDGE_OUTSIDE);
    ck_assert_int_eq(judge_frustum(j, &away), JUDGE_OUTSIDE);
    judge_free(j);
    occ_camera_desc singular = {
        .view_projection = {0, 0, -1, -1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 7, 8}};
    ck_assert_ptr_null(judge_of_camera(&singular));
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("judge_cameras");
    TCase *cameras = tcase_create("cameras");
    tcase_add_test(cameras, a_direction_casts_parallel_shadows);
    tcase_add_test(cameras, hidden_from_every_eye_in_a_box);
    tcase_add_test(cameras, an_occluder_among_the_eyes_hides_nothing);
    tcase_add_test(cameras, inside_crossing_and_outside);
    tcase_add_test(cameras, outside_though_no_plane_tells);
    tcase_add_test(cameras, what_is_seen_must_be_inside);
    tcase_add_test(cameras, the_near_plane_opens_objects_and_occluders);
    tcase_add_test(cameras, planes_are_carried_to_a_given_eye);
    suite_add_tcase(suite, cameras);
    return test_run_suite(suite);
}
