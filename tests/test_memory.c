// SPDX-License-Identifier: Apache-2.0
#include "kit.h"
#include "log.h"
#include "memory.h"
#include "support.h"

#include <stdint.h>
#include <string.h>

static kit_heap heap;
static kit_log record;
static occ_hooks hooks;
static occ_array numbers;

static void set_up(void)
{
    heap = (kit_heap){0};
    kit_forget(&record);
    occ_allocator allocator = kit_allocator(&heap);
    occ_logger logger = kit_logger(&record);
    ck_assert_int_eq(occ_hooks_init(&hooks, &allocator, &logger), OCC_SUCCESS);
    numbers = OCC_ARRAY(uint32_t);
}

static void tear_down(void)
{
    occ_array_free(&hooks, &numbers);
    ck_assert_uint_eq(heap.blocks, 0);
    ck_assert_uint_eq(hooks.bytes, 0);
}

static void push_numbers(uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        uint32_t *place = occ_array_push(&hooks, &numbers);
        ck_assert_ptr_nonnull(place);
        *place = 3 * numbers.count;
    }
}

static void check_numbers(uint32_t count)
{
    ck_assert_uint_eq(numbers.count, count);
    for (uint32_t i = 0; i < count; i++)
        ck_assert_uint_eq(((uint32_t *)numbers.data)[i], 3 * (i + 1));
}

START_TEST(allocator_with_one_function_is_refused)
{
    occ_allocator whole = kit_allocator(&heap), half = whole;
    occ_logger silent = {NULL, NULL};
    half.free = NULL;
    ck_assert_int_eq(occ_hooks_init(&hooks, &half, &silent), OCC_ERROR_INVALID_ARGUMENT);
    half = whole;
    half.alloc = NULL;
    ck_assert_int_eq(occ_hooks_init(&hooks, &half, &silent), OCC_ERROR_INVALID_ARGUMENT);
}
END_TEST

START_TEST(without_hooks_memory_comes_aligned_from_the_c_library)
{
    occ_allocator none = {NULL, NULL, NULL};
    occ_logger silent = {NULL, NULL};
    ck_assert_int_eq(occ_hooks_init(&hooks, &none, &silent), OCC_SUCCESS);
    for (size_t size = 1; size < 5000; size = 2 * size + 1) {
        char *block = occ_alloc(&hooks, size);
        ck_assert_ptr_nonnull(block);
        ck_assert_uint_eq((uintptr_t)block % OCC_ALIGNMENT, 0);
        memset(block, 1, size);
        ck_assert_uint_eq(hooks.bytes, size);
        occ_free(&hooks, block, size);
        ck_assert_uint_eq(hooks.bytes, 0);
    }
    ck_assert_ptr_null(occ_alloc(&hooks, SIZE_MAX));
    ck_assert_ptr_null(occ_alloc(&hooks, SIZE_MAX - 62));
    ck_assert_uint_eq(hooks.bytes, 0);
}
END_TEST

START_TEST(no_bytes_are_no_memory)
{
    ck_assert_ptr_null(occ_alloc(&hooks, 0));
    occ_free(&hooks, NULL, 100);
    ck_assert_uint_eq(heap.calls, 0);
    ck_assert_uint_eq(hooks.bytes, 0);
}
END_TEST

START_TEST(bytes_are_what_the_allocator_gave)
{
    void *a = occ_alloc(&hooks, 100), *b = occ_alloc(&hooks, 1000);
    ck_assert_uint_eq(hooks.bytes, 1100);
    ck_assert_uint_eq(heap.bytes, 1100);
    heap.fail_at = heap.calls + 1;
    ck_assert_ptr_null(occ_alloc(&hooks, 10));
    ck_assert_uint_eq(hooks.bytes, 1100);
    occ_free(&hooks, a, 100);
    ck_assert_uint_eq(hooks.bytes, 1000);
    occ_free(&hooks, b, 1000);
}
END_TEST

START_TEST(array_keeps_its_elements_while_it_grows)
{
    push_numbers(10000);
    check_numbers(10000);
    ck_assert_uint_lt(heap.calls, 40);
}
END_TEST

START_TEST(reserved_elements_need_no_more_memory)
{
    ck_assert_int_eq(occ_array_reserve(&hooks, &numbers, 1000), OCC_SUCCESS);
    ck_assert_uint_eq(numbers.capacity, 1000);
    ck_assert_uint_eq(hooks.bytes, 4000);
    push_numbers(1000);
    ck_assert_uint_eq(heap.calls, 1);
    ck_assert_int_eq(occ_array_reserve(&hooks, &numbers, 10), OCC_SUCCESS);
    ck_assert_uint_eq(heap.calls, 1);
    check_numbers(1000);
}
END_TEST

START_TEST(extending_makes_room_and_leaves_the_count)
{
    push_numbers(5);
    uint32_t *end = occ_array_extend(&hooks, &numbers, 500);
    ck_assert_ptr_eq(end, (uint32_t *)numbers.data + 5);
    ck_assert_uint_eq(numbers.count, 5);
    ck_assert_uint_ge(numbers.capacity, 505);
    uint64_t calls = heap.calls;
    numbers.count = 505;
    for (uint32_t i = 5; i < 505; i++)
        ((uint32_t *)numbers.data)[i] = 3 * (i + 1);
    ck_assert_uint_eq(heap.calls, calls);
    check_numbers(505);
}
END_TEST

START_TEST(extending_by_nothing_is_no_failure)
{
    ck_assert_ptr_nonnull(occ_array_extend(&hooks, &numbers, 0));
    ck_assert_uint_eq(numbers.count, 0);
}
END_TEST

START_TEST(array_that_cannot_grow_stays_as_it_was)
{
    push_numbers(100);
    occ_array before = numbers;
    heap.fail_at = heap.calls + 1;
    heap.keeps_failing = true;
    ck_assert_int_eq(occ_array_reserve(&hooks, &numbers, 10000), OCC_ERROR_OUT_OF_MEMORY);
    ck_assert_ptr_null(occ_array_extend(&hooks, &numbers, 10000));
    while (numbers.count < numbers.capacity)
        push_numbers(1);
    uint32_t count = numbers.count;
    ck_assert_ptr_null(occ_array_push(&hooks, &numbers));
    ck_assert_ptr_eq(numbers.data, before.data);
    ck_assert_uint_eq(numbers.capacity, before.capacity);
    check_numbers(count);
}
END_TEST

START_TEST(more_elements_than_an_index_can_name_are_refused)
{
    push_numbers(3);
    uint64_t calls = heap.calls;
    ck_assert_int_eq(occ_array_reserve(&hooks, &numbers, (size_t)UINT32_MAX + 1), OCC_ERROR_LIMIT);
    ck_assert_int_eq(occ_array_reserve(&hooks, &numbers, SIZE_MAX), OCC_ERROR_LIMIT);
    ck_assert_ptr_null(occ_array_extend(&hooks, &numbers, UINT32_MAX));
    ck_assert_ptr_null(occ_array_extend(&hooks, &numbers, SIZE_MAX - 1));
    ck_assert_uint_eq(heap.calls, calls);
    check_numbers(3);
}
END_TEST

START_TEST(trimming_gives_back_what_lies_beyond_the_count)
{
    ck_assert_int_eq(occ_array_reserve(&hooks, &numbers, 1000), OCC_SUCCESS);
    push_numbers(100);
    occ_array_trim(&hooks, &numbers);
    ck_assert_uint_eq(hooks.bytes, 400);
    check_numbers(100);
    numbers.count = 0;
    occ_array_trim(&hooks, &numbers);
    ck_assert_uint_eq(hooks.bytes, 0);
    ck_assert_ptr_null(numbers.data);
    push_numbers(2);
    check_numbers(2);
}
END_TEST

START_TEST(array_that_cannot_be_trimmed_stays_as_it_was)
{
    ck_assert_int_eq(occ_array_reserve(&hooks, &numbers, 1000), OCC_SUCCESS);
    push_numbers(100);
    heap.fail_at = heap.calls + 1;
    occ_array_trim(&hooks, &numbers);
    ck_assert_uint_eq(heap.failures, 1);
    ck_assert_uint_eq(numbers.capacity, 1000);
    check_numbers(100);
}
END_TEST

START_TEST(freed_array_can_be_filled_again)
{
    push_numbers(100);
    occ_array_free(&hooks, &numbers);
    ck_assert_uint_eq(hooks.bytes, 0);
    occ_array_free(&hooks, &numbers);
    push_numbers(7);
    check_numbers(7);
}
END_TEST

START_TEST(failure_is_logged_with_its_name_and_reason)
{
    ck_assert_int_eq(occ_fail(&hooks, OCC_ERROR_LIMIT, "%d of %s", 3, "them"), OCC_ERROR_LIMIT);
    ck_assert_uint_eq(record.errors, 1);
    ck_assert_str_eq(record.text, "OCC_ERROR_LIMIT: 3 of them\n");
}
END_TEST

START_TEST(level_of_a_line_is_kept)
{
    occ_log(&hooks, OCC_LOG_INFO, "device %s", "x");
    ck_assert_uint_eq(record.lines, 1);
    ck_assert_uint_eq(record.errors, 0);
    occ_log(&hooks, OCC_LOG_ERROR, "broken");
    ck_assert_uint_eq(record.errors, 1);
}
END_TEST

START_TEST(long_line_is_cut_off)
{
    char text[3000];
    memset(text, 'x', sizeof text);
    text[sizeof text - 1] = '\0';
    occ_log(&hooks, OCC_LOG_INFO, "%s", text);
    ck_assert_uint_eq(record.lines, 1);
    ck_assert_uint_le(strlen(record.text), 1001);
    ck_assert_uint_ge(strlen(record.text), 900);
    (void)occ_fail(&hooks, OCC_ERROR_DEVICE, "%s", text);
    ck_assert_uint_eq(record.errors, 1);
}
END_TEST

START_TEST(without_a_logger_nothing_happens)
{
    hooks.logger.log = NULL;
    occ_log(&hooks, OCC_LOG_ERROR, "nobody listens");
    ck_assert_int_eq(occ_fail(&hooks, OCC_ERROR_DEVICE, "nor here"), OCC_ERROR_DEVICE);
    ck_assert_uint_eq(record.lines, 0);
}
END_TEST

static TCase *with_fixture(TCase *group)
{
    tcase_add_checked_fixture(group, set_up, tear_down);
    return group;
}

int main(void)
{
    Suite *suite = suite_create("memory");
    TCase *hook_tests = with_fixture(tcase_create("hooks"));
    tcase_add_test(hook_tests, allocator_with_one_function_is_refused);
    tcase_add_test(hook_tests, without_hooks_memory_comes_aligned_from_the_c_library);
    tcase_add_test(hook_tests, no_bytes_are_no_memory);
    tcase_add_test(hook_tests, bytes_are_what_the_allocator_gave);
    suite_add_tcase(suite, hook_tests);
    TCase *arrays = with_fixture(tcase_create("arrays"));
    tcase_add_test(arrays, array_keeps_its_elements_while_it_grows);
    tcase_add_test(arrays, reserved_elements_need_no_more_memory);
    tcase_add_test(arrays, extending_makes_room_and_leaves_the_count);
    tcase_add_test(arrays, extending_by_nothing_is_no_failure);
    tcase_add_test(arrays, array_that_cannot_grow_stays_as_it_was);
    tcase_add_test(arrays, more_elements_than_an_index_can_name_are_refused);
    tcase_add_test(arrays, trimming_gives_back_what_lies_beyond_the_count);
    tcase_add_test(arrays, array_that_cannot_be_trimmed_stays_as_it_was);
    tcase_add_test(arrays, freed_array_can_be_filled_again);
    suite_add_tcase(suite, arrays);
    TCase *lines = with_fixture(tcase_create("lines"));
    tcase_add_test(lines, failure_is_logged_with_its_name_and_reason);
    tcase_add_test(lines, level_of_a_line_is_kept);
    tcase_add_test(lines, long_line_is_cut_off);
    tcase_add_test(lines, without_a_logger_nothing_happens);
    suite_add_tcase(suite, lines);
    return test_run_suite(suite);
}
