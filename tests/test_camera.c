// SPDX-License-Identifier: Apache-2.0
// labels: unit property oracle
// What a camera derives from its matrix, against the exact judge and against where it was put.
#include "oracle.h"

#include "support.h"
#include "verdicts.h"
#include "worlds.h"

#include <float.h>
#include <math.h>
#include <stdio.h>

static double length(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static occ_camera init(const occ_camera_desc *desc)
{
    return verdict_frame(desc).camera;
}

// --- eyes and directions -------------------------------------------------------------------------

static world_lens random_lens(kit_random *random)
{
    world_lens lens = {.projection = (world_projection)kit_below(random, WORLD_PROJECTIONS),
                       .depth = (occ_depth)kit_below(random, 3),
                       .near_z = (float)world_scale(random, 1e-3, 10)};
    lens.height = lens.projection == WORLD_ORTHOGRAPHIC ? (float)world_scale(random, 0.1, 1e3)
                                                        : (float)world_scale(random, 1e-3, 3);
    lens.far_z = lens.near_z * (float)world_scale(random, 10, 1e6);
    return lens;
}

static void random_place(kit_random *random, double reach, float eye[3], float target[3])
{
    double toward[3];
    world_direction(random, toward);
    for (int j = 0; j < 3; j++) {
        eye[j] = (float)world_between(random, -reach, reach);
        target[j] = eye[j] + 100 * (float)toward[j];
    }
}

START_TEST(the_eye_of_a_perspective_matrix_is_where_the_camera_was_put)
{
    kit_random random = {1};
    for (int i = 0; i < 2000; i++) {
        float eye[3], target[3];
        double reach = world_scale(&random, 1e-3, 1e4), off[3];
        world_lens lens = random_lens(&random);
        if (lens.projection == WORLD_ORTHOGRAPHIC) continue;
        random_place(&random, reach, eye, target);
        occ_camera_desc desc = world_camera(eye, target, &lens);
        occ_camera camera = init(&desc);
        ck_assert(!camera.orthographic);
        for (int j = 0; j < 3; j++)
            off[j] = camera.eye[j] - (double)eye[j];
        ck_assert_msg(length(off) < 4e-6 * (reach + (double)lens.near_z),
                      "camera %d: the eye is %g from where it was put", i, length(off));
    }
}
END_TEST

START_TEST(an_orthographic_camera_looks_against_the_direction_to_its_viewer)
{
    kit_random random = {2};
    for (int i = 0; i < 500; i++) {
        float eye[3], target[3];
        world_lens lens = random_lens(&random);
        lens.projection = WORLD_ORTHOGRAPHIC;
        random_place(&random, 10, eye, target);
        occ_camera_desc desc = world_camera(eye, target, &lens);
        occ_camera camera = init(&desc);
        ck_assert(camera.orthographic);
        double along = 0.0, size = length(camera.toward);
        for (int j = 0; j < 3; j++)
            along += camera.toward[j] * ((double)eye[j] - (double)target[j]) / (100 * size);
        ck_assert_double_eq_tol(along, 1.0, 1e-5);
    }
}
END_TEST

START_TEST(a_derived_eye_is_as_near_to_the_exact_one_as_the_camera_says)
{
    kit_random random = {3};
    unsigned made = 0;
    for (int i = 0; i < WORLD_SHARE(20000); i++) {
        occ_camera_desc desc = world_skewed_camera(&random, world_scale(&random, 1e-6, 1e6));
        const double origin[3] = {world_between(&random, -1e7, 1e7), 1e-9, 3e7};
        if (kit_below(&random, 2)) desc.origin = origin;
        occ_camera camera;
        const char *reason;
        if (occ_camera_init(&camera, &desc, &reason)) continue;
        made++;
        oracle *judge = oracle_of_camera(&desc);
        double exact[3];
        ck_assert_ptr_nonnull(judge);
        ck_assert(oracle_eye(judge, exact));
        for (int j = 0; j < 3; j++) {
            double off = fabs(camera.eye[j] - exact[j]);
            ck_assert_msg(off <= 0x1p-50 * camera.doubt[j] + 0x1p-52 * fabs(exact[j]),
                          "camera %d: off by %g, it says %g", i, off, 0x1p-50 * camera.doubt[j]);
        }
        oracle_free(judge);
    }
    ck_assert_uint_gt(made, WORLD_SHARE(15000));
}
END_TEST

START_TEST(an_eye_that_is_given_is_taken_as_it_is)
{
    const double eye[3] = {1e7 + 0.001, -1.0 / 3.0, 1e-40};
    occ_camera_desc desc = kit_look((float[3]){1, 2, 3}, (float[3]){4, 5, 6});
    desc.eye = eye;
    occ_camera camera = init(&desc);
    for (int j = 0; j < 3; j++) {
        ck_assert(camera.eye[j] == eye[j] && camera.doubt[j] == 0.0);
        double pair = (double)camera.constants.high[j] + (double)camera.constants.low[j];
        ck_assert_double_le(fabs(pair - eye[j]), fabs(eye[j]) * 0x1p-48 + 0x1p-149);
    }
    for (uint32_t p = 0; p < OCC_NEAR_PLANE; p++)
        ck_assert(camera.plane[p][3] == 0.0);
}
END_TEST

START_TEST(an_origin_is_added_to_what_the_matrix_says)
{
    const double origin[3] = {1e7, 2e7, -3e7};
    occ_camera_desc desc = kit_look((float[3]){0.25f, 0, 0}, (float[3]){0.25f, 0, -1});
    desc.origin = origin;
    occ_camera camera = init(&desc);
    ck_assert_double_eq_tol(camera.eye[0], 1e7 + 0.25, 1e-6);
    ck_assert_double_eq_tol(camera.eye[1], 2e7, 1e-6);
    ck_assert_double_eq_tol(camera.eye[2], -3e7, 1e-6);
}
END_TEST

// --- planes --------------------------------------------------------------------------------------

START_TEST(an_infinite_far_plane_is_no_plane)
{
    for (int depth = 0; depth < 3; depth++) {
        world_lens lens = {.projection = WORLD_INFINITE, .depth = (occ_depth)depth};
        const float eye[3] = {0, 0, 0}, target[3] = {0, 0, -1};
        occ_camera_desc desc = world_camera(eye, target, &lens);
        ck_assert_uint_eq(init(&desc).planes, 0x1f);
        occ_frame frame = verdict_frame(&desc);
        occ_box distant = kit_cube(0, 0, -1e12f, 1);
        ck_assert(!verdict_outside(&frame, &distant));
        lens.projection = WORLD_PERSPECTIVE;
        desc = world_camera(eye, target, &lens);
        ck_assert_uint_eq(init(&desc).planes, 0x3f);
        frame = verdict_frame(&desc);
        ck_assert(verdict_outside(&frame, &distant));
    }
}
END_TEST

// 60 degrees of height: at distance 10 the edges are at 5.7735 up and 10.264 aside.
static void check_edges(const world_lens *lens, double up, double aside)
{
    const float eye[3] = {0, 0, 0}, target[3] = {0, 0, -1};
    occ_camera_desc desc = world_camera(eye, target, lens);
    occ_frame frame = verdict_frame(&desc);
    const double points[6][3] = {{aside, 0, -10}, {-aside, 0, -10}, {0, up, -10},
                                 {0, -up, -10},   {0, 0, -0.1},     {0, 0, -1000}};
    for (int i = 0; i < 6; i++) {
        for (int inside = 0; inside < 2; inside++) {
            // floats hold the planes of depth to some 1e-7 of far over near
            double step = i >= 4 ? 0.01 : 0.001;
            double factor = (i == 4) == (inside == 1) ? 1.0 + step : 1.0 - step;
            occ_box point = {{0, 0, 0}, {{0}}};
            for (int j = 0; j < 3; j++) {
                bool moves = i < 4 ? j < 2 : j == 2;
                point.center[j] = (float)(points[i][j] * (moves ? factor : 1.0));
            }
            ck_assert_msg(verdict_outside(&frame, &point) == !inside, "depth %d, edge %d, %s",
                          (int)lens->depth, i, inside ? "inside" : "outside");
        }
    }
}

START_TEST(objects_just_inside_each_edge_are_kept_and_just_outside_are_not)
{
    for (int depth = 0; depth < 3; depth++) {
        world_lens lens = {.projection = WORLD_PERSPECTIVE, .depth = (occ_depth)depth};
        check_edges(&lens, 10 * tan(1.0471976 / 2), 10 * tan(1.0471976 / 2) * 16 / 9);
        lens.projection = WORLD_ORTHOGRAPHIC;
        check_edges(&lens, 10, 160.0 / 9.0);
    }
}
END_TEST

START_TEST(an_off_centre_view_ends_where_its_matrix_says)
{
    world_lens lens = {.projection = WORLD_OFF_CENTRE};
    const float eye[3] = {0, 0, 0}, target[3] = {0, 0, -1};
    occ_camera_desc desc = world_camera(eye, target, &lens);
    occ_frame frame = verdict_frame(&desc);
    double half = tan(1.0471976 / 2) * 16 / 9; // x = half * (±1 + 0.35) at distance 1
    occ_box inside = kit_cube((float)(100 * half * 1.349), 0, -100, 0);
    occ_box outside = kit_cube((float)(100 * half * 1.351), 0, -100, 0);
    ck_assert(!verdict_outside(&frame, &inside));
    ck_assert(verdict_outside(&frame, &outside));
    inside.center[0] = (float)(-100 * half * 0.649);
    outside.center[0] = (float)(-100 * half * 0.651);
    ck_assert(!verdict_outside(&frame, &inside));
    ck_assert(verdict_outside(&frame, &outside));
}
END_TEST

// A box near the eye or far from it, and as often as not with an axis that just reaches, or just
// does not reach, one of the frustum's planes.
static occ_box random_object(kit_random *random, const occ_camera *camera)
{
    double center[3], toward[3], size = world_scale(random, 1e-6, 1e4);
    world_direction(random, toward);
    double away = kit_below(random, 2) ? size * world_scale(random, 1e-3, 1e6)
                                       : length(camera->eye) * world_scale(random, 1e-7, 1e-1);
    for (int j = 0; j < 3; j++)
        center[j] = camera->eye[j] + away * toward[j];
    occ_box box = world_box(random, (world_shape)kit_below(random, WORLD_SHAPES), center, size);
    if (kit_below(random, 2)) return box;
    const double *plane = camera->plane[kit_below(random, OCC_FRUSTUM_PLANES)];
    double height = plane[3], squared = 0.0;
    for (int j = 0; j < 3; j++) {
        height += plane[j] * ((double)box.center[j] - camera->eye[j]);
        squared += plane[j] * plane[j];
    }
    if (!(squared > 0.0) || !(fabs(height) < 1e12)) return box;
    double share = 1.0 + world_scale(random, 1e-7, 1e-2) * (kit_below(random, 2) ? 1.0 : -1.0);
    for (int j = 0; j < 3; j++) {
        box.axis[0][j] = (float)(share * height / squared * plane[j]);
        box.axis[1][j] = box.axis[2][j] = 0.0f;
    }
    return box;
}

static void check_frusta(uint64_t seed, bool skewed)
{
    kit_random random = {seed};
    unsigned cameras = 0, outside = 0, missed = 0;
    for (int i = 0; i < WORLD_SHARE(2000); i++) {
        float eye[3], target[3];
        double reach = world_scale(&random, 1e-3, 1e6);
        world_lens lens = random_lens(&random);
        random_place(&random, reach, eye, target);
        occ_camera_desc desc =
            skewed ? world_skewed_camera(&random, reach) : world_camera(eye, target, &lens);
        const double given[3] = {reach + 1e-9, -reach / 3.0, 12.5};
        if (kit_below(&random, 3) == 0) desc.eye = given;
        if (kit_below(&random, 3) == 0) desc.origin = given;
        occ_frame frame = {.hooks = NULL};
        const char *reason;
        if (occ_camera_init(&frame.camera, &desc, &reason)) continue;
        cameras++;
        oracle *judge = oracle_of_camera(&desc);
        for (int k = 0; k < 60; k++) {
            occ_box object = random_object(&random, &frame.camera);
            bool found = verdict_outside(&frame, &object);
            outside += found;
            if (!found && k % 8) continue;
            bool exact = oracle_outside(judge, &object);
            ck_assert_msg(exact || !found, "camera %d, object %d is in all planes", i, k);
            if (exact && !found) missed += 8;
        }
        oracle_free(judge);
    }
    printf("%u cameras: %u objects outside, about %u missed\n", cameras, outside, missed);
    ck_assert_uint_gt(cameras, WORLD_SHARE(1000));
    ck_assert_uint_gt(outside, 20 * cameras);
    ck_assert_uint_lt(missed, outside / 10);
}

START_TEST(no_object_that_may_be_in_a_frustum_is_called_outside)
{
    check_frusta(4, false);
}
END_TEST

START_TEST(no_object_that_may_be_in_a_skewed_frustum_is_called_outside)
{
    check_frusta(5, true);
}
END_TEST

// --- what is refused -----------------------------------------------------------------------------

static void refused(const occ_camera_desc *desc, occ_result expected)
{
    occ_camera camera;
    const char *reason = NULL;
    occ_result result = occ_camera_init(&camera, desc, &reason);
    ck_assert_msg(result == expected, "%s", occ_result_name(result));
    ck_assert_ptr_nonnull(reason);
    kit_log log = {.lines = 0};
    occ_view_desc view_desc = {.logger = kit_logger(&log), .backend = OCC_BACKEND_PLAIN};
    occ_view *view = NULL;
    occ_scene *scene = world_scene(NULL, 0, NULL, 0, 0);
    ck_assert_int_eq(occ_view_create(&view_desc, &view), OCC_SUCCESS);
    ck_assert_int_eq(occ_cull(view, scene, desc, NULL), expected);
    ck_assert(kit_logged(&log, reason));
    size_t count;
    ck_assert_int_eq(occ_view_read_mask(view, NULL, 0, &count), OCC_ERROR_NO_RESULT);
    occ_view_destroy(view);
    occ_scene_destroy(scene);
}

static occ_camera_desc plain_camera(void)
{
    return kit_look((float[3]){1, 2, 3}, (float[3]){4, 5, 7});
}

START_TEST(numbers_that_are_not_finite_are_refused_by_name)
{
    const float bad[3] = {NAN, INFINITY, -INFINITY};
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 16; i++) {
            occ_camera_desc desc = plain_camera();
            desc.view_projection[i] = bad[k];
            refused(&desc, OCC_ERROR_NOT_FINITE);
        }
        for (int j = 0; j < 3; j++) {
            double point[3] = {0, 0, 0};
            point[j] = (double)bad[k];
            occ_camera_desc desc = plain_camera();
            desc.eye = point;
            refused(&desc, OCC_ERROR_NOT_FINITE);
            desc.eye = NULL;
            desc.origin = point;
            refused(&desc, OCC_ERROR_NOT_FINITE);
        }
    }
}
END_TEST

START_TEST(an_eye_or_origin_out_of_range_is_refused_by_name)
{
    const double point[3] = {0, 1.0001e15, 0}, largest[3] = {DBL_MAX, 0, 0};
    occ_camera_desc desc = plain_camera();
    desc.eye = point;
    refused(&desc, OCC_ERROR_OUT_OF_RANGE);
    desc.eye = largest;
    refused(&desc, OCC_ERROR_OUT_OF_RANGE);
    desc.eye = NULL;
    desc.origin = point;
    refused(&desc, OCC_ERROR_OUT_OF_RANGE);
    desc = plain_camera(); // the eye that the matrix has
    for (int r = 0; r < 4; r++)
        desc.view_projection[12 + r] *= 1e17f;
    refused(&desc, OCC_ERROR_OUT_OF_RANGE);
}
END_TEST

START_TEST(a_singular_matrix_is_refused_by_name)
{
    occ_camera_desc desc = {.depth = OCC_DEPTH_MINUS_ONE_TO_ONE};
    refused(&desc, OCC_ERROR_DEGENERATE_CAMERA);
    for (int row = 0; row < 4; row++) { // a row without a direction: 2 and 3 have other meanings
        desc = plain_camera();
        for (int c = 0; c < 3; c++)
            desc.view_projection[4 * c + row] = 0;
        if (row < 2) refused(&desc, OCC_ERROR_DEGENERATE_CAMERA);
    }
    desc = plain_camera();
    for (int c = 0; c < 4; c++) // x a multiple of w
        desc.view_projection[4 * c] = 2 * desc.view_projection[4 * c + 3];
    refused(&desc, OCC_ERROR_DEGENERATE_CAMERA);
    const world_lens lens = {.projection = WORLD_ORTHOGRAPHIC};
    desc = world_camera((float[3]){0, 0, 0}, (float[3]){0, 0, -1}, &lens);
    for (int c = 0; c < 3; c++) // orthographic, and its depth does not tell front from back
        desc.view_projection[4 * c + 2] = 0;
    refused(&desc, OCC_ERROR_DEGENERATE_CAMERA);
}
END_TEST

START_TEST(an_unknown_depth_range_is_refused_by_name)
{
    occ_camera_desc desc = plain_camera();
    desc.depth = (occ_depth)3;
    refused(&desc, OCC_ERROR_INVALID_ARGUMENT);
    desc.depth = (occ_depth)-1;
    refused(&desc, OCC_ERROR_INVALID_ARGUMENT);
}
END_TEST

// The matrix times a number is the same camera.
START_TEST(huge_and_denormal_matrices_are_matrices)
{
    const float factors[] = {1e-38f, 1e-30f, 1e30f, 1e35f};
    for (int i = 0; i < 4; i++) {
        occ_camera_desc desc = kit_look((float[3]){0, 0, 0}, (float[3]){0, 0, -1});
        for (int k = 0; k < 16; k++)
            desc.view_projection[k] *= factors[i];
        occ_frame frame = verdict_frame(&desc);
        occ_box ahead = kit_cube(0, 0, -5, 1), behind = kit_cube(0, 0, 5, 1);
        occ_box wall = {{0, 0, -3}, {{9, 0, 0}, {0, 9, 0}, {0, 0, 0}}};
        ck_assert(!verdict_outside(&frame, &ahead));
        ck_assert(verdict_outside(&frame, &behind));
        ck_assert(verdict_hides(&frame, &wall, &ahead));
        ck_assert(!verdict_hides(&frame, &wall, &behind));
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("camera");
    TCase *eyes = tcase_create("eyes");
    tcase_add_test(eyes, the_eye_of_a_perspective_matrix_is_where_the_camera_was_put);
    tcase_add_test(eyes, an_orthographic_camera_looks_against_the_direction_to_its_viewer);
    tcase_add_test(eyes, a_derived_eye_is_as_near_to_the_exact_one_as_the_camera_says);
    tcase_add_test(eyes, an_eye_that_is_given_is_taken_as_it_is);
    tcase_add_test(eyes, an_origin_is_added_to_what_the_matrix_says);
    suite_add_tcase(suite, eyes);
    TCase *planes = tcase_create("planes");
    tcase_add_test(planes, an_infinite_far_plane_is_no_plane);
    tcase_add_test(planes, objects_just_inside_each_edge_are_kept_and_just_outside_are_not);
    tcase_add_test(planes, an_off_centre_view_ends_where_its_matrix_says);
    tcase_add_test(planes, no_object_that_may_be_in_a_frustum_is_called_outside);
    tcase_add_test(planes, no_object_that_may_be_in_a_skewed_frustum_is_called_outside);
    suite_add_tcase(suite, planes);
    TCase *refusals = tcase_create("refusals");
    tcase_add_test(refusals, numbers_that_are_not_finite_are_refused_by_name);
    tcase_add_test(refusals, an_eye_or_origin_out_of_range_is_refused_by_name);
    tcase_add_test(refusals, a_singular_matrix_is_refused_by_name);
    tcase_add_test(refusals, an_unknown_depth_range_is_refused_by_name);
    tcase_add_test(refusals, huge_and_denormal_matrices_are_matrices);
    suite_add_tcase(suite, refusals);
    return test_run_suite(suite);
}
