// SPDX-License-Identifier: Apache-2.0
#include "error_row.h"

#include <stdlib.h>

bool error_table_add(error_table *table, const error_row *row)
{
    if (table->count == table->capacity) {
        size_t wanted = table->capacity ? 2 * table->capacity : 64;
        error_row *larger = realloc(table->rows, wanted * sizeof *larger);
        if (!larger) return false;
        table->rows = larger;
        table->capacity = wanted;
    }
    table->rows[table->count++] = *row;
    return true;
}

void error_table_free(error_table *table)
{
    free(table->rows);
    *table = (error_table){0};
}

uint64_t error_table_broken_promises(const error_table *table)
{
    uint64_t count = 0;
    for (size_t i = 0; i < table->count; i++)
        if (error_run_is_one_sided(&table->rows[i].run)) count += table->rows[i].sums.false_hidden;
    return count;
}

static double per_frame(uint64_t sum, uint32_t frames)
{
    return frames > 0 ? (double)sum / frames : 0.0;
}

double error_row_in_frustum(const error_row *row)
{
    return per_frame(row->sums.in_frustum, row->truth_frames);
}

double error_row_visible(const error_row *row)
{
    return per_frame(row->sums.visible, row->truth_frames);
}

void error_csv_header(FILE *stream)
{
    fputs("scene,method,backend,threads,min_area_sr,max_occluders,grain,max_splits,tolerance_rad,"
          "preset,"
          "rays,scale,frames,objects,"
          "in_frustum_objects,visible_objects,median_ms,p99_ms,false_hidden_objects,largest_px,"
          "missed_objects,missed_pct,settled_objects,judged_visible_objects,unsettled_objects,"
          "false_confirmed_objects,false_refuted_objects,agreed_judged_objects,"
          "agreed_seen_objects,build_ms,memory_bytes,skipped\n",
          stream);
}

static void write_fusion(FILE *stream, const error_run *run)
{
    static const char *const presets[] = {"balanced", "fast", "thorough"};
    const occ_cull_desc *knobs = &run->settings.knobs;
    bool has_presets = run->method->traits & ERROR_PRESETS;
    if (has_presets && knobs->preset == OCC_PRESET_BALANCED)
        fprintf(stream, "%u", knobs->max_splits);
    if (has_presets)
        fprintf(stream, ",%g,%s,", (double)knobs->tolerance, presets[knobs->preset]);
    else
        fputs(",,,", stream);
}

// What does not apply to a run, or follows from its preset, is left empty.
static void write_setting(FILE *stream, const error_run *run)
{
    const measure_settings *settings = &run->settings;
    const occ_cull_desc *knobs = &settings->knobs;
    if (run->method->traits & ERROR_KNOBS && knobs->preset == OCC_PRESET_BALANCED)
        fprintf(stream, "%g,%u,%u,", (double)knobs->min_area, knobs->max_occluders, knobs->grain);
    else
        fputs(",,,", stream);
    write_fusion(stream, run);
    if (run->method->traits & ERROR_RAYS)
        fprintf(stream, "%ux%u", settings->rays_width, settings->rays_height);
    fprintf(stream, ",%g,", run->scale);
}

static void write_count(FILE *stream, uint64_t count)
{
    fprintf(stream, "%llu,", (unsigned long long)count);
}

static void write_errors(FILE *stream, const error_row *row)
{
    const settle_sums *settled = &row->settled;
    write_count(stream, row->sums.false_hidden);
    write_count(stream, row->sums.largest_px);
    write_count(stream, row->sums.missed);
    fprintf(stream, "%.4f,", compare_missed_percent(&row->sums));
    write_count(stream, settled->settled);
    write_count(stream, settled->judged_visible);
    write_count(stream, settled->unsettled);
    write_count(stream, settled->false_confirmed);
    write_count(stream, settled->false_refuted);
    write_count(stream, settled->agreed_judged);
    write_count(stream, settled->agreed_seen);
}

void error_csv_row(FILE *stream, const error_row *row)
{
    const error_run *run = &row->run;
    fprintf(stream, "%s,%s,%s,", row->scene, run->method->name, run->settings.backend);
    if (run->skipped) {
        fputs(",", stream);
        write_setting(stream, run);
        fprintf(stream, ",%u,,,,,,,,,,,,,,,,,,\"%s\"\n", row->objects, run->skipped);
        return;
    }
    fprintf(stream, "%u,", row->threads);
    write_setting(stream, run);
    fprintf(stream, "%u,%u,%.1f,%.1f,", row->frames, row->objects, error_row_in_frustum(row),
            error_row_visible(row));
    if (row->is_timed)
        fprintf(stream, "%.6f,%.6f,", row->median_ms, row->p99_ms);
    else
        fputs(",,", stream);
    write_errors(stream, row);
    if (row->is_timed)
        fprintf(stream, "%.3f,%llu,\n", row->build_ms, (unsigned long long)row->bytes);
    else
        fputs(",,\n", stream);
}
