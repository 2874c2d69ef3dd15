// SPDX-License-Identifier: Apache-2.0
#include "kit_team.h"
#include "support.h"
#include "tree_sort.h"

#include <stdlib.h>
#include <string.h>

typedef uint64_t (*key_maker)(kit_random *random, uint32_t i, uint32_t count);

static uint64_t any_key(kit_random *random, uint32_t i, uint32_t count)
{
    (void)i;
    (void)count;
    return kit_next(random) >> 2; // keys have 62 bits
}

static uint64_t one_key(kit_random *random, uint32_t i, uint32_t count)
{
    (void)random;
    (void)i;
    (void)count;
    return 0x2345678912345678u;
}

static uint64_t few_keys(kit_random *random, uint32_t i, uint32_t count)
{
    (void)i;
    (void)count;
    return (uint64_t)kit_below(random, 5) << 57;
}

static uint64_t ascending_keys(kit_random *random, uint32_t i, uint32_t count)
{
    (void)random;
    return (uint64_t)i * (((uint64_t)1 << 62) / count);
}

static uint64_t descending_keys(kit_random *random, uint32_t i, uint32_t count)
{
    return ascending_keys(random, count - 1 - i, count);
}

// Only one digit of eleven bits differs, so that the sorted entries end in the spare array.
static uint64_t keys_of_one_digit(kit_random *random, uint32_t i, uint32_t count)
{
    (void)i;
    (void)count;
    return (uint64_t)kit_below(random, 2048) << 22;
}

// Two digits differ: they end where they began.
static uint64_t keys_of_two_digits(kit_random *random, uint32_t i, uint32_t count)
{
    (void)i;
    (void)count;
    return kit_next(random) & 0x7ff000003ff800u;
}

// Nearly all in one bucket of those that many entries are split into, and far apart in it.
static uint64_t crowded_keys(kit_random *random, uint32_t i, uint32_t count)
{
    return i % 1000 ? kit_next(random) >> 20 : any_key(random, i, count);
}

// As a flat world has them: every third bit is the same in all.
static uint64_t keys_with_gaps(kit_random *random, uint32_t i, uint32_t count)
{
    return any_key(random, i, count) & 0x36db6db6db6db6d3u;
}

static const key_maker makers[] = {
    any_key,         one_key,           few_keys,           ascending_keys,
    descending_keys, keys_of_one_digit, keys_of_two_digits, crowded_keys,
    keys_with_gaps};
static const uint32_t counts[] = {0, 1, 2, 3, 63, 64, 65, 1000, 16383, 16384, 20000, 50000};

enum { MAKERS = (int)(sizeof makers / sizeof *makers) };

// By key, and among equal keys by the order in which they came: the row.
static int compare(const void *left, const void *right)
{
    const occ_tree_entry *a = left, *b = right;
    if (a->key != b->key) return a->key < b->key ? -1 : 1;
    return a->row < b->row ? -1 : a->row > b->row;
}

typedef struct sorting {
    occ_tree_entry *entries;
    void *room;
    uint32_t count;
} sorting;

static void sort_all(occ_team *team, void *context)
{
    sorting *s = context;
    size_t bytes = occ_tree_sort_room(s->count, team);
    s->room = malloc(bytes + 1);
    KIT_CHECK(s->room, "out of memory");
    occ_tree_sort(s->entries, s->room, s->count, team);
}

static void sort_and_compare(key_maker maker, uint32_t count, uint32_t threads)
{
    size_t bytes = (count + 1) * sizeof(occ_tree_entry);
    occ_tree_entry *entries = calloc(1, bytes), *expected = calloc(1, bytes);
    ck_assert(entries && expected);
    kit_random random = {count};
    for (uint32_t i = 0; i < count; i++)
        expected[i] = entries[i] = (occ_tree_entry){maker(&random, i, count), i};
    qsort(expected, count, sizeof *expected, compare);
    sorting s = {entries, NULL, count};
    kit_with_team(threads, sort_all, &s);
    for (uint32_t i = 0; i < count; i++) {
        KIT_CHECK(entries[i].key == expected[i].key, "entry %u of %u is out of order", i, count);
        KIT_CHECK(entries[i].row == expected[i].row, "%u of %u equal keys changed places", i,
                  count);
    }
    free(s.room);
    free(entries);
    free(expected);
}

START_TEST(entries_come_out_by_key_and_equal_ones_as_they_came)
{
    for (size_t c = 0; c < sizeof counts / sizeof *counts; c++)
        for (uint32_t threads = 1; threads <= 3; threads++)
            sort_and_compare(makers[_i], counts[c], threads);
    sort_and_compare(makers[_i], 100000, 8);
}
END_TEST

START_TEST(entries_beyond_the_count_stay_as_they_are)
{
    for (uint32_t count = 0; count < 200; count += 33) {
        occ_tree_entry entries[256], spare[256];
        kit_random random = {count};
        for (uint32_t i = 0; i < 256; i++)
            entries[i] = spare[i] = (occ_tree_entry){any_key(&random, i, count), i};
        size_t room = occ_tree_sort_room(count, NULL) / sizeof *spare;
        ck_assert_uint_le(room, count);
        occ_tree_entry last[2] = {entries[count], spare[room]};
        occ_tree_sort(entries, spare, count, NULL);
        ck_assert(entries[count].key == last[0].key && entries[count].row == last[0].row);
        ck_assert(spare[room].key == last[1].key && spare[room].row == last[1].row);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("tree_sort");
    TCase *order = tcase_create("order");
    tcase_add_loop_test(order, entries_come_out_by_key_and_equal_ones_as_they_came, 0, MAKERS);
    tcase_add_test(order, entries_beyond_the_count_stay_as_they_are);
    suite_add_tcase(suite, order);
    return test_run_suite(suite);
}
