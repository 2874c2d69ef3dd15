// SPDX-License-Identifier: Apache-2.0
#include "error_hard.h"

#include "error_report.h"
#include "plot.h"

#include <string.h>

// How a method looks in both panels. gnuplot's point types.
typedef struct hard_style {
    const char *method, *title;
    double scale;
    unsigned color;
    int shape;
} hard_style;

static const hard_style hard_styles[] = {
    {"single", "single", 1, 0x0050a0, 7},
    {"fused", "fused", 1, 0x007030, 13},
    {"pairwise", "pairwise", 1, 0x8040c0, 12},
    {"embree-depth", "Embree, depth buffer", 1, 0x00a080, 4},
    {"embree-rays", "Embree, rays", 1, 0x60a000, 8},
    {"thesis", "thesis x1", 1, 0xd00000, 5},
    {"thesis", "thesis x0.01", 0.01, 0xff7070, 9},
    {"thesis", "thesis x100", 100, 0x800000, 11},
};
enum { STYLES = sizeof hard_styles / sizeof *hard_styles, ROW_HEIGHT = 20, MARGINS = 120 };

static size_t count_families(const error_table *table)
{
    size_t count = 0;
    for (size_t first = 0; first < table->count; first = error_scene_end(table, first))
        count++;
    return count;
}

static bool is_of_style(const error_row *row, const hard_style *style)
{
    return error_hard_is_main(row) && strcmp(row->run.method->name, style->method) == 0 &&
           !(row->run.scale < style->scale) && !(row->run.scale > style->scale);
}

// Columns: missed share, false-hidden share, row from the top. NaN where there is nothing to miss
// or to hide.
static void put_style(FILE *stream, const error_table *table, int s, size_t families)
{
    fprintf(stream, "$style%d << END\n", s);
    size_t place = families;
    for (size_t first = 0, last; first < table->count; first = last, place--) {
        last = error_scene_end(table, first);
        for (size_t i = first; i < last; i++) {
            const compare_sums *sums = &table->rows[i].sums;
            if (!is_of_style(&table->rows[i], &hard_styles[s])) continue;
            if (sums->in_frustum > sums->visible)
                fprintf(stream, "%.4f", compare_missed_percent(sums));
            else
                fputs("NaN", stream);
            if (sums->visible > 0)
                fprintf(stream, " %.4f %zu\n",
                        100 * (double)sums->false_hidden / (double)sums->visible, place);
            else
                fprintf(stream, " NaN %zu\n", place);
        }
    }
    fputs("END\n", stream);
}

static void put_families(FILE *stream, const error_table *table, size_t families)
{
    fputs("set ytics (", stream);
    size_t place = families;
    for (size_t first = 0; first < table->count; first = error_scene_end(table, first)) {
        const char *slash = strchr(table->rows[first].scene, '/');
        if (first > 0) fputs(", ", stream);
        plot_quote(stream, slash ? slash + 1 : table->rows[first].scene);
        fprintf(stream, " %zu", place--);
    }
    fputs(")\n", stream);
}

// A panel of its own, across the whole width: the others are too narrow for it.
static void put_legend(FILE *stream, double height)
{
    fprintf(stream,
            "set lmargin at screen 0.02\nset rmargin at screen 0.98\n"
            "set tmargin at screen 1\nset bmargin at screen %.4f\n"
            "unset border\nunset tics\nset xrange [0:1]\nset yrange [0:1]\n"
            "set key center center horizontal maxcols 4 Left reverse width 2 samplen 1\nplot -1 "
            "notitle",
            1 - 55 / height);
    for (int s = 0; s < STYLES; s++) {
        fprintf(stream,
                ", keyentry with points pointtype %d pointsize 1 linewidth 1.5 linecolor rgb "
                "'#%06x' title ",
                hard_styles[s].shape, hard_styles[s].color);
        plot_quote(stream, hard_styles[s].title);
    }
    fputs("\nset border\nset key off\n", stream);
}

// Points of one family are spread a little over its line, so that none hides another.
static void put_panel(FILE *stream, int column, double left, double right, const char *label)
{
    fprintf(stream, "set lmargin at screen %.3f\nset rmargin at screen %.3f\nset xlabel ", left,
            right);
    plot_quote(stream, label);
    fputc('\n', stream);
    for (int s = 0; s < STYLES; s++) {
        double shift = 0.08 * ((STYLES - 1) / 2.0 - s);
        fprintf(stream,
                "%s $style%d using %d:($3%+.2f) with points pointtype %d pointsize 1 linewidth 1.5 "
                "linecolor rgb '#%06x'",
                s == 0 ? "plot" : ",", s, column, shift, hard_styles[s].shape,
                hard_styles[s].color);
    }
    fputc('\n', stream);
}

static void put_hard(FILE *stream, const char *path, const void *data)
{
    const error_table *table = data;
    size_t families = count_families(table);
    double height = (double)(families * ROW_HEIGHT + MARGINS);
    for (int s = 0; s < STYLES; s++)
        put_style(stream, table, s, families);
    fprintf(stream, "set terminal pngcairo size 900,%.0f noenhanced font 'sans,10'\nset output ",
            height);
    plot_quote(stream, path);
    fputs("\nset multiplot\n", stream);
    put_legend(stream, height);
    fprintf(stream,
            "set grid xtics ytics linetype 1 linecolor rgb '#e0e0e0'\n"
            "set xrange [-4:104]\nset yrange [0.3:%.1f]\nset xtics 0,20,100\n"
            "set tmargin at screen %.4f\nset bmargin at screen %.4f\n",
            (double)families + 0.7, 1 - 60 / height, 50 / height);
    put_families(stream, table, families);
    put_panel(stream, 1, 0.17, 0.57, "hidden objects missed, %");
    fputs("set format y ''\nset ytics 1,1\n", stream);
    put_panel(stream, 2, 0.59, 0.99, "visible objects hidden, %");
    fputs("unset multiplot\n", stream);
}

bool error_hard_plot(const char *path, const error_table *table)
{
    return plot_run(path, put_hard, table);
}
