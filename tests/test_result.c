// SPDX-License-Identifier: Apache-2.0
#include "support.h"

#include <occlude/base.h>

#include <string.h>

// The numbers as they were first given out. Lines may be added; none may change.
#define RESULT(name, number)                                                                       \
    {                                                                                              \
#name, name, number                                                                        \
    }
static const struct {
    const char *name;
    occ_result result;
    int number;
} given_out[] = {
    RESULT(OCC_SUCCESS, 0),
    RESULT(OCC_ERROR_INVALID_ARGUMENT, -1),
    RESULT(OCC_ERROR_NOT_FINITE, -2),
    RESULT(OCC_ERROR_OUT_OF_RANGE, -3),
    RESULT(OCC_ERROR_STALE_HANDLE, -4),
    RESULT(OCC_ERROR_OUT_OF_MEMORY, -5),
    RESULT(OCC_ERROR_BUFFER_TOO_SMALL, -6),
    RESULT(OCC_ERROR_NOT_COMMITTED, -7),
    RESULT(OCC_ERROR_DEGENERATE_CAMERA, -8),
    RESULT(OCC_ERROR_UNSUPPORTED, -9),
    RESULT(OCC_ERROR_NO_DEVICE, -10),
    RESULT(OCC_ERROR_KERNEL_BUILD, -11),
    RESULT(OCC_ERROR_DEVICE, -12),
    RESULT(OCC_ERROR_LIMIT, -13),
    RESULT(OCC_ERROR_CORRUPT, -14),
    RESULT(OCC_ERROR_NO_RESULT, -15),
    RESULT(OCC_ERROR_NOT_INSIDE, -16),
    RESULT(OCC_ERROR_CANCELLED, -17),
};

enum { RESULTS = (int)(sizeof given_out / sizeof *given_out) };

START_TEST(result_keeps_the_number_it_was_given)
{
    ck_assert_int_eq(given_out[_i].result, given_out[_i].number);
}
END_TEST

START_TEST(result_is_called_by_its_enumerator)
{
    ck_assert_str_eq(occ_result_name(given_out[_i].result), given_out[_i].name);
}
END_TEST

START_TEST(message_is_a_sentence_of_its_own)
{
    const char *message = occ_result_message(given_out[_i].result);
    size_t length = strlen(message);
    ck_assert_uint_gt(length, 0);
    ck_assert_int_ne(message[length - 1], '.');
    ck_assert_ptr_null(strchr(message, '\n'));
    for (int other = 0; other < RESULTS; other++) {
        if (other == _i) continue;
        ck_assert_str_ne(message, occ_result_message(given_out[other].result));
    }
}
END_TEST

START_TEST(number_that_is_no_result_has_a_name_and_a_message_too)
{
    static const int strangers[] = {1, -18, -1000, 2147483647, -2147483647 - 1};
    for (size_t i = 0; i < sizeof strangers / sizeof *strangers; i++) {
        ck_assert_str_eq(occ_result_name((occ_result)strangers[i]), "OCC_UNKNOWN");
        const char *message = occ_result_message((occ_result)strangers[i]);
        ck_assert_uint_gt(strlen(message), 0);
        for (int known = 0; known < RESULTS; known++)
            ck_assert_str_ne(message, occ_result_message(given_out[known].result));
    }
}
END_TEST

START_TEST(linked_version_is_that_of_the_headers)
{
    ck_assert_int_eq(occ_version(), OCC_VERSION);
    ck_assert_int_eq(OCC_VERSION,
                     OCC_VERSION_MAJOR * 10000 + OCC_VERSION_MINOR * 100 + OCC_VERSION_PATCH);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("result");
    TCase *names = tcase_create("names");
    tcase_add_loop_test(names, result_keeps_the_number_it_was_given, 0, RESULTS);
    tcase_add_loop_test(names, result_is_called_by_its_enumerator, 0, RESULTS);
    tcase_add_loop_test(names, message_is_a_sentence_of_its_own, 0, RESULTS);
    tcase_add_test(names, number_that_is_no_result_has_a_name_and_a_message_too);
    tcase_add_test(names, linked_version_is_that_of_the_headers);
    suite_add_tcase(suite, names);
    return test_run_suite(suite);
}
