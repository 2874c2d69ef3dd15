// SPDX-License-Identifier: Apache-2.0
#include "trial.h"

#include "judge.h"

#include <occlude/occlude.h>
#include <stdlib.h>

struct trial_bench {
    occ_view *view;
    occ_result error;
    uint64_t mask;
};

// --- the truth -----------------------------------------------------------------------------------

bool trial_judge(const family_world *world, trial_fate fates[FAMILY_OBJECTS], trial_effort *effort)
{
    occ_box boxes[FAMILY_OCCLUDERS];
    int owners[FAMILY_OCCLUDERS];
    judge *j = judge_of_camera(&world->camera);
    if (!j) return false;
    for (uint32_t i = 0; i < world->occluder_count; i++) {
        boxes[i] = world->occluders[i].box;
        owners[i] = world->occluders[i].owner;
    }
    judge_set_occluders(j, boxes, owners, world->occluder_count);
    for (uint32_t i = 0; i < world->sheet_count; i++)
        judge_add_sheets(j, &world->sheets[i].sheet, &world->sheets[i].owner, 1);
    for (uint32_t i = 0; i < world->object_count; i++) {
        fates[i] = TRIAL_OUTSIDE;
        if (judge_frustum(j, &world->objects[i]) == JUDGE_OUTSIDE) continue;
        fates[i] = judge_sees(j, &world->objects[i], (int)i) ? TRIAL_SEEN : TRIAL_HIDDEN;
    }
    if (effort) {
        judge_effort spent = judge_spent(j);
        effort->signs += spent.signs;
        effort->exact += spent.exact;
    }
    judge_free(j);
    return true;
}

// --- the library's answer ------------------------------------------------------------------------

trial_bench *trial_open(occ_backend backend, uint32_t threads)
{
    occ_view_desc desc = {.backend = backend, .threads = threads};
    trial_bench *bench = calloc(1, sizeof *bench);
    if (bench && occ_view_create(&desc, &bench->view) == OCC_SUCCESS) return bench;
    free(bench);
    return NULL;
}

void trial_close(trial_bench *bench)
{
    if (!bench) return;
    occ_view_destroy(bench->view);
    free(bench);
}

const occ_view *trial_view(const trial_bench *bench)
{
    return bench->view;
}

static occ_result fill_scene(occ_scene *scene, const family_world *world)
{
    occ_object handles[FAMILY_OBJECTS], owners[FAMILY_OCCLUDERS];
    occ_box boxes[FAMILY_OCCLUDERS];
    occ_result result = occ_scene_add_many(scene, world->objects, world->object_count, handles);
    if (result != OCC_SUCCESS) return result;
    for (uint32_t i = 0; i < world->occluder_count; i++) {
        int owner = world->occluders[i].owner;
        boxes[i] = world->occluders[i].box;
        owners[i] = owner < 0 ? (occ_object){0, 0} : handles[owner];
    }
    result = occ_scene_add_occluders(scene, boxes, owners, world->occluder_count, NULL);
    for (uint32_t i = 0; i < world->sheet_count && result == OCC_SUCCESS; i++) {
        int owner = world->sheets[i].owner;
        const occ_object of = owner < 0 ? (occ_object){0, 0} : handles[owner];
        result = occ_scene_add_sheet(scene, &world->sheets[i].sheet, of, NULL);
    }
    return result == OCC_SUCCESS ? occ_scene_commit(scene) : result;
}

static occ_result cull(trial_bench *bench, const family_world *world, const occ_cull_desc *desc)
{
    const occ_scene_desc small = {.leaf_objects = 4};
    occ_scene *scene;
    uint32_t words[OCC_MASK_WORDS(FAMILY_OBJECTS)] = {0};
    size_t count;
    occ_result result = occ_scene_create(&small, &scene);
    if (result == OCC_SUCCESS) result = fill_scene(scene, world);
    if (result == OCC_SUCCESS) result = occ_cull(bench->view, scene, &world->camera, desc);
    if (result == OCC_SUCCESS)
        result = occ_view_read_mask(bench->view, words, sizeof words / sizeof *words, &count);
    bench->mask = (uint64_t)words[1] << 32 | words[0];
    occ_scene_destroy(scene);
    return result;
}

static void count(trial_tally *tally, trial_fate fate, bool visible)
{
    tally->verdicts++;
    tally->outside += fate == TRIAL_OUTSIDE;
    tally->hidden += fate == TRIAL_HIDDEN;
    tally->seen += fate == TRIAL_SEEN;
    tally->false_hidden += fate == TRIAL_SEEN && !visible;
    tally->missed += fate == TRIAL_HIDDEN && visible;
    tally->generous += fate == TRIAL_OUTSIDE && visible;
}

bool trial_run(trial_bench *bench, const family_world *world, const trial_fate *fates,
               const occ_cull_desc *desc, trial_tally *tally)
{
    bench->error = cull(bench, world, desc);
    if (bench->error != OCC_SUCCESS) return false;
    tally->worlds++;
    for (uint32_t i = 0; i < world->object_count; i++)
        count(tally, fates[i], bench->mask >> i & 1);
    return true;
}

uint64_t trial_mask(const trial_bench *bench)
{
    return bench->mask;
}

occ_result trial_error(const trial_bench *bench)
{
    return bench->error;
}

void trial_add(trial_tally *sum, const trial_tally *more)
{
    sum->worlds += more->worlds;
    sum->verdicts += more->verdicts;
    sum->outside += more->outside;
    sum->hidden += more->hidden;
    sum->seen += more->seen;
    sum->false_hidden += more->false_hidden;
    sum->missed += more->missed;
    sum->generous += more->generous;
}

occ_cull_desc trial_knobs(occ_method method)
{
    return (occ_cull_desc){
        .method = method, .min_area = 1e-30f, .max_occluders = 1u << 30, .grain = 8};
}
