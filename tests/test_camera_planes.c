// SPDX-License-Identifier: Apache-2.0
// labels: unit property oracle
// The planes that depend on the camera alone, against the exact ones: each of the frustum is the
// next float outward, and no silhouette takes the eye for another. Verdicts cannot show that, since
// their own bound would cover for a plane that is off by an ulp.
#include "oracle_data.h"

#include "kit_sheets.h"
#include "support.h"
#include "verdicts.h"
#include "worlds.h"

#include <math.h>
#include <stdio.h>

// What set-up moves an offset by, of itself: 8u.
#define MOVED 0x1p-21

static mpq_t limit, shift, number, exact;

static void begin(void)
{
    mpq_inits(limit, shift, number, exact, NULL);
}

static void end(void)
{
    mpq_clears(limit, shift, number, exact, NULL);
}

// numerator / (denominator 2^places); no denominator: 1
static void set_fraction(mpq_t out, mpz_t numerator, mpz_t denominator, long places)
{
    mpq_set_z(out, numerator);
    if (denominator) {
        mpq_set_den(out, denominator);
        mpq_canonicalize(out);
    }
    mpq_div_2exp(out, out, (mp_bitcnt_t)places);
}

// --- an offset -----------------------------------------------------------------------------------

// Compares an offset with where `exact` less the slack is to be moved.
static int compare_moved(float offset, double slack)
{
    mpq_set_d(number, slack);
    mpq_sub(limit, exact, number);
    mpq_set_d(shift, MOVED);
    mpq_mul(shift, shift, limit);
    mpq_abs(shift, shift);
    mpq_sub(limit, limit, shift);
    mpq_set_d(number, (double)offset);
    return mpq_cmp(number, limit);
}

typedef struct tally {
    unsigned planes, sharp;
} tally;

// An offset was lowered from `exact` if it is not above the moved one but the next float is, when
// the slack is added. It is sharp if that needs no slack: one float up or down would be noticed.
static void check_lowered(float offset, double slack, uint32_t p, tally *sum)
{
    float above = nextafterf(offset, INFINITY);
    KIT_CHECK(compare_moved(offset, 0.0) <= 0, "frustum plane %u: the offset %a is too far inward",
              p, (double)-offset);
    KIT_CHECK(compare_moved(above, slack) > 0, "frustum plane %u: the offset %a is too far outward",
              p, (double)-offset);
    sum->planes++;
    sum->sharp += compare_moved(above, 0.0) > 0;
}

// --- a normal ------------------------------------------------------------------------------------

// Whether each component is n / 2^unit to 3/4 u: u/2 for the float, the rest for set-up.
static bool is_rounded(const float plane[4], mpz_t *n, long unit)
{
    for (int j = 0; j < 3; j++) {
        set_fraction(limit, n[j], NULL, unit);
        mpq_set_d(number, (double)plane[j]);
        mpq_sub(limit, limit, number);
        mpq_abs(limit, limit);
        mpq_set_d(number, 0.75 * 0x1p-24);
        if (mpq_cmp(limit, number) > 0) return false;
    }
    return true;
}

// Whether a plane's normal is n, rounded, and if so what n was divided by: 2^unit.
static bool has_normal(const float plane[4], mpz_t *n, long *unit)
{
    *unit = 0;
    for (int j = 0; j < 3; j++) {
        long bits = mpz_sgn(n[j]) ? (long)mpz_sizeinbase(n[j], 2) : 0;
        *unit = bits > *unit ? bits : *unit;
    }
    if (is_rounded(plane, n, *unit)) return true;
    *unit += 1; // set-up's own rounding has carried into the next power of two
    return is_rounded(plane, n, *unit);
}

// --- the frustum ---------------------------------------------------------------------------------

// The value of plane p at the library's eye, where its normal is divided by 2^unit.
static void plane_at_eye(oracle *o, uint32_t p, const double eye[3], long unit)
{
    mpq_t part;
    mpq_init(part);
    set_fraction(exact, o->c[p], o->cd, o->places);
    for (int j = 0; j < 3; j++) {
        set_fraction(part, o->b[j], o->bw, o->places);
        mpq_set_d(number, eye[j]);
        mpq_sub(part, number, part);
        mpq_set_z(number, o->n[p][j]);
        mpq_mul(part, part, number);
        mpq_add(exact, exact, part);
    }
    mpq_div_2exp(exact, exact, (mp_bitcnt_t)unit);
    mpq_clear(part);
}

// More than what double may round in an offset: `own` is the camera that its matrix alone makes.
static double frustum_slack(const occ_camera *own, const occ_camera_desc *desc, uint32_t p)
{
    double size = fabs(own->plane[p][3]);
    for (int j = 0; j < 3; j++) {
        double origin = desc->origin ? fabs(desc->origin[j]) : 0.0;
        size += fabs(own->plane[p][j]) * (fabs(own->eye[j]) + origin + own->doubt[j]);
    }
    return size * 0x1p-46;
}

static void check_frustum(const occ_camera *camera, const occ_camera_desc *desc, tally *sum)
{
    occ_camera_desc alone = *desc;
    alone.eye = NULL;
    occ_camera own = verdict_frame(&alone).camera;
    oracle *o = oracle_of_camera(desc);
    for (uint32_t p = 0; p < OCC_FRUSTUM_PLANES; p++) {
        if (!(camera->planes >> p & 1u)) continue;
        const float *plane = camera->constants.plane[p];
        long unit;
        KIT_CHECK(has_normal(plane, o->n[p], &unit), "frustum plane %u: the normal is off", p);
        plane_at_eye(o, p, camera->eye, unit);
        mpq_neg(exact, exact); // outward is up
        bool through_eye = desc->eye && !camera->orthographic && p < OCC_NEAR_PLANE;
        double slack = through_eye ? 0.0 : frustum_slack(&own, desc, p);
        check_lowered(-plane[3], slack, p, sum);
    }
    oracle_free(o);
}

static occ_camera_desc random_camera(kit_random *random, double reach)
{
    world_lens lens = {.projection = (world_projection)kit_below(random, WORLD_PROJECTIONS),
                       .depth = (occ_depth)kit_below(random, 3),
                       .near_z = (float)world_scale(random, 1e-3, 10)};
    lens.far_z = lens.near_z * (float)world_scale(random, 10, 1e6);
    float eye[3], target[3];
    double toward[3];
    world_direction(random, toward);
    for (int j = 0; j < 3; j++) {
        eye[j] = (float)world_between(random, -reach, reach);
        target[j] = eye[j] + 100 * (float)toward[j];
    }
    return world_camera(eye, target, &lens);
}

static void check_frusta(uint64_t seed, bool given, tally *sum)
{
    kit_random random = {seed};
    for (int i = 0; i < WORLD_SHARE(3000); i++) {
        double reach = world_scale(&random, 1e-3, 1e5);
        bool skewed = kit_below(&random, 2) == 0;
        occ_camera_desc desc =
            skewed ? world_skewed_camera(&random, reach) : random_camera(&random, reach);
        const double point[3] = {reach + 1e-9, -reach / 3.0, 12.5};
        const double distant[3] = {1e7 / 3.0, -2e7, 3e7 + 1e-9};
        if (given) desc.eye = point;
        if (!given && kit_below(&random, 2)) desc.origin = i % 2 ? point : distant;
        occ_camera camera;
        const char *reason;
        if (occ_camera_init(&camera, &desc, &reason)) continue;
        check_frustum(&camera, &desc, sum);
    }
    printf("%u planes, %u of them known to the float\n", sum->planes, sum->sharp);
    ck_assert_uint_gt(sum->planes, WORLD_SHARE(15000));
}

START_TEST(planes_of_a_given_eye_are_the_next_floats_outward)
{
    tally sum = {0, 0};
    check_frusta(1, true, &sum);
    ck_assert_uint_gt(sum.sharp, sum.planes / 4 * 3);
}
END_TEST

// Planes through such an eye have offsets near 0: of these only the side is known for certain.
START_TEST(planes_of_a_derived_eye_are_outward_by_no_more_than_may_be_lost)
{
    tally sum = {0, 0};
    check_frusta(2, false, &sum);
    ck_assert_uint_gt(sum.sharp, sum.planes / 5);
}
END_TEST

// --- silhouettes ---------------------------------------------------------------------------------

// Of a plane through `eye`: sets `exact` and returns its sign.
static int value_at_exact_eye(oracle *o, const double eye[3], const float plane[4])
{
    mpq_set_ui(exact, 0, 1);
    for (int j = 0; j < 3; j++) {
        set_fraction(limit, o->e[j], o->ew, o->places);
        mpq_set_d(number, eye[j]);
        mpq_sub(limit, limit, number);
        mpq_set_d(number, (double)plane[j]);
        mpq_mul(limit, limit, number);
        mpq_add(exact, exact, limit);
    }
    return mpq_sgn(exact);
}

// The shadow of a box, or of one of its faces as a sheet.
static bool any_shadow(occ_shadow *shadow, const occ_camera *camera, const occ_box *box, bool sheet)
{
    const occ_sheet face = kit_sheet_of_box(box);
    return sheet ? occ_shadow_of_sheet(shadow, camera, &face, OCC_NOBODY)
                 : occ_lanes_choose()->shade(shadow, camera, box, OCC_NOBODY);
}

// A silhouette belongs to the eye that the matrix has, which is where double cannot put it.
START_TEST(no_silhouette_of_a_derived_eye_holds_the_exact_one)
{
    kit_random random = {4};
    unsigned silhouettes = 0, beyond = 0;
    for (int i = 0; i < WORLD_SHARE(1500); i++) {
        double reach = world_scale(&random, 1e-3, 1e5), center[3], aside[3];
        occ_camera_desc desc = world_skewed_camera(&random, reach);
        const double origin[3] = {1e7 / 3.0, -2e7, 3e7 + 1e-9};
        if (kit_below(&random, 2)) desc.origin = origin;
        occ_frame frame = {.hooks = NULL};
        const char *reason;
        if (occ_camera_init(&frame.camera, &desc, &reason)) continue;
        oracle *o = oracle_of_camera(&desc);
        for (int k = 0; k < 10; k++) {
            double size = reach * world_scale(&random, 1e-7, 1);
            world_direction(&random, aside);
            for (int j = 0; j < 3; j++)
                center[j] = frame.camera.eye[j] + 4 * size * aside[j];
            occ_box box = world_box(&random, WORLD_TURNED, center, size);
            occ_shadow shadow;
            if (!any_shadow(&shadow, &frame.camera, &box, k % 2)) continue;
            for (uint32_t p = 0; p < shadow.silhouettes; p++) {
                silhouettes++;
                beyond += value_at_exact_eye(o, frame.camera.eye, shadow.plane[p]) > 0;
                mpq_set_d(number, (double)shadow.plane[p][3]);
                mpq_add(exact, exact, number);
                KIT_CHECK(mpq_sgn(exact) <= 0, "camera %d: silhouette %u holds the eye", i, p);
            }
        }
        oracle_free(o);
    }
    printf("%u silhouettes, %u of which lie beyond the exact eye\n", silhouettes, beyond);
    ck_assert_uint_gt(beyond, WORLD_SHARE(5000));
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("camera planes");
    TCase *frusta = tcase_create("frusta");
    tcase_add_checked_fixture(frusta, begin, end);
    tcase_add_test(frusta, planes_of_a_given_eye_are_the_next_floats_outward);
    tcase_add_test(frusta, planes_of_a_derived_eye_are_outward_by_no_more_than_may_be_lost);
    suite_add_tcase(suite, frusta);
    TCase *silhouettes = tcase_create("silhouettes");
    tcase_add_checked_fixture(silhouettes, begin, end);
    tcase_add_test(silhouettes, no_silhouette_of_a_derived_eye_holds_the_exact_one);
    suite_add_tcase(suite, silhouettes);
    return test_run_suite(suite);
}
