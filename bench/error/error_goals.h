// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the library is to reach: the scenes of `occlude-bench error --targets`, and for each the
/// time and the missed share that its default method was set as a goal on one thread.
#ifndef OCC_BENCH_ERROR_GOALS_H
#define OCC_BENCH_ERROR_GOALS_H

#include "error_scene.h"

/// A scene and its goal.
typedef struct error_goal {
    error_source source;   ///< With the seed that the goal was set for.
    double ms, missed_pct; ///< 0, 0: there is none.
} error_goal;

/// All of them; the last has a NULL source name.
extern const error_goal error_goals[];

/// What is asked of all of them together.
extern const struct error_limits {
    double worst_frame;       ///< The slowest frame over the median one, at most.
    double speed_up;          ///< Two threads against one, at least...
    double speed_up_above_ms; ///< ...where one thread needs longer than this.
    double city_growth;       ///< The frame of the city of a million objects over that of 10,000.
    double city_build_ms;     ///< Building the city of a million objects on two threads.
} error_limits;

/// Each scene is measured with its own seed, variant 0, and with two others.
enum { ERROR_VARIANTS = 3 };

/// The source of a goal's variant. It is called NAME or NAME_seedSEED; `name` keeps that.
error_source error_goal_source(const error_goal *goal, int variant, char name[64]);

#endif
