// SPDX-License-Identifier: Apache-2.0
// Floats are rationals: what lies inside a box is decided exactly, by GMP.
#include "box.h"
#include "kit.h"
#include "support.h"

#include <gmp.h>
#include <math.h>
#include <string.h>

// Whether point lies in [center - half, center + half].
static bool holds(float center, float half, float point)
{
    mpq_t c, h, p;
    mpq_inits(c, h, p, NULL);
    mpq_set_d(c, (double)center);
    mpq_set_d(h, (double)half);
    mpq_set_d(p, (double)point);
    mpq_sub(p, p, c);
    mpq_abs(p, p);
    bool inside = mpq_cmp(p, h) <= 0;
    mpq_clears(c, h, p, NULL);
    return inside;
}

static void check_axis_aligned(const occ_box *box)
{
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3; j++)
            KIT_CHECK(j == k ? box->axis[k][j] >= 0.0f : box->axis[k][j] == 0.0f,
                      "axis %d is not along itself", k);
}

// The box holds every point, and with half sizes smaller by two floats it would not.
static void check_bounds(const occ_box *box, float (*points)[3], size_t count)
{
    check_axis_aligned(box);
    for (int j = 0; j < 3; j++) {
        float center = box->center[j], half = box->axis[j][j], smaller;
        smaller = nextafterf(nextafterf(half, 0.0f), 0.0f);
        bool needed = half == 0.0f;
        for (size_t i = 0; i < count; i++) {
            KIT_CHECK(holds(center, half, points[i][j]), "%a is outside %a +- %a",
                      (double)points[i][j], (double)center, (double)half);
            needed = needed || !holds(center, smaller, points[i][j]);
        }
        KIT_CHECK(needed, "%a +- %a is larger than it need be", (double)center, (double)half);
    }
}

// --- kinds of points -----------------------------------------------------------------------------

static float unit(kit_random *random)
{
    return kit_between(random, -1, 1);
}

static float huge(kit_random *random)
{
    return kit_between(random, -4e14f, 4e14f);
}

static float denormal(kit_random *random)
{
    return kit_between(random, -0x1p-127f, 0x1p-127f);
}

static float of_any_size(kit_random *random)
{
    return ldexpf(unit(random), (int)kit_below(random, 190) - 145);
}

static float negative(kit_random *random)
{
    return kit_between(random, -7, -3);
}

static float far_away(kit_random *random)
{
    return kit_between(random, 1e7f, 1e7f + 3.0f);
}

static float huge_or_tiny(kit_random *random)
{
    return kit_below(random, 2) ? huge(random) : denormal(random);
}

typedef float (*number_maker)(kit_random *random);
static const number_maker kinds[] = {unit,     huge,     denormal,    of_any_size,
                                     negative, far_away, huge_or_tiny};
enum { KINDS = (int)(sizeof kinds / sizeof *kinds), POINTS = 12 };

START_TEST(bounds_of_points_hold_every_point_exactly)
{
    kit_random random = {(uint64_t)_i};
    for (int round = 0; round < 300; round++) {
        float points[POINTS][3];
        size_t count = 1 + kit_below(&random, POINTS);
        for (size_t i = 0; i < 3 * count; i++)
            points[i / 3][i % 3] = kinds[_i](&random);
        occ_box box;
        KIT_CHECK(!occ_box_from_points(points[0], count, 0, &box), "points are refused");
        check_bounds(&box, points, count);
    }
}
END_TEST

START_TEST(box_of_min_and_max_holds_both_exactly)
{
    kit_random random = {(uint64_t)_i};
    for (int round = 0; round < 500; round++) {
        float ends[2][3];
        for (int j = 0; j < 3; j++) {
            float a = kinds[_i](&random), b = kinds[_i](&random);
            ends[0][j] = fminf(a, b);
            ends[1][j] = fmaxf(a, b);
        }
        occ_box box;
        KIT_CHECK(!occ_box_from_min_max(ends[0], ends[1], &box), "a range is refused");
        check_bounds(&box, ends, 2);
    }
}
END_TEST

START_TEST(single_point_makes_a_point_box)
{
    kit_random random = {(uint64_t)_i};
    for (int round = 0; round < 100; round++) {
        float point[3];
        for (int j = 0; j < 3; j++)
            point[j] = kinds[_i](&random);
        occ_box box;
        KIT_CHECK(!occ_box_from_points(point, 1, 0, &box), "a point is refused");
        for (int j = 0; j < 3; j++)
            KIT_CHECK(box.center[j] == point[j] && box.axis[j][j] == 0.0f, "it is no point");
    }
}
END_TEST

START_TEST(stride_leads_from_point_to_point)
{
    struct vertex {
        float position[3];
        char other[9]; // so that points are not aligned
    } vertices[20];
    memset(vertices, 0x7f, sizeof vertices);
    kit_random random = {3};
    float points[20][3];
    for (int i = 0; i < 60; i++)
        vertices[i / 3].position[i % 3] = points[i / 3][i % 3] = unit(&random);
    occ_box strided, packed;
    const float *first = vertices[0].position;
    ck_assert_int_eq(occ_box_from_points(first, 20, sizeof *vertices, &strided), OCC_SUCCESS);
    ck_assert_int_eq(occ_box_from_points(points[0], 20, 12, &packed), OCC_SUCCESS);
    ck_assert_mem_eq(&strided, &packed, sizeof packed);
}
END_TEST

START_TEST(largest_coordinates_are_accepted)
{
    const float max[3] = {OCC_MAX_COORDINATE, OCC_MAX_COORDINATE, OCC_MAX_COORDINATE};
    const float min[3] = {-OCC_MAX_COORDINATE, 0.0f, OCC_MAX_COORDINATE};
    occ_box box;
    ck_assert_int_eq(occ_box_from_min_max(min, max, &box), OCC_SUCCESS);
    ck_assert(box.axis[0][0] == OCC_MAX_COORDINATE && box.axis[2][2] == 0.0f);
}
END_TEST

// --- models --------------------------------------------------------------------------------------

static const float identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

// |value - exact| <= half a step of value's floats, with `slack` for the double that was rounded.
static void check_nearest(float value, const mpq_t exact, double slack)
{
    mpq_t difference, bound;
    mpq_inits(difference, bound, NULL);
    mpq_set_d(difference, (double)value);
    mpq_sub(difference, difference, exact);
    mpq_abs(difference, difference);
    double magnitude = fabs((double)value);
    mpq_set_d(bound, 0.5 * ((double)nextafterf(fabsf(value), INFINITY) - magnitude) + slack);
    KIT_CHECK(mpq_cmp(difference, bound) <= 0, "%a is not the nearest float", (double)value);
    mpq_clears(difference, bound, NULL);
}

// Adds a * (b + sign * c) / 2.
static void add_product(mpq_t sum, float a, float b, int sign, float c)
{
    mpq_t term, other;
    mpq_inits(term, other, NULL);
    mpq_set_d(term, (double)b);
    mpq_set_d(other, (double)sign * (double)c);
    mpq_add(term, term, other);
    mpq_set_d(other, 0.5 * (double)a);
    mpq_mul(term, term, other);
    mpq_add(sum, sum, term);
    mpq_clears(term, other, NULL);
}

static void check_image(const float *model, const float *min, const float *max, const occ_box *box)
{
    mpq_t exact;
    mpq_init(exact);
    for (int j = 0; j < 3; j++) {
        double entered = fabs((double)model[12 + j]);
        for (int k = 0; k < 3; k++) {
            mpq_set_ui(exact, 0, 1);
            add_product(exact, model[4 * k + j], max[k], -1, min[k]);
            double size =
                fabs((double)model[4 * k + j]) * (fabs((double)min[k]) + fabs((double)max[k]));
            check_nearest(box->axis[k][j], exact, size * 0x1p-51);
            entered += size;
        }
        mpq_set_d(exact, (double)model[12 + j]);
        for (int k = 0; k < 3; k++)
            add_product(exact, model[4 * k + j], max[k], 1, min[k]);
        check_nearest(box->center[j], exact, entered * 0x1p-50);
    }
    mpq_clear(exact);
}

START_TEST(model_carries_a_box_to_its_image_rounded_once)
{
    static const float scales[] = {1.0f, 1e-6f, 1e6f, 1e-20f};
    kit_random random = {11};
    for (int round = 0; round < 1000; round++) {
        float model[16], min[3], max[3];
        memcpy(model, identity, sizeof model);
        for (int j = 0; j < 3; j++) {
            for (int k = 0; k < 4; k++)
                model[4 * k + j] = unit(&random) * scales[round % 4];
            min[j] = 10.0f * unit(&random);
            max[j] = min[j] + kit_between(&random, 0, 5);
        }
        occ_box box;
        KIT_CHECK(!occ_box_from_model(model, min, max, &box), "a model is refused");
        check_image(model, min, max, &box);
    }
}
END_TEST

START_TEST(corners_of_the_image_are_the_images_of_the_corners)
{
    // Sheared, mirrored, scaled and moved, in whole numbers: nothing rounds.
    static const float model[16] = {2, 1, 0, 0, -3, 5, 1, 0, 4, 0, -7, 0, 100, -200, 300, 1};
    static const float min[3] = {-1, 2, -8}, max[3] = {3, 4, -2};
    occ_box box;
    ck_assert_int_eq(occ_box_from_model(model, min, max, &box), OCC_SUCCESS);
    for (int corner = 0; corner < 8; corner++) {
        for (int j = 0; j < 3; j++) {
            float expected = model[12 + j], found = box.center[j];
            for (int k = 0; k < 3; k++) {
                bool high = corner >> k & 1;
                expected += model[4 * k + j] * (high ? max[k] : min[k]);
                found += high ? box.axis[k][j] : -box.axis[k][j];
            }
            KIT_CHECK(found == expected, "corner %d is at %g, not at %g", corner, (double)found,
                      (double)expected);
        }
    }
}
END_TEST

// --- bounds of boxes -----------------------------------------------------------------------------

// The end of the box's extent along j, exactly.
static void exact_end(mpq_t end, const occ_box *box, int j, int side)
{
    mpq_t part;
    mpq_init(part);
    mpq_set_d(end, (double)box->center[j]);
    for (int k = 0; k < 3; k++) {
        mpq_set_d(part, (double)side * fabs((double)box->axis[k][j]));
        mpq_add(end, end, part);
    }
    mpq_clear(part);
}

// How far outward a bound may lie: two floats, or where center and extent cancel, a trifle of them.
static double outward(const occ_box *box, int j, float bound)
{
    double size = fabs((double)box->center[j]);
    for (int k = 0; k < 3; k++)
        size += fabs((double)box->axis[k][j]);
    double magnitude = fabs((double)bound);
    return 2.0 * ((double)nextafterf(fabsf(bound), INFINITY) - magnitude) + size * 0x1p-49;
}

static void check_end(const occ_box *box, int j, int side, float bound)
{
    mpq_t end, beyond, most;
    mpq_inits(end, beyond, most, NULL);
    exact_end(end, box, j, side);
    mpq_set_d(beyond, (double)bound);
    mpq_sub(beyond, beyond, end);
    if (side < 0) mpq_neg(beyond, beyond);
    mpq_set_d(most, outward(box, j, bound));
    KIT_CHECK(mpq_sgn(beyond) >= 0, "a corner is outside %a", (double)bound);
    KIT_CHECK(mpq_cmp(beyond, most) <= 0, "%a is too far out", (double)bound);
    mpq_clears(end, beyond, most, NULL);
}

START_TEST(bounds_of_a_box_hold_every_corner_and_little_more)
{
    kit_random random = {(uint64_t)_i};
    for (int round = 0; round < 500; round++) {
        occ_box box;
        float numbers[12], min[3], max[3];
        for (int k = 0; k < 12; k++)
            numbers[k] = kinds[_i](&random) * (kit_below(&random, 4) ? 0.25f : 0.0f);
        memcpy(&box, numbers, sizeof box);
        occ_box_bounds(&box, min, max);
        for (int j = 0; j < 3; j++) {
            check_end(&box, j, -1, min[j]);
            check_end(&box, j, 1, max[j]);
        }
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("box");
    TCase *bounds = tcase_create("bounds");
    tcase_add_loop_test(bounds, bounds_of_points_hold_every_point_exactly, 0, KINDS);
    tcase_add_loop_test(bounds, box_of_min_and_max_holds_both_exactly, 0, KINDS);
    tcase_add_loop_test(bounds, single_point_makes_a_point_box, 0, KINDS);
    tcase_add_loop_test(bounds, bounds_of_a_box_hold_every_corner_and_little_more, 0, KINDS);
    tcase_add_test(bounds, stride_leads_from_point_to_point);
    tcase_add_test(bounds, largest_coordinates_are_accepted);
    suite_add_tcase(suite, bounds);
    TCase *models = tcase_create("models");
    tcase_add_test(models, model_carries_a_box_to_its_image_rounded_once);
    tcase_add_test(models, corners_of_the_image_are_the_images_of_the_corners);
    suite_add_tcase(suite, models);
    return test_run_suite(suite);
}
