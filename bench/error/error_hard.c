// SPDX-License-Identifier: Apache-2.0
#include "error_hard.h"

#ifdef OCC_BENCH_JUDGE

#include "hard_scene.h"
#include "peer.h"
#include "progress.h"
#include "trial.h"

#include <stdlib.h>
#include <string.h>

enum { WORLDS = 150, QUICK_WORLDS = 20 };

// A family at a scale, put before every run of the plan.
typedef struct hard_trial {
    const error_run *runs;
    size_t count;
    trial_bench *benches[ERROR_MAX_RUNS]; // of the library's methods
    error_row rows[ERROR_MAX_RUNS];
    const char *family;
    error_status status;
} hard_trial;

// What a world is for a method that reads scene files.
typedef struct hard_scene {
    obs_scene scene;
    bool is_usable;
} hard_scene;

static void count(error_row *row, const family_world *world, const trial_fate *fates,
                  uint64_t shown)
{
    compare_sums *sums = &row->sums;
    row->frames++;
    row->truth_frames++;
    row->objects += world->object_count;
    for (uint32_t i = 0; i < world->object_count; i++) {
        if (fates[i] == TRIAL_OUTSIDE) continue;
        bool is_shown = shown >> i & 1, is_seen = fates[i] == TRIAL_SEEN;
        sums->in_frustum++;
        sums->visible += is_seen;
        sums->false_hidden += is_seen && !is_shown;
        sums->missed += !is_seen && is_shown;
    }
}

// --- the library's methods -----------------------------------------------------------------------

static bool open_benches(hard_trial *trial)
{
    for (size_t r = 0; r < trial->count; r++) {
        const error_run *run = &trial->runs[r];
        if (run->skipped || !(run->method->traits & ERROR_ONE_SIDED)) continue;
        occ_backend backend = OCC_BACKEND_PLAIN;
        if (strcmp(run->settings.backend, "openmp") == 0) backend = OCC_BACKEND_OPENMP;
        if (strcmp(run->settings.backend, "opencl") == 0) backend = OCC_BACKEND_OPENCL;
        trial->benches[r] = trial_open(backend, run->settings.threads);
        if (!trial->benches[r]) return false;
    }
    return true;
}

static void close_benches(hard_trial *trial)
{
    for (size_t r = 0; r < trial->count; r++)
        trial_close(trial->benches[r]);
}

// --- the others ----------------------------------------------------------------------------------

// They take perspective cameras. And they know no occluder that is nobody's: it becomes part of an
// object of its own.
static hard_scene describe(const family_world *world)
{
    hard_scene result = {.is_usable = world->proj[11] < 0};
    obs_scene *scene = &result.scene;
    for (uint32_t i = 0; i < world->object_count; i++)
        obs_add_object(scene, &world->objects[i]);
    for (uint32_t i = 0; i < world->occluder_count; i++) {
        const world_occluder *occluder = &world->occluders[i];
        uint32_t owner = occluder->owner >= 0 ? (uint32_t)occluder->owner
                                              : obs_add_object(scene, &occluder->box);
        obs_add_occluder(scene, &occluder->box, owner);
    }
    for (uint32_t i = 0; i < world->sheet_count; i++) {
        const world_sheet *from = &world->sheets[i];
        uint32_t owner = (uint32_t)from->owner;
        occ_box bounds;
        if (from->owner < 0 && occ_box_from_points(from->sheet.corner[0], from->sheet.corner_count,
                                                   0, &bounds) != OCC_SUCCESS)
            result.is_usable = false;
        else if (from->owner < 0)
            owner = obs_add_object(scene, &bounds);
        if (result.is_usable) obs_add_sheet(scene, &from->sheet, owner);
    }
    obs_frame frame = hard_scene_frame(world);
    obs_add_frame(scene, &frame);
    return result;
}

static bool ask_peer(const error_run *run, const hard_scene *scene, uint64_t *shown)
{
    const peer_method *peer = peer_find(run->method->name);
    const peer_options options = {.threads = 1,
                                  .rays_width = run->settings.rays_width,
                                  .rays_height = run->settings.rays_height};
    uint32_t mask[OCC_MASK_WORDS(FAMILY_OBJECTS + FAMILY_OCCLUDERS + FAMILY_SHEETS)] = {0};
    peer_info info;
    occ_view_stats stats = {0};
    void *state = peer->open(&scene->scene, &options, &info);
    if (!state) return false;
    peer->cull(state, &scene->scene.frames[0], mask, &stats);
    peer->close(state);
    *shown = (uint64_t)mask[1] << 32 | mask[0];
    return true;
}

// --- worlds --------------------------------------------------------------------------------------

static bool ask(const hard_trial *trial, size_t r, const family_world *world,
                const trial_fate *fates, const hard_scene *scene, uint64_t *shown)
{
    const error_run *run = &trial->runs[r];
    occ_method method;
    if (!measure_method(run->method->name, &method)) return ask_peer(run, scene, shown);
    occ_cull_desc knobs = trial_knobs(method);
    trial_tally unused = {0};
    if (!trial_run(trial->benches[r], world, fates, &knobs, &unused)) return false;
    *shown = trial_mask(trial->benches[r]);
    return true;
}

// The library's backends and threads must agree bit by bit.
static void compare(hard_trial *trial, size_t r, const uint64_t *shown, uint64_t seed)
{
    size_t first = r;
    while (first > 0 && error_run_equals(&trial->runs[first - 1], &trial->runs[r]))
        first--;
    if (shown[first] == shown[r]) return;
    fprintf(stderr, "occlude-bench: hard/%s, scale %g, seed %llu: %s on %s differs from %s\n",
            trial->family, trial->runs[r].scale, (unsigned long long)seed,
            trial->runs[r].method->name, trial->runs[r].settings.backend,
            trial->runs[first].settings.backend);
    trial->status = ERROR_DIFFERENT;
}

// A world that cannot be judged, or that the library refuses, is left out: bench/hard asks about
// those.
static bool try_world(hard_trial *trial, const family_world *world, double scale, uint64_t seed)
{
    trial_fate fates[FAMILY_OBJECTS];
    uint64_t shown[ERROR_MAX_RUNS] = {0};
    if (!trial_judge(world, fates, NULL)) return true;
    hard_scene scene = describe(world);
    bool good = !scene.scene.out_of_memory;
    for (size_t r = 0; r < trial->count && good; r++) {
        const error_run *run = &trial->runs[r];
        bool is_peer = !(run->method->traits & ERROR_ONE_SIDED);
        if (run->skipped || run->scale < scale || run->scale > scale) continue;
        if (is_peer && !scene.is_usable) continue;
        good = ask(trial, r, world, fates, &scene, &shown[r]);
        if (!good) break;
        count(&trial->rows[r], world, fates, shown[r]);
        compare(trial, r, shown, seed);
    }
    obs_free(&scene.scene);
    return good;
}

static bool try_family(hard_trial *trial, const family *kind, uint32_t worlds, error_table *table)
{
    static const double scales[] = {1, 0.01, 100};
    trial->family = kind->name;
    for (size_t r = 0; r < trial->count; r++) {
        trial->rows[r] =
            (error_row){.run = trial->runs[r], .threads = trial->runs[r].settings.threads};
        snprintf(trial->rows[r].scene, sizeof trial->rows[r].scene, "hard/%s", kind->name);
    }
    for (int s = 0; s < 3; s++)
        for (uint32_t seed = 1; seed <= worlds; seed++) {
            const family_place place = {.scale = scales[s], .seed = seed};
            family_world world;
            kind->make(&world, &place);
            if (try_world(trial, &world, scales[s], seed)) continue;
            fprintf(stderr, "occlude-bench: hard/%s, scale %g, seed %u: refused\n", kind->name,
                    scales[s], seed);
            return false;
        }
    for (size_t r = 0; r < trial->count; r++)
        if (!error_table_add(table, &trial->rows[r])) return false;
    return true;
}

static error_status try_families(hard_trial *trial, const error_options *options,
                                 error_table *table)
{
    uint32_t done = 0, worlds = options->is_quick ? QUICK_WORLDS : WORLDS;
    progress_begin("hard families", family_count());
    for (const family *kind = families; kind->name && trial->status != ERROR_UNUSABLE; kind++) {
        if (!try_family(trial, kind, worlds, table)) trial->status = ERROR_UNUSABLE;
        progress_step(++done);
    }
    progress_end();
    return trial->status;
}

error_status error_hard(const error_options *options, error_table *table)
{
    static error_run runs[ERROR_MAX_RUNS];
    hard_trial *trial = calloc(1, sizeof *trial);
    if (!trial) return ERROR_UNUSABLE;
    trial->runs = runs;
    trial->count = error_plan_hard(options, runs);
    error_status status = ERROR_UNUSABLE;
    if (open_benches(trial)) status = try_families(trial, options, table);
    close_benches(trial);
    free(trial);
    return status;
}

#else

error_status error_hard(const error_options *options, error_table *table)
{
    (void)options, (void)table;
    puts("hard families: skipped: built without GMP, which the judge needs");
    return ERROR_GOOD;
}

#endif
