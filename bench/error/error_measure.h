// SPDX-License-Identifier: Apache-2.0
/// @file
/// Runs a plan on a scene and judges every run by the truth.
#ifndef OCC_BENCH_ERROR_MEASURE_H
#define OCC_BENCH_ERROR_MEASURE_H

#include "error_row.h"
#include "error_truth.h"

typedef enum error_status {
    ERROR_GOOD,
    ERROR_UNUSABLE, ///< An input or memory: said on standard error.
    ERROR_DIFFERENT ///< Backends or threads disagree: said on standard error, and measured on.
} error_status;

/// Appends a row for each run to `table`. Truths are kept as `truths` says.
error_status error_measure_scene(const error_options *options, const error_truths *truths,
                                 const char *name, const obs_scene *scene, error_table *table);

#endif
