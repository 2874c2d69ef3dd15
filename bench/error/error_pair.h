// SPDX-License-Identifier: Apache-2.0
/// @file
/// One thread and two on the same scene, in turns, so that a slow phase of the machine meets both.
#ifndef OCC_BENCH_ERROR_PAIR_H
#define OCC_BENCH_ERROR_PAIR_H

#include "measure.h"

/// What came out.
typedef struct error_pair {
    measure_summary one, two; ///< A frame's time is the median over the rounds.
    double warm_ms;           ///< The first frame on one thread, met before.
    double build_ms;          ///< Of the scene on two threads: the median over the rounds.
    vis_result verdicts;      ///< Those of one thread.
    uint64_t interruptions;   ///< How often other processes took a processor from this one.
    bool is_same;             ///< Every mask of every round was the same.
} error_pair;

/// How often each is run.
enum { ERROR_ROUNDS = 3 };

/// `settings` must be complete; its threads do not matter. False after a message, with nothing to
/// free. Else error_pair_free() it.
bool error_pair_run(const measure_settings *settings, const obs_scene *scene, error_pair *pair);

void error_pair_free(error_pair *pair);

#endif
