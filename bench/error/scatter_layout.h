// SPDX-License-Identifier: Apache-2.0
/// @file
/// Where things are in a scatter plot: its axes, in pixels, and places for its labels.
#ifndef OCC_BENCH_SCATTER_LAYOUT_H
#define OCC_BENCH_SCATTER_LAYOUT_H

#include "scatter.h"

/// The picture, and in it the rectangle of the axes; y goes up.
enum {
    SCATTER_WIDTH = 900,
    SCATTER_HEIGHT = 600,
    SCATTER_LEFT = 75,
    SCATTER_RIGHT = 640,
    SCATTER_BOTTOM = 60,
    SCATTER_TOP = 555
};

/// The ranges of both axes, and where a y of 0 is drawn.
typedef struct scatter_axes {
    double x_low, x_high, y_low, y_high;
    double zero;
    bool has_zero;
} scatter_axes;

scatter_axes scatter_axes_of(const scatter_plot *plot);

/// Where a point is drawn on the y axis: at y, or at the place of 0.
double scatter_place(const scatter_axes *axes, double y);

/// A label, with its text's left end and middle line.
typedef struct scatter_label {
    const char *text;
    bool is_bad;
    double x, y;
} scatter_label;

enum { SCATTER_MAX_LABELS = 256 };

/// Finds places for all labels, next to their points. Returns how many there are.
size_t scatter_place_labels(const scatter_plot *plot, const scatter_axes *axes,
                            scatter_label labels[SCATTER_MAX_LABELS]);

#endif
