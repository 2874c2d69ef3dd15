// SPDX-License-Identifier: Apache-2.0
// The filter's numbers: whatever is computed, the exact value is within the bound.
// labels: property
#include "judge_num.h"

#include "support.h"
#include "worlds.h"

#include <gmp.h>
#include <stdlib.h>

enum { NUMBERS = 24, STEPS = 200 };

typedef struct pair {
    num filtered;
    mpq_t exact;
} pair;

static void check_bound(const pair *p)
{
    mpq_t v, e;
    if (!isfinite(p->filtered.v) || !isfinite(p->filtered.e)) return;
    mpq_init(v);
    mpq_init(e);
    mpq_set_d(v, p->filtered.v);
    mpq_set_d(e, p->filtered.e);
    mpq_sub(v, v, p->exact);
    mpq_abs(v, v);
    KIT_CHECK(mpq_cmp(v, e) <= 0, "%g +- %g", p->filtered.v, p->filtered.e);
    int sign = num_sign(p->filtered);
    KIT_CHECK(sign == NUM_UNSURE || sign == mpq_sgn(p->exact), "sign %d", sign);
    mpq_clear(v);
    mpq_clear(e);
}

// A number of `scale`, or a small whole one; sometimes its exact value is anywhere in its bound.
static void start(kit_random *random, pair *p, double scale)
{
    double v = kit_below(random, 3) ? scale * world_between(random, -1, 1)
                                    : (double)kit_below(random, 5) - 2.0;
    p->filtered = num_of(v);
    mpq_set_d(p->exact, v);
    if (kit_below(random, 2)) return;
    mpq_t shift;
    mpq_init(shift);
    p->filtered.e = fabs(v) * world_scale(random, 1e-17, 1e-2) + DBL_MIN;
    uint32_t where = kit_below(random, 3); // often at the very end of it
    double part = where ? (where == 1 ? 1.0 : -1.0) : world_between(random, -1, 1);
    mpq_set_d(shift, p->filtered.e * part);
    mpq_add(p->exact, p->exact, shift);
    mpq_clear(shift);
}

static void combine(kit_random *random, const pair *a, const pair *b, pair *out)
{
    num result;
    switch (kit_below(random, 4)) {
    case 0:
        result = num_add(a->filtered, b->filtered);
        mpq_add(out->exact, a->exact, b->exact);
        break;
    case 1:
        result = num_sub(a->filtered, b->filtered);
        mpq_sub(out->exact, a->exact, b->exact);
        break;
    case 2:
        result = num_abs(a->filtered);
        mpq_abs(out->exact, a->exact);
        break;
    default:
        result = num_mul(a->filtered, b->filtered);
        mpq_mul(out->exact, a->exact, b->exact);
    }
    out->filtered = result;
    check_bound(out);
}

START_TEST(the_exact_value_is_within_the_bound)
{
    kit_random random = {31};
    static const double scales[] = {1, 1e-6, 1e7, 1e-100, 1e-160, 1e-300, 1e150};
    pair numbers[NUMBERS];
    for (int i = 0; i < NUMBERS; i++)
        mpq_init(numbers[i].exact);
    for (int round = 0; round < WORLD_SHARE(700); round++) {
        for (int i = 0; i < NUMBERS; i++)
            start(&random, &numbers[i], scales[round % 7]);
        for (int step = 0; step < STEPS; step++) {
            uint32_t a = kit_below(&random, NUMBERS), b = kit_below(&random, NUMBERS);
            uint32_t out = kit_below(&random, NUMBERS);
            if (mpz_sizeinbase(mpq_numref(numbers[a].exact), 2) > 4000) continue;
            if (mpz_sizeinbase(mpq_numref(numbers[b].exact), 2) > 4000) continue;
            if (out != a && out != b) combine(&random, &numbers[a], &numbers[b], &numbers[out]);
        }
    }
    for (int i = 0; i < NUMBERS; i++)
        mpq_clear(numbers[i].exact);
}
END_TEST

// Scaling keeps signs, and ratios to each other within their bounds.
START_TEST(taming_scales_by_a_power_of_two)
{
    kit_random random = {32};
    static const double scales[] = {1, 1e-60, 1e60, 1e-300, 1e300, 5e-324};
    for (int i = 0; i < WORLD_SHARE(20000); i++) {
        num v[3], w[3];
        for (int k = 0; k < 3; k++) {
            v[k] = num_of(scales[i % 6] * world_between(&random, -1, 1));
            v[k].e = kit_below(&random, 2) ? 0.0 : fabs(v[k].v) * 1e-10;
            w[k] = v[k];
        }
        num_tame(w, 3);
        int shift = 0;
        for (int k = 0; k < 3; k++)
            if (v[k].v != 0.0) shift = ilogb(w[k].v) - ilogb(v[k].v);
        for (int k = 0; k < 3; k++) {
            KIT_CHECK(ldexp(v[k].v, shift) == w[k].v, "%g became %g", v[k].v, w[k].v);
            KIT_CHECK(ldexp(v[k].e, shift) <= w[k].e, "%g became %g", v[k].e, w[k].e);
        }
    }
}
END_TEST

START_TEST(what_is_no_number_is_unsure)
{
    num huge = num_of(1e308), more = num_mul(huge, huge);
    ck_assert_int_eq(num_sign(more), NUM_UNSURE);
    ck_assert_int_eq(num_sign(num_sub(more, more)), NUM_UNSURE);
    ck_assert_int_eq(num_sign(num_mul(more, num_of(1e-300))), NUM_UNSURE);
    ck_assert_int_eq(num_sign(num_mul(more, num_of(0.0))), 0); // nothing is 0 times any number
    ck_assert_int_eq(num_sign(num_mul(num_of(1e-200), num_of(1e-200))), NUM_UNSURE);
    ck_assert_int_eq(num_sign(num_sub(num_of(1.0), num_of(1.0))), NUM_UNSURE);
    ck_assert_int_eq(num_sign(num_of(-1.0)), -1);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("judge_num");
    TCase *bounds = tcase_create("bounds");
    tcase_add_test(bounds, the_exact_value_is_within_the_bound);
    tcase_add_test(bounds, taming_scales_by_a_power_of_two);
    tcase_add_test(bounds, what_is_no_number_is_unsure);
    suite_add_tcase(suite, bounds);
    return test_run_suite(suite);
}
