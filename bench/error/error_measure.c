// SPDX-License-Identifier: Apache-2.0
#include "error_measure.h"

#include "error_judge.h"
#include "error_scene.h"
#include "error_truth.h"

#include <stdlib.h>
#include <string.h>

// A scene at one scale, its truth, and both cut down to the truth's frames.
typedef struct error_stage {
    obs_scene own; // what was scaled; empty at scale 1
    const obs_scene *whole;
    obs_scene part;
    truth_result truth, part_truth;
    error_judge judge, part_judge;
} error_stage;

// A scene being measured.
typedef struct worker {
    const error_truths *truths;
    const char *name;
    const obs_scene *scene;
    uint64_t identity;
    settle_limits limits;
    error_table *table;
    // The latest run whose verdicts are not to equal an earlier one's, with verdicts and errors.
    const error_run *first;
    vis_result verdicts;
    compare_sums sums;
    settle_sums settled;
    error_status status;
} worker;

static bool is_one(double scale)
{
    return !(scale < 1) && !(scale > 1);
}

static void free_stage(error_stage *stage)
{
    error_judge_free(&stage->judge);
    error_judge_free(&stage->part_judge);
    free(stage->part.frames);
    free(stage->part_truth.frames);
    truth_free(&stage->truth);
    obs_free(&stage->own);
    memset(stage, 0, sizeof *stage);
}

static bool make_stage(const worker *work, double scale, error_stage *stage)
{
    memset(stage, 0, sizeof *stage);
    stage->whole = work->scene;
    if (!is_one(scale)) {
        if (!error_scene_scale(work->scene, scale, &stage->own)) return false;
        stage->whole = &stage->own;
    }
    stage->judge = (error_judge){.scene = stage->whole, .truth = &stage->truth};
    stage->part_judge = (error_judge){.scene = &stage->part, .truth = &stage->part_truth};
    return error_truth(work->truths, work->name, stage->whole, &stage->truth) &&
           error_truth_cut(&stage->truth, &stage->part_truth) &&
           error_scene_cut(stage->whole, stage->truth.frames, stage->truth.frame_count,
                           &stage->part);
}

static error_row begin_row(const worker *work, const error_run *run)
{
    error_row row = {.run = *run,
                     .objects = work->scene->object_count,
                     .occluders = obs_occluder_total(work->scene),
                     .identity = work->identity};
    snprintf(row.scene, sizeof row.scene, "%s", work->name);
    return row;
}

static bool fill_row(error_row *row, const measure_result *result, const truth_result *truth)
{
    measure_summary sum;
    if (!measure_summarize(result, &sum)) return false;
    row->threads = result->threads;
    row->frames = result->frame_count;
    row->truth_frames = truth->frame_count;
    row->is_timed = true;
    row->median_ms = sum.median_ms;
    row->p99_ms = sum.p99_ms;
    row->build_ms = result->build_ms;
    row->bytes = result->held_bytes + result->device_bytes;
    return true;
}

static bool are_same(const vis_result *a, const vis_result *b)
{
    return a->object_count == b->object_count && a->frame_count == b->frame_count &&
           memcmp(a->bits, b->bits, vis_row_bytes(a->object_count) * a->frame_count) == 0;
}

static void complain(const worker *work, const error_run *run)
{
    char setting[64];
    error_run_setting(run, setting, sizeof setting);
    fprintf(stderr,
            "occlude-bench: %s: %s (%s) gives other verdicts on %s with %u threads than on %s\n",
            work->name, run->method->name, setting, run->settings.backend, run->settings.threads,
            work->first->settings.backend);
}

// Puts the run's errors into the row: those of an earlier run with the same verdicts, or counted.
// The first run of its kind hands over its verdicts; the others must repeat them.
static bool judge_run(worker *work, const error_run *run, error_judge *judge, vis_result *verdicts,
                      error_row *row)
{
    bool must_repeat = work->first && error_run_equals(work->first, run);
    if (must_repeat && are_same(&work->verdicts, verdicts)) {
        row->sums = work->sums;
        row->settled = work->settled;
        return true;
    }
    if (!error_judge_count(judge, verdicts, work->limits, &row->sums, &row->settled)) return false;
    if (must_repeat) {
        complain(work, run);
        work->status = ERROR_DIFFERENT;
        return true;
    }
    vis_free(&work->verdicts);
    work->verdicts = *verdicts;
    *verdicts = (vis_result){0};
    work->first = run;
    work->sums = row->sums;
    work->settled = row->settled;
    return true;
}

static void note_driver(error_table *table, const error_run *run, const char *driver)
{
    if (strcmp(driver, "none") == 0) return;
    char *place = run->method->traits & ERROR_ONE_SIDED ? table->driver : table->peer;
    snprintf(place, sizeof table->driver, "%s", driver);
}

static bool run_on(worker *work, const error_run *run, error_stage *stage)
{
    bool is_brief = run->method->traits & ERROR_BRIEF;
    error_row row = begin_row(work, run);
    measure_result result;
    if (!measure_run(&run->settings, is_brief ? &stage->part : stage->whole, &result)) return false;
    bool good = fill_row(&row, &result, &stage->truth) &&
                judge_run(work, run, is_brief ? &stage->part_judge : &stage->judge,
                          &result.verdicts, &row) &&
                error_table_add(work->table, &row);
    note_driver(work->table, run, result.driver);
    measure_free(&result);
    return good;
}

static bool run_all(worker *work, const error_run *runs, size_t count, error_stage *usual)
{
    for (size_t i = 0; i < count; i++) {
        const error_run *run = &runs[i];
        error_stage other = {0};
        bool good;
        if (run->skipped) {
            error_row row = begin_row(work, run);
            good = error_table_add(work->table, &row);
        } else if (is_one(run->scale)) {
            good = run_on(work, run, usual);
        } else {
            good = make_stage(work, run->scale, &other) && run_on(work, run, &other);
        }
        free_stage(&other);
        if (!good) return false;
    }
    return true;
}

error_status error_measure_scene(const error_options *options, const error_truths *truths,
                                 const char *name, const obs_scene *scene, error_table *table)
{
    error_run runs[ERROR_MAX_RUNS];
    size_t count = error_plan(options, scene, runs);
    worker work = {.truths = truths,
                   .name = name,
                   .scene = scene,
                   .identity = error_scene_identity(scene),
                   .limits = {.disagreed = options->settle, .agreed = options->hidden},
                   .table = table};
    error_stage usual;
    if (!make_stage(&work, 1, &usual) || !run_all(&work, runs, count, &usual))
        work.status = ERROR_UNUSABLE;
    free_stage(&usual);
    vis_free(&work.verdicts);
    return work.status;
}
