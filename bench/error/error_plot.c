// SPDX-License-Identifier: Apache-2.0
#include "error_report.h"

#include "error_published.h"
#include "scatter.h"

#include <stdlib.h>
#include <string.h>

// What is drawn of a method: the setting that is varied along a curve, and how it looks. gnuplot's
// point types: 4, 6, 8, 10, 12, 14 are hollow, the next number is the same one filled.
typedef struct plot_style {
    const char *method, *backend;
    const char *varied; // what the settings drawn vary
    const char *title;
    double size;
    uint32_t threads; // as planned: 0 means all
    unsigned color;
    int shape;
    bool skips_default; // it stands in another curve
    bool is_joined;
} plot_style;

static const plot_style plot_styles[] = {
    {"single", "openmp", "min_area", "single, 1 thread, min_area", 1.2, 1, 0x0050a0, 7, false,
     true},
    {"single", "openmp", "max_occluders", "  max_occluders", 1, 1, 0x0050a0, 8, true, false},
    {"single", "openmp", "grain", "  grain", 1, 1, 0x0050a0, 10, true, false},
    {"single", "openmp", "min_area", "single, all threads", 0.9, 0, 0x30a0e0, 7, false, true},
    {"single", "opencl", "min_area", "single, OpenCL", 0.9, 0, 0x00a080, 7, false, true},
    {"fused", "openmp", "min_area", "fused, 1 thread, min_area", 1.2, 1, 0x007030, 7, false, true},
    {"fused", "openmp", "max_occluders", "  max_occluders", 1, 1, 0x007030, 8, true, false},
    {"fused", "openmp", "preset", "  presets fast, thorough", 1.3, 1, 0x007030, 5, true, false},
    {"fused", "openmp", "tolerance", "  tolerance, hides visible", 1, 1, 0x80a000, 12, false, true},
    {"pairwise", "openmp", NULL, "pairwise, 1 thread", 1.3, 1, 0x8040c0, 13, false, false},
    {"frustum", "plain", NULL, "frustum alone, 1 thread", 1.2, 0, 0x000000, 2, false, false},
    {"embree-depth", "plain", "rays", "Embree, depth buffer, 1 thread", 1.1, 0, 0xc06000, 11, false,
     true},
    {"embree-rays", "plain", NULL, "Embree, rays, 1 thread", 1.2, 0, 0xc06000, 9, false, false},
    {"thesis", "plain", "scale", "thesis of 2019, at scales", 1.3, 0, 0xc08000, 3, false, false},
};
enum { STYLES = sizeof plot_styles / sizeof *plot_styles };

// Programs measured elsewhere, in the order of the legend.
static const struct {
    const char *method, *title;
    int shape;
    bool is_joined;
} published_styles[] = {{"MaskedOcclusionCulling", "MaskedOcclusionCulling*", 4, true},
                        {"Masked + tree", "Masked + tree*", 5, false},
                        {"rasterizer", "rasterizer*", 8, false},
                        {"Godot's way", "Godot's way*", 12, false}};
enum { PUBLISHED = sizeof published_styles / sizeof *published_styles };

static bool is_of_style(const error_row *row, const plot_style *style)
{
    const error_run *run = &row->run;
    if (run->skipped || strcmp(run->method->name, style->method) != 0 ||
        strcmp(run->settings.backend, style->backend) != 0 ||
        run->settings.threads != style->threads)
        return false;
    char setting[64];
    error_run_setting(run, setting, sizeof setting);
    if (error_run_is_default(run)) return !style->skips_default;
    return style->varied && strstr(setting, style->varied);
}

static void add_row(scatter_series *series, const error_row *row)
{
    char label[SCATTER_LABEL] = "";
    unsigned long long count = row->sums.false_hidden;
    bool shows_scale =
        !(row->run.method->traits & ERROR_ONE_SIDED) && row->run.method->traits & ERROR_SCALES;
    if (shows_scale && count > 0)
        snprintf(label, sizeof label, "x%g: %llu", row->run.scale, count);
    else if (shows_scale)
        snprintf(label, sizeof label, "x%g", row->run.scale);
    else if (count > 0)
        snprintf(label, sizeof label, "%llu", count);
    scatter_add(series, row->median_ms, compare_missed_percent(&row->sums), count > 0, label);
}

static void add_style(scatter_series *series, const plot_style *style, const error_row *rows,
                      size_t count)
{
    snprintf(series->title, sizeof series->title, "%s", style->title);
    series->color = style->color;
    series->shape = style->shape;
    series->size = style->size;
    series->is_joined = style->is_joined;
    for (size_t i = 0; i < count; i++)
        if (is_of_style(&rows[i], style)) add_row(series, &rows[i]);
}

static void add_published(scatter_series *series, int style, const error_published *points)
{
    snprintf(series->title, sizeof series->title, "%s", published_styles[style].title);
    series->color = 0x808080;
    series->shape = published_styles[style].shape;
    series->size = 1.1;
    series->is_joined = published_styles[style].is_joined;
    const char *scene = points->scene;
    for (const error_published *point = points; point->scene; point++) {
        if (strcmp(point->scene, scene) != 0) break;
        if (strcmp(point->method, published_styles[style].method) != 0) continue;
        char label[SCATTER_LABEL] = "";
        if (point->false_hidden > 0) snprintf(label, sizeof label, "%u", point->false_hidden);
        scatter_add(series, point->ms, point->missed_pct, point->false_hidden > 0, label);
    }
}

bool error_plot_scene(const char *path, const error_table *table, size_t first, size_t last)
{
    const error_row *row = &table->rows[first];
    scatter_series *series = calloc(STYLES + PUBLISHED, sizeof *series);
    if (!series) return false;
    char title[160];
    snprintf(title, sizeof title, "%s: %u objects, %u occluders", row->scene, row->objects,
             row->occluders);
    scatter_plot plot = {.title = title,
                         .x_label = "milliseconds a frame (median)",
                         .y_label = "hidden objects missed, %",
                         .bad_title = "red: so many visible ones hidden",
                         .series = series};
    for (int s = 0; s < STYLES; s++)
        add_style(&series[plot.count++], &plot_styles[s], row, last - first);
    const error_published *points = error_published_find(row->scene, row->identity);
    if (points) plot.note = "* same boxes, another machine";
    for (int s = 0; points && s < PUBLISHED; s++)
        add_published(&series[plot.count++], s, points);
    bool is_drawn = scatter_draw(path, &plot);
    free(series);
    return is_drawn;
}
