// SPDX-License-Identifier: Apache-2.0
#include "error_report.h"

#include "build_info.h"
#include "outfile.h"

#include <stdlib.h>
#include <string.h>

size_t error_scene_end(const error_table *table, size_t first)
{
    size_t last = first;
    while (last < table->count && strcmp(table->rows[last].scene, table->rows[first].scene) == 0)
        last++;
    return last;
}

bool error_is_summary(const error_row *row)
{
    const error_run *run = &row->run;
    if (run->skipped) return false;
    char setting[64];
    error_run_setting(run, setting, sizeof setting);
    bool is_default = strcmp(setting, "default") == 0;
    // The thesis's test is one thing at each scale.
    if (!(run->method->traits & ERROR_ONE_SIDED)) return true;
    if (!(run->method->traits & ERROR_BACKENDS)) return is_default;
    return is_default && strcmp(run->settings.backend, "openmp") == 0 && run->settings.threads == 1;
}

static void summary_name(const error_row *row, char *text, size_t size)
{
    char setting[64];
    error_run_setting(&row->run, setting, sizeof setting);
    if (strcmp(setting, "default") == 0)
        snprintf(text, size, "%s", row->run.method->name);
    else
        snprintf(text, size, "%s, %s", row->run.method->name, setting);
}

void error_print_summary(FILE *stream, const error_table *table)
{
    fprintf(stream, "\n%-17s %-28s %10s %13s %9s %9s %9s\n", "scene", "method, one thread",
            "median_ms", "false_hidden", "largest", "missed", "missed_%");
    for (size_t i = 0; i < table->count; i++) {
        const error_row *row = &table->rows[i];
        if (!error_is_summary(row)) continue;
        char name[96];
        summary_name(row, name, sizeof name);
        fprintf(stream, "%-17s %-28s %10.3f %13llu %9u %9llu %9.3f\n", row->scene, name,
                row->median_ms, (unsigned long long)row->sums.false_hidden, row->sums.largest_px,
                (unsigned long long)row->sums.missed, compare_missed_percent(&row->sums));
    }
}

static char *join(const char *folder, const char *name, const char *extension)
{
    size_t size = strlen(folder) + strlen(name) + strlen(extension) + 2;
    char *path = malloc(size);
    if (path) snprintf(path, size, "%s/%s%s", folder, name, extension);
    return path;
}

static bool write_csv(const char *path, const error_options *options, const error_table *table)
{
    outfile file;
    if (!outfile_open(&file, path)) return false;
    build_info_write(file.stream, table->driver);
    fprintf(file.stream, "# repeats=%u\n", options->repeats);
    error_csv_header(file.stream);
    for (size_t i = 0; i < table->count; i++)
        error_csv_row(file.stream, &table->rows[i]);
    return outfile_commit(&file);
}

static bool write_markdown(const char *path, const error_table *table, bool has_plots)
{
    outfile file;
    if (!outfile_open(&file, path)) return false;
    error_write_markdown(file.stream, table, has_plots);
    return outfile_commit(&file);
}

// False if there is a scene without a plot.
static bool draw_scenes(const char *folder, const error_table *table)
{
    for (size_t first = 0, last; first < table->count; first = last) {
        last = error_scene_end(table, first);
        char *path = join(folder, table->rows[first].scene, ".png");
        bool is_drawn = path && error_plot_scene(path, table, first, last);
        free(path);
        if (!is_drawn) return false;
    }
    return true;
}

bool error_report(const char *folder, const error_options *options, const error_table *table)
{
    char *csv = join(folder, "error", ".csv"), *markdown = join(folder, "error", ".md");
    bool good = csv && markdown && write_csv(csv, options, table);
    good = good && write_markdown(markdown, table, draw_scenes(folder, table));
    free(csv);
    free(markdown);
    return good;
}
