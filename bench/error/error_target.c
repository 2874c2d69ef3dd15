// SPDX-License-Identifier: Apache-2.0
#include "error_target.h"

#include "error_judge.h"
#include "measure_first.h"

#include <stdlib.h>
#include <string.h>

// A scene of a single frame is culled so many times more often: its median is of no other frames.
enum { SINGLE_FRAME_REPEATS = 20, BUILDS = 3 };

static bool is_wanted(const error_target_options *options, const error_source *source, int variant)
{
    if (options->scene_count == 0) return !options->is_quick || (variant == 0 && source->is_quick);
    for (int i = 0; i < options->scene_count; i++)
        if (strcmp(options->scenes[i], source->name) == 0) return true;
    return false;
}

static bool is_known(const char *scene)
{
    char name[64];
    for (const error_goal *goal = error_goals; goal->source.name; goal++)
        for (int variant = 0; variant < ERROR_VARIANTS; variant++)
            if (strcmp(error_goal_source(goal, variant, name).name, scene) == 0) return true;
    return false;
}

static bool judge(const error_target_options *options, const obs_scene *scene,
                  const vis_result *verdicts, error_target *row)
{
    truth_result truth;
    if (!error_truth(&options->truths, row->scene, scene, &truth)) return false;
    error_judge judge = {.scene = scene, .truth = &truth};
    row->truth_frames = truth.frame_count;
    bool good = error_judge_count(&judge, verdicts, options->limits, &row->sums, &row->settled);
    error_judge_free(&judge);
    truth_free(&truth);
    return good;
}

// Small scenes are built in no time: their first frames are seen more often.
static uint32_t first_frames(const obs_scene *scene)
{
    return scene->object_count > 200000 ? 5 : 15;
}

static bool measure(const error_target_options *options, const obs_scene *scene, error_target *row)
{
    measure_settings settings = measure_defaults();
    settings.method = "fused";
    settings.backend = "openmp";
    settings.threads = 1;
    settings.builds = BUILDS;
    settings.repeats = options->repeats * (scene->frame_count == 1 ? SINGLE_FRAME_REPEATS : 1);
    error_pair pair;
    if (!error_pair_run(&settings, scene, &pair)) return false;
    row->one = pair.one;
    row->two = pair.two;
    row->warm_ms = pair.warm_ms;
    row->build_ms = pair.build_ms;
    row->interruptions = pair.interruptions;
    row->is_same = pair.is_same;
    bool good = measure_first_frame(&settings, scene, first_frames(scene), &row->first_ms) &&
                judge(options, scene, &pair.verdicts, row);
    error_pair_free(&pair);
    return good;
}

static bool run_source(const error_target_options *options, const error_source *source,
                       error_target *row)
{
    obs_scene scene;
    snprintf(row->scene, sizeof row->scene, "%s", source->name);
    row->seed = source->seed;
    if (error_scene_load_source(options->folder, source, &scene, &row->is_file) != ERROR_LOADED)
        return false;
    row->objects = scene.object_count;
    row->frames = scene.frame_count;
    row->peers = error_published_find(row->scene, error_scene_identity(&scene));
    bool good = measure(options, &scene, row);
    obs_free(&scene);
    return good;
}

static bool add_row(error_targets *targets, const error_target *row)
{
    if (targets->count == targets->capacity) {
        size_t wanted = targets->capacity ? 2 * targets->capacity : 32;
        error_target *larger = realloc(targets->rows, wanted * sizeof *larger);
        if (!larger) return false;
        targets->rows = larger;
        targets->capacity = wanted;
    }
    targets->rows[targets->count++] = *row;
    return true;
}

// The scenes that goals were set for come first, then the other seeds.
bool error_targets_run(const error_target_options *options, error_targets *targets)
{
    for (int i = 0; i < options->scene_count; i++)
        if (!is_known(options->scenes[i])) {
            fprintf(stderr, "occlude-bench: %s is no scene of --targets\n", options->scenes[i]);
            return false;
        }
    for (int variant = 0; variant < ERROR_VARIANTS; variant++)
        for (const error_goal *goal = error_goals; goal->source.name; goal++) {
            char name[64];
            error_target row = {.goal = goal, .variant = variant};
            error_source source = error_goal_source(goal, variant, name);
            if (!is_wanted(options, &source, variant)) continue;
            if (!run_source(options, &source, &row) || !add_row(targets, &row)) return false;
            error_target_print(stdout, &row);
            fflush(stdout);
        }
    return true;
}

error_target_faults error_targets_faults(const error_targets *targets)
{
    error_target_faults faults = {0};
    for (size_t i = 0; i < targets->count; i++) {
        faults.false_hidden += targets->rows[i].sums.false_hidden;
        faults.different += !targets->rows[i].is_same;
    }
    return faults;
}

void error_targets_free(error_targets *targets)
{
    free(targets->rows);
    *targets = (error_targets){0};
}
