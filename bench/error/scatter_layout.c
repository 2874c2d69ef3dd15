// SPDX-License-Identifier: Apache-2.0
#include "scatter_layout.h"

#include <math.h>
#include <string.h>

// In pixels: half the side of a point and half a line's width, and a label's letters.
#define POINT_REACH 5.0
#define LINE_REACH  2.0
#define LABEL_GAP   6.0
#define LETTER      7.0
#define LINE        13.0

enum { MAX_POINTS = 8192 };

// A rectangle of pixels.
typedef struct area {
    double left, right, bottom, top;
} area;

// What is taken already.
typedef struct layout_taken {
    area points[MAX_POINTS], labels[SCATTER_MAX_LABELS];
    size_t point_count, label_count;
} layout_taken;

scatter_axes scatter_axes_of(const scatter_plot *plot)
{
    scatter_axes axes = {.x_low = INFINITY, .x_high = 0, .y_low = INFINITY, .y_high = 0};
    for (size_t s = 0; s < plot->count; s++)
        for (size_t i = 0; i < plot->series[s].count; i++) {
            const scatter_point *point = &plot->series[s].points[i];
            axes.x_low = fmin(axes.x_low, point->x);
            axes.x_high = fmax(axes.x_high, point->x);
            axes.y_high = fmax(axes.y_high, point->y);
            if (point->y > 0)
                axes.y_low = fmin(axes.y_low, point->y);
            else
                axes.has_zero = true;
        }
    if (!(axes.x_low <= axes.x_high)) axes.x_low = axes.x_high = 1;
    if (!(axes.y_low <= axes.y_high)) axes.y_low = axes.y_high = 1;
    double margin = fmax(1.15, pow(axes.x_high / axes.x_low, 0.06));
    axes.x_low /= margin;
    axes.x_high *= margin;
    axes.y_low = fmin(axes.y_low / 1.4, axes.y_high / 20);
    axes.y_high *= 2;
    axes.zero = axes.y_low;
    if (axes.has_zero) {
        axes.zero = axes.y_low / pow(axes.y_high / axes.y_low, 0.04);
        axes.y_low = axes.zero / pow(axes.y_high / axes.zero, 0.06);
    }
    return axes;
}

double scatter_place(const scatter_axes *axes, double y)
{
    return y > 0 ? y : axes->zero;
}

static double pixel_x(const scatter_axes *axes, double x)
{
    double share = log(x / axes->x_low) / log(axes->x_high / axes->x_low);
    return SCATTER_LEFT + share * (SCATTER_RIGHT - SCATTER_LEFT);
}

static double pixel_y(const scatter_axes *axes, double y)
{
    double share = log(scatter_place(axes, y) / axes->y_low) / log(axes->y_high / axes->y_low);
    return SCATTER_BOTTOM + share * (SCATTER_TOP - SCATTER_BOTTOM);
}

static area around(double x, double y, double reach_x, double reach_y)
{
    return (area){x - reach_x, x + reach_x, y - reach_y, y + reach_y};
}

static double overlap(const area *a, const area *b)
{
    double width = fmin(a->right, b->right) - fmax(a->left, b->left);
    double height = fmin(a->top, b->top) - fmax(a->bottom, b->bottom);
    return width > 0 && height > 0 ? width * height : 0;
}

// How bad a place is: what it covers of others, labels above all, and what hangs out of the axes.
static double penalty(const layout_taken *taken, const area *place)
{
    static const area frame = {SCATTER_LEFT + 4, SCATTER_RIGHT - 4, SCATTER_BOTTOM + 2,
                               SCATTER_TOP - 2};
    double whole = (place->right - place->left) * (place->top - place->bottom);
    double sum = 20 * (whole - overlap(place, &frame));
    for (size_t i = 0; i < taken->label_count; i++)
        sum += 4 * overlap(place, &taken->labels[i]);
    for (size_t i = 0; i < taken->point_count; i++)
        sum += overlap(place, &taken->points[i]);
    return sum;
}

// Beside the point first, then above and below, then farther away.
static area find_place(const layout_taken *taken, double x, double y, size_t letters)
{
    static const double directions[8][2] = {{1, 0}, {-1, 0}, {0, 1},  {0, -1},
                                            {1, 1}, {1, -1}, {-1, 1}, {-1, -1}};
    double reach_x = LETTER * (double)letters / 2, reach_y = LINE / 2;
    area best = {0};
    double least = INFINITY;
    for (int ring = 0; ring < 4; ring++)
        for (int d = 0; d < 8; d++) {
            double gap = POINT_REACH + 2 + 9 * ring;
            area place = around(x + directions[d][0] * (gap + reach_x),
                                y + directions[d][1] * (gap + reach_y), reach_x, reach_y);
            double cost = penalty(taken, &place) + 3 * ring;
            if (cost >= least) continue;
            least = cost;
            best = place;
        }
    return best;
}

static void take(layout_taken *taken, double x, double y, double reach)
{
    if (taken->point_count < MAX_POINTS)
        taken->points[taken->point_count++] = around(x, y, reach, reach);
}

// The line between two points, as a chain of small squares.
static void take_line(layout_taken *taken, const scatter_axes *axes, const scatter_point *from,
                      const scatter_point *to)
{
    double x = pixel_x(axes, from->x), y = pixel_y(axes, from->y);
    double across = pixel_x(axes, to->x) - x, up = pixel_y(axes, to->y) - y;
    int steps = (int)(hypot(across, up) / (2 * LINE_REACH));
    for (int i = 1; i < steps; i++)
        take(taken, x + across * i / steps, y + up * i / steps, LINE_REACH);
}

static void take_points(layout_taken *taken, const scatter_plot *plot, const scatter_axes *axes)
{
    for (size_t s = 0; s < plot->count; s++)
        for (size_t i = 0; i < plot->series[s].count; i++) {
            const scatter_point *point = &plot->series[s].points[i];
            take(taken, pixel_x(axes, point->x), pixel_y(axes, point->y), POINT_REACH);
            if (i > 0 && plot->series[s].is_joined) take_line(taken, axes, point - 1, point);
        }
}

size_t scatter_place_labels(const scatter_plot *plot, const scatter_axes *axes,
                            scatter_label labels[SCATTER_MAX_LABELS])
{
    static layout_taken taken;
    taken.point_count = taken.label_count = 0;
    take_points(&taken, plot, axes);
    for (size_t s = 0; s < plot->count; s++)
        for (size_t i = 0; i < plot->series[s].count; i++) {
            const scatter_point *point = &plot->series[s].points[i];
            size_t letters = strlen(point->label);
            if (letters == 0 || taken.label_count == SCATTER_MAX_LABELS) continue;
            area place =
                find_place(&taken, pixel_x(axes, point->x), pixel_y(axes, point->y), letters);
            labels[taken.label_count] = (scatter_label){point->label, point->is_bad, place.left,
                                                        (place.bottom + place.top) / 2};
            place.left -= LABEL_GAP; // two numbers side by side must not read as one
            place.right += LABEL_GAP;
            taken.labels[taken.label_count++] = place;
        }
    return taken.label_count;
}
