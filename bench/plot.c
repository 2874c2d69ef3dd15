// SPDX-License-Identifier: Apache-2.0
#define _POSIX_C_SOURCE 200809L
#include "plot.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

// What plot_logarithmic() draws.
typedef struct plot_lines {
    const char *title, *x_label, *y_label;
    const plot_curve *curves;
    size_t count;
} plot_lines;

// In gnuplot a quote within single quotes is doubled.
void plot_quote(FILE *stream, const char *text)
{
    fputc('\'', stream);
    for (; *text; text++) {
        if (*text == '\'') fputc('\'', stream);
        fputc(*text, stream);
    }
    fputc('\'', stream);
}

static void put_command(FILE *stream, const char *command, const char *text)
{
    fprintf(stream, "%s ", command);
    plot_quote(stream, text);
    fputc('\n', stream);
}

static void put_lines(FILE *stream, const char *path, const void *data)
{
    const plot_lines *lines = data;
    for (size_t c = 0; c < lines->count; c++) {
        const plot_curve *curve = &lines->curves[c];
        fprintf(stream, "$curve%zu << END\n", c);
        for (size_t i = 0; i < curve->count; i++)
            if (curve->y[i] > 0) fprintf(stream, "%.9g %.9g\n", curve->x[i], curve->y[i]);
        fputs("END\n", stream);
    }
    fputs("set terminal pngcairo size 960,640 noenhanced\nset logscale xy\nset grid\n"
          "set key left top\nset format '%.0s%c'\nset format y '%g'\n",
          stream);
    put_command(stream, "set output", path);
    put_command(stream, "set title", lines->title);
    put_command(stream, "set xlabel", lines->x_label);
    put_command(stream, "set ylabel", lines->y_label);
    for (size_t c = 0; c < lines->count; c++) {
        fprintf(stream, "%s $curve%zu with linespoints linewidth 2 pointtype 7 title ",
                c == 0 ? "plot" : ",", c);
        plot_quote(stream, lines->curves[c].title);
    }
    fputc('\n', stream);
}

static bool run_gnuplot(const char *path, plot_writer *writer, const void *data)
{
    // Should gnuplot die, it is its exit status that tells, not a signal to us.
    struct sigaction ignore = {.sa_handler = SIG_IGN}, before;
    sigaction(SIGPIPE, &ignore, &before);
    FILE *stream = popen("gnuplot", "w");
    if (stream) writer(stream, path, data);
    bool good = stream && pclose(stream) == 0;
    sigaction(SIGPIPE, &before, NULL);
    return good;
}

bool plot_run(const char *path, plot_writer *writer, const void *data)
{
    if (system("command -v gnuplot >/dev/null 2>&1") != 0) {
        fprintf(stderr, "occlude-bench: %s: no plot: gnuplot is not installed\n", path);
        return false;
    }
    size_t size = strlen(path) + 32;
    char *temporary = malloc(size);
    if (!temporary) return false;
    snprintf(temporary, size, "%s.%ld.part", path, (long)getpid());
    bool good = run_gnuplot(temporary, writer, data) && rename(temporary, path) == 0;
    if (!good) {
        remove(temporary);
        fprintf(stderr, "occlude-bench: %s: no plot: gnuplot could not write it\n", path);
    }
    free(temporary);
    return good;
}

bool plot_logarithmic(const char *path, const char *title, const char *x_label, const char *y_label,
                      const plot_curve *curves, size_t count)
{
    const plot_lines lines = {title, x_label, y_label, curves, count};
    return plot_run(path, put_lines, &lines);
}
