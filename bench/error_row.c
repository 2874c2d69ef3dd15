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
        if (table->rows[i].run.method->traits & ERROR_ONE_SIDED)
            count += table->rows[i].sums.false_hidden;
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
    fputs("scene,method,backend,threads,min_area_sr,max_occluders,grain,scale,frames,objects,"
          "in_frustum_objects,visible_objects,median_ms,p99_ms,false_hidden_objects,largest_px,"
          "missed_objects,missed_pct,build_ms,memory_bytes,skipped\n",
          stream);
}

// What does not apply to a run is left empty.
static void write_knobs(FILE *stream, const error_run *run)
{
    const occ_cull_desc *knobs = &run->settings.knobs;
    if (run->method->traits & ERROR_KNOBS)
        fprintf(stream, "%g,%u,%u,%g,", (double)knobs->min_area, knobs->max_occluders, knobs->grain,
                run->scale);
    else
        fprintf(stream, ",,,%g,", run->scale);
}

void error_csv_row(FILE *stream, const error_row *row)
{
    const error_run *run = &row->run;
    fprintf(stream, "%s,%s,%s,", row->scene, run->method->name, run->settings.backend);
    if (run->skipped) {
        fputs(",", stream);
        write_knobs(stream, run);
        fprintf(stream, ",%u,,,,,,,,,,,\"%s\"\n", row->objects, run->skipped);
        return;
    }
    fprintf(stream, "%u,", row->threads);
    write_knobs(stream, run);
    fprintf(stream, "%u,%u,%.1f,%.1f,%.6f,%.6f,", row->frames, row->objects,
            error_row_in_frustum(row), error_row_visible(row), row->median_ms, row->p99_ms);
    fprintf(stream, "%llu,%u,%llu,%.4f,%.3f,%llu,\n", (unsigned long long)row->sums.false_hidden,
            row->sums.largest_px, (unsigned long long)row->sums.missed,
            compare_missed_percent(&row->sums), row->build_ms, (unsigned long long)row->bytes);
}
