// SPDX-License-Identifier: Apache-2.0
#define _DEFAULT_SOURCE // getrusage
#include "error_pair.h"

#include "timing.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

enum { SIDES = 2, PARTS = 4 };

// Each frame's times: those of a frame, a side (one thread, two) and a part (whole, walk, test,
// moved) stand together, a round each.
typedef struct pair_times {
    double *ms;
    double builds[ERROR_ROUNDS];
    uint32_t frames;
} pair_times;

static double *times_of(const pair_times *times, uint32_t frame, int side, int part)
{
    return times->ms +
           (((size_t)frame * SIDES + (size_t)side) * PARTS + (size_t)part) * ERROR_ROUNDS;
}

static void note_times(const pair_times *times, int side, int round, const measure_result *result)
{
    for (uint32_t i = 0; i < times->frames; i++) {
        times_of(times, i, side, 0)[round] = result->frames[i].ms;
        times_of(times, i, side, 1)[round] = result->frames[i].walk_ms;
        times_of(times, i, side, 2)[round] = result->frames[i].test_ms;
        times_of(times, i, side, 3)[round] = result->frames[i].moved_ms;
    }
}

static bool are_same(const vis_result *a, const vis_result *b)
{
    return memcmp(a->bits, b->bits, vis_row_bytes(a->object_count) * a->frame_count) == 0;
}

// Counts and the order of frames are the same in every round: the last one's are taken.
static bool sum_up(const pair_times *times, int side, measure_result *result,
                   measure_summary *summary)
{
    for (uint32_t i = 0; i < times->frames; i++) {
        measure_frame *frame = &result->frames[i];
        frame->ms = timing_median(times_of(times, i, side, 0), ERROR_ROUNDS);
        frame->walk_ms = timing_median(times_of(times, i, side, 1), ERROR_ROUNDS);
        frame->test_ms = timing_median(times_of(times, i, side, 2), ERROR_ROUNDS);
        frame->moved_ms = timing_median(times_of(times, i, side, 3), ERROR_ROUNDS);
    }
    if (measure_summarize(result, summary)) return true;
    fputs("occlude-bench: not enough memory\n", stderr);
    return false;
}

static bool run_side(measure_settings settings, const obs_scene *scene, pair_times *times, int side,
                     int round, error_pair *pair)
{
    measure_result result;
    settings.backend = "openmp";
    settings.threads = (uint32_t)side + 1;
    if (!measure_run(&settings, scene, &result)) return false;
    note_times(times, side, round, &result);
    if (side == 1) times->builds[round] = result.build_ms;
    bool good = true;
    if (round == ERROR_ROUNDS - 1)
        good = sum_up(times, side, &result, side == 0 ? &pair->one : &pair->two);
    if (side == 0 && times->frames > 0) pair->warm_ms = result.frames[0].ms;
    if (round == 0 && side == 0) {
        pair->verdicts = result.verdicts;
        result.verdicts = (vis_result){0};
    } else {
        pair->is_same = pair->is_same && are_same(&pair->verdicts, &result.verdicts);
    }
    measure_free(&result);
    return good;
}

static uint64_t interruptions_so_far(void)
{
    struct rusage usage;
    return getrusage(RUSAGE_SELF, &usage) == 0 ? (uint64_t)usage.ru_nivcsw : 0;
}

bool error_pair_run(const measure_settings *settings, const obs_scene *scene, error_pair *pair)
{
    *pair = (error_pair){.is_same = true};
    pair_times times = {.frames = scene->frame_count};
    times.ms =
        calloc((size_t)scene->frame_count + 1, SIDES * PARTS * ERROR_ROUNDS * sizeof(double));
    if (!times.ms) fputs("occlude-bench: not enough memory\n", stderr);
    bool good = times.ms != NULL;
    uint64_t before = interruptions_so_far();
    for (int round = 0; round < ERROR_ROUNDS; round++)
        for (int side = 0; side < SIDES; side++)
            good = good && run_side(*settings, scene, &times, side, round, pair);
    pair->interruptions = interruptions_so_far() - before;
    if (good) pair->build_ms = timing_median(times.builds, ERROR_ROUNDS);
    free(times.ms);
    if (!good) error_pair_free(pair);
    return good;
}

void error_pair_free(error_pair *pair)
{
    vis_free(&pair->verdicts);
    *pair = (error_pair){0};
}
