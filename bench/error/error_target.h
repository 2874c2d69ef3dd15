// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the default method takes and misses on a scene with a goal, and what is said of all such
/// scenes together: the rows and the last lines of `occlude-bench error --targets`.
#ifndef OCC_BENCH_ERROR_TARGET_H
#define OCC_BENCH_ERROR_TARGET_H

#include "compare_count.h"
#include "error_goals.h"
#include "error_pair.h"
#include "error_published.h"
#include "error_truth.h"
#include "settle.h"

#include <stdio.h>

/// A scene measured.
typedef struct error_target {
    char scene[64];
    const error_goal *goal;
    const error_published
        *peers;    ///< The first point of other programs on this very scene, or NULL.
    uint64_t seed; ///< Of the generator, or by the file's name.
    int variant;   ///< 0: with the seed that the goal was set for.
    uint32_t objects, frames, truth_frames;
    measure_summary one, two; ///< On one thread and on two.
    double first_ms, warm_ms; ///< The first frame on one thread: by a fresh view, and met before.
    double build_ms;          ///< On two threads.
    uint64_t interruptions;   ///< By other processes, while it was timed.
    compare_sums sums;        ///< By what the judge left of the truth.
    settle_sums settled;      ///< What the judge was asked; zero without a judge.
    bool is_file;             ///< Else one of this program's generators made it.
    bool is_same;             ///< One thread's masks and two threads' were the same.
} error_target;

/// Rows.
typedef struct error_targets {
    error_target *rows;
    size_t count, capacity;
} error_targets;

/// How to measure them.
typedef struct error_target_options {
    const char *folder;        ///< Of scene files, or NULL.
    const char *const *scenes; ///< These alone, unless there are none...
    int scene_count;           ///< ...of so many.
    bool is_quick;             ///< Small scenes and their own seeds, where none are named.
    uint32_t repeats;          ///< Timed culls of a frame in each round.
    settle_limits limits;
    error_truths truths;
} error_target_options;

/// Measures and prints a line for each scene. False after a message.
bool error_targets_run(const error_target_options *options, error_targets *targets);

/// Writes FOLDER/targets.csv and FOLDER/targets.md. False after a message.
bool error_targets_report(const char *folder, const error_target_options *options,
                          const error_targets *targets);

/// The row's line on standard output: key=value.
void error_target_print(FILE *stream, const error_target *row);

/// Visible objects reported hidden, and scenes whose masks depended on the number of threads.
typedef struct error_target_faults {
    uint64_t false_hidden;
    size_t different;
} error_target_faults;

error_target_faults error_targets_faults(const error_targets *targets);

/// What is asked of all scenes together, as a list in Markdown or as plain lines.
void error_targets_totals(FILE *stream, const error_targets *targets);

/// The slowest frame over the median one.
double error_target_worst(const error_target *row);

/// One thread's median over two threads'.
double error_target_speed_up(const error_target *row);

/// The strong peer's fastest point on this very scene, and its most accurate one; NULL: none.
const error_published *error_target_fastest(const error_target *row);
const error_published *error_target_finest(const error_target *row);

void error_targets_free(error_targets *targets);

#endif
