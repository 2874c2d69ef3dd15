// SPDX-License-Identifier: Apache-2.0
// Every part once, whatever the number of threads, and what one step wrote the next one reads. What
// the assertions cannot see, ThreadSanitizer does.
#include "kit.h"
#include "support.h"
#include "team.h"

#include <string.h>

enum { STEPS = OCC_TEST_SLOWNESS > 1 ? 300 : 3000 };

typedef struct steps {
    uint32_t parts;
    uint32_t size;                 // as the team says
    uint32_t seen[OCC_MOST_PARTS]; // how often each part was done
    uint32_t from[OCC_MOST_PARTS]; // what its neighbour had been done in the step before
    uint32_t bodies;
} steps;

static void count(void *job, uint32_t part)
{
    steps *s = job;
    s->seen[part]++;
}

static void look_at_neighbour(void *job, uint32_t part)
{
    steps *s = job;
    s->from[part] = s->seen[(part + 1) % s->parts];
}

static void many_steps(occ_team *team, void *context)
{
    steps *s = context;
    s->size = occ_team_size(team);
    s->bodies++;
    for (uint32_t i = 1; i <= STEPS; i++) {
        s->parts = i % OCC_MOST_PARTS + 1;
        memset(s->seen, 0, sizeof s->seen);
        occ_do_parts(team, s->parts, count, s);
        occ_do_parts(team, s->parts, look_at_neighbour, s);
        for (uint32_t p = 0; p < OCC_MOST_PARTS; p++)
            KIT_CHECK(s->seen[p] == (p < s->parts), "step %u: part %u was done %u times", i, p,
                      s->seen[p]);
        for (uint32_t p = 0; p < s->parts; p++)
            KIT_CHECK(s->from[p] == 1, "step %u: part %u saw its neighbour undone", i, p);
    }
}

START_TEST(every_part_is_done_once)
{
    static const uint32_t threads[] = {1, 2, 3, 8};
    steps s = {0};
    occ_with_team(threads[_i], many_steps, &s);
    ck_assert_uint_eq(s.bodies, 1);
    ck_assert_uint_ge(s.size, 1);
    ck_assert_uint_le(s.size, threads[_i]);
}
END_TEST

static void no_step(occ_team *team, void *context)
{
    (void)team;
    ++*(uint32_t *)context;
}

START_TEST(team_without_work_ends)
{
    uint32_t bodies = 0;
    for (uint32_t i = 0; i < 100; i++)
        occ_with_team(1 + i % 5, no_step, &bodies);
    ck_assert_uint_eq(bodies, 100);
}
END_TEST

START_TEST(parts_cover_all_items_once)
{
    for (uint32_t n = 0; n < 40; n++) {
        uint32_t items = n < 32 ? 1u << n : UINT32_MAX - n, parts = occ_parts_of(items);
        ck_assert_uint_ge(parts, 1);
        ck_assert_uint_le(parts, OCC_MOST_PARTS);
        ck_assert_uint_eq(occ_part_first(items, parts, 0), 0);
        ck_assert_uint_eq(occ_part_first(items, parts, parts), items);
        for (uint32_t p = 0; p < parts && parts > 1; p++)
            KIT_CHECK(occ_part_first(items, parts, p + 1) - occ_part_first(items, parts, p) >=
                          OCC_PART_ITEMS,
                      "part %u of %u items is too small", p, items);
    }
}
END_TEST

START_TEST(threads_that_nobody_asked_for_are_what_openmp_offers)
{
    ck_assert_uint_ge(occ_threads_offered(0), 1);
    ck_assert_uint_le(occ_threads_offered(0), OCC_MOST_THREADS);
    ck_assert_uint_eq(occ_threads_offered(1), 1);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("team");
    TCase *parts = tcase_create("parts");
    tcase_add_loop_test(parts, every_part_is_done_once, 0, 4);
    tcase_add_test(parts, team_without_work_ends);
    tcase_add_test(parts, parts_cover_all_items_once);
    tcase_add_test(parts, threads_that_nobody_asked_for_are_what_openmp_offers);
    suite_add_tcase(suite, parts);
    return test_run_suite(suite);
}
