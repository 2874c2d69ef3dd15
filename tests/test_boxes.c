// SPDX-License-Identifier: Apache-2.0
#include "boxes.h"
#include "kit_team.h"
#include "support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static kit_heap heap;
static occ_hooks hooks;
static occ_boxes boxes;

static void set_up(void)
{
    heap = (kit_heap){0};
    occ_allocator allocator = kit_allocator(&heap);
    occ_logger silent = {NULL, NULL};
    ck_assert_int_eq(occ_hooks_init(&hooks, &allocator, &silent), OCC_SUCCESS);
    boxes = (occ_boxes){NULL, 0, 0};
}

static void tear_down(void)
{
    occ_boxes_free(&hooks, &boxes);
    ck_assert_uint_eq(heap.blocks, 0);
    ck_assert_uint_eq(hooks.bytes, 0);
}

// The i-th of a row of boxes that all differ.
static occ_box nth(uint32_t i)
{
    kit_random random = {i};
    return kit_box(&random, 1000, 10);
}

static void fill(uint32_t count)
{
    ck_assert_int_eq(occ_boxes_reserve(&hooks, &boxes, count), OCC_SUCCESS);
    for (uint32_t i = boxes.count; i < count; i++) {
        occ_box box = nth(i);
        occ_boxes_set(&boxes, i, &box);
    }
    boxes.count = count;
}

static void check_row(uint32_t row, uint32_t expected)
{
    occ_box box = occ_boxes_get(&boxes, row), same = nth(expected);
    ck_assert_mem_eq(&box, &same, sizeof box);
}

START_TEST(box_comes_back_bit_for_bit)
{
    static const float odd[] = {-0.0f, 0x1p-149f, -0x1p-127f, 1e15f, 0.1f};
    ck_assert_int_eq(occ_boxes_reserve(&hooks, &boxes, 5), OCC_SUCCESS);
    for (uint32_t i = 0; i < 5; i++) {
        occ_box box;
        float numbers[12];
        for (uint32_t k = 0; k < 12; k++)
            numbers[k] = odd[(i + k) % 5];
        memcpy(&box, numbers, sizeof box);
        occ_boxes_set(&boxes, i, &box);
        occ_box back = occ_boxes_get(&boxes, i);
        ck_assert_mem_eq(&back, &box, sizeof box);
    }
}
END_TEST

START_TEST(number_k_of_a_box_stands_in_column_k)
{
    fill(100);
    for (uint32_t i = 0; i < 100; i++) {
        float numbers[12];
        occ_box box = nth(i);
        memcpy(numbers, &box, sizeof box);
        for (uint32_t k = 0; k < 12; k++)
            KIT_CHECK(occ_boxes_column(&boxes, k)[i] == numbers[k], "box %u, number %u", i, k);
    }
}
END_TEST

START_TEST(sixteen_rows_can_be_loaded_from_any_row)
{
    for (uint32_t count = 1; count < 70; count++) {
        fill(count);
        ck_assert_uint_eq(boxes.stride % OCC_BOX_LANES, 0);
        ck_assert_uint_ge(boxes.stride, count - 1 + OCC_BOX_LANES);
    }
}
END_TEST

START_TEST(unused_rows_hold_finite_numbers)
{
    fill(3);
    fill(40);
    for (uint32_t k = 0; k < OCC_BOX_COLUMNS; k++)
        for (uint32_t row = 0; row < boxes.stride; row++)
            KIT_CHECK(isfinite(occ_boxes_column(&boxes, k)[row]), "row %u, column %u", row, k);
}
END_TEST

START_TEST(growing_keeps_every_box)
{
    for (uint32_t count = 1; count < 3000; count = 2 * count + 5)
        fill(count);
    for (uint32_t i = 0; i < boxes.count; i++)
        check_row(i, i);
}
END_TEST

START_TEST(failing_to_grow_changes_nothing)
{
    fill(20);
    occ_boxes before = boxes;
    heap.fail_at = heap.calls + 1;
    ck_assert_int_eq(occ_boxes_reserve(&hooks, &boxes, 5000), OCC_ERROR_OUT_OF_MEMORY);
    ck_assert_mem_eq(&boxes, &before, sizeof boxes);
    for (uint32_t i = 0; i < 20; i++)
        check_row(i, i);
}
END_TEST

START_TEST(more_boxes_than_an_index_can_name_are_refused)
{
    fill(1);
    uint64_t calls = heap.calls;
    ck_assert_int_eq(occ_boxes_reserve(&hooks, &boxes, UINT32_MAX), OCC_ERROR_LIMIT);
    ck_assert_int_eq(occ_boxes_reserve(&hooks, &boxes, (size_t)1 << 40), OCC_ERROR_LIMIT);
    ck_assert_uint_eq(heap.calls, calls);
}
END_TEST

enum { GATHERED = 20000 }; // more than one part

static uint32_t source[GATHERED], scratch_columns;

static void gather(occ_team *team, void *scratch)
{
    occ_boxes_gather(&boxes, source, GATHERED, scratch, scratch_columns, team);
}

START_TEST(gathering_puts_rows_into_the_order_asked_for)
{
    static const uint32_t columns[] = {1, 5, 8, OCC_BOX_COLUMNS};
    scratch_columns = columns[_i];
    float *scratch = malloc(sizeof(float) * GATHERED * scratch_columns);
    ck_assert_ptr_nonnull(scratch);
    fill(GATHERED);
    kit_random random = {7};
    for (uint32_t i = 0; i < GATHERED; i++) { // a shuffle
        uint32_t j = kit_below(&random, i + 1);
        source[i] = source[j];
        source[j] = i;
    }
    kit_with_team((uint32_t)_i + 1, gather, scratch);
    for (uint32_t i = 0; i < GATHERED; i++)
        check_row(i, source[i]);
    free(scratch);
}
END_TEST

START_TEST(gathering_leaves_out_what_is_not_listed)
{
    static const uint32_t few[] = {8, 3, 4};
    float scratch[3];
    fill(10);
    occ_boxes_gather(&boxes, few, 3, scratch, 1, NULL);
    ck_assert_uint_eq(boxes.count, 3);
    for (uint32_t i = 0; i < 3; i++)
        check_row(i, few[i]);
    occ_boxes_gather(&boxes, NULL, 0, NULL, 1, NULL);
    ck_assert_uint_eq(boxes.count, 0);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("boxes");
    TCase *table = tcase_create("table");
    tcase_add_checked_fixture(table, set_up, tear_down);
    tcase_add_test(table, box_comes_back_bit_for_bit);
    tcase_add_test(table, number_k_of_a_box_stands_in_column_k);
    tcase_add_test(table, sixteen_rows_can_be_loaded_from_any_row);
    tcase_add_test(table, unused_rows_hold_finite_numbers);
    tcase_add_test(table, growing_keeps_every_box);
    tcase_add_test(table, failing_to_grow_changes_nothing);
    tcase_add_test(table, more_boxes_than_an_index_can_name_are_refused);
    tcase_add_loop_test(table, gathering_puts_rows_into_the_order_asked_for, 0, 4);
    tcase_add_test(table, gathering_leaves_out_what_is_not_listed);
    suite_add_tcase(suite, table);
    return test_run_suite(suite);
}
