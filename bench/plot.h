// SPDX-License-Identifier: Apache-2.0
/// @file
/// Pictures through gnuplot.
#ifndef OCC_BENCH_PLOT_H
#define OCC_BENCH_PLOT_H

#include <stdbool.h>
#include <stddef.h>

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

#endif
