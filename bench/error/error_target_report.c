// SPDX-License-Identifier: Apache-2.0
#include "build_info.h"
#include "error_target.h"
#include "outfile.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

// --- key=value -----------------------------------------------------------------------------------

static void print_peer(FILE *stream, const char *key, const error_target *row,
                       const error_published *point)
{
    if (!point) return;
    fprintf(stream, " %s_ms=%g %s_missed_pct=%g %s_false=%u %s_times=%.2f", key, point->ms, key,
            point->missed_pct, key, point->false_hidden, key, point->ms / row->one.median_ms);
}

void error_target_print(FILE *stream, const error_target *row)
{
    fprintf(stream,
            "scene=%s seed=%" PRIu64 " from=%s method=fused objects=%u frames=%u visible=%.1f "
            "median_ms=%.4f p99_ms=%.4f max_ms=%.4f worst=%.2f moved_ms=%.4f first_ms=%.4f "
            "warm_ms=%.4f two_threads_ms=%.4f "
            "speed_up=%.2f same_masks=%s build_ms=%.2f interruptions=%llu missed_pct=%.3f "
            "false_hidden=%llu",
            row->scene, row->seed, row->is_file ? "file" : "generator", row->objects, row->frames,
            row->one.visible, row->one.median_ms, row->one.p99_ms, row->one.max_ms,
            error_target_worst(row), row->one.moved_ms, row->first_ms, row->warm_ms,
            row->two.median_ms, error_target_speed_up(row), row->is_same ? "yes" : "no",
            row->build_ms, (unsigned long long)row->interruptions,
            compare_missed_percent(&row->sums), (unsigned long long)row->sums.false_hidden);
    if (row->goal->ms > 0)
        fprintf(stream, " target_ms=%g target_missed_pct=%g of_target=%.2f", row->goal->ms,
                row->goal->missed_pct, row->one.median_ms / row->goal->ms);
    print_peer(stream, "peer_fast", row, error_target_fastest(row));
    print_peer(stream, "peer_fine", row, error_target_finest(row));
    fputc('\n', stream);
}

// --- CSV -----------------------------------------------------------------------------------------

static void write_csv_peer(FILE *stream, const error_target *row, const error_published *point)
{
    if (point)
        fprintf(stream, ",%g,%g,%u,%.3f", point->ms, point->missed_pct, point->false_hidden,
                point->ms / row->one.median_ms);
    else
        fputs(",,,,", stream);
}

static void write_csv_row(FILE *stream, const error_target *row)
{
    fprintf(stream, "%s,%" PRIu64 ",%s,fused,%u,%u,%u,%.1f,%.1f,", row->scene, row->seed,
            row->is_file ? "file" : "generator", row->objects, row->frames, row->truth_frames,
            (double)row->sums.visible / (row->truth_frames ? row->truth_frames : 1),
            row->one.visible);
    fprintf(stream, "%.6f,%.6f,%.6f,%.3f,%.6f,%.6f,%.6f,%.6f,%.3f,%s,%.3f,%llu,",
            row->one.median_ms, row->one.p99_ms, row->one.max_ms, error_target_worst(row),
            row->one.moved_ms, row->first_ms, row->warm_ms, row->two.median_ms,
            error_target_speed_up(row), row->is_same ? "yes" : "no", row->build_ms,
            (unsigned long long)row->interruptions);
    fprintf(stream, "%llu,%.4f,%llu,%llu,", (unsigned long long)row->sums.missed,
            compare_missed_percent(&row->sums), (unsigned long long)row->sums.false_hidden,
            (unsigned long long)row->settled.unsettled);
    if (row->goal->ms > 0)
        fprintf(stream, "%g,%g", row->goal->ms, row->goal->missed_pct);
    else
        fputc(',', stream);
    write_csv_peer(stream, row, error_target_fastest(row));
    write_csv_peer(stream, row, error_target_finest(row));
    fputc('\n', stream);
}

static void write_setup(FILE *stream, const error_target_options *options)
{
    build_info_write(stream, "none");
    fprintf(stream, "# rounds=%d\n# repeats=%u\n", ERROR_ROUNDS, options->repeats);
}

static void write_csv(FILE *stream, const error_target_options *options,
                      const error_targets *targets)
{
    write_setup(stream, options);
    fputs("scene,seed,from,method,objects,frames,truth_frames,visible_objects,reported_objects,"
          "median_ms,p99_ms,max_ms,worst_frame,moved_ms,first_ms,first_warm_ms,two_threads_ms,two_"
          "threads_"
          "speed_up,"
          "same_masks,build_ms,interruptions,missed_objects,missed_pct,false_hidden_objects,"
          "unsettled_objects,"
          "target_ms,target_missed_pct,peer_fast_ms,peer_fast_missed_pct,peer_fast_false_objects,"
          "peer_fast_times,peer_fine_ms,peer_fine_missed_pct,peer_fine_false_objects,"
          "peer_fine_times\n",
          stream);
    for (size_t i = 0; i < targets->count; i++)
        write_csv_row(stream, &targets->rows[i]);
}

// --- Markdown ------------------------------------------------------------------------------------

static void write_peer(FILE *stream, const error_target *row, const error_published *point)
{
    if (!point) return;
    fprintf(stream, "%g @ %g %%", point->ms, point->missed_pct);
    if (point->false_hidden > 0) fprintf(stream, " (%u)", point->false_hidden);
    fprintf(stream, " = **%.1f x**", point->ms / row->one.median_ms);
}

static void write_error(FILE *stream, const error_target *row)
{
    const error_published *fast = error_target_fastest(row), *fine = error_target_finest(row);
    fprintf(stream, "| %s | %u | %.0f | %.3f @ %.3f %% | %llu |", row->scene, row->objects,
            (double)row->sums.visible / (row->truth_frames ? row->truth_frames : 1),
            row->one.median_ms, compare_missed_percent(&row->sums),
            (unsigned long long)row->sums.false_hidden);
    if (row->goal->ms > 0)
        fprintf(stream, " %g @ %g %% | %.2f | ", row->goal->ms, row->goal->missed_pct,
                row->one.median_ms / row->goal->ms);
    else
        fputs(" | | ", stream);
    write_peer(stream, row, fast);
    if (fine != fast) fputs("; ", stream);
    if (fine != fast) write_peer(stream, row, fine);
    fputs(" |\n", stream);
}

static void write_times(FILE *stream, const error_target *row)
{
    fprintf(stream,
            "| %s | %.1f | %.3f | %.3f | %.3f | %.2f | %.3f | %.3f (%.3f) | %.3f | %.2f | %s | "
            "%.2f |\n",
            row->scene, row->one.visible, row->one.median_ms, row->one.p99_ms, row->one.max_ms,
            error_target_worst(row), row->one.moved_ms, row->first_ms, row->warm_ms,
            row->two.median_ms, error_target_speed_up(row), row->is_same ? "same" : "**different**",
            row->build_ms);
}

typedef void write_row_function(FILE *stream, const error_target *row);

static void write_rows(FILE *stream, const error_targets *targets, bool is_own_seed,
                       write_row_function *write_row)
{
    for (size_t i = 0; i < targets->count; i++)
        if ((targets->rows[i].variant == 0) == is_own_seed) write_row(stream, &targets->rows[i]);
    fputc('\n', stream);
}

static void write_part(FILE *stream, const error_targets *targets, bool is_own_seed)
{
    fputs("| scene | objects | visible | ms @ missed | false-hidden | target | ms / target | "
          "Masked + tree: ms @ missed (false-hidden) = times ours |\n"
          "|---|---:|---:|---:|---:|---:|---:|---|\n",
          stream);
    write_rows(stream, targets, is_own_seed, write_error);
    fputs("| scene | reported | median ms | p99 | max | max / median | after another frame | "
          "first frame (warm) | two threads | speed-up | masks | build ms "
          "|\n|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---|---:|\n",
          stream);
    write_rows(stream, targets, is_own_seed, write_times);
}

static const char introduction[] =
    "Written by `occlude-bench error --targets`; docs/performance.md says how to read it. Method "
    "`fused` with the library's default knobs. Times are milliseconds of a frame on one thread "
    "(the call, the copy of the mask and of the list), a frame's time the median of its repeats, "
    "one after the other: their median, 99th percentile and maximum over the frames. *After "
    "another frame*: the median over frames of the time when the frame before it in the path was "
    "culled just before, with the caches as that left them. One thread and two were measured "
    "in turns. *First frame*: the first call of a new view on a scene just built, what it "
    "allocates included, and the same frame met before. *Build*: the scene on two threads. "
    "*Visible*: in truth, at the frames "
    "that are judged (0, 20 and 40); *reported*: by the library, mean over all frames. Errors are "
    "sums over the judged frames. \"Masked + tree\" is MaskedOcclusionCulling with occluders "
    "tested before they are drawn, the best of them, and a tree over the objects: its fastest and "
    "its most accurate setting, taken once on these very boxes but on another machine, so that "
    "its ratios carry that machine's speed; it is shown only where a checksum says that the boxes "
    "are the same.";

static void write_markdown(FILE *stream, const error_target_options *options,
                           const error_targets *targets)
{
    fprintf(stream,
            "<!-- SPDX-License-Identifier: Apache-2.0 -->\n# Goals and what is reached\n\n%s\n\n"
            "```\n",
            introduction);
    write_setup(stream, options);
    fputs("```\n\n## The scenes with goals\n\n", stream);
    write_part(stream, targets, true);
    if (!options->is_quick) {
        fputs("## Other seeds\n\nThe same kinds and sizes: no setting was chosen on these.\n\n",
              stream);
        write_part(stream, targets, false);
    }
    fputs("## All together\n\n", stream);
    error_targets_totals(stream, targets);
}

typedef void write_function(FILE *stream, const error_target_options *options,
                            const error_targets *targets);

static bool write_file(const char *folder, const char *name, write_function *write,
                       const error_target_options *options, const error_targets *targets)
{
    outfile file;
    size_t size = strlen(folder) + strlen(name) + 2;
    char *path = malloc(size);
    if (!path) return false;
    snprintf(path, size, "%s/%s", folder, name);
    bool good = outfile_open(&file, path);
    free(path);
    if (!good) return false;
    write(file.stream, options, targets);
    return outfile_commit(&file);
}

bool error_targets_report(const char *folder, const error_target_options *options,
                          const error_targets *targets)
{
    return write_file(folder, "targets.csv", write_csv, options, targets) &&
           write_file(folder, "targets.md", write_markdown, options, targets);
}
