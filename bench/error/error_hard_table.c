// SPDX-License-Identifier: Apache-2.0
#include "error_hard.h"

#include "error_report.h"

#include <string.h>

// A method at a scale: a column.
typedef struct hard_column {
    const error_method *method;
    double scale;
} hard_column;

enum { MAX_COLUMNS = 16 };

bool error_hard_is_main(const error_row *row)
{
    return !row->run.skipped && strcmp(row->run.settings.backend, "plain") == 0;
}

// Scales beside 1 are shown of the methods that are one thing at one scale and another at another.
static bool is_shown(const error_run *run)
{
    bool is_one = !(run->scale < 1) && !(run->scale > 1);
    return is_one || run->method->traits & ERROR_SCALES;
}

static size_t find_columns(const error_table *table, hard_column columns[MAX_COLUMNS])
{
    size_t count = 0;
    for (size_t i = 0; i < error_scene_end(table, 0) && count < MAX_COLUMNS; i++) {
        const error_row *row = &table->rows[i];
        if (error_hard_is_main(row) && is_shown(&row->run))
            columns[count++] = (hard_column){row->run.method, row->run.scale};
    }
    return count;
}

static bool is_in_column(const error_row *row, const hard_column *column)
{
    return error_hard_is_main(row) && row->run.method == column->method &&
           !(row->run.scale < column->scale) && !(row->run.scale > column->scale);
}

static void add_errors(compare_sums *sum, const compare_sums *more)
{
    sum->in_frustum += more->in_frustum;
    sum->visible += more->visible;
    sum->false_hidden += more->false_hidden;
    sum->missed += more->missed;
}

static compare_sums sum_column(const error_table *table, size_t first, size_t last,
                               const hard_column *column)
{
    compare_sums sums = {0};
    for (size_t i = first; i < last; i++)
        if (is_in_column(&table->rows[i], column)) add_errors(&sums, &table->rows[i].sums);
    return sums;
}

static void write_head(FILE *stream, const hard_column *columns, size_t count)
{
    fputs("| family |", stream);
    for (size_t c = 0; c < count; c++) {
        fprintf(stream, " %s", columns[c].method->name);
        if (columns[c].method->traits & ERROR_SCALES) fprintf(stream, " x%g", columns[c].scale);
        fputs(" |", stream);
    }
    fputs("\n|---|", stream);
    for (size_t c = 0; c < count; c++)
        fputs("---:|", stream);
    fputc('\n', stream);
}

// Missed share, and behind a stroke what was hidden wrongly.
static void write_cell(FILE *stream, const compare_sums *sums)
{
    if (sums->in_frustum > sums->visible)
        fprintf(stream, " %.1f", compare_missed_percent(sums));
    else
        fputs(" -", stream);
    const char *strong = sums->false_hidden > 0 ? "**" : "";
    fprintf(stream, " / %s%llu%s |", strong, (unsigned long long)sums->false_hidden, strong);
}

static void write_line(FILE *stream, const char *name, const error_table *table, size_t first,
                       size_t last, const hard_column *columns, size_t count)
{
    fprintf(stream, "| %s |", name);
    for (size_t c = 0; c < count; c++) {
        compare_sums sums = sum_column(table, first, last, &columns[c]);
        write_cell(stream, &sums);
    }
    fputc('\n', stream);
}

static uint64_t count_verdicts(const error_table *table)
{
    uint64_t count = 0;
    for (size_t i = 0; i < table->count; i++)
        count += table->rows[i].objects;
    return count;
}

void error_hard_markdown(FILE *stream, const error_table *table, bool has_plot)
{
    if (table->count == 0) return;
    hard_column columns[MAX_COLUMNS];
    size_t count = find_columns(table, columns);
    fprintf(stream,
            "\n## The hard families\n\n"
            "Small worlds, each made to break culling, and every object judged exactly: %llu "
            "verdicts over all methods, backends and scales. A cell has the missed share in per "
            "cent and the number of visible objects hidden. The library's methods use every "
            "occluder here, and every backend gave the same verdicts.\n\n",
            (unsigned long long)count_verdicts(table));
    if (has_plot) fputs("![the hard families: missed and false-hidden](hard.png)\n\n", stream);
    write_head(stream, columns, count);
    for (size_t first = 0, last; first < table->count; first = last) {
        last = error_scene_end(table, first);
        const char *slash = strchr(table->rows[first].scene, '/');
        write_line(stream, slash ? slash + 1 : table->rows[first].scene, table, first, last,
                   columns, count);
    }
    write_line(stream, "**all**", table, 0, table->count, columns, count);
}

void error_hard_summary(FILE *stream, const error_table *table)
{
    if (table->count == 0) return;
    hard_column columns[MAX_COLUMNS];
    size_t count = find_columns(table, columns);
    for (size_t c = 0; c < count; c++) {
        compare_sums sums = sum_column(table, 0, table->count, &columns[c]);
        char name[64];
        snprintf(name, sizeof name, "%s, scale %g", columns[c].method->name, columns[c].scale);
        fprintf(stream, "%-17s %-28s %10s %13llu %9s %9llu %9.3f\n", "hard families", name, "-",
                (unsigned long long)sums.false_hidden, "-", (unsigned long long)sums.missed,
                compare_missed_percent(&sums));
    }
}
