// SPDX-License-Identifier: Apache-2.0
// The walk's bucket queue: everything once, in the order of buckets, whatever the keys.
#include "queue.h"

#include "kit.h"
#include "support.h"

#include <float.h>
#include <stdlib.h>

enum { ENTRIES = 4000 };

static occ_hooks hooks;
static occ_queue queue;

static void set_up(void)
{
    ck_assert_int_eq(occ_hooks_init(&hooks, &(occ_allocator){0}, &(occ_logger){0}), OCC_SUCCESS);
    queue = (occ_queue){.entries = OCC_ARRAY(occ_walk_entry)};
}

static void tear_down(void)
{
    occ_array_free(&hooks, &queue.entries);
    ck_assert_uint_eq(hooks.bytes, 0);
}

static void push(float key, uint32_t index, uint32_t what)
{
    occ_walk_entry entry = {.key = key, .index = index, .what = what};
    KIT_CHECK(!occ_queue_push(&hooks, &queue, entry), "not pushed");
}

// Keys from 1 to 1e6, as distances squared are.
static float any_key(kit_random *random)
{
    return powf(10.0f, kit_between(random, 0.0f, 6.0f));
}

START_TEST(entries_come_out_once_and_front_to_back)
{
    kit_random random = {3};
    static bool seen[ENTRIES];
    memset(seen, 0, sizeof seen);
    float farthest = 0.0f;
    occ_queue_start(&queue, 0.0f, 1e6f);
    for (uint32_t i = 0; i < ENTRIES; i++)
        push(any_key(&random), i, i % 3 ? OCC_WALK_NODE : OCC_WALK_OCCLUDER);
    for (uint32_t i = 0; i < ENTRIES; i++) {
        uint32_t bucket = occ_queue_bucket_of_first(&queue);
        occ_walk_entry entry = occ_queue_pop(&queue);
        KIT_CHECK(!seen[entry.index], "entry %u came twice", entry.index);
        KIT_CHECK(occ_queue_bucket(&queue, entry.key) == bucket, "a wrong bucket");
        KIT_CHECK(entry.key >= farthest * (15.0f / 16.0f), "%g after %g", (double)entry.key,
                  (double)farthest);
        farthest = fmaxf(farthest, entry.key);
        seen[entry.index] = true;
    }
    ck_assert_uint_eq(queue.count, 0);
}
END_TEST

START_TEST(occluders_go_before_nodes_of_their_bucket)
{
    occ_queue_start(&queue, 0.0f, 100.0f);
    push(50.0f, 1, OCC_WALK_NODE);
    push(50.1f, 2, OCC_WALK_OCCLUDER);
    push(50.2f, 3, OCC_WALK_FREE);
    ck_assert_uint_eq(occ_queue_pop(&queue).index, 2);
    push(50.3f, 4, OCC_WALK_OCCLUDER);
    ck_assert_uint_eq(occ_queue_pop(&queue).index, 4);
    ck_assert_uint_ne(occ_queue_pop(&queue).index, 4);
    ck_assert_uint_eq(queue.count, 1);
}
END_TEST

// What is pushed while others are taken is never nearer than the bucket of what was just taken.
START_TEST(places_are_used_again)
{
    kit_random random = {5};
    uint32_t pushed = 0, taken = 0, bucket = 0;
    occ_queue_start(&queue, 0.0f, 1e6f);
    push(1.0f, 0, OCC_WALK_NODE);
    for (; queue.count; taken++) {
        KIT_CHECK(occ_queue_bucket_of_first(&queue) >= bucket, "back to front");
        occ_walk_entry entry = occ_queue_pop(&queue);
        for (uint32_t i = 0; i < 3 && pushed < ENTRIES; i++, pushed++)
            push(entry.key * kit_between(&random, 1.0f, 2.0f), pushed, OCC_WALK_NODE);
        if (queue.count > 20) // let it shrink now and then
            for (; queue.count > 5; taken++)
                (void)occ_queue_pop(&queue);
        bucket = queue.count ? occ_queue_bucket_of_first(&queue) : 0;
    }
    ck_assert_uint_eq(taken, pushed + 1);
    ck_assert_uint_lt(queue.entries.count, 64);
}
END_TEST

// Whatever the numbers, a larger key is in no lower bucket.
START_TEST(strange_keys_are_in_the_outer_buckets)
{
    static const float rising[] = {-INFINITY, -1e30f, -1.0f,   0.0f,    FLT_TRUE_MIN,
                                   1e-30f,    1e-6f,  1.0f,    7.0f,    8.0f,
                                   1000.0f,   1e20f,  FLT_MAX, INFINITY};
    static const float spans[][2] = {{0, 1000},           {-500, 500}, {3, 3},
                                     {0, INFINITY},       {0, 1e-40f}, {INFINITY, -INFINITY},
                                     {-FLT_MAX, FLT_MAX}, {0, 1e-20f}, {NAN, NAN}};
    const size_t count = sizeof rising / sizeof *rising;
    for (size_t s = 0; s < sizeof spans / sizeof *spans; s++) {
        occ_queue_start(&queue, spans[s][0], spans[s][1]);
        uint32_t last = 0;
        for (size_t i = 0; i < count; i++) {
            uint32_t bucket = occ_queue_bucket(&queue, rising[i]);
            ck_assert_uint_lt(bucket, OCC_QUEUE_BUCKETS);
            KIT_CHECK(bucket >= last, "span %zu: key %zu is before the last", s, i);
            last = bucket;
            push(rising[i], (uint32_t)i, OCC_WALK_NODE);
        }
        push(NAN, 99, OCC_WALK_NODE);
        for (size_t i = 0; i <= count; i++)
            (void)occ_queue_pop(&queue);
        ck_assert_uint_eq(queue.count, 0);
    }
}
END_TEST

START_TEST(shortage_of_memory_is_told)
{
    static kit_heap heap;
    heap.fail_at = 1;
    occ_allocator allocator = kit_allocator(&heap);
    ck_assert_int_eq(occ_hooks_init(&hooks, &allocator, &(occ_logger){0}), OCC_SUCCESS);
    occ_queue_start(&queue, 0.0f, 1.0f);
    occ_walk_entry entry = {.key = 0.5f};
    ck_assert_int_eq(occ_queue_push(&hooks, &queue, entry), OCC_ERROR_OUT_OF_MEMORY);
    ck_assert_uint_eq(queue.count, 0);
    push(0.5f, 1, OCC_WALK_NODE);
    ck_assert_uint_eq(occ_queue_pop(&queue).index, 1);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("queue");
    TCase *buckets = tcase_create("buckets");
    tcase_add_checked_fixture(buckets, set_up, tear_down);
    tcase_add_test(buckets, entries_come_out_once_and_front_to_back);
    tcase_add_test(buckets, occluders_go_before_nodes_of_their_bucket);
    tcase_add_test(buckets, places_are_used_again);
    tcase_add_test(buckets, strange_keys_are_in_the_outer_buckets);
    tcase_add_test(buckets, shortage_of_memory_is_told);
    suite_add_tcase(suite, buckets);
    return test_run_suite(suite);
}
