// SPDX-License-Identifier: Apache-2.0
#include "kit.h"
#include "slots.h"
#include "support.h"

#include <string.h>

static kit_heap heap;
static occ_hooks hooks;
static occ_slots slots;

static void set_up(void)
{
    heap = (kit_heap){0};
    occ_allocator allocator = kit_allocator(&heap);
    occ_logger silent = {NULL, NULL};
    ck_assert_int_eq(occ_hooks_init(&hooks, &allocator, &silent), OCC_SUCCESS);
    slots = OCC_SLOTS;
}

static void tear_down(void)
{
    occ_slots_free(&hooks, &slots);
    ck_assert_uint_eq(heap.blocks, 0);
    ck_assert_uint_eq(hooks.bytes, 0);
}

static uint32_t take(uint32_t value)
{
    KIT_CHECK(!occ_slots_reserve(&hooks, &slots, 1), "no room for a slot");
    return occ_slots_take(&slots, value);
}

static void check_valid(void)
{
    const char *broken = occ_slots_validate(&slots);
    ck_assert_msg(!broken, "%s", broken);
}

START_TEST(fresh_slots_come_in_ascending_order)
{
    for (uint32_t i = 0; i < 1000; i++) {
        KIT_CHECK(take(i + 7) == i, "slot %u comes out of order", i);
        KIT_CHECK(slots.value[i] == i + 7, "slot %u has lost its value", i);
    }
    check_valid();
}
END_TEST

START_TEST(handle_names_its_slot_until_that_is_released)
{
    uint32_t slot = take(0), generation = slots.generation[slot];
    ck_assert_uint_eq(occ_slots_find(&slots, slot + 1, generation), slot);
    occ_slots_release(&slots, slot);
    ck_assert_uint_eq(occ_slots_find(&slots, slot + 1, generation), OCC_NO_SLOT);
    occ_slots_recycle(&slots);
    ck_assert_uint_eq(occ_slots_find(&slots, slot + 1, generation), OCC_NO_SLOT);
    ck_assert_uint_eq(take(0), slot);
    ck_assert_uint_eq(occ_slots_find(&slots, slot + 1, generation), OCC_NO_SLOT);
}
END_TEST

START_TEST(handle_that_was_never_given_names_nothing)
{
    uint32_t slot = take(0);
    ck_assert_uint_eq(occ_slots_find(&slots, 0, 0), OCC_NO_SLOT);
    ck_assert_uint_eq(occ_slots_find(&slots, 0, slots.generation[slot]), OCC_NO_SLOT);
    ck_assert_uint_eq(occ_slots_find(&slots, slot + 2, slots.generation[slot]), OCC_NO_SLOT);
    ck_assert_uint_eq(occ_slots_find(&slots, UINT32_MAX, 1), OCC_NO_SLOT);
    uint32_t fitting = 0;
    for (uint32_t generation = 0; generation < 0x30000; generation++)
        fitting += occ_slots_find(&slots, slot + 1, generation) != OCC_NO_SLOT;
    ck_assert_uint_eq(fitting, 1);
}
END_TEST

START_TEST(released_slot_is_not_taken_before_it_is_recycled)
{
    uint32_t first = take(0), second = take(0);
    occ_slots_release(&slots, first);
    uint32_t third = take(0);
    ck_assert(third != first && third != second);
    occ_slots_recycle(&slots);
    check_valid();
    ck_assert_uint_eq(take(0), first);
}
END_TEST

START_TEST(slot_is_retired_when_its_generations_are_used_up)
{
    uint32_t slot = take(0), lives = 1;
    while (slots.generation[slot] != UINT16_MAX) {
        occ_slots_release(&slots, slot);
        occ_slots_recycle(&slots);
        KIT_CHECK(take(0) == slot, "another slot was taken");
        lives++;
    }
    ck_assert_uint_eq(lives, 32768);
    occ_slots_release(&slots, slot);
    occ_slots_recycle(&slots);
    check_valid();
    for (uint32_t generation = 0; generation <= UINT16_MAX; generation++)
        KIT_CHECK(occ_slots_find(&slots, slot + 1, generation) == OCC_NO_SLOT,
                  "generation %u still fits", generation);
    ck_assert_uint_ne(take(0), slot);
    check_valid();
}
END_TEST

START_TEST(free_slots_need_no_memory)
{
    ck_assert_int_eq(occ_slots_reserve(&hooks, &slots, 100), OCC_SUCCESS);
    for (uint32_t i = 0; i < 100; i++)
        (void)occ_slots_take(&slots, i);
    for (uint32_t i = 0; i < 100; i += 2)
        occ_slots_release(&slots, i);
    occ_slots_recycle(&slots);
    uint64_t calls = heap.calls;
    ck_assert_int_eq(occ_slots_reserve(&hooks, &slots, 50), OCC_SUCCESS);
    for (uint32_t i = 0; i < 50; i++)
        ck_assert_uint_lt(occ_slots_take(&slots, i), 100);
    ck_assert_uint_eq(heap.calls, calls);
    check_valid();
}
END_TEST

START_TEST(growing_keeps_values_and_generations)
{
    for (uint32_t i = 0; i < 10; i++)
        (void)take(100 + i);
    occ_slots_release(&slots, 4);
    occ_slots_recycle(&slots);
    (void)take(77);
    ck_assert_int_eq(occ_slots_reserve(&hooks, &slots, 100000), OCC_SUCCESS);
    for (uint32_t i = 0; i < 10; i++) {
        ck_assert_uint_eq(slots.value[i], i == 4 ? 77 : 100 + i);
        ck_assert_uint_eq(slots.generation[i], i == 4 ? 3 : 1);
    }
    check_valid();
}
END_TEST

START_TEST(failing_to_grow_changes_nothing)
{
    uint32_t slot = take(5);
    for (uint64_t n = 1; n <= 2; n++) {
        occ_slots before = slots;
        uint64_t bytes = hooks.bytes;
        heap.fail_at = heap.calls + n;
        ck_assert_int_eq(occ_slots_reserve(&hooks, &slots, 1000), OCC_ERROR_OUT_OF_MEMORY);
        ck_assert_mem_eq(&slots, &before, sizeof slots);
        ck_assert_uint_eq(hooks.bytes, bytes);
        ck_assert_uint_eq(occ_slots_find(&slots, slot + 1, 1), slot);
    }
}
END_TEST

START_TEST(more_slots_than_an_index_can_name_are_refused)
{
    static const size_t too_many[] = {UINT32_MAX - 1, UINT32_MAX, (size_t)UINT32_MAX + 1,
                                      SIZE_MAX / 2, SIZE_MAX};
    (void)take(0);
    uint64_t calls = heap.calls;
    for (size_t i = 0; i < sizeof too_many / sizeof *too_many; i++)
        ck_assert_int_eq(occ_slots_reserve(&hooks, &slots, too_many[i]), OCC_ERROR_LIMIT);
    ck_assert_uint_eq(heap.calls, calls);
}
END_TEST

enum { MODEL = 300 };

// What the table should say, kept in the plainest way.
typedef struct model {
    uint32_t index[MODEL], generation[MODEL], value[MODEL];
    bool alive[MODEL];
    uint32_t count;
} model;

static void check_model(const model *m)
{
    uint32_t alive = 0;
    for (uint32_t i = 0; i < m->count; i++) {
        uint32_t slot = occ_slots_find(&slots, m->index[i], m->generation[i]);
        KIT_CHECK(slot == (m->alive[i] ? m->index[i] - 1 : OCC_NO_SLOT), "handle %u names %u", i,
                  slot);
        if (!m->alive[i]) continue;
        KIT_CHECK(slots.value[slot] == m->value[i], "slot %u has another's value", slot);
        alive++;
    }
    ck_assert_uint_eq(slots.taken, alive);
    check_valid();
}

START_TEST(random_lives_agree_with_a_list)
{
    kit_random random = {(uint64_t)_i};
    model m = {.count = 0};
    while (m.count < MODEL) {
        uint32_t what = kit_below(&random, 10);
        if (what < 6) {
            uint32_t slot = take(m.count * 3);
            m.index[m.count] = slot + 1;
            m.generation[m.count] = slots.generation[slot];
            m.value[m.count] = m.count * 3;
            m.alive[m.count++] = true;
        } else if (what < 9 && m.count) {
            uint32_t i = kit_below(&random, m.count);
            if (m.alive[i]) occ_slots_release(&slots, m.index[i] - 1);
            m.alive[i] = false;
        } else {
            occ_slots_recycle(&slots);
        }
        check_model(&m);
    }
}
END_TEST

// --- the validator itself ------------------------------------------------------------------------

typedef struct damage {
    const char *what;
    void (*do_it)(void);
} damage;

static void count_one_taken_too_many(void)
{
    slots.taken++;
}

static void count_one_free_too_few(void)
{
    slots.free_count--;
}

static void count_one_released_too_many(void)
{
    slots.released_count++;
}

static void lose_the_free_list(void)
{
    slots.free = OCC_NO_SLOT;
    slots.free_count = 0;
}

static void lose_the_released_list(void)
{
    slots.released = OCC_NO_SLOT;
    slots.released_count = 0;
}

static void bite_the_tail(void)
{
    slots.value[slots.free] = slots.free;
}

static void point_beyond_the_end(void)
{
    slots.value[slots.free] = slots.count;
}

static void list_a_taken_slot(void)
{
    slots.value[slots.released] = 9;
}

static void forget_the_last_released(void)
{
    slots.released_last = 9;
}

static void take_without_counting(void)
{
    slots.generation[slots.free]++;
}

static const damage damages[] = {
    {"taken", count_one_taken_too_many},
    {"free_count", count_one_free_too_few},
    {"released_count", count_one_released_too_many},
    {"free", lose_the_free_list},
    {"released", lose_the_released_list},
    {"a cycle", bite_the_tail},
    {"a slot that is not there", point_beyond_the_end},
    {"a taken slot in a list", list_a_taken_slot},
    {"released_last", forget_the_last_released},
    {"generation", take_without_counting},
};

enum { DAMAGES = (int)(sizeof damages / sizeof *damages) };

START_TEST(validator_sees_every_damage)
{
    for (uint32_t i = 0; i < 10; i++)
        (void)take(i);
    occ_slots_release(&slots, 0);
    occ_slots_release(&slots, 1);
    occ_slots_release(&slots, 2);
    occ_slots_recycle(&slots);
    occ_slots_release(&slots, 5);
    occ_slots_release(&slots, 6);
    check_valid();
    damages[_i].do_it();
    ck_assert_msg(occ_slots_validate(&slots), "damage goes unseen: %s", damages[_i].what);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("slots");
    TCase *life = tcase_create("life");
    tcase_add_checked_fixture(life, set_up, tear_down);
    tcase_add_test(life, fresh_slots_come_in_ascending_order);
    tcase_add_test(life, handle_names_its_slot_until_that_is_released);
    tcase_add_test(life, handle_that_was_never_given_names_nothing);
    tcase_add_test(life, released_slot_is_not_taken_before_it_is_recycled);
    tcase_add_test(life, slot_is_retired_when_its_generations_are_used_up);
    tcase_add_test(life, free_slots_need_no_memory);
    tcase_add_test(life, growing_keeps_values_and_generations);
    tcase_add_test(life, failing_to_grow_changes_nothing);
    tcase_add_test(life, more_slots_than_an_index_can_name_are_refused);
    tcase_add_loop_test(life, random_lives_agree_with_a_list, 0, 8);
    suite_add_tcase(suite, life);
    TCase *validator = tcase_create("validator");
    tcase_add_checked_fixture(validator, set_up, tear_down);
    tcase_add_loop_test(validator, validator_sees_every_damage, 0, DAMAGES);
    suite_add_tcase(suite, validator);
    return test_run_suite(suite);
}
