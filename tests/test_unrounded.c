// SPDX-License-Identifier: Apache-2.0
// labels: property oracle
// The numbers without rounding against GMP's rationals.
#include "soup/unrounded.h"
#include "steady.h"
#include "support.h"

#include <gmp.h>
#include <math.h>
#include <stdlib.h>

enum { TRIALS = 20000 };

// Any float up to about 2^49, often with few bits, often zero, down to denormals.
static float any_float(steady_random *random)
{
    if (steady_below(random, 8) == 0) return 0.0f;
    int exponent = steady_below(random, 3) ? (int)steady_below(random, 12) - 6
                                           : (int)steady_below(random, 190) - 148;
    double mantissa =
        steady_below(random, 2) ? 1.0 + steady_below(random, 8) / 8.0 : 1.0 + steady_unit(random);
    return (float)ldexp(steady_below(random, 2) ? mantissa : -mantissa, exponent);
}

static void to_rational(mpq_t out, const occ_unrounded *a, unsigned factors)
{
    mpz_t whole;
    mpz_init(whole);
    for (uint32_t i = a->used; i-- > 0;) {
        mpz_mul_2exp(whole, whole, 32);
        mpz_add_ui(whole, whole, a->limb[i]);
    }
    if (a->sign < 0) mpz_neg(whole, whole);
    mpq_set_z(out, whole);
    mpq_div_2exp(out, out, 149UL * factors);
    mpz_clear(whole);
}

static void rational_determinant(mpq_t out, mpq_t v[3][3])
{
    mpq_t left, right;
    mpq_inits(left, right, NULL);
    mpq_set_ui(out, 0, 1);
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        mpq_mul(left, v[1][i], v[2][j]);
        mpq_mul(right, v[1][j], v[2][i]);
        mpq_sub(left, left, right);
        mpq_mul(left, left, v[0][k]);
        mpq_add(out, out, left);
    }
    mpq_clears(left, right, NULL);
}

START_TEST(float_is_kept_as_it_is)
{
    const float values[] = {0.0f,       -0.0f,     1.0f,      -3.5f,          0x1p-149f,
                            -0x3p-149f, 0x1p-126f, 0x1.8p49f, 0x1.fffffep20f, -0x1.234566p-130f};
    mpq_t want, got;
    mpq_inits(want, got, NULL);
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
        occ_unrounded a = occ_unrounded_from(values[i]);
        to_rational(got, &a, 1);
        mpq_set_d(want, (double)values[i]);
        ck_assert_msg(mpq_equal(want, got), "%a", (double)values[i]);
        ck_assert_int_eq(a.sign, (values[i] > 0.0f) - (values[i] < 0.0f));
    }
    mpq_clears(want, got, NULL);
}
END_TEST

START_TEST(determinant_of_differences_equals_the_rational_one)
{
    steady_random random = steady_seed(1, "unrounded");
    mpq_t want, got, v[3][3], base;
    mpq_inits(want, got, base, NULL);
    for (int i = 0; i < 9; i++)
        mpq_init(v[i / 3][i % 3]);
    for (int trial = 0; trial < TRIALS; trial++) {
        occ_unrounded_vector p[4], d[3];
        float f[4][3];
        for (int i = 0; i < 12; i++)
            f[i / 3][i % 3] = any_float(&random);
        for (int i = 0; i < 4; i++)
            p[i] = occ_unrounded_vector_from(f[i]);
        for (int i = 0; i < 3; i++) {
            d[i] = occ_unrounded_vector_subtract(&p[i + 1], &p[0]);
            for (int k = 0; k < 3; k++) {
                mpq_set_d(v[i][k], (double)f[i + 1][k]);
                mpq_set_d(base, (double)f[0][k]);
                mpq_sub(v[i][k], v[i][k], base);
            }
        }
        occ_unrounded value = occ_unrounded_determinant(&d[0], &d[1], &d[2]);
        rational_determinant(want, v);
        to_rational(got, &value, 3);
        ck_assert_msg(mpq_equal(want, got), "trial %d", trial);
        ck_assert_int_eq(value.sign, mpq_sgn(want));
    }
    for (int i = 0; i < 9; i++)
        mpq_clear(v[i / 3][i % 3]);
    mpq_clears(want, got, base, NULL);
}
END_TEST

START_TEST(sum_and_difference_undo_each_other)
{
    steady_random random = steady_seed(2, "unrounded");
    for (int trial = 0; trial < TRIALS; trial++) {
        occ_unrounded a = occ_unrounded_from(any_float(&random)),
                      b = occ_unrounded_from(any_float(&random));
        occ_unrounded sum = occ_unrounded_add(&a, &b), back = occ_unrounded_subtract(&sum, &b);
        ck_assert_int_eq(back.sign, a.sign);
        ck_assert_int_eq(occ_unrounded_compare_magnitude(&back, &a), 0);
        occ_unrounded nothing = occ_unrounded_subtract(&a, &a);
        ck_assert_int_eq(nothing.sign, 0);
        ck_assert_uint_eq(nothing.used, 0);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("unrounded");
    TCase *values = tcase_create("values");
    tcase_add_test(values, float_is_kept_as_it_is);
    tcase_add_test(values, determinant_of_differences_equals_the_rational_one);
    tcase_add_test(values, sum_and_difference_undo_each_other);
    suite_add_tcase(suite, values);
    return test_run_suite(suite);
}
