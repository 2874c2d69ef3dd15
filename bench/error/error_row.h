// SPDX-License-Identifier: Apache-2.0
/// @file
/// A run of `occlude-bench error` and what came of it: a row of its CSV.
#ifndef OCC_BENCH_ERROR_ROW_H
#define OCC_BENCH_ERROR_ROW_H

#include "compare_count.h"
#include "error_plan.h"
#include "settle.h"

#include <stdio.h>

/// What came of a run. Nothing after `identity` is set where the run was skipped.
typedef struct error_row {
    char scene[64];
    error_run run;
    uint32_t objects, occluders;
    uint64_t identity; ///< Of the scene at scale 1.
    uint32_t threads, frames;
    uint32_t truth_frames; ///< Those that `sums` runs over.
    bool is_timed;         ///< Else there are errors alone: times, `build_ms` and `bytes` are 0.
    double median_ms, p99_ms;
    compare_sums sums;   ///< By what the judge left of the truth.
    settle_sums settled; ///< What the judge was asked; zero without a judge.
    double build_ms;
    uint64_t bytes; ///< Host and device memory of scene and view.
} error_row;

/// Rows, in the order of scenes and plans. All zero is empty.
typedef struct error_table {
    error_row *rows;
    size_t count, capacity;
    char driver[256]; ///< The OpenCL device, or "none".
    char peer[256];   ///< What the other methods stand on, or "none".
} error_table;

/// False when memory runs out.
bool error_table_add(error_table *table, const error_row *row);

void error_table_free(error_table *table);

/// Objects that the method promised not to hide and did, over all rows.
uint64_t error_table_broken_promises(const error_table *table);

/// Means over the truth's frames.
double error_row_in_frustum(const error_row *row);
double error_row_visible(const error_row *row);

/// The names of the columns, and a row of them, each with its line feed.
void error_csv_header(FILE *stream);
void error_csv_row(FILE *stream, const error_row *row);

#endif
