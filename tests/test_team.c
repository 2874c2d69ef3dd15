// SPDX-License-Identifier: Apache-2.0
// Every part once, whatever the number of threads, and what one step wrote the next one reads. What
// the assertions cannot see, ThreadSanitizer does.
#define _POSIX_C_SOURCE 200809L
#include "kit.h"
#include "support.h"
#include "team.h"

#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { STEPS = OCC_TEST_SLOWNESS > 1 ? 300 : 3000 };

typedef struct steps {
    uint32_t parts;
    uint32_t seen[OCC_MOST_PARTS]; // how often each part was done
    uint32_t from[OCC_MOST_PARTS]; // what its neighbour had been done in the step before
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

static void many_steps(occ_team *team, steps *s)
{
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

static const uint32_t threads[] = {1, 2, 3, 8};
static occ_hooks hooks;
static occ_team *team;

static void set_up(void)
{
    static const occ_allocator allocator;
    static const occ_logger logger;
    ck_assert_int_eq(occ_hooks_init(&hooks, &allocator, &logger), OCC_SUCCESS);
}

static void make_team(uint32_t size)
{
    ck_assert_int_eq(occ_team_create(&hooks, size, &team), OCC_SUCCESS);
    ck_assert_uint_eq(occ_team_size(team), size);
}

static void end_team(void)
{
    occ_team_destroy(&hooks, team);
    ck_assert_uint_eq(hooks.bytes, 0);
}

START_TEST(every_part_is_done_once)
{
    steps s = {0};
    make_team(threads[_i]);
    many_steps(team, &s); // alone
    for (int round = 0; round < 3; round++) {
        occ_team_wake(team);
        many_steps(team, &s);
        occ_team_rest(team);
    }
    many_steps(NULL, &s);
    end_team();
}
END_TEST

// Sleeping between calls, or still looking for work: whatever the gap.
START_TEST(others_come_when_called)
{
    make_team(threads[_i]);
    steps s = {.parts = OCC_MOST_PARTS};
    for (uint32_t i = 0; i < 60; i++) {
        struct timespec gap = {0, i % 3 ? 1000L * i * i : 0};
        nanosleep(&gap, NULL);
        memset(s.seen, 0, sizeof s.seen);
        occ_team_wake(team);
        occ_do_parts(team, s.parts, count, &s);
        occ_team_rest(team);
        for (uint32_t p = 0; p < s.parts; p++)
            KIT_CHECK(s.seen[p] == 1, "call %u: part %u was done %u times", i, p, s.seen[p]);
    }
    end_team();
}
END_TEST

enum { ITEMS = 5000 };

// Items of a list that grows while it is being done, and moves.
typedef struct list {
    uint32_t *done;
} list;

static void do_item(void *context, uint32_t item)
{
    list *l = context;
    l->done[item]++;
}

static void move_list(list *l, uint32_t room)
{
    uint32_t *moved = calloc(room, sizeof *moved);
    ck_assert_ptr_nonnull(moved);
    if (l->done) memcpy(moved, l->done, room / 2 * sizeof *moved);
    free(l->done);
    l->done = moved;
}

START_TEST(list_may_grow_and_move)
{
    make_team(threads[_i]);
    for (uint32_t round = 0; round < 20; round++) {
        list l = {NULL};
        uint32_t room = 0;
        occ_team_begin(team, do_item, &l);
        occ_team_wake(team);
        for (uint32_t i = 0; i < ITEMS; i++) {
            if (i == room) {
                occ_team_settle(team);
                room = room ? 2 * room : 16;
                move_list(&l, room);
            }
            occ_team_offer(team, i + 1);
        }
        occ_team_settle(team);
        occ_team_rest(team);
        for (uint32_t i = 0; i < ITEMS; i++)
            KIT_CHECK(l.done[i] == 1, "round %u: item %u was done %u times", round, i, l.done[i]);
        free(l.done);
    }
    end_team();
}
END_TEST

#ifdef __has_feature
#define HAS_TSAN __has_feature(thread_sanitizer)
#else
#define HAS_TSAN 0
#endif

// A child process has none of its parent's threads: it makes its own and waits for nobody's.
START_TEST(team_survives_a_fork)
{
    make_team(3);
    steps s = {0};
    occ_team_wake(team);
    many_steps(team, &s);
    occ_team_rest(team);
    pid_t child = fork();
    ck_assert_int_ge(child, 0);
    if (!child) {
        steps own = {0};
        occ_team_wake(team);
        many_steps(team, &own);
        occ_team_rest(team);
        occ_team_destroy(&hooks, team);
        _exit(hooks.bytes ? 1 : 0);
    }
    int status;
    ck_assert_int_eq(waitpid(child, &status, 0), child);
    ck_assert_int_eq(status, 0);
    end_team();
}
END_TEST

START_TEST(team_without_work_ends)
{
    for (uint32_t i = 0; i < 100; i++) {
        make_team(1 + i % 5);
        if (i % 2) occ_team_wake(team);
        if (i % 3) occ_team_rest(team);
        end_team();
    }
    occ_team_destroy(&hooks, NULL);
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
    tcase_add_checked_fixture(parts, set_up, NULL);
    tcase_add_loop_test(parts, every_part_is_done_once, 0, 4);
    tcase_add_loop_test(parts, others_come_when_called, 0, 4);
    tcase_add_loop_test(parts, list_may_grow_and_move, 0, 4);
    // ThreadSanitizer ends a child that starts threads.
    if (!HAS_TSAN) tcase_add_test(parts, team_survives_a_fork);
    tcase_add_test(parts, team_without_work_ends);
    tcase_add_test(parts, parts_cover_all_items_once);
    tcase_add_test(parts, threads_that_nobody_asked_for_are_what_openmp_offers);
    suite_add_tcase(suite, parts);
    return test_run_suite(suite);
}
