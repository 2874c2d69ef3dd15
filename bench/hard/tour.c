// SPDX-License-Identifier: Apache-2.0
#define _POSIX_C_SOURCE 200809L
#include "tour.h"

#include <stdlib.h>
#include <unistd.h>

enum { MOST_WORKERS = 256 };

struct tour_crew {
    int count;
    trial_bench *workers[MOST_WORKERS];
};

family_place tour_place(const tour_settings *settings, uint64_t number)
{
    family_place place = family_sweep(number);
    if (settings->scale >= 0.0) place.scale = settings->scale;
    if (settings->offset >= 0.0) place.offset = settings->offset;
    return place;
}

// Other backends have threads of their own, or a device that all would wait for.
static int worker_count(const tour_settings *settings)
{
    long count = 1;
    if (settings->backend == OCC_BACKEND_PLAIN)
        count = settings->threads ? (long)settings->threads : sysconf(_SC_NPROCESSORS_ONLN);
    if (count < 1) return 1;
    return count < MOST_WORKERS ? (int)count : MOST_WORKERS;
}

tour_crew *tour_open(const tour_settings *settings)
{
    tour_crew *crew = calloc(1, sizeof *crew);
    if (!crew) return NULL;
    int wanted = worker_count(settings);
    for (; crew->count < wanted; crew->count++) {
        crew->workers[crew->count] = trial_open(settings->backend, settings->threads);
        if (crew->workers[crew->count]) continue;
        tour_close(crew);
        return NULL;
    }
    return crew;
}

void tour_close(tour_crew *crew)
{
    if (!crew) return;
    for (int i = 0; i < crew->count; i++)
        trial_close(crew->workers[i]);
    free(crew);
}

const occ_view *tour_view(const tour_crew *crew)
{
    return trial_view(crew->workers[0]);
}

static void visit(trial_bench *bench, const family *f, const tour_settings *settings,
                  uint64_t number, tour_result *result)
{
    family_world world;
    trial_fate fates[FAMILY_OBJECTS];
    family_place place = tour_place(settings, number);
    uint64_t before = result->tally.false_hidden;
    f->make(&world, &place);
    if (!trial_judge(&world, fates, &result->effort)) {
        result->error = OCC_ERROR_DEGENERATE_CAMERA;
        result->refused = number;
    } else if (!trial_run(bench, &world, fates, &settings->knobs, &result->tally)) {
        result->error = trial_error(bench);
        result->refused = number;
    }
    if (before == 0 && result->tally.false_hidden > 0) result->forbidden = number;
}

static void join(tour_result *sum, const tour_result *more)
{
    if (more->tally.false_hidden && (!sum->tally.false_hidden || more->forbidden < sum->forbidden))
        sum->forbidden = more->forbidden;
    if (more->error && (!sum->error || more->refused < sum->refused)) {
        sum->refused = more->refused;
        sum->error = more->error;
    }
    trial_add(&sum->tally, &more->tally);
    sum->effort.signs += more->effort.signs;
    sum->effort.exact += more->effort.exact;
}

tour_result tour_run(tour_crew *crew, const family *f, const tour_settings *settings)
{
    tour_result sum = {.error = OCC_SUCCESS};
    int workers = crew->count;
#pragma omp parallel for schedule(static, 1) num_threads(workers) default(none)                    \
    shared(crew, f, settings, sum, workers)
    for (int w = 0; w < workers; w++) {
        tour_result own = {.error = OCC_SUCCESS};
        uint64_t end = settings->first + settings->worlds;
        for (uint64_t i = settings->first + (uint64_t)w; i < end && !own.error;
             i += (uint64_t)workers)
            visit(crew->workers[w], f, settings, i, &own);
#pragma omp critical
        join(&sum, &own);
    }
    return sum;
}
