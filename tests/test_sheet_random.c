// SPDX-License-Identifier: Apache-2.0
// labels: property oracle
// timeout: 120
#include "sheet_rounds.h"
#include "support.h"

#include <gmp.h>
#include <stdio.h>

START_TEST(every_sheet_of_random_soups_blocks_what_it_says)
{
    sheet_report report = {0};
    sheet_rounds_run(2026, 600, &report);
    printf("soups %u sheets %u merged %u bent %u forged %u passed %u sights %lu\n", report.soups,
           report.sheets, report.merged, report.bent, report.forged, report.passed,
           (unsigned long)report.sights);
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
