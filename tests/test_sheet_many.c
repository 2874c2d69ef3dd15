// SPDX-License-Identifier: Apache-2.0
// labels: slow
// timeout: 1500
#include "sheet_rounds.h"
#include "support.h"

#include <gmp.h>

START_TEST(every_sheet_of_ten_thousand_soups_blocks_what_it_says)
{
    sheet_report report = {0};
    sheet_rounds_run(7, 10000, &report);
    ck_assert_uint_eq(report.soups, 10000);
    ck_assert_uint_ge(report.sheets, 100000);
    ck_assert_uint_ge(report.passed, 1000);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("sheet_many");
    TCase *soups = tcase_create("soups");
    tcase_add_test(soups, every_sheet_of_ten_thousand_soups_blocks_what_it_says);
    suite_add_tcase(suite, soups);
    return test_run_suite(suite);
}
