// SPDX-License-Identifier: Apache-2.0
/// @file
/// The hard cases in the report: every method on many small worlds of every family, each verdict
/// held against the exact judge. There in a build with GMP alone.
#ifndef OCC_BENCH_ERROR_HARD_H
#define OCC_BENCH_ERROR_HARD_H

#include "error_measure.h"

/// Appends a row for each family, scale, method and backend. In it `frames` are worlds, and objects
/// are summed over them; nothing is timed. A method that is not the library's sits out the
/// orthographic worlds, which it does not take. Without a
/// judge says so and appends nothing.
error_status error_hard(const error_options *options, error_table *table);

/// The table of families in Markdown.
void error_hard_markdown(FILE *stream, const error_table *table, bool has_plot);

/// Draws families against missed and false-hidden shares into a PNG.
bool error_hard_plot(const char *path, const error_table *table);

/// The families' part of the summary: a line for each method and scale, over all families.
void error_hard_summary(FILE *stream, const error_table *table);

/// Whether the row's backend stands for its method's.
bool error_hard_is_main(const error_row *row);

#endif
