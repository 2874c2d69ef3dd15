// SPDX-License-Identifier: Apache-2.0
#include "error_report.h"

#include "build_info.h"
#include "error_hard.h"
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
    const char *backend = run->method->traits & ERROR_BACKENDS ? "openmp" : "plain";
    if (run->skipped || strcmp(run->settings.backend, backend) != 0) return false;
    // The thesis's test is another thing at every scale.
    if (!(run->method->traits & ERROR_ONE_SIDED) && run->method->traits & ERROR_SCALES) return true;
    // Presets stand beside the default, which is one of them.
    bool is_preset = run->settings.knobs.preset != OCC_PRESET_BALANCED;
    bool is_one_thread = !(run->method->traits & ERROR_BACKENDS) || run->settings.threads == 1;
    return is_one_thread && (is_preset || error_run_is_default(run));
}

void error_summary_name(const error_row *row, char *text, size_t size)
{
    const error_run *run = &row->run;
    char setting[64];
    error_run_setting(run, setting, sizeof setting);
    if (error_run_is_default(run) && !(run->method->traits & ERROR_RAYS))
        snprintf(text, size, "%s", run->method->name);
    else
        snprintf(text, size, "%s, %s", run->method->name, setting);
}

void error_print_summary(FILE *stream, const error_findings *findings)
{
    const error_table *table = &findings->scenes;
    fprintf(stream, "\n%-17s %-28s %10s %13s %9s %9s %9s\n", "scene", "method, one thread",
            "median_ms", "false_hidden", "largest", "missed", "missed_%");
    for (size_t i = 0; i < table->count; i++) {
        const error_row *row = &table->rows[i];
        if (!error_is_summary(row)) continue;
        char name[96];
        error_summary_name(row, name, sizeof name);
        fprintf(stream, "%-17s %-28s %10.3f %13llu %9u %9llu %9.3f\n", row->scene, name,
                row->median_ms, (unsigned long long)row->sums.false_hidden, row->sums.largest_px,
                (unsigned long long)row->sums.missed, compare_missed_percent(&row->sums));
    }
    error_hard_summary(stream, &findings->hard);
}

void error_write_setup(FILE *stream, const error_findings *findings)
{
    const error_options *options = &findings->options;
    build_info_write(stream, findings->scenes.driver);
    fprintf(stream, "# peer=%s\n# repeats=%u\n", findings->scenes.peer, options->repeats);
#ifdef OCC_BENCH_JUDGE
    fprintf(stream, "# settled_at_most=%u\n# hidden_judged_at_most=%u\n", options->settle,
            options->hidden);
#else
    fputs("# settled_at_most=0\n# hidden_judged_at_most=0\n", stream);
#endif
}

static char *join(const char *folder, const char *name, const char *extension)
{
    size_t size = strlen(folder) + strlen(name) + strlen(extension) + 2;
    char *path = malloc(size);
    if (path) snprintf(path, size, "%s/%s%s", folder, name, extension);
    return path;
}

static void write_rows(FILE *stream, const error_table *table)
{
    for (size_t i = 0; i < table->count; i++)
        error_csv_row(stream, &table->rows[i]);
}

static bool write_csv(const char *path, const error_findings *findings)
{
    outfile file;
    if (!outfile_open(&file, path)) return false;
    error_write_setup(file.stream, findings);
    error_csv_header(file.stream);
    write_rows(file.stream, &findings->scenes);
    write_rows(file.stream, &findings->hard);
    return outfile_commit(&file);
}

static bool write_markdown(const char *path, const error_findings *findings, bool has_plots)
{
    outfile file;
    if (!outfile_open(&file, path)) return false;
    error_write_markdown(file.stream, findings, has_plots);
    return outfile_commit(&file);
}

// False if there is one without a plot.
static bool draw_all(const char *folder, const error_findings *findings)
{
    const error_table *table = &findings->scenes;
    bool is_drawn = true;
    for (size_t first = 0, last; is_drawn && first < table->count; first = last) {
        last = error_scene_end(table, first);
        char *path = join(folder, table->rows[first].scene, ".png");
        is_drawn = path && error_plot_scene(path, table, first, last);
        free(path);
    }
    if (!is_drawn || findings->hard.count == 0) return is_drawn;
    char *path = join(folder, "hard", ".png");
    is_drawn = path && error_hard_plot(path, &findings->hard);
    free(path);
    return is_drawn;
}

bool error_report(const char *folder, const error_findings *findings)
{
    char *csv = join(folder, "error", ".csv"), *markdown = join(folder, "error", ".md");
    bool good = csv && markdown && write_csv(csv, findings);
    good = good && write_markdown(markdown, findings, draw_all(folder, findings));
    free(csv);
    free(markdown);
    return good;
}
