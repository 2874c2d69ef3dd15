// SPDX-License-Identifier: Apache-2.0
// labels: property oracle
// timeout: 120
#include "inner_rounds.h"
#include "support.h"

#include <gmp.h>

START_TEST(every_box_of_random_soups_is_in_a_solid)
{
    rounds_report report = {0};
    rounds_run(2026, 400, &report);
    // What the random choice must not lack.
    ck_assert_uint_eq(report.soups, 400);
    ck_assert_uint_ge(report.boxes, 1500);
    ck_assert_uint_ge(report.turned, 200);
    ck_assert_uint_ge(report.barren, 20);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("inner_random");
    TCase *soups = tcase_create("soups");
    tcase_add_test(soups, every_box_of_random_soups_is_in_a_solid);
    suite_add_tcase(suite, soups);
    return test_run_suite(suite);
}
