// SPDX-License-Identifier: Apache-2.0
// What the box helpers refuse: by name, and with the result left alone.
#include "box.h"
#include "kit.h"
#include "support.h"

#include <float.h>
#include <math.h>
#include <string.h>

static const float good_model[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1};
static const float good_min[3] = {-1, -2, -3}, good_max[3] = {1, 2, 3};

// A bad number and what it is called; what is finite and too large only for a box stands last.
static const struct {
    float number;
    occ_result result;
} bad[] = {
    {NAN, OCC_ERROR_NOT_FINITE},       {-NAN, OCC_ERROR_NOT_FINITE},
    {INFINITY, OCC_ERROR_NOT_FINITE},  {-INFINITY, OCC_ERROR_NOT_FINITE},
    {FLT_MAX, OCC_ERROR_OUT_OF_RANGE}, {1.001e15f, OCC_ERROR_OUT_OF_RANGE},
};
enum { BAD = (int)(sizeof bad / sizeof *bad), NOT_FINITE = 4 };

static const occ_box untouched = {{42, 43, 44}, {{45, 46, 47}, {48, 49, 50}, {51, 52, 53}}};

#define CHECK_REFUSED(call, expected)                                                              \
    do {                                                                                           \
        occ_box box = untouched;                                                                   \
        occ_result result = (call);                                                                \
        ck_assert_str_eq(occ_result_name(result), occ_result_name(expected));                      \
        ck_assert_mem_eq(&box, &untouched, sizeof box);                                            \
    } while (0)

START_TEST(bad_number_in_min_or_max_is_refused)
{
    for (int j = 0; j < 3; j++) {
        float min[3], max[3];
        memcpy(min, good_min, sizeof min);
        memcpy(max, good_max, sizeof max);
        max[j] = bad[_i].number;
        CHECK_REFUSED(occ_box_from_min_max(min, max, &box), bad[_i].result);
        max[j] = good_max[j];
        min[j] = -bad[_i].number;
        CHECK_REFUSED(occ_box_from_min_max(min, max, &box), bad[_i].result);
    }
}
END_TEST

START_TEST(bad_number_in_a_point_is_refused)
{
    float points[7][3] = {{0}};
    for (int k = 0; k < 21; k++) {
        points[k / 3][k % 3] = bad[_i].number;
        CHECK_REFUSED(occ_box_from_points(points[0], 7, 0, &box), bad[_i].result);
        points[k / 3][k % 3] = 0.0f;
    }
}
END_TEST

START_TEST(bad_number_in_a_model_is_refused)
{
    for (int k = 0; k < 16; k++) {
        float model[16];
        memcpy(model, good_model, sizeof model);
        model[k] = bad[_i].number;
        bool affine = k % 4 != 3 || _i < NOT_FINITE;
        CHECK_REFUSED(occ_box_from_model(model, good_min, good_max, &box),
                      affine ? bad[_i].result : OCC_ERROR_INVALID_ARGUMENT);
    }
}
END_TEST

START_TEST(bad_number_in_a_local_box_is_refused)
{
    for (int j = 0; j < 3; j++) {
        float min[3], max[3];
        memcpy(min, good_min, sizeof min);
        memcpy(max, good_max, sizeof max);
        max[j] = bad[_i].number;
        CHECK_REFUSED(occ_box_from_model(good_model, min, max, &box), bad[_i].result);
        max[j] = good_max[j];
        min[j] = -bad[_i].number;
        CHECK_REFUSED(occ_box_from_model(good_model, min, max, &box), bad[_i].result);
    }
}
END_TEST

START_TEST(projective_matrix_is_no_model)
{
    static const float last_row[4] = {0, 0, 0, 1};
    for (int c = 0; c < 4; c++) {
        float model[16];
        memcpy(model, good_model, sizeof model);
        model[4 * c + 3] = last_row[c] + 0x1p-20f;
        CHECK_REFUSED(occ_box_from_model(model, good_min, good_max, &box),
                      OCC_ERROR_INVALID_ARGUMENT);
    }
}
END_TEST

START_TEST(min_above_max_is_refused)
{
    for (int j = 0; j < 3; j++) {
        float max[3];
        memcpy(max, good_max, sizeof max);
        max[j] = nextafterf(good_min[j], -10.0f);
        CHECK_REFUSED(occ_box_from_min_max(good_min, max, &box), OCC_ERROR_INVALID_ARGUMENT);
        CHECK_REFUSED(occ_box_from_model(good_model, good_min, max, &box),
                      OCC_ERROR_INVALID_ARGUMENT);
    }
}
END_TEST

START_TEST(missing_arguments_are_refused)
{
    const occ_result invalid = OCC_ERROR_INVALID_ARGUMENT;
    CHECK_REFUSED(occ_box_from_min_max(NULL, good_max, &box), invalid);
    CHECK_REFUSED(occ_box_from_min_max(good_min, NULL, &box), invalid);
    CHECK_REFUSED(occ_box_from_min_max(good_min, good_max, NULL), invalid);
    CHECK_REFUSED(occ_box_from_model(NULL, good_min, good_max, &box), invalid);
    CHECK_REFUSED(occ_box_from_model(good_model, NULL, good_max, &box), invalid);
    CHECK_REFUSED(occ_box_from_model(good_model, good_min, NULL, &box), invalid);
    CHECK_REFUSED(occ_box_from_model(good_model, good_min, good_max, NULL), invalid);
    CHECK_REFUSED(occ_box_from_points(NULL, 1, 0, &box), invalid);
    CHECK_REFUSED(occ_box_from_points(good_min, 1, 0, NULL), invalid);
}
END_TEST

START_TEST(no_points_have_no_bounds)
{
    CHECK_REFUSED(occ_box_from_points(good_min, 0, 0, &box), OCC_ERROR_INVALID_ARGUMENT);
}
END_TEST

START_TEST(stride_shorter_than_a_point_is_refused)
{
    for (size_t stride = 1; stride < 12; stride++)
        CHECK_REFUSED(occ_box_from_points(good_min, 1, stride, &box), OCC_ERROR_INVALID_ARGUMENT);
}
END_TEST

START_TEST(every_bad_number_of_a_box_has_its_name)
{
    for (int k = 0; k < 12; k++) {
        occ_box box = kit_cube(1, 2, 3, 4);
        float *number = k < 3 ? &box.center[k] : &box.axis[k / 3 - 1][k % 3];
        ck_assert_int_eq(occ_box_check(&box), OCC_SUCCESS);
        *number = bad[_i].number;
        ck_assert_str_eq(occ_result_name(occ_box_check(&box)), occ_result_name(bad[_i].result));
    }
}
END_TEST

START_TEST(corner_decides_whether_a_box_is_too_large)
{
    // No single number is too large, but a corner is.
    occ_box box = kit_cube(6e14f, 0, 0, 4e14f);
    ck_assert_int_eq(occ_box_check(&box), OCC_ERROR_OUT_OF_RANGE);
    box = kit_cube(5e14f, 0, 0, 4e14f);
    ck_assert_int_eq(occ_box_check(&box), OCC_SUCCESS);
    box.axis[1][0] = -2e14f;
    ck_assert_int_eq(occ_box_check(&box), OCC_ERROR_OUT_OF_RANGE);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("box_input");
    TCase *refused = tcase_create("refused");
    tcase_add_loop_test(refused, bad_number_in_min_or_max_is_refused, 0, BAD);
    tcase_add_loop_test(refused, bad_number_in_a_point_is_refused, 0, BAD);
    tcase_add_loop_test(refused, bad_number_in_a_model_is_refused, 0, BAD);
    tcase_add_loop_test(refused, bad_number_in_a_local_box_is_refused, 0, BAD);
    tcase_add_test(refused, projective_matrix_is_no_model);
    tcase_add_test(refused, min_above_max_is_refused);
    tcase_add_test(refused, missing_arguments_are_refused);
    tcase_add_test(refused, no_points_have_no_bounds);
    tcase_add_test(refused, stride_shorter_than_a_point_is_refused);
    tcase_add_loop_test(refused, every_bad_number_of_a_box_has_its_name, 0, BAD);
    tcase_add_test(refused, corner_decides_whether_a_box_is_too_large);
    suite_add_tcase(suite, refused);
    return test_run_suite(suite);
}
