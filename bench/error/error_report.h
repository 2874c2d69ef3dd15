// SPDX-License-Identifier: Apache-2.0
/// @file
/// What `occlude-bench error` leaves behind: a CSV, tables in Markdown, plots.
#ifndef OCC_BENCH_ERROR_REPORT_H
#define OCC_BENCH_ERROR_REPORT_H

#include "error_row.h"

/// What is reported.
typedef struct error_findings {
    error_options options;
    error_table scenes, hard; ///< The named scenes; the hard families, or empty.
} error_findings;

/// Writes FOLDER/error.csv, FOLDER/error.md, a FOLDER/SCENE.png for each scene and FOLDER/hard.png.
/// Plots are left
/// out, after a message, where gnuplot is missing. False after a message when a file cannot be
/// written.
bool error_report(const char *folder, const error_findings *findings);

/// A line for each scene and method at its default setting.
void error_print_summary(FILE *stream, const error_findings *findings);

/// The report in Markdown, with links to the plots if there are any.
void error_write_markdown(FILE *stream, const error_findings *findings, bool has_plots);

/// Lines `# key=value` on the machine, the build and the options.
void error_write_setup(FILE *stream, const error_findings *findings);

/// Draws the scene of the rows [first, last) into a PNG.
bool error_plot_scene(const char *path, const error_table *table, size_t first, size_t last);

/// The first row after `first` that is of another scene.
size_t error_scene_end(const error_table *table, size_t first);

/// Whether the run stands for its method in a summary: the default setting or a preset on one
/// thread, the fastest backend that has one.
bool error_is_summary(const error_row *row);

/// Its method, and what is set of it.
void error_summary_name(const error_row *row, char *text, size_t size);

#endif
