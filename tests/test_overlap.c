// SPDX-License-Identifier: Apache-2.0
// labels: property oracle
// How triangles and boxes meet, against linear inequalities in rational numbers.
#include "contact_oracle.h"
#include "kit.h"
#include "soup/overlap.h"
#include "support.h"

#include <math.h>
#include <stdlib.h>

// --- boxes and triangles that meet in every way --------------------------------------------------

static float step_of(kit_random *random, int most)
{
    return (float)((int)kit_below(random, 2 * (uint32_t)most + 1) - most);
}

// Few bits: contacts, common planes and common lines are frequent. Scaled by a power of two.
static void make_coarse(kit_random *random, occ_box *box, float corner[3][3])
{
    float scale = ldexpf(1.0f, (int)kit_below(random, 60) - 40);
    int most = 1 + (int)kit_below(random, 3);
    for (int j = 0; j < 3; j++)
        box->center[j] = step_of(random, 2) * scale;
    for (int k = 0; k < 9; k++)
        box->axis[k / 3][k % 3] = step_of(random, most) * scale;
    if (kit_below(random, 2))
        for (int k = 0; k < 9; k++)
            if (k % 4) box->axis[k / 3][k % 3] = 0.0f;
    for (int k = 0; k < 9; k++)
        corner[k / 3][k % 3] = step_of(random, 4) * scale;
}

// A point of the box that rounding has moved by next to nothing.
static void near_box(kit_random *random, const occ_box *box, float point[3])
{
    double s[3];
    for (int k = 0; k < 3; k++)
        s[k] = kit_below(random, 2) ? 1.0 : (double)kit_between(random, -1.0f, 1.0f);
    for (int j = 0; j < 3; j++) {
        double x = (double)box->center[j];
        for (int k = 0; k < 3; k++)
            x += s[k] * (double)box->axis[k][j];
        point[j] = (float)x;
    }
}

static void make_close(kit_random *random, occ_box *box, float corner[3][3])
{
    float size = ldexpf(1.0f, (int)kit_below(random, 90) - 50);
    *box = kit_box(random, size * (kit_below(random, 2) ? 1.0f : 1000.0f), size);
    if (kit_below(random, 4) == 0) memset(box->axis[kit_below(random, 3)], 0, 3 * sizeof(float));
    for (int i = 0; i < 3; i++) {
        near_box(random, box, corner[i]);
        if (i && kit_below(random, 3) == 0)
            for (int j = 0; j < 3; j++)
                corner[i][j] += kit_between(random, -3.0f, 3.0f) * size;
    }
    if (kit_below(random, 8) == 0)
        memcpy(corner[2], corner[kit_below(random, 2)], 3 * sizeof(float));
}

// Magnitudes that have nothing to do with each other.
static void make_wild(kit_random *random, occ_box *box, float corner[3][3])
{
    float *number[] = {box->center, box->axis[0], box->axis[1], box->axis[2],
                       corner[0],   corner[1],    corner[2]};
    for (int i = 0; i < 21; i++) {
        int exponent = kit_below(random, 2) ? 0 : (int)kit_below(random, 195) - 149;
        float value = ldexpf(kit_between(random, -1.0f, 1.0f), exponent);
        number[i / 3][i % 3] = kit_below(random, 5) ? value : 0.0f;
    }
}

static void check_pair(const occ_box *box, float corner[3][3], int trial, unsigned seen[3])
{
    occ_ready_box ready;
    occ_ready_box_make(box, &ready);
    KIT_CHECK(ready.flat == !contact_oracle_has_volume(box), "trial %d: flat", trial);
    occ_contact want = contact_oracle(box, corner);
    const float *const by_pointer[3] = {corner[0], corner[1], corner[2]};
    occ_contact got = occ_ready_box_meets(&ready, by_pointer);
    KIT_CHECK(got == want, "trial %d: %d, not %d", trial, (int)got, (int)want);
    KIT_CHECK(occ_ready_box_entered(&ready, by_pointer) == (want == OCC_ENTERING),
              "trial %d: entered", trial);
    float point[3][3] = {{corner[0][0], corner[0][1], corner[0][2]},
                         {corner[0][0], corner[0][1], corner[0][2]},
                         {corner[0][0], corner[0][1], corner[0][2]}};
    KIT_CHECK(occ_ready_box_holds(&ready, corner[0]) == contact_oracle_meet(box, point, false),
              "trial %d: point", trial);
    seen[want]++;
}

static const struct {
    void (*make)(kit_random *random, occ_box *box, float corner[3][3]);
    const char *name;
    int trials;
} kinds[] = {{make_coarse, "coarse", 4000}, {make_close, "close", 3000}, {make_wild, "wild", 4000}};

START_TEST(contact_is_what_rational_numbers_say)
{
    kit_random random = steady_seed(1, kinds[_i].name);
    unsigned seen[3] = {0};
    for (int trial = 0; trial < kinds[_i].trials; trial++) {
        occ_box box;
        float corner[3][3];
        kinds[_i].make(&random, &box, corner);
        check_pair(&box, corner, trial, seen);
    }
    // Each answer must have been asked for.
    for (int k = 0; k < 3; k++)
        ck_assert_uint_gt(seen[k], 20);
}
END_TEST

static const occ_box cube = {{0, 0, 0}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

START_TEST(surface_is_told_from_the_interior)
{
    occ_ready_box ready;
    occ_ready_box_make(&cube, &ready);
    const float in = nextafterf(1.0f, 0.0f), out = nextafterf(1.0f, 2.0f);
    const float high[3] = {5, 0, 5}, low[3] = {5, 0, -5};
    const struct {
        float x;
        occ_contact contact;
    } want[] = {{1.0f, OCC_TOUCHING}, {in, OCC_ENTERING}, {out, OCC_APART}};
    for (int i = 0; i < 3; i++) {
        const float point[3] = {want[i].x, 0, 0};
        const float *const corner[3] = {point, high, low};
        ck_assert_int_eq(occ_ready_box_meets(&ready, corner), want[i].contact);
        ck_assert_int_eq(occ_ready_box_holds(&ready, point), want[i].contact != OCC_APART);
    }
}
END_TEST

START_TEST(box_within_a_large_triangle_is_entered)
{
    occ_ready_box ready;
    occ_ready_box_make(&cube, &ready);
    const float a[3] = {-1e6f, -1e6f, 0.5f}, b[3] = {1e6f, -1e6f, 0.5f}, c[3] = {0, 1e6f, 0.5f};
    const float *const corner[3] = {a, b, c};
    ck_assert_int_eq(occ_ready_box_meets(&ready, corner), OCC_ENTERING);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("overlap");
    TCase *contacts = tcase_create("contacts");
    tcase_add_loop_test(contacts, contact_is_what_rational_numbers_say, 0,
                        (int)(sizeof kinds / sizeof *kinds));
    tcase_add_test(contacts, surface_is_told_from_the_interior);
    tcase_add_test(contacts, box_within_a_large_triangle_is_entered);
    suite_add_tcase(suite, contacts);
    return test_run_suite(suite);
}
