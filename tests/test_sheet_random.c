// SPDX-License-Identifier: Apache-2.0
// labels: property oracle
// timeout: 120
#include "sheet_rounds.h"
#include "support.h"

#include <gmp.h>

START_TEST(every_sheet_of_random_soups_blocks_what_it_says)
{
    sheet_report report = {0};
    sheet_rounds_run(2026, 600, &report);
    // What the random choice must not lack.
    ck_assert_uint_eq(report.soups, 600);
    ck_assert_uint_ge(report.sheets, 6000);
    ck_assert_uint_ge(report.merged, 3000);
    ck_assert_uint_ge(report.bent, 800);
    ck_assert_uint_ge(report.forged, 3000);
    ck_assert_uint_ge(report.passed, 60);
    ck_assert_uint_ge(report.sights, 30000);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("sheet_random");
    TCase *soups = tcase_create("soups");
    tcase_add_test(soups, every_sheet_of_random_soups_blocks_what_it_says);
    suite_add_tcase(suite, soups);
    return test_run_suite(suite);
}
