// SPDX-License-Identifier: Apache-2.0
/// @file
/// Pictures through gnuplot.
#ifndef OCC_BENCH_PLOT_H
#define OCC_BENCH_PLOT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/// A curve. Points with a y that is not positive are left out.
typedef struct plot_curve {
    const char *title;
    const double *x, *y;
    size_t count;
} plot_curve;

/// Draws curves over logarithmic axes into a PNG. When gnuplot is absent or fails, says so on
/// standard error, writes nothing and returns false.
bool plot_logarithmic(const char *path, const char *title, const char *x_label, const char *y_label,
                      const plot_curve *curves, size_t count);

/// Writes a gnuplot script that draws into the file `path`.
typedef void plot_writer(FILE *stream, const char *path, const void *data);

/// Runs gnuplot on such a script and puts what it drew at `path`, whole or not at all. When gnuplot
/// is absent or fails, says so on standard error and returns false.
bool plot_run(const char *path, plot_writer *writer, const void *data);

/// Writes text as gnuplot's quoted string.
void plot_quote(FILE *stream, const char *text);

#endif
