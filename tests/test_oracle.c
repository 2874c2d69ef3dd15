// SPDX-License-Identifier: Apache-2.0
// The judge itself, where the answer is known without it.
#include "oracle.h"

#include "support.h"
#include "worlds.h"

#include <math.h>

static const double eye_on_x[3] = {8, 0, 0};

static const occ_box unit_cube = {{0, 0, 0}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
static const occ_box unit_sheet = {{0, 0, 0}, {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

static oracle_sight sight(const double eye[3], double x, double y, double z, const occ_box *box)
{
    oracle *judge = oracle_of_eye(eye);
    const double point[3] = {x, y, z};
    oracle_sight answer = oracle_point(judge, point, box);
    oracle_free(judge);
    return answer;
}

static oracle_sight box_sight(const double eye[3], const occ_box *object, const occ_box *occluder)
{
    oracle *judge = oracle_of_eye(eye);
    oracle_sight answer = oracle_box(judge, object, occluder);
    oracle_free(judge);
    return answer;
}

// The rim of the near face seen from (8, 0, 0): lines with slope 1 / 7.
START_TEST(points_behind_in_front_beside_and_on_the_rim_of_a_solid)
{
    ck_assert_int_eq(sight(eye_on_x, -4, 0, 0, &unit_cube), ORACLE_HIDDEN);
    ck_assert_int_eq(sight(eye_on_x, -6, 1.99, 1.99, &unit_cube), ORACLE_HIDDEN);
    ck_assert_int_eq(sight(eye_on_x, -6, 2, 0, &unit_cube), ORACLE_GRAZED);
    ck_assert_int_eq(sight(eye_on_x, -6, 2.01, 0, &unit_cube), ORACLE_SEEN);
    ck_assert_int_eq(sight(eye_on_x, 3, 0, 0, &unit_cube), ORACLE_SEEN);
    ck_assert_int_eq(sight(eye_on_x, 1, 0.5, 0.5, &unit_cube), ORACLE_GRAZED);
    ck_assert_int_eq(sight(eye_on_x, 0.5, 0.5, 0.5, &unit_cube), ORACLE_HIDDEN);
    ck_assert_int_eq(sight(eye_on_x, 16, 0, 0, &unit_cube), ORACLE_SEEN);
}
END_TEST

START_TEST(points_around_a_sheet)
{
    ck_assert_int_eq(sight(eye_on_x, -8, 1.99, 0, &unit_sheet), ORACLE_HIDDEN);
    ck_assert_int_eq(sight(eye_on_x, -8, 2, 0, &unit_sheet), ORACLE_GRAZED);
    ck_assert_int_eq(sight(eye_on_x, -8, 2, 2, &unit_sheet), ORACLE_GRAZED);
    ck_assert_int_eq(sight(eye_on_x, 0, 0, 0, &unit_sheet), ORACLE_GRAZED);
    ck_assert_int_eq(sight(eye_on_x, 1, 0, 0, &unit_sheet), ORACLE_SEEN);
    static const double behind[3] = {-8, 0, 0}, edge_on[3] = {0, 5, 0};
    ck_assert_int_eq(sight(behind, 8, 1.99, 0, &unit_sheet), ORACLE_HIDDEN);
    ck_assert_int_eq(sight(edge_on, 0, -5, 0, &unit_sheet), ORACLE_GRAZED);
    ck_assert_int_eq(sight(edge_on, 0.001, -5, 0, &unit_sheet), ORACLE_SEEN);
}
END_TEST

// Axes y, z and y + z: a hexagon with corners such as (0, 2, 2) and (0, 2, 0).
START_TEST(three_axes_in_one_plane_are_a_hexagon)
{
    const occ_box hexagon = {{0, 0, 0}, {{0, 1, 0}, {0, 0, 1}, {0, 1, 1}}};
    ck_assert_int_eq(sight(eye_on_x, -8, 3.9, 3.9, &hexagon), ORACLE_HIDDEN);
    ck_assert_int_eq(sight(eye_on_x, -8, 4, 4, &hexagon), ORACLE_GRAZED);
    ck_assert_int_eq(sight(eye_on_x, -8, 3.9, -0.05, &hexagon), ORACLE_HIDDEN);
    ck_assert_int_eq(sight(eye_on_x, -8, 3.9, -0.2, &hexagon), ORACLE_SEEN);
    ck_assert_int_eq(sight(eye_on_x, -8, -3.9, 0.2, &hexagon), ORACLE_SEEN);
}
END_TEST

START_TEST(a_segment_and_a_point_are_touched_at_most)
{
    const occ_box segment = {{0, 0, 0}, {{0, 0, 0}, {0, 2, 0}, {0, 1, 0}}};
    const occ_box point = {{0, 1, 0}, {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}};
    ck_assert_int_eq(sight(eye_on_x, -8, 5, 0, &segment), ORACLE_GRAZED);
    ck_assert_int_eq(sight(eye_on_x, -8, 6, 0, &segment), ORACLE_GRAZED);
    ck_assert_int_eq(sight(eye_on_x, -8, 6.1, 0, &segment), ORACLE_SEEN);
    ck_assert_int_eq(sight(eye_on_x, -8, 5, 0.001, &segment), ORACLE_SEEN);
    ck_assert_int_eq(sight(eye_on_x, -8, 2, 0, &point), ORACLE_GRAZED);
    ck_assert_int_eq(sight(eye_on_x, -8, 1, 0, &point), ORACLE_SEEN);
}
END_TEST

START_TEST(an_occluder_that_holds_the_eye_hides_nothing)
{
    static const double inside[3] = {0.5, 0, 0}, on_face[3] = {1, 0, 0}, corner[3] = {1, 1, 1};
    static const double on_sheet[3] = {0, 0.5, 0}, beside[3] = {0, 1.5, 0};
    ck_assert_int_eq(sight(inside, -5, 0, 0, &unit_cube), ORACLE_SEEN);
    ck_assert_int_eq(sight(on_face, -5, 0, 0, &unit_cube), ORACLE_SEEN);
    ck_assert_int_eq(sight(corner, -5, -5, -5, &unit_cube), ORACLE_SEEN);
    ck_assert_int_eq(sight(on_sheet, -5, 0, 0, &unit_sheet), ORACLE_SEEN);
    ck_assert_int_eq(sight(beside, 0, -5, 0, &unit_sheet), ORACLE_GRAZED);
}
END_TEST

START_TEST(the_least_hidden_corner_decides_for_a_box)
{
    occ_box small = kit_cube(-8, 0, 0, 1), large = kit_cube(-8, 0, 0, 4);
    ck_assert_int_eq(box_sight(eye_on_x, &small, &unit_cube), ORACLE_HIDDEN);
    ck_assert_int_eq(box_sight(eye_on_x, &large, &unit_cube), ORACLE_SEEN);
    occ_box flush = kit_cube(-2, 0, 0, 1); // reaches the hidden back face, and behind it
    ck_assert_int_eq(box_sight(eye_on_x, &flush, &unit_cube), ORACLE_HIDDEN);
    ck_assert_int_eq(box_sight(eye_on_x, &unit_cube, &unit_cube), ORACLE_GRAZED);
    occ_box mirrored = {{0, 0, 0}, {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}}};
    ck_assert_int_eq(box_sight(eye_on_x, &small, &mirrored), ORACLE_HIDDEN);
}
END_TEST

START_TEST(the_smallest_float_makes_the_difference)
{
    occ_box sheet = {{0, 0, 0}, {{0, 0, 0}, {0, 1e6f, 0}, {0, 0, 1e6f}}};
    occ_box before = {{0x1p-149f, 0, 0}, {{0}}}, behind = {{-0x1p-149f, 0, 0}, {{0}}};
    occ_box at = {{0, 0, 0}, {{0}}};
    ck_assert_int_eq(box_sight(eye_on_x, &before, &sheet), ORACLE_SEEN);
    ck_assert_int_eq(box_sight(eye_on_x, &at, &sheet), ORACLE_GRAZED);
    ck_assert_int_eq(box_sight(eye_on_x, &behind, &sheet), ORACLE_HIDDEN);
    static const double near_by[3] = {0x1p-1000, 0, 0};
    ck_assert_int_eq(box_sight(near_by, &behind, &sheet), ORACLE_HIDDEN);
    ck_assert_int_eq(box_sight(near_by, &before, &sheet), ORACLE_SEEN);
}
END_TEST

START_TEST(a_direction_casts_parallel_shadows)
{
    static const double toward[3] = {1, 0, 0};
    oracle *judge = oracle_of_direction(toward);
    occ_box behind = kit_cube(-100, 0, 0, 0.9f), flush = kit_cube(-100, 0, 0, 1);
    occ_box beside = kit_cube(-100, 0, 0, 1.1f), before = kit_cube(100, 0, 0, 0.5f);
    ck_assert_int_eq(oracle_box(judge, &behind, &unit_cube), ORACLE_HIDDEN);
    ck_assert_int_eq(oracle_box(judge, &flush, &unit_cube), ORACLE_GRAZED);
    ck_assert_int_eq(oracle_box(judge, &beside, &unit_cube), ORACLE_SEEN);
    ck_assert_int_eq(oracle_box(judge, &before, &unit_cube), ORACLE_SEEN);
    ck_assert_int_eq(oracle_box(judge, &behind, &unit_sheet), ORACLE_HIDDEN);
    oracle_free(judge);
}
END_TEST

// Looks from (1/3, 0, 0) along -z with 90 degrees, near 1, far 3: rows x - w/3 and so on.
static const float third_of_x[16] = {3, 0, 0, 0, 0, 1, 0, 0, 0, 0, -2, -1, -1, 0, -3, 0};

START_TEST(the_eye_of_a_matrix_is_a_fraction)
{
    occ_camera_desc camera = {.depth = OCC_DEPTH_MINUS_ONE_TO_ONE};
    for (int i = 0; i < 16; i++)
        camera.view_projection[i] = third_of_x[i];
    oracle *judge = oracle_of_camera(&camera);
    ck_assert_ptr_nonnull(judge);
    double eye[3];
    ck_assert(oracle_eye(judge, eye));
    ck_assert_double_eq_tol(eye[0], 1.0 / 3.0, 1e-16);
    ck_assert(eye[1] == 0.0 && eye[2] == 0.0);
    oracle_free(judge);
    static const double origin[3] = {10, 20, 30};
    camera.origin = origin;
    judge = oracle_of_camera(&camera);
    ck_assert(oracle_eye(judge, eye));
    ck_assert_double_eq_tol(eye[0], 31.0 / 3.0, 1e-14);
    ck_assert(eye[1] == 20.0 && eye[2] == 30.0);
    oracle_free(judge);
}
END_TEST

// w = -z; z = -2z - 3 runs from -w at w = 1 to w at w = 3.
START_TEST(clip_planes_are_the_matrix_rows)
{
    occ_camera_desc camera = {.depth = OCC_DEPTH_MINUS_ONE_TO_ONE};
    for (int i = 0; i < 16; i++)
        camera.view_projection[i] = third_of_x[i];
    camera.view_projection[0] = 1;
    camera.view_projection[12] = 0;
    static const double given[3] = {100, 0, 0};
    for (int moved = 0; moved < 2; moved++) {
        camera.eye = moved ? given : NULL;
        double x = moved ? 100 : 0;
        oracle *judge = oracle_of_camera(&camera);
        const double near_rim[3] = {x + 1, 1, -1}, before[3] = {x, 0, -0.999}, far[3] = {x, 0, -3};
        const double beyond[3] = {x, 0, -3.001}, aside[3] = {x + 2.001, 0, -2};
        ck_assert(oracle_holds(judge, near_rim));
        ck_assert(!oracle_holds(judge, before));
        ck_assert(oracle_holds(judge, far));
        ck_assert(!oracle_holds(judge, beyond));
        ck_assert(!oracle_holds(judge, aside));
        occ_box touching = kit_cube((float)x, 0, -4, 1), outside = kit_cube((float)x, 0, -5, 1);
        ck_assert(!oracle_outside(judge, &touching));
        ck_assert(oracle_outside(judge, &outside));
        oracle_free(judge);
    }
}
END_TEST

START_TEST(what_the_near_plane_cuts_away_hides_no_point)
{
    occ_camera_desc camera = {.depth = OCC_DEPTH_MINUS_ONE_TO_ONE};
    for (int i = 0; i < 16; i++)
        camera.view_projection[i] = third_of_x[i];
    oracle *judge = oracle_of_camera(&camera);
    const double point[3] = {0.25, 0, -2.5};
    occ_box wall = {{0, 0, -0.5f}, {{9, 0, 0}, {0, 9, 0}, {0, 0, 0}}};
    ck_assert_int_eq(oracle_point(judge, point, &wall), ORACLE_SEEN);
    wall.center[2] = -1; // in the near plane itself
    ck_assert_int_eq(oracle_point(judge, point, &wall), ORACLE_GRAZED);
    wall.center[2] = -1.001f;
    ck_assert_int_eq(oracle_point(judge, point, &wall), ORACLE_HIDDEN);
    ck_assert_int_eq(oracle_box(judge, &(occ_box){{0, 0, -2}, {{0}}}, &wall), ORACLE_HIDDEN);
    oracle_free(judge);
}
END_TEST

START_TEST(a_singular_matrix_has_no_judge)
{
    occ_camera_desc camera = {.depth = OCC_DEPTH_MINUS_ONE_TO_ONE};
    ck_assert_ptr_null(oracle_of_camera(&camera));
    const float flat[16] = {1, 2, 0, 0, 1, 2, 0, 0, 1, 2, 1, 1, 0, 0, 1, 0};
    for (int i = 0; i < 16; i++)
        camera.view_projection[i] = flat[i];
    ck_assert_ptr_null(oracle_of_camera(&camera));
}
END_TEST

// The library's own way to see it, in double: eight corners against the sides of a cone.
START_TEST(random_boxes_agree_with_a_plain_computation)
{
    kit_random random = {1};
    unsigned hidden = 0;
    for (int i = 0; i < 2000; i++) {
        occ_box object = kit_cube(kit_between(&random, -9, -2), kit_between(&random, -2, 2),
                                  kit_between(&random, -2, 2), kit_between(&random, 0.01f, 0.5f));
        bool behind = true;
        for (unsigned c = 0; c < 8; c++) {
            double p[3];
            world_corner(&object, c, p);
            double reach = (8 - p[0]) / 7 - 1e-9; // the near face's cone, at the corner
            behind = behind && p[0] < 1 && fabs(p[1]) < reach && fabs(p[2]) < reach;
        }
        oracle_sight answer = box_sight(eye_on_x, &object, &unit_cube);
        hidden += behind;
        ck_assert_msg((answer == ORACLE_HIDDEN) == behind, "box %d: %d", i, answer);
    }
    ck_assert_uint_gt(hidden, 200);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("oracle");
    TCase *boxes = tcase_create("boxes");
    tcase_add_test(boxes, points_behind_in_front_beside_and_on_the_rim_of_a_solid);
    tcase_add_test(boxes, points_around_a_sheet);
    tcase_add_test(boxes, three_axes_in_one_plane_are_a_hexagon);
    tcase_add_test(boxes, a_segment_and_a_point_are_touched_at_most);
    tcase_add_test(boxes, an_occluder_that_holds_the_eye_hides_nothing);
    tcase_add_test(boxes, the_least_hidden_corner_decides_for_a_box);
    tcase_add_test(boxes, the_smallest_float_makes_the_difference);
    tcase_add_test(boxes, a_direction_casts_parallel_shadows);
    tcase_add_test(boxes, random_boxes_agree_with_a_plain_computation);
    suite_add_tcase(suite, boxes);
    TCase *cameras = tcase_create("cameras");
    tcase_add_test(cameras, the_eye_of_a_matrix_is_a_fraction);
    tcase_add_test(cameras, clip_planes_are_the_matrix_rows);
    tcase_add_test(cameras, what_the_near_plane_cuts_away_hides_no_point);
    tcase_add_test(cameras, a_singular_matrix_has_no_judge);
    suite_add_tcase(suite, cameras);
    return test_run_suite(suite);
}
