// SPDX-License-Identifier: Apache-2.0
#include "error_report.h"

#include "error_hard.h"
#include "error_published.h"

#include <string.h>

// The columns of time, by backend and threads as a plan states them.
static const struct {
    const char *backend, *title;
    uint32_t threads;
} time_columns[] = {{"plain", "plain C", 0},
                    {"openmp", "OpenMP, 1 thread", 1},
                    {"openmp", "OpenMP, all threads", 0},
                    {"opencl", "OpenCL", 0}};
enum { TIME_COLUMNS = sizeof time_columns / sizeof *time_columns };

static int time_column(const error_row *row)
{
    const measure_settings *settings = &row->run.settings;
    for (int c = 0; c < TIME_COLUMNS; c++)
        if (strcmp(settings->backend, time_columns[c].backend) == 0 &&
            settings->threads == time_columns[c].threads)
            return c;
    return 0;
}

static void write_errors(FILE *stream, const error_row *row)
{
    const compare_sums *sums = &row->sums;
    const char *strong = sums->false_hidden > 0 ? "**" : "";
    fprintf(stream, " %s%llu%s | %u | %llu | %.3f |", strong,
            (unsigned long long)sums->false_hidden, strong, sums->largest_px,
            (unsigned long long)sums->missed, compare_missed_percent(sums));
}

// One line for all backends of a setting: rows [first, last), whose verdicts are the same.
static void write_line(FILE *stream, const error_table *table, size_t first, size_t last)
{
    const error_row *row = &table->rows[first];
    const error_row *times[TIME_COLUMNS] = {NULL};
    for (size_t i = first; i < last; i++)
        if (!table->rows[i].run.skipped) times[time_column(&table->rows[i])] = &table->rows[i];
    char setting[64];
    error_run_setting(&row->run, setting, sizeof setting);
    fprintf(stream, "| %s | %s |", row->run.method->name, setting);
    write_errors(stream, row);
    for (int c = 0; c < TIME_COLUMNS; c++) {
        if (times[c])
            fprintf(stream, " %.3f (%.3f) |", times[c]->median_ms, times[c]->p99_ms);
        else
            fputs(" |", stream);
    }
    fputc('\n', stream);
}

static void write_runs(FILE *stream, const error_table *table, size_t first, size_t last)
{
    fputs("| method | setting | false-hidden | largest, px | missed | missed, % |", stream);
    for (int c = 0; c < TIME_COLUMNS; c++)
        fprintf(stream, " %s |", time_columns[c].title);
    fputs("\n|---|---|---:|---:|---:|---:|", stream);
    for (int c = 0; c < TIME_COLUMNS; c++)
        fputs("---:|", stream);
    fputc('\n', stream);
    for (size_t i = first, end; i < last; i = end) {
        for (end = i + 1; end < last; end++)
            if (!error_run_equals(&table->rows[i].run, &table->rows[end].run)) break;
        if (!table->rows[i].run.skipped) write_line(stream, table, i, end);
    }
}

static void write_skipped(FILE *stream, const error_table *table, size_t first, size_t last)
{
    for (size_t i = first; i < last; i++) {
        const error_run *run = &table->rows[i].run;
        if (!run->skipped || strcmp(run->settings.backend, "opencl") == 0) continue;
        fprintf(stream, "\nNot run: `%s`: %s.\n", run->method->name, run->skipped);
    }
}

static void write_published(FILE *stream, const error_row *row)
{
    const error_published *point = error_published_find(row->scene, row->identity);
    if (!point) return;
    fputs("\nOther programs on these very boxes, measured once on another machine (2 cores, "
          "AVX-512), one thread:\n\n"
          "| program | setting | false-hidden | missed, % | ms |\n|---|---|---:|---:|---:|\n",
          stream);
    for (; point->scene && strcmp(point->scene, row->scene) == 0; point++)
        fprintf(stream, "| %s | %s | %u | %g | %g |\n", point->method, point->setting,
                point->false_hidden, point->missed_pct, point->ms);
}

static const error_row *find_measured(const error_table *table, size_t first, size_t last)
{
    for (size_t i = first; i < last; i++)
        if (!table->rows[i].run.skipped) return &table->rows[i];
    return &table->rows[first];
}

static void write_scene(FILE *stream, const error_table *table, size_t first, size_t last,
                        bool has_plots)
{
    const error_row *row = find_measured(table, first, last);
    fprintf(stream, "\n## %s\n\n", row->scene);
    fprintf(stream,
            "%u objects, %u occluders. In truth %.1f objects a frame are in the frustum and %.1f "
            "visible (means over %u frames).\n\n",
            row->objects, row->occluders, error_row_in_frustum(row), error_row_visible(row),
            row->truth_frames);
    if (has_plots) fprintf(stream, "![%s: time against error](%s.png)\n\n", row->scene, row->scene);
    write_runs(stream, table, first, last);
    write_skipped(stream, table, first, last);
    write_published(stream, row);
}

static void write_summary(FILE *stream, const error_table *table)
{
    fputs("\n## Summary\n\n"
          "| scene | method, one thread | ms | false-hidden | largest, px | missed | missed, % |\n"
          "|---|---|---:|---:|---:|---:|---:|\n",
          stream);
    for (size_t i = 0; i < table->count; i++) {
        const error_row *row = &table->rows[i];
        if (!error_is_summary(row)) continue;
        char name[96];
        error_summary_name(row, name, sizeof name);
        fprintf(stream, "| %s | %s | %.3f |", row->scene, name, row->median_ms);
        write_errors(stream, row);
        fputc('\n', stream);
    }
}

void error_write_markdown(FILE *stream, const error_findings *findings, bool has_plots)
{
    const error_table *table = &findings->scenes;
    fputs("<!-- SPDX-License-Identifier: Apache-2.0 -->\n# Speed against error\n\n"
          "Written by `occlude-bench error`. Times are milliseconds of a frame: the median over "
          "the frames, and the 99th percentile in brackets. Errors are sums over the truth's "
          "frames: *false-hidden* objects can be seen but are reported hidden, *missed* ones are "
          "in the frustum and hidden but reported visible, in per cent of all such objects. "
          "What sampling and a result did not agree on went to the exact judge, up to the number "
          "below for each result; the rest counts as sampling has it. "
          "All backends of a line gave the same verdict for every object and frame.\n\n```\n",
          stream);
    error_write_setup(stream, findings);
    fputs("```\n", stream);
    write_summary(stream, table);
    for (size_t first = 0, last; first < table->count; first = last) {
        last = error_scene_end(table, first);
        write_scene(stream, table, first, last, has_plots);
    }
    error_hard_markdown(stream, &findings->hard, has_plots);
}
