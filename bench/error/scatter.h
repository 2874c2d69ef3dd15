// SPDX-License-Identifier: Apache-2.0
/// @file
/// A picture of points over logarithmic axes, made for error: y may be 0, and has a place below the
/// smallest other; a point that is bad is red whatever its series; labels keep out of each other's
/// way.
#ifndef OCC_BENCH_SCATTER_H
#define OCC_BENCH_SCATTER_H

#include <stdbool.h>
#include <stddef.h>

enum { SCATTER_LABEL = 48, SCATTER_TITLE = 64, SCATTER_MAX_POINTS = 64, SCATTER_MAX_SERIES = 24 };

/// x is positive, y is not negative.
typedef struct scatter_point {
    double x, y;
    char label[SCATTER_LABEL]; ///< May be empty.
    bool is_bad;
} scatter_point;

typedef struct scatter_series {
    char title[SCATTER_TITLE]; ///< In the legend. Empty: not there.
    unsigned color;            ///< 0xrrggbb
    int shape;                 ///< gnuplot's pointtype.
    double size;               ///< gnuplot's pointsize.
    bool is_joined;            ///< By a line, in the order of the points.
    scatter_point points[SCATTER_MAX_POINTS];
    size_t count;
} scatter_series;

typedef struct scatter_plot {
    const char *title, *x_label, *y_label;
    const char *bad_title; ///< What red means, for the legend.
    const char *note;      ///< A line below the legend, or NULL.
    scatter_series *series;
    size_t count;
} scatter_plot;

/// Appends a point, unless the series is full or it cannot be drawn over such axes.
void scatter_add(scatter_series *series, double x, double y, bool is_bad, const char *label);

/// Draws into a PNG. False when gnuplot is absent or fails, after a message.
bool scatter_draw(const char *path, const scatter_plot *plot);

#endif
