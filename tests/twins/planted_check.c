// SPDX-License-Identifier: Apache-2.0
// One case that holds and one that fails: the gate that Check is.

#include "support.h"

START_TEST(planted_sum_is_right)
{
    ck_assert_int_eq(1 + 1, 2);
}
END_TEST

START_TEST(planted_sum_is_wrong)
{
    ck_assert_int_eq(1 + 1, 3);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("planted_check");
    TCase *holds = tcase_create("holds");
    tcase_add_test(holds, planted_sum_is_right);
    suite_add_tcase(suite, holds);
    TCase *fails = tcase_create("fails");
    tcase_add_test(fails, planted_sum_is_wrong);
    suite_add_tcase(suite, fails);
    return test_run_suite(suite);
}
