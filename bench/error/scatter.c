// SPDX-License-Identifier: Apache-2.0
#include "scatter.h"

#include "plot.h"
#include "scatter_layout.h"

#include <math.h>
#include <stdio.h>

#define BAD_COLOR 0xd00000u

void scatter_add(scatter_series *series, double x, double y, bool is_bad, const char *label)
{
    if (series->count == SCATTER_MAX_POINTS || !(x > 0) || !(y >= 0)) return;
    scatter_point *point = &series->points[series->count++];
    *point = (scatter_point){.x = x, .y = y, .is_bad = is_bad};
    snprintf(point->label, sizeof point->label, "%s", label);
}

// Marks at powers of ten; where that leaves few, also at two and five times them.
static void put_tics(FILE *stream, char axis, double low, double high, const double *zero)
{
    double decades = log10(high / low);
    int first = (int)floor(log10(low)), last = (int)ceil(log10(high));
    const char *comma = "";
    fprintf(stream, "set %ctics (", axis);
    if (zero) {
        fprintf(stream, "'0' %.9g", *zero);
        comma = ", ";
    }
    for (int exponent = first; exponent <= last; exponent++)
        for (int digit = 1; digit <= 5; digit += digit == 1 ? 1 : 3) {
            double value = digit * pow(10, exponent);
            bool is_inside = value >= low && value <= high && (!zero || value > *zero * 1.3);
            if (!is_inside || (digit > 1 && decades > 2.3)) continue;
            fprintf(stream, "%s'%g' %.9g", comma, value, value);
            comma = ", ";
        }
    fputs(")\n", stream);
}

static void put_axes(FILE *stream, const scatter_axes *axes)
{
    fprintf(stream, "set lmargin at screen %.5f\nset rmargin at screen %.5f\n",
            (double)SCATTER_LEFT / SCATTER_WIDTH, (double)SCATTER_RIGHT / SCATTER_WIDTH);
    fprintf(stream, "set bmargin at screen %.5f\nset tmargin at screen %.5f\n",
            (double)SCATTER_BOTTOM / SCATTER_HEIGHT, (double)SCATTER_TOP / SCATTER_HEIGHT);
    fprintf(stream, "set xrange [%.9g:%.9g]\nset yrange [%.9g:%.9g]\n", axes->x_low, axes->x_high,
            axes->y_low, axes->y_high);
    put_tics(stream, 'x', axes->x_low, axes->x_high, NULL);
    put_tics(stream, 'y', axes->y_low, axes->y_high, axes->has_zero ? &axes->zero : NULL);
}

static void put_labels(FILE *stream, const scatter_plot *plot, const scatter_axes *axes)
{
    static scatter_label labels[SCATTER_MAX_LABELS];
    size_t count = scatter_place_labels(plot, axes, labels);
    for (size_t i = 0; i < count; i++) {
        fputs("set label ", stream);
        plot_quote(stream, labels[i].text);
        fprintf(stream, " at screen %.5f, screen %.5f left font ',9' textcolor rgb '#%06x'\n",
                labels[i].x / SCATTER_WIDTH, labels[i].y / SCATTER_HEIGHT,
                labels[i].is_bad ? BAD_COLOR : 0x404040u);
    }
}

// Columns: x, y, color.
static void put_data(FILE *stream, const scatter_plot *plot, const scatter_axes *axes)
{
    for (size_t s = 0; s < plot->count; s++) {
        const scatter_series *series = &plot->series[s];
        fprintf(stream, "$series%zu << END\n", s);
        for (size_t i = 0; i < series->count; i++) {
            const scatter_point *point = &series->points[i];
            fprintf(stream, "%.9g %.9g %u\n", point->x, scatter_place(axes, point->y),
                    point->is_bad ? BAD_COLOR : series->color);
        }
        fputs("END\n", stream);
    }
}

static void put_curves(FILE *stream, const scatter_plot *plot)
{
    const char *comma = "plot ";
    for (size_t s = 0; s < plot->count; s++) {
        const scatter_series *series = &plot->series[s];
        if (series->count == 0) continue;
        if (series->is_joined)
            fprintf(stream,
                    "%s$series%zu using 1:2 with lines linewidth 1.2 linecolor rgb '#%06x' notitle",
                    comma, s, series->color),
                comma = ", ";
        fprintf(stream,
                "%s$series%zu using 1:2:3 with points pointtype %d pointsize %.2f linewidth 1.5 "
                "linecolor rgb variable notitle",
                comma, s, series->shape, series->size);
        comma = ", ";
        if (!series->title[0]) continue;
        fprintf(stream,
                ", keyentry with %s pointtype %d pointsize %.2f linewidth 1.5 linecolor rgb "
                "'#%06x' title ",
                series->is_joined ? "linespoints" : "points", series->shape, series->size,
                series->color);
        plot_quote(stream, series->title);
    }
    fprintf(stream, "%skeyentry with points pointtype 5 pointsize 1.2 linecolor rgb '#%06x' title ",
            comma, BAD_COLOR);
    plot_quote(stream, plot->bad_title);
    fputc('\n', stream);
}

static void put_text(FILE *stream, const char *command, const char *text)
{
    fprintf(stream, "%s ", command);
    plot_quote(stream, text);
    fputc('\n', stream);
}

static void put_note(FILE *stream, const char *note)
{
    fputs("set label ", stream);
    plot_quote(stream, note);
    fprintf(stream, " at screen %.5f, screen %.5f left font ',9' textcolor rgb '#404040'\n",
            (SCATTER_RIGHT + 12.0) / SCATTER_WIDTH, (double)SCATTER_BOTTOM / SCATTER_HEIGHT);
}

static void put_scatter(FILE *stream, const char *path, const void *data)
{
    const scatter_plot *plot = data;
    scatter_axes axes = scatter_axes_of(plot);
    put_data(stream, plot, &axes);
    fprintf(stream,
            "set terminal pngcairo size %d,%d noenhanced font 'sans,10'\nset logscale xy\n"
            "set grid xtics ytics linetype 1 linewidth 1 linecolor rgb '#e0e0e0'\n"
            "set key at screen %.5f, screen %.5f left top Left reverse samplen 2 spacing 1.25 font "
            "',9'\n",
            SCATTER_WIDTH, SCATTER_HEIGHT, (SCATTER_RIGHT + 8.0) / SCATTER_WIDTH,
            (double)SCATTER_TOP / SCATTER_HEIGHT);
    put_text(stream, "set output", path);
    put_text(stream, "set title", plot->title);
    put_text(stream, "set xlabel", plot->x_label);
    put_text(stream, "set ylabel", plot->y_label);
    put_axes(stream, &axes);
    put_labels(stream, plot, &axes);
    if (plot->note) put_note(stream, plot->note);
    put_curves(stream, plot);
}

bool scatter_draw(const char *path, const scatter_plot *plot)
{
    return plot_run(path, put_scatter, plot);
}
