// SPDX-License-Identifier: Apache-2.0
// The mask of a view: what is set is listed, and what was set before is gone, whatever the sizes.
#include "mask.h"

#include "kit.h"
#include "support.h"

enum { MOST_SLOTS = 32 * 300 };

static occ_hooks hooks;
static occ_mask mask;
static bool is_set[MOST_SLOTS];
static uint32_t listed[MOST_SLOTS];

static void set_up(void)
{
    ck_assert_int_eq(occ_hooks_init(&hooks, &(occ_allocator){0}, &(occ_logger){0}), OCC_SUCCESS);
    mask = OCC_MASK;
}

static void tear_down(void)
{
    occ_mask_free(&hooks, &mask);
    ck_assert_uint_eq(hooks.bytes, 0);
}

static void check(uint32_t slots)
{
    uint32_t count = 0;
    for (uint32_t s = 0; s < slots; s++)
        count += is_set[s];
    memset(listed, 0xff, sizeof listed);
    occ_mask_list(&mask, listed);
    for (uint32_t s = 0, i = 0; s < slots; s++) {
        bool bit = ((const uint32_t *)mask.words.data)[s / 32] >> s % 32 & 1u;
        KIT_CHECK(bit == is_set[s], "%u slots: slot %u is %d", slots, s, bit);
        if (is_set[s]) KIT_CHECK(listed[i++] == s, "%u slots: slot %u is not listed", slots, s);
    }
    if (count < MOST_SLOTS) ck_assert_uint_eq(listed[count], UINT32_MAX);
}

START_TEST(mask_forgets_and_lists)
{
    static const uint32_t words[] = {1, 64, 64, 64, 300, 63, 63, 128, 0, 65, 300, 300};
    kit_random random = {11};
    for (size_t round = 0; round < sizeof words / sizeof *words; round++) {
        uint32_t slots = 32 * words[round], some = round % 3 ? slots / 20 : slots;
        ck_assert_int_eq(occ_mask_start(&hooks, &mask, words[round]), OCC_SUCCESS);
        ck_assert_uint_eq(mask.words.count, words[round]);
        memset(is_set, 0, sizeof is_set);
        check(slots);
        for (uint32_t i = 0; i < some; i++) {
            uint32_t slot = kit_below(&random, slots);
            occ_mask_set(&mask, slot);
            is_set[slot] = true;
        }
        check(slots);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("mask");
    TCase *bits = tcase_create("bits");
    tcase_add_checked_fixture(bits, set_up, tear_down);
    tcase_add_test(bits, mask_forgets_and_lists);
    suite_add_tcase(suite, bits);
    return test_run_suite(suite);
}
