// SPDX-License-Identifier: Apache-2.0
// What `occlude-bench error --targets` says of its rows.
#define _POSIX_C_SOURCE 200809L
#include "error_target.h"
#include "support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// What city_10000 is where the other programs' figures come from.
static const uint64_t city_10000 = UINT64_C(0xc71dec626980c395);

static const error_goal *goal_of(const char *name)
{
    for (const error_goal *goal = error_goals; goal->source.name; goal++)
        if (strcmp(goal->source.name, name) == 0) return goal;
    ck_abort_msg("%s has no goal", name);
    return NULL;
}

// A row that reaches all that is asked for.
static error_target good_row(const char *name, int variant)
{
    error_target row = {.goal = goal_of(name), .variant = variant, .is_same = true};
    error_goal_source(row.goal, variant, row.scene);
    double ms = row.goal->ms > 0 ? row.goal->ms : 0.1;
    row.one = (measure_summary){.median_ms = ms, .p99_ms = 2 * ms, .max_ms = 4 * ms, .visible = 10};
    row.two = (measure_summary){.median_ms = ms / 1.5, .max_ms = ms, .visible = 10};
    row.build_ms = 70;
    row.truth_frames = 3;
    row.sums = (compare_sums){.in_frustum = 1100, .visible = 100, .missed = 0};
    return row;
}

static char *totals_of(error_target *rows, size_t count)
{
    const error_targets targets = {.rows = rows, .count = count};
    char *text;
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    ck_assert_ptr_nonnull(stream);
    error_targets_totals(stream, &targets);
    fclose(stream);
    return text;
}

static void expect_line(error_target *rows, size_t count, const char *line)
{
    char *text = totals_of(rows, count);
    ck_assert_msg(strstr(text, line), "no \"%s\" in\n%s", line, text);
    free(text);
}

START_TEST(what_is_reached_is_said_to_be_met)
{
    error_target rows[] = {good_row("city_10000", 0), good_row("city_1000000", 0)};
    char *text = totals_of(rows, 2);
    ck_assert_ptr_null(strstr(text, "not met"));
    free(text);
    expect_line(rows, 2, "the time is met on 2 of 2, the missed share on 2\n");
    expect_line(rows, 2, "city_1000000 against city_10000: 8.3 times");
}
END_TEST

START_TEST(a_false_hidden_object_is_a_fault)
{
    error_target rows[] = {good_row("city_10000", 0), good_row("forest_100000", 1)};
    rows[1].sums.false_hidden = 1;
    const error_targets targets = {.rows = rows, .count = 2};
    ck_assert_uint_eq(error_targets_faults(&targets).false_hidden, 1);
    ck_assert_uint_eq(error_targets_faults(&targets).different, 0);
    expect_line(rows, 2, "all scenes: 1 (limit 0: **not met**)");
}
END_TEST

START_TEST(another_mask_on_two_threads_is_a_fault)
{
    error_target rows[] = {good_row("city_10000", 0)};
    rows[0].is_same = false;
    const error_targets targets = {.rows = rows, .count = 1};
    ck_assert_uint_eq(error_targets_faults(&targets).different, 1);
    expect_line(rows, 1, "gave other masks: 1 (limit 0: **not met**)");
}
END_TEST

START_TEST(the_slowest_frame_of_any_scene_counts)
{
    error_target rows[] = {good_row("city_10000", 0), good_row("interior_10000", 2)};
    rows[1].one.max_ms = 4.1 * rows[1].one.median_ms;
    expect_line(rows, 2, "largest: 4.10 in interior_10000_seed12 (limit 4: **not met**)");
}
END_TEST

START_TEST(two_threads_need_not_help_where_one_is_fast)
{
    error_target rows[] = {good_row("city_10000", 0), good_row("soup_100000", 0)};
    rows[0].two.median_ms = rows[0].one.median_ms;
    expect_line(rows, 1, "no scene needs more than 0.25 ms");
    expect_line(rows, 2, "least: 1.50 in soup_100000 (at least 1.35: met)");
    rows[1].two.median_ms = rows[1].one.median_ms / 1.3;
    expect_line(rows, 2, "least: 1.30 in soup_100000 (at least 1.35: **not met**)");
}
END_TEST

START_TEST(growth_and_build_are_of_one_seed)
{
    error_target rows[] = {good_row("city_10000", 0), good_row("city_10000", 1),
                           good_row("city_1000000", 1)};
    rows[1].one.median_ms = 0.01;
    rows[2].build_ms = 81;
    expect_line(rows, 3,
                "city_1000000_seed11 against city_10000_seed11: 50.0 times the time "
                "(limit 10: **not met**)");
    expect_line(rows, 3,
                "building city_1000000_seed11 on two threads: 81.0 ms (limit 80: **not met**)");
    char *text = totals_of(rows, 3);
    ck_assert_ptr_null(strstr(text, "city_1000000 against"));
    free(text);
}
END_TEST

START_TEST(interruptions_add_up)
{
    error_target rows[] = {good_row("city_10000", 0), good_row("city_10000", 1)};
    rows[0].interruptions = 40;
    rows[1].interruptions = 2;
    expect_line(rows, 2, "- other processes interrupted the timing 42 times\n");
}
END_TEST

START_TEST(goals_count_for_their_own_seed_alone)
{
    error_target rows[] = {good_row("city_10000", 0), good_row("city_10000", 1),
                           good_row("interior_10000", 0)};
    rows[0].one.median_ms = 1.01 * rows[0].goal->ms;
    rows[0].sums.missed = 15; // 1.5 % of those hidden
    expect_line(rows, 3, "the time is met on 0 of 1, the missed share on 0\n");
}
END_TEST

START_TEST(the_peers_fastest_and_finest_points_are_shown)
{
    error_target row = good_row("city_10000", 0);
    ck_assert_ptr_null(error_target_fastest(&row));
    ck_assert_ptr_null(error_target_finest(&row));
    row.peers = error_published_find("city_10000", city_10000);
    ck_assert_ptr_nonnull(row.peers);
    const error_published *fast = error_target_fastest(&row), *fine = error_target_finest(&row);
    ck_assert_str_eq(fast->method, ERROR_PUBLISHED_STRONG);
    ck_assert_str_eq(fine->method, ERROR_PUBLISHED_STRONG);
    for (const error_published *p = row.peers; strcmp(p->scene, "city_10000") == 0; p++) {
        if (strcmp(p->method, ERROR_PUBLISHED_STRONG) != 0) continue;
        ck_assert(p->ms >= fast->ms);
        ck_assert(p->missed_pct >= fine->missed_pct);
    }
    ck_assert(fast != fine);
}
END_TEST

START_TEST(every_goal_has_a_generator_and_three_names)
{
    for (const error_goal *goal = error_goals; goal->source.name; goal++) {
        char names[ERROR_VARIANTS][64];
        uint64_t seeds[ERROR_VARIANTS];
        for (int v = 0; v < ERROR_VARIANTS; v++) {
            error_source source = error_goal_source(goal, v, names[v]);
            seeds[v] = source.seed;
            ck_assert_str_eq(source.name, names[v]);
            ck_assert_ptr_nonnull(source.kind);
            for (int w = 0; w < v; w++) {
                ck_assert_str_ne(names[v], names[w]);
                ck_assert_uint_ne(seeds[v], seeds[w]);
            }
        }
        const error_source *usual = error_source_find(goal->source.name);
        ck_assert_ptr_nonnull(usual);
        ck_assert_str_eq(usual->kind, goal->source.kind);
        ck_assert_uint_eq(usual->count, goal->source.count);
        ck_assert_uint_eq(usual->seed, goal->source.seed);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("error_target");
    TCase *totals = tcase_create("totals");
    tcase_add_test(totals, what_is_reached_is_said_to_be_met);
    tcase_add_test(totals, a_false_hidden_object_is_a_fault);
    tcase_add_test(totals, another_mask_on_two_threads_is_a_fault);
    tcase_add_test(totals, the_slowest_frame_of_any_scene_counts);
    tcase_add_test(totals, two_threads_need_not_help_where_one_is_fast);
    tcase_add_test(totals, growth_and_build_are_of_one_seed);
    tcase_add_test(totals, interruptions_add_up);
    tcase_add_test(totals, goals_count_for_their_own_seed_alone);
    suite_add_tcase(suite, totals);
    TCase *rows = tcase_create("rows");
    tcase_add_test(rows, the_peers_fastest_and_finest_points_are_shown);
    tcase_add_test(rows, every_goal_has_a_generator_and_three_names);
    suite_add_tcase(suite, rows);
    return test_run_suite(suite);
}
