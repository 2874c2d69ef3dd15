// SPDX-License-Identifier: Apache-2.0
// labels: slow
// timeout: 1500
#include "inner_rounds.h"
#include "support.h"

#include <gmp.h>

START_TEST(every_box_of_ten_thousand_soups_is_in_a_solid)
{
    rounds_report report = {0};
    rounds_run(7, 10000, &report);
    ck_assert_uint_eq(report.soups, 10000);
    ck_assert_uint_ge(report.boxes, 30000);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("inner_many");
    TCase *soups = tcase_create("soups");
    tcase_add_test(soups, every_box_of_ten_thousand_soups_is_in_a_solid);
    suite_add_tcase(suite, soups);
    return test_run_suite(suite);
}
