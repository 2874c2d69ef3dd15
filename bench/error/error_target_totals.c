// SPDX-License-Identifier: Apache-2.0
#include "error_target.h"

#include <string.h>

static double ratio(double a, double b)
{
    return b > 0 ? a / b : 0;
}

double error_target_worst(const error_target *row)
{
    return ratio(row->one.max_ms, row->one.median_ms);
}

double error_target_speed_up(const error_target *row)
{
    return ratio(row->one.median_ms, row->two.median_ms);
}

// Whether a is to be shown rather than b.
typedef bool is_better_function(const error_published *a, const error_published *b);

static bool is_faster(const error_published *a, const error_published *b)
{
    return a->ms < b->ms;
}

static bool is_finer(const error_published *a, const error_published *b)
{
    return a->missed_pct < b->missed_pct || (!(a->missed_pct > b->missed_pct) && a->ms < b->ms);
}

static const error_published *best_of(const error_target *row, is_better_function *is_better)
{
    const error_published *best = NULL, *point = row->peers;
    for (; point && point->scene && strcmp(point->scene, row->peers->scene) == 0; point++) {
        if (strcmp(point->method, ERROR_PUBLISHED_STRONG) != 0) continue;
        if (!best || is_better(point, best)) best = point;
    }
    return best;
}

const error_published *error_target_fastest(const error_target *row)
{
    return best_of(row, is_faster);
}

const error_published *error_target_finest(const error_target *row)
{
    return best_of(row, is_finer);
}

static const char *verdict(bool is_met)
{
    return is_met ? "met" : "**not met**";
}

static void print_goals(FILE *stream, const error_targets *targets)
{
    size_t goals = 0, fast = 0, fine = 0;
    for (size_t i = 0; i < targets->count; i++) {
        const error_target *row = &targets->rows[i];
        if (row->variant > 0 || !(row->goal->ms > 0)) continue;
        goals++;
        fast += row->one.median_ms <= row->goal->ms;
        fine += compare_missed_percent(&row->sums) <= row->goal->missed_pct;
    }
    fprintf(stream, "- target scenes: the time is met on %zu of %zu, the missed share on %zu\n",
            fast, goals, fine);
}

static void print_faults(FILE *stream, const error_targets *targets)
{
    error_target_faults faults = error_targets_faults(targets);
    fprintf(stream, "- false-hidden objects, all scenes: %llu (limit 0: %s)\n",
            (unsigned long long)faults.false_hidden, verdict(faults.false_hidden == 0));
    fprintf(stream, "- scenes where one thread and two gave other masks: %zu (limit 0: %s)\n",
            faults.different, verdict(faults.different == 0));
}

static void print_worst(FILE *stream, const error_targets *targets)
{
    const error_target *worst = &targets->rows[0];
    for (size_t i = 1; i < targets->count; i++)
        if (error_target_worst(&targets->rows[i]) > error_target_worst(worst))
            worst = &targets->rows[i];
    fprintf(stream, "- slowest frame over median frame, largest: %.2f in %s (limit %g: %s)\n",
            error_target_worst(worst), worst->scene, error_limits.worst_frame,
            verdict(error_target_worst(worst) <= error_limits.worst_frame));
}

static void print_speed_up(FILE *stream, const error_targets *targets)
{
    const error_target *least = NULL;
    for (size_t i = 0; i < targets->count; i++) {
        const error_target *row = &targets->rows[i];
        if (!(row->one.median_ms > error_limits.speed_up_above_ms)) continue;
        if (!least || error_target_speed_up(row) < error_target_speed_up(least)) least = row;
    }
    if (!least) {
        fprintf(stream, "- two threads: no scene needs more than %g ms on one\n",
                error_limits.speed_up_above_ms);
        return;
    }
    fprintf(stream,
            "- speed-up of two threads where one needs more than %g ms, least: %.2f in %s (at "
            "least %g: %s)\n",
            error_limits.speed_up_above_ms, error_target_speed_up(least), least->scene,
            error_limits.speed_up, verdict(error_target_speed_up(least) >= error_limits.speed_up));
}

static const error_target *find_variant(const error_targets *targets, const char *name, int variant)
{
    for (size_t i = 0; i < targets->count; i++) {
        const error_target *row = &targets->rows[i];
        if (row->variant == variant && strcmp(row->goal->source.name, name) == 0) return row;
    }
    return NULL;
}

static void print_city(FILE *stream, const error_targets *targets, int variant)
{
    const error_target *small = find_variant(targets, "city_10000", variant),
                       *large = find_variant(targets, "city_1000000", variant);
    if (!large) return;
    fprintf(stream, "- building %s on two threads: %.1f ms (limit %g: %s)\n", large->scene,
            large->build_ms, error_limits.city_build_ms,
            verdict(large->build_ms <= error_limits.city_build_ms));
    if (!small) return;
    double growth = ratio(large->one.median_ms, small->one.median_ms);
    fprintf(stream,
            "- %s against %s: %.1f times the time (limit %g: %s) for %.1f times the visible "
            "objects\n",
            large->scene, small->scene, growth, error_limits.city_growth,
            verdict(growth <= error_limits.city_growth),
            ratio(large->one.visible, small->one.visible));
}

// Where there are many, slowest frames and two threads' times say more about the machine.
static void print_interruptions(FILE *stream, const error_targets *targets)
{
    uint64_t sum = 0;
    for (size_t i = 0; i < targets->count; i++)
        sum += targets->rows[i].interruptions;
    fprintf(stream, "- other processes interrupted the timing %llu times\n",
            (unsigned long long)sum);
}

void error_targets_totals(FILE *stream, const error_targets *targets)
{
    if (targets->count == 0) return;
    print_goals(stream, targets);
    print_faults(stream, targets);
    print_worst(stream, targets);
    print_speed_up(stream, targets);
    print_interruptions(stream, targets);
    for (int variant = 0; variant < ERROR_VARIANTS; variant++)
        print_city(stream, targets, variant);
}
