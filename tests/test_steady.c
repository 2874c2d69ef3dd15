// SPDX-License-Identifier: Apache-2.0
// Functions with the same bits everywhere are as close to the true ones as their header says.
#include "steady.h"

#include "kit.h"
#include "support.h"

#include <math.h>

enum { TRIES = 20000 };

static void near_to(double value, double wanted, double bound, const char *what, double x)
{
    KIT_CHECK(fabs(value - wanted) <= bound, "%s(%.17g) is %.17g, not %.17g", what, x, value,
              wanted);
}

START_TEST(sine_and_cosine_are_within_their_bound)
{
    steady_random random = steady_seed(1, "sine");
    for (int i = 0; i < TRIES; i++) {
        double reach = i % 2 ? 1e6 : 4.0, x = steady_between(&random, -reach, reach);
        near_to(steady_sin(x), sin(x), 2e-15, "sin", x);
        near_to(steady_cos(x), cos(x), 2e-15, "cos", x);
    }
    ck_assert(steady_sin(0) == 0 && steady_cos(0) == 1);
}
END_TEST

START_TEST(exponential_and_logarithm_are_within_their_bounds_and_undo_each_other)
{
    steady_random random = steady_seed(2, "exp");
    for (int i = 0; i < TRIES; i++) {
        double x = steady_between(&random, -700, 700), y = steady_exp(x);
        near_to(y, exp(x), 2e-15 * exp(x), "exp", x);
        near_to(steady_log(y), x, 1e-15 * fabs(x) + 2e-15, "log of exp", x);
        double z = ldexp(steady_between(&random, 0.5, 1), (int)steady_below(&random, 3));
        near_to(steady_log(z), log(z), 1e-15, "log", z);
    }
    ck_assert(steady_exp(0) == 1 && steady_log(1) == 0);
}
END_TEST

START_TEST(cube_roots_are_within_their_bound)
{
    steady_random random = steady_seed(3, "cbrt");
    for (int i = 0; i < TRIES; i++) {
        double x = exp(steady_between(&random, -60, 60));
        near_to(steady_cbrt(x), cbrt(x), 2e-15 * cbrt(x), "cbrt", x);
    }
}
END_TEST

START_TEST(labels_give_streams_of_their_own)
{
    steady_random a = steady_seed(7, "one"), b = steady_seed(7, "two"),
                  again = steady_seed(7, "one");
    unsigned same = 0;
    for (int i = 0; i < 64; i++) {
        uint64_t bits = steady_bits(&a);
        ck_assert_uint_eq(bits, steady_bits(&again));
        same += bits == steady_bits(&b);
    }
    ck_assert_uint_eq(same, 0);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("steady");
    TCase *functions = tcase_create("functions");
    tcase_add_test(functions, sine_and_cosine_are_within_their_bound);
    tcase_add_test(functions,
                   exponential_and_logarithm_are_within_their_bounds_and_undo_each_other);
    tcase_add_test(functions, cube_roots_are_within_their_bound);
    tcase_add_test(functions, labels_give_streams_of_their_own);
    suite_add_tcase(suite, functions);
    return test_run_suite(suite);
}
