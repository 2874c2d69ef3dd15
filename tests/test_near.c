// SPDX-License-Identifier: Apache-2.0
// labels: unit property oracle
// What the near plane cuts away hides nothing, whatever the projection.
#include "oracle.h"

#include "support.h"
#include "verdicts.h"
#include "worlds.h"

#include <math.h>
#include <stdio.h>

// --- by hand -------------------------------------------------------------------------------------

static const float nowhere[3] = {0, 0, 0}, ahead[3] = {0, 0, -1};

static bool hides_ahead(const world_lens *lens, const occ_box *occluder, const occ_box *object)
{
    occ_camera_desc camera = world_camera(nowhere, ahead, lens);
    occ_frame frame = verdict_frame(&camera);
    return verdict_hides(&frame, occluder, object);
}

static occ_box wall_at(float z)
{
    return (occ_box){{0, 0, z}, {{9, 0, 0}, {0, 9, 0}, {0, 0, 0}}};
}

static const world_lens lenses[] = {
    {WORLD_PERSPECTIVE, OCC_DEPTH_MINUS_ONE_TO_ONE, 0, 1, 100},
    {WORLD_PERSPECTIVE, OCC_DEPTH_ZERO_TO_ONE, 0, 1, 100},
    {WORLD_PERSPECTIVE, OCC_DEPTH_ONE_TO_ZERO, 0, 1, 100},
    {WORLD_INFINITE, OCC_DEPTH_MINUS_ONE_TO_ONE, 0, 1, 100},
    {WORLD_INFINITE, OCC_DEPTH_ZERO_TO_ONE, 0, 1, 100},
    {WORLD_INFINITE, OCC_DEPTH_ONE_TO_ZERO, 0, 1, 100},
    {WORLD_OFF_CENTRE, OCC_DEPTH_MINUS_ONE_TO_ONE, 0, 1, 100},
    {WORLD_JITTERED, OCC_DEPTH_ONE_TO_ZERO, 0, 1, 100},
    {WORLD_ORTHOGRAPHIC, OCC_DEPTH_MINUS_ONE_TO_ONE, 1, 1, 100},
    {WORLD_ORTHOGRAPHIC, OCC_DEPTH_ZERO_TO_ONE, 1, 1, 100},
    {WORLD_ORTHOGRAPHIC, OCC_DEPTH_ONE_TO_ZERO, 1, 1, 100},
};
enum { LENSES = sizeof lenses / sizeof *lenses };

START_TEST(a_wall_before_the_near_plane_hides_nothing)
{
    occ_box object = kit_cube(0, 0, -20, 0.5f), before = wall_at(-0.5f), next = wall_at(-0.999f);
    ck_assert(!hides_ahead(&lenses[_i], &before, &object));
    ck_assert(!hides_ahead(&lenses[_i], &next, &object));
}
END_TEST

START_TEST(a_wall_beyond_the_near_plane_hides_what_is_behind_it)
{
    occ_box object = kit_cube(0, 0, -20, 0.5f), beyond = wall_at(-1.01f);
    ck_assert(hides_ahead(&lenses[_i], &beyond, &object));
}
END_TEST

START_TEST(a_box_that_the_near_plane_cuts_open_hides_nothing)
{
    occ_box object = kit_cube(0, 0, -20, 0.1f), cut = kit_cube(0, 0, -1.5f, 1.0f);
    ck_assert(!hides_ahead(&lenses[_i], &cut, &object));
    occ_box whole = kit_cube(0, 0, -2.5f, 1.0f);
    ck_assert(hides_ahead(&lenses[_i], &whole, &object));
}
END_TEST

// Its slab reaches behind the camera, but nothing of it is between the eye and the near rectangle.
START_TEST(the_ground_under_a_camera_hides_a_cellar)
{
    world_lens lens = lenses[_i];
    lens.near_z = 0.1f;
    occ_box ground = {{0, -2, 0}, {{500, 0, 0}, {0, 0.5f, 0}, {0, 0, 500}}};
    occ_box cellar = kit_cube(0, -6, -30, 2);
    if (lens.projection == WORLD_ORTHOGRAPHIC) return; // looks along the ground
    ck_assert(hides_ahead(&lens, &ground, &cellar));
    lens.near_z = 20;
    ck_assert(!hides_ahead(&lens, &ground, &cellar));
}
END_TEST

// Clip z from 1 at the near distance to -1 at the far one, for which there is no name: the planes
// change places, and so does what is cut away.
START_TEST(a_camera_with_near_and_far_exchanged_cuts_all_the_same)
{
    const world_lens exchanged = {WORLD_PERSPECTIVE, OCC_DEPTH_MINUS_ONE_TO_ONE, 0, 100, 1};
    occ_box object = kit_cube(0, 0, -20, 0.5f), before = wall_at(-0.5f), beyond = wall_at(-2);
    ck_assert(!hides_ahead(&exchanged, &before, &object));
    ck_assert(hides_ahead(&exchanged, &beyond, &object));
}
END_TEST

START_TEST(an_immensely_wide_view_is_cut_by_its_near_plane_too)
{
    occ_camera_desc camera = {.depth = OCC_DEPTH_ZERO_TO_ONE}; // z from 1 to 101, along -z
    camera.view_projection[0] = camera.view_projection[5] = 1e-32f;
    camera.view_projection[10] = -0.01f;
    camera.view_projection[14] = -0.01f;
    camera.view_projection[15] = 1;
    occ_frame frame = verdict_frame(&camera);
    occ_box object = kit_cube(0, 0, -20, 0.5f), before = wall_at(-0.5f), beyond = wall_at(-2);
    ck_assert(!verdict_hides(&frame, &before, &object));
    ck_assert(verdict_hides(&frame, &beyond, &object));
}
END_TEST

// Columns of a matrix whose float lost its near plane: the far plane is x = 0, or 8 x + z = 0, by
// an ulp of a row, and the near plane is nearly that of the viewer. The eye is at (x, 4096, -8192).
static occ_camera_desc camera_that_lost_its_near_plane(float x, float slope)
{
    const float ulp = 0x1p-24f;
    return (occ_camera_desc){
        .view_projection = {1, 0, -slope * ulp, 0, 0, 1, 0, 0, 0, 0, slope == 1 ? 1 : 1 - ulp, 1,
                            -x, -4096, 8192, 8192},
        .depth = OCC_DEPTH_ZERO_TO_ONE,
    };
}

static occ_box at_lost(float x, float ahead_of_eye, float half)
{
    return (occ_box){{x, 4096, ahead_of_eye - 8192}, {{half, 0, 0}, {0, 1, 0}, {0, 0, 0}}};
}

// Rounding leaves open on which side of the near plane the eye is, but beyond the far plane it is
// for certain: what cuts is that one, at x = 0, and a wall across it is open there.
START_TEST(an_eye_surely_beyond_the_far_plane_is_not_taken_for_one_before_the_near_plane)
{
    occ_camera_desc camera = camera_that_lost_its_near_plane(-0x1p-14f, 1);
    occ_frame frame = verdict_frame(&camera);
    occ_box across = at_lost(0, 1, 0.5f), inside = at_lost(0.5f, 1, 0.25f);
    occ_box next = at_lost(0x1p-16f, 12, 0), aside = at_lost(6, 12, 0.5f);
    oracle *judge = oracle_of_camera(&camera);
    const double point[3] = {0x1p-16, 4096, -8180};
    ck_assert(oracle_holds(judge, point));
    ck_assert_int_eq(oracle_point(judge, point, &across), ORACLE_SEEN);
    oracle_free(judge);
    ck_assert(!verdict_hides(&frame, &across, &next));
    ck_assert(verdict_hides(&frame, &inside, &aside));
}
END_TEST

// Here it may be beyond either: a wall hides if it is inside of both.
START_TEST(an_eye_that_may_be_beyond_near_or_far_is_taken_for_both)
{
    occ_camera_desc camera = camera_that_lost_its_near_plane(1024, 8);
    occ_frame frame = verdict_frame(&camera);
    ck_assert(frame.camera.far_cuts_too);
    occ_box across = at_lost(1024, 1, 0.5f), next = at_lost(1024, 12, 0.125f);
    ck_assert(!verdict_hides(&frame, &across, &next));
    occ_box inside = at_lost(1025, 1, 0.25f), aside = at_lost(1036, 12, 0.5f);
    ck_assert(verdict_hides(&frame, &inside, &aside));
}
END_TEST

// As water does it: the near plane is the water's, and steep. To the right of where it meets the
// ray x = -z / 2 nothing is drawn, so that the pillar is seen through.
START_TEST(an_oblique_near_plane_cuts_up_to_the_horizon)
{
    occ_camera_desc camera = {.depth = OCC_DEPTH_ZERO_TO_ONE};
    camera.view_projection[0] = camera.view_projection[5] = 1;
    camera.view_projection[11] = -1; // w = -z
    camera.view_projection[2] = -1;  // z = -x - z/2 - 1
    camera.view_projection[10] = -0.5f;
    camera.view_projection[14] = -1;
    occ_frame frame = verdict_frame(&camera);
    oracle *judge = oracle_of_camera(&camera);
    kit_random random = {3};
    unsigned hidden = 0;
    for (int i = 0; i < 20000; i++) {
        const double center[3] = {world_between(&random, -40, 40), 0,
                                  world_between(&random, -40, -1)};
        double factor = world_between(&random, 1.1, 4);
        occ_box occluder = world_box(&random, (world_shape)kit_below(&random, 5), center,
                                     world_scale(&random, 0.1, 60));
        occ_box object = kit_cube((float)(factor * center[0]), 0, (float)(factor * center[2]),
                                  kit_between(&random, 0.01f, 1));
        if (!verdict_hides(&frame, &occluder, &object)) continue;
        for (unsigned c = 0; c < 8; c++) {
            double point[3];
            world_corner(&object, c, point);
            if (!oracle_holds(judge, point)) continue;
            hidden++;
            ck_assert_msg(oracle_point(judge, point, &occluder) == ORACLE_HIDDEN,
                          "corner %u of object %d can be seen", c, i);
        }
    }
    oracle_free(judge);
    ck_assert_uint_gt(hidden, 1000);
}
END_TEST

// --- at random -----------------------------------------------------------------------------------

enum { TRIALS = 20000 };

typedef struct setting {
    occ_camera_desc camera;
    occ_box occluder, object;
} setting;

// An occluder about the near plane, and an object behind it.
static setting make_setting(kit_random *random)
{
    setting s;
    float scale = (float)world_scale(random, 1e-3, 1e3);
    world_lens lens = {.projection = (world_projection)kit_below(random, WORLD_PROJECTIONS),
                       .depth = (occ_depth)kit_below(random, 3),
                       .near_z = scale * (float)world_scale(random, 0.01, 1),
                       .far_z = 1000 * scale};
    lens.height = lens.projection == WORLD_ORTHOGRAPHIC ? 2 * scale : kit_between(random, 0.05f, 3);
    float eye[3], target[3];
    double toward[3], center[3], behind[3], aside[3];
    float offset = kit_below(random, 2) ? 0.0f : 30 * scale;
    world_direction(random, toward);
    world_direction(random, aside);
    double away = (double)lens.near_z * world_scale(random, 0.3, 10);
    double beyond = away * world_scale(random, 1, 20);
    for (int j = 0; j < 3; j++) {
        eye[j] = kit_between(random, -offset, offset);
        target[j] = eye[j] + scale * (float)toward[j];
        center[j] = (double)eye[j] + away * (toward[j] + 0.5 * aside[j]);
        behind[j] = (double)eye[j] + (away + beyond) * (toward[j] + 0.5 * aside[j]);
    }
    s.camera = world_camera(eye, target, &lens);
    s.occluder = world_box(random, (world_shape)kit_below(random, WORLD_SHAPES), center,
                           away * world_scale(random, 0.1, 30));
    s.object = world_box(random, (world_shape)kit_below(random, WORLD_SHAPES), behind,
                         (double)scale * world_scale(random, 1e-4, 1));
    return s;
}

static void random_point(kit_random *random, const occ_box *box, double point[3])
{
    for (int j = 0; j < 3; j++)
        point[j] = (double)box->center[j];
    for (int k = 0; k < 3; k++) {
        double u = (double)kit_between(random, -1, 1);
        for (int j = 0; j < 3; j++)
            point[j] += (double)(float)(u * (double)box->axis[k][j]);
    }
}

START_TEST(no_point_in_the_frustum_of_a_hidden_object_can_be_seen_past_the_near_plane)
{
    kit_random random = {(uint64_t)_i + 10};
    unsigned hidden = 0, points = 0;
    for (int i = 0; i < WORLD_SHARE(TRIALS); i++) {
        setting s = make_setting(&random);
        occ_frame frame = verdict_frame(&s.camera);
        if (!verdict_hides(&frame, &s.occluder, &s.object)) continue;
        hidden++;
        oracle *judge = oracle_of_camera(&s.camera);
        for (unsigned c = 0; c < 24; c++) {
            double point[3];
            if (c < 8) {
                world_corner(&s.object, c, point);
            } else {
                random_point(&random, &s.object, point);
            }
            if (!oracle_holds(judge, point)) continue;
            points++;
            ck_assert_msg(oracle_point(judge, point, &s.occluder) == ORACLE_HIDDEN,
                          "point %u of object %d can be seen", c, i);
        }
        oracle_free(judge);
    }
    printf("%u hidden, %u of their points in the frustum\n", hidden, points);
    ck_assert_uint_gt(hidden, WORLD_SHARE(TRIALS) / 20);
    ck_assert_uint_gt(points, hidden);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("near");
    TCase *by_hand = tcase_create("by hand");
    tcase_add_loop_test(by_hand, a_wall_before_the_near_plane_hides_nothing, 0, LENSES);
    tcase_add_loop_test(by_hand, a_wall_beyond_the_near_plane_hides_what_is_behind_it, 0, LENSES);
    tcase_add_loop_test(by_hand, a_box_that_the_near_plane_cuts_open_hides_nothing, 0, LENSES);
    tcase_add_loop_test(by_hand, the_ground_under_a_camera_hides_a_cellar, 0, LENSES);
    tcase_add_test(by_hand, a_camera_with_near_and_far_exchanged_cuts_all_the_same);
    tcase_add_test(by_hand, an_immensely_wide_view_is_cut_by_its_near_plane_too);
    tcase_add_test(by_hand,
                   an_eye_surely_beyond_the_far_plane_is_not_taken_for_one_before_the_near_plane);
    tcase_add_test(by_hand, an_eye_that_may_be_beyond_near_or_far_is_taken_for_both);
    tcase_add_test(by_hand, an_oblique_near_plane_cuts_up_to_the_horizon);
    suite_add_tcase(suite, by_hand);
    TCase *at_random = tcase_create("at random");
    tcase_add_loop_test(at_random,
                        no_point_in_the_frustum_of_a_hidden_object_can_be_seen_past_the_near_plane,
                        0, 3);
    suite_add_tcase(suite, at_random);
    return test_run_suite(suite);
}
