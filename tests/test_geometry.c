// SPDX-License-Identifier: Apache-2.0
// labels: unit property
// The error bound of every sign test of kernels/, against the same numbers with 40 more bits, on
// inputs that are bred to make the error large.
#include "camera.h"
#include "kit.h"
#include "support.h"
#include "verdict.h"

#include <math.h>
#include <stdio.h>

enum { LINES = 40, STEPS = 50000 / OCC_TEST_SLOWNESS };

#define U 0x1p-24

// A plane, a box and an eye. The plane's normal has its largest component in [1/2, 1); `slip` is
// what set-up in double got wrong of it.
typedef struct contest {
    double eye[3], n[3], slip[3], d;
    float center[3], axis[3][3]; // of a node only the diagonal of `axis`
    occ_eye constants;
} contest;

// s - r or s + r: as the kernels have it, as it is, and the bound on their difference.
typedef struct outcome {
    float computed, bound;
    long double exact;
} outcome;

static void renew_eye(contest *c)
{
    static const float ahead[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, -1, 0, 0, 0, 0};
    occ_camera_desc desc = {.depth = OCC_DEPTH_ZERO_TO_ONE, .eye = c->eye};
    memcpy(desc.view_projection, ahead, sizeof ahead);
    occ_camera camera;
    const char *reason = "";
    KIT_CHECK(!occ_camera_init(&camera, &desc, &reason), "%s", reason);
    c->constants = camera.constants;
}

static float rounded_to_float(double value)
{
    volatile float rounded = (float)value; // for good: some compilers forget such a rounding
    return rounded;
}

static void round_plane(const contest *c, float plane[4])
{
    for (int j = 0; j < 3; j++)
        plane[j] = rounded_to_float(c->n[j] + c->slip[j]);
    plane[3] = rounded_to_float(c->d);
}

// Beside the bound stands what the plane's offset was moved by.
static float whole_bound(float e, const float plane[4])
{
    return e + 0x1p-21f * fabsf(plane[3]);
}

static long double exact_center(const contest *c, const float center[3])
{
    long double sum = (long double)c->d;
    for (int j = 0; j < 3; j++)
        sum += (long double)c->n[j] * ((long double)center[j] - (long double)c->eye[j]);
    return sum;
}

static outcome try_box(const contest *c, int side)
{
    float plane[4];
    round_plane(c, plane);
    occ_relative_box box;
    long double reach = 0.0L;
    for (int j = 0; j < 3; j++)
        box.t[j] = OCC_RELATIVE(c->center[j], c->constants.high[j], c->constants.low[j]);
    for (int k = 0; k < 3; k++) {
        long double along = 0.0L;
        for (int j = 0; j < 3; j++) {
            box.a[3 * k + j] = c->axis[k][j];
            along += (long double)c->n[j] * (long double)c->axis[k][j];
        }
        reach += fabsl(along);
    }
    float e = occ_box_slack(&box, c->constants.slack_floor);
    float s = OCC_PLANE_AT(plane[0], plane[1], plane[2], plane[3], box.t[0], box.t[1], box.t[2]);
    float r = occ_box_reach(&box, plane[0], plane[1], plane[2]);
    return (outcome){side > 0 ? s + r : s - r, whole_bound(e, plane),
                     exact_center(c, c->center) + (side > 0 ? reach : -reach)};
}

// An axis-aligned node from min to max, as the octree keeps it.
static outcome try_node(const contest *c, int side)
{
    float plane[4], t[3], h[3], extreme[3];
    round_plane(c, plane);
    for (int j = 0; j < 3; j++) {
        float half = fabsf(c->axis[j][j]), min = c->center[j] - half, max = c->center[j] + half;
        float low = OCC_RELATIVE(min, c->constants.high[j], c->constants.low[j]);
        float high = OCC_RELATIVE(max, c->constants.high[j], c->constants.low[j]);
        t[j] = OCC_MIDDLE(low, high);
        h[j] = OCC_HALF(low, high);
        extreme[j] = (c->n[j] > 0.0) == (side > 0) ? max : min;
    }
    float size = OCC_NORM1(t[0], t[1], t[2]) + OCC_NORM1(h[0], h[1], h[2]);
    float e = OCC_BOUND(size, c->constants.slack_floor);
    float s = OCC_PLANE_AT(plane[0], plane[1], plane[2], plane[3], t[0], t[1], t[2]);
    float r = OCC_REACH_OF_AABB(plane[0], plane[1], plane[2], h[0], h[1], h[2]);
    return (outcome){side > 0 ? s + r : s - r, whole_bound(e, plane), exact_center(c, extreme)};
}

// How much of the bound the error uses up.
static double used_up(outcome o)
{
    return fabs((double)((long double)o.computed - o.exact)) / (double)o.bound;
}

// --- breeding ------------------------------------------------------------------------------------

static double any_size(kit_random *random, double low, double high)
{
    double at = (double)(kit_next(random) >> 11) * 0x1p-53;
    return exp2(low + at * (high - low)) * (kit_below(random, 2) ? 1.0 : -1.0);
}

// A little, a lot, or next to a power of two, where a rounding weighs most.
static double bent(kit_random *random, double value, double grain)
{
    switch (kit_below(random, 5)) {
    case 0:
        return value * (1.0 + grain * any_size(random, 0, 6));
    case 1:
        return value * any_size(random, -1, 1);
    case 2:
        return value == 0.0 ? 0.0 : copysign(exp2(rint(log2(fabs(value)))), value);
    case 3:
        return value * (1.0 + any_size(random, -24, -4));
    default:
        return -value;
    }
}

static void keep_normal(contest *c)
{
    double largest = fmax(fabs(c->n[0]), fmax(fabs(c->n[1]), fabs(c->n[2])));
    int exponent = 0;
    if (largest > 0.0) frexp(largest, &exponent);
    for (int j = 0; j < 3; j++)
        c->n[j] = ldexp(c->n[j], -exponent);
}

static void mutate(contest *c, kit_random *random)
{
    uint32_t what = kit_below(random, 8), j = kit_below(random, 3), k = kit_below(random, 3);
    if (what == 0) {
        c->eye[j] = bent(random, c->eye[j], 0x1p-50);
        c->center[j] = rounded_to_float(c->eye[j] + any_size(random, -8, 4));
        renew_eye(c);
    } else if (what == 1) {
        c->n[j] = bent(random, c->n[j], 0x1p-50);
    } else if (what == 2) {
        c->slip[j] = 0.25 * U * (double)kit_between(random, -1, 1);
    } else if (what == 3) {
        c->d = bent(random, c->d, 0x1p-50);
    } else if (what < 6) {
        c->center[j] = rounded_to_float(bent(random, (double)c->center[j], 0x1p-23));
    } else {
        c->axis[k][j] = rounded_to_float(bent(random, (double)c->axis[k][j], 0x1p-23));
    }
    keep_normal(c);
}

static contest first_of_a_line(kit_random *random, bool has_offset)
{
    contest c = {.d = has_offset ? any_size(random, -4, 4) : 0.0};
    double reach = any_size(random, -3, 24);
    for (int j = 0; j < 3; j++) {
        c.eye[j] = reach * any_size(random, -2, 0);
        c.n[j] = any_size(random, -3, 0);
        c.slip[j] = 0.25 * U * (double)kit_between(random, -1, 1);
        c.center[j] = rounded_to_float(c.eye[j] + any_size(random, -2, 2));
        for (int k = 0; k < 3; k++)
            c.axis[k][j] = rounded_to_float(any_size(random, -4, 2));
    }
    renew_eye(&c);
    keep_normal(&c);
    return c;
}

// Of the 16 units of the bound no more than 11 can be used up (docs/accuracy.md). That they reach
// `least` of them shows how tight it is, and that the search finds what there is to find.
static void check_bound(outcome (*try)(const contest *, int), int side, double least)
{
    kit_random random = {(uint64_t)(2 + side)};
    double most = 0.0;
    for (int line = 0; line < LINES; line++) {
        contest best = first_of_a_line(&random, line % 2 == 1);
        double best_use = used_up(try(&best, side));
        for (int i = 0; i < STEPS; i++) {
            contest child = best;
            for (uint32_t times = 1 + kit_below(&random, 3); times; times--)
                mutate(&child, &random);
            double use = used_up(try(&child, side));
            KIT_CHECK(use < 11.0 / 16.0, "the error is %.3f of its bound", use);
            if (use >= best_use) best = child;
            best_use = fmax(best_use, use);
        }
        most = fmax(most, best_use);
    }
    printf("the error takes up to %.2f of the bound's 16 units\n", 16.0 * most);
    ck_assert_double_gt(16.0 * most, least);
}

START_TEST(the_error_of_a_box_inside_a_plane_stays_within_its_bound)
{
    check_bound(try_box, -1, 4);
}
END_TEST

START_TEST(the_error_of_a_box_outside_a_plane_stays_within_its_bound)
{
    check_bound(try_box, 1, 4);
}
END_TEST

START_TEST(the_error_of_a_node_inside_a_plane_stays_within_its_bound)
{
    check_bound(try_node, -1, 4);
}
END_TEST

START_TEST(the_error_of_a_node_outside_a_plane_stays_within_its_bound)
{
    check_bound(try_node, 1, 4);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("geometry");
    TCase *bounds = tcase_create("bounds");
    tcase_add_test(bounds, the_error_of_a_box_inside_a_plane_stays_within_its_bound);
    tcase_add_test(bounds, the_error_of_a_box_outside_a_plane_stays_within_its_bound);
    tcase_add_test(bounds, the_error_of_a_node_inside_a_plane_stays_within_its_bound);
    tcase_add_test(bounds, the_error_of_a_node_outside_a_plane_stays_within_its_bound);
    suite_add_tcase(suite, bounds);
    return test_run_suite(suite);
}
