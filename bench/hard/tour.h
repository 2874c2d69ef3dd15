// SPDX-License-Identifier: Apache-2.0
/// @file
/// A tour of many worlds of one family: made, judged exactly, culled, and counted.
#ifndef OCC_BENCH_TOUR_H
#define OCC_BENCH_TOUR_H

#include "trial.h"

/// Where to go and how to answer.
typedef struct tour_settings {
    occ_backend backend;
    uint32_t threads; ///< Of the OpenMP backend; with the plain one, worlds at a time. 0: all.
    occ_cull_desc knobs;
    uint64_t first, worlds; ///< Numbers of family_sweep().
    double scale, offset;   ///< In place of the sweep's. Negative: the sweep's.
} tour_settings;

typedef struct tour_result {
    trial_tally tally;
    trial_effort effort;
    occ_result error;   ///< What the library refused a world with, or OCC_SUCCESS.
    uint64_t refused;   ///< The number of the first world that it refused.
    uint64_t forbidden; ///< The number of the first world with an object falsely hidden.
} tour_result;

/// The place of a world of the tour.
family_place tour_place(const tour_settings *settings, uint64_t number);

/// Opens what a tour needs: a bench for each worker. NULL if there is no such backend or device.
typedef struct tour_crew tour_crew;
tour_crew *tour_open(const tour_settings *settings);
void tour_close(tour_crew *crew);

/// The view of the first worker.
const occ_view *tour_view(const tour_crew *crew);

/// Goes through all worlds of the family. The result does not depend on the number of workers.
tour_result tour_run(tour_crew *crew, const family *f, const tour_settings *settings);

#endif
