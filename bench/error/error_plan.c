// SPDX-License-Identifier: Apache-2.0
#include "error_plan.h"

#include <stdio.h>
#include <string.h>

const error_method error_methods[] = {
    {"frustum", ERROR_ONE_SIDED},
    {"single", ERROR_BACKENDS | ERROR_KNOBS | ERROR_SCALES | ERROR_ONE_SIDED},
    {"fused", ERROR_BACKENDS | ERROR_KNOBS | ERROR_SCALES | ERROR_ONE_SIDED | ERROR_PRESETS},
    {"pairwise", ERROR_BACKENDS | ERROR_BRIEF | ERROR_ONE_SIDED},
    {"embree-depth", ERROR_THREADS | ERROR_RAYS},
    {"embree-rays", ERROR_THREADS | ERROR_BRIEF},
    {"thesis", ERROR_SCALES | ERROR_BRIEF},
    {NULL, 0}};

const occ_cull_desc error_default_knobs = {
    .min_area = 3e-4f, .max_occluders = 1024, .grain = 64, .max_splits = 48};

// One knob is turned at a time, in the order in which a curve is drawn.
static const struct {
    occ_cull_desc knobs;
    bool is_quick;
} error_settings[] = {
    {{.min_area = 2e-5f, .max_occluders = 1024, .grain = 64}, true},
    {{.min_area = 3e-4f, .max_occluders = 1024, .grain = 64}, true},
    {{.min_area = 2e-3f, .max_occluders = 1024, .grain = 64}, true},
    {{.min_area = 2e-2f, .max_occluders = 1024, .grain = 64}, false},
    {{.min_area = 3e-4f, .max_occluders = 64, .grain = 64}, true},
    {{.min_area = 3e-4f, .max_occluders = 256, .grain = 64}, false},
    {{.min_area = 3e-4f, .max_occluders = 4096, .grain = 64}, false},
    {{.min_area = 3e-4f, .max_occluders = 1024, .grain = 8}, false},
    {{.min_area = 3e-4f, .max_occluders = 1024, .grain = 256}, false},
};
enum { SETTINGS = sizeof error_settings / sizeof *error_settings };

// What their knobs are the library says.
static const struct {
    const char *name;
    occ_preset preset;
} error_presets[] = {{"fast", OCC_PRESET_FAST}, {"thorough", OCC_PRESET_THOROUGH}};
enum { PRESETS = sizeof error_presets / sizeof *error_presets };

// In radians, beside 0.
static const float error_tolerances[] = {3e-4f, 1e-3f, 3e-3f};
enum { TOLERANCES = sizeof error_tolerances / sizeof *error_tolerances };

// The first is the default.
static const struct {
    uint32_t width, height;
    bool is_quick;
} error_rays[] = {{85, 48, true}, {256, 144, true}, {640, 360, false}};
enum { RAYS = sizeof error_rays / sizeof *error_rays };

// The first is the one that the others are compared with.
static const struct {
    const char *backend;
    uint32_t threads; // 0: all
    unsigned traits;  // of the methods that run on it: any of these
} error_backends[] = {{"plain", 0, ERROR_BACKENDS | ERROR_THREADS},
                      {"openmp", 1, ERROR_BACKENDS},
                      {"openmp", 0, ERROR_BACKENDS | ERROR_THREADS},
                      {"opencl", 0, ERROR_BACKENDS}};
enum { BACKENDS = sizeof error_backends / sizeof *error_backends };

// Beside 1.
static const double error_scales[] = {0.01, 100};
enum { SCALES = sizeof error_scales / sizeof *error_scales };

// A plan being made.
typedef struct planner {
    const error_options *options;
    const obs_scene *scene;
    error_run *runs;
    size_t count;
    bool has_scales; // the thesis's test can be run: its scales are to be seen beside the others
} planner;

const error_method *error_method_find(const char *name)
{
    for (const error_method *method = error_methods; method->name; method++)
        if (strcmp(method->name, name) == 0) return method;
    return NULL;
}

static error_run begin(const planner *plan, const error_method *method)
{
    error_run run = {.method = method, .settings = measure_defaults(), .scale = 1};
    run.settings.method = method->name;
    run.settings.repeats = method->traits & ERROR_BRIEF ? 1 : plan->options->repeats;
    run.settings.knobs = error_default_knobs;
    run.settings.backend = "plain";
    run.skipped = measure_complete(&run.settings);
    if (!run.skipped && measure_warning(&run.settings, plan->scene))
        run.skipped = "it tries all pairs and the scene is large";
    return run;
}

// Whether the method that scales are shown for can be run on this scene.
static bool can_run_thesis(const planner *plan)
{
    measure_settings settings = measure_defaults();
    settings.method = "thesis";
    return !measure_warning(&settings, plan->scene);
}

static void put(planner *plan, error_run run)
{
    if (plan->count < ERROR_MAX_RUNS) plan->runs[plan->count++] = run;
}

// On the first `most` of the backends.
static void put_some_backends(planner *plan, error_run run, int most)
{
    for (int b = 0; b < most; b++) {
        if (!(run.method->traits & error_backends[b].traits)) continue;
        run.settings.backend = error_backends[b].backend;
        run.settings.threads = error_backends[b].threads;
        bool is_missing = strcmp(run.settings.backend, "opencl") == 0 && !plan->options->has_opencl;
        if (is_missing) run.skipped = "no OpenCL device";
        put(plan, run);
    }
}

static void put_backends(planner *plan, error_run run)
{
    put_some_backends(plan, run, BACKENDS);
}

static void put_knobs(planner *plan, error_run run)
{
    for (int s = 0; s < SETTINGS; s++) {
        if (plan->options->is_quick && !error_settings[s].is_quick) continue;
        run.settings.knobs = error_settings[s].knobs;
        run.settings.knobs.max_splits = error_default_knobs.max_splits;
        put_backends(plan, run);
    }
}

// On plain C and one thread of OpenMP.
static void put_presets(planner *plan, error_run run)
{
    for (int p = 0; p < PRESETS; p++) {
        run.settings.knobs = (occ_cull_desc){.preset = error_presets[p].preset};
        put_some_backends(plan, run, 2);
    }
    run.settings.knobs = error_default_knobs;
    for (int t = 0; t < TOLERANCES && plan->options->has_tolerance; t++) {
        run.settings.knobs.tolerance = error_tolerances[t];
        put_some_backends(plan, run, 2);
    }
}

static void put_rays(planner *plan, error_run run)
{
    for (int r = 0; r < RAYS; r++) {
        if (plan->options->is_quick && !error_rays[r].is_quick) continue;
        run.settings.rays_width = error_rays[r].width;
        run.settings.rays_height = error_rays[r].height;
        if (r == 0)
            put_backends(plan, run);
        else
            put(plan, run); // building its tree takes longer than all the rest
    }
}

static void put_scales(planner *plan, error_run run)
{
    for (size_t i = 0; i < SCALES; i++) {
        run.scale = error_scales[i];
        put(plan, run);
    }
}

static void put_method(planner *plan, const error_method *method)
{
    error_run run = begin(plan, method);
    if (run.skipped || !(method->traits & (ERROR_BACKENDS | ERROR_THREADS)))
        put(plan, run);
    else if (method->traits & ERROR_KNOBS)
        put_knobs(plan, run);
    else if (method->traits & ERROR_RAYS)
        put_rays(plan, run);
    else
        put_backends(plan, run);
    if (!run.skipped && method->traits & ERROR_PRESETS) put_presets(plan, run);
    if (!run.skipped && plan->has_scales && method->traits & ERROR_SCALES) put_scales(plan, run);
}

size_t error_plan(const error_options *options, const obs_scene *scene,
                  error_run runs[ERROR_MAX_RUNS])
{
    planner plan = {.options = options, .scene = scene, .runs = runs};
    plan.has_scales = can_run_thesis(&plan);
    for (const error_method *method = error_methods; method->name; method++)
        put_method(&plan, method);
    return plan.count;
}

size_t error_plan_hard(const error_options *options, error_run runs[ERROR_MAX_RUNS])
{
    const obs_scene small = {0};
    planner plan = {.options = options, .scene = &small, .runs = runs};
    for (const error_method *method = error_methods; method->name; method++) {
        error_run run = begin(&plan, method);
        bool has_backends = !run.skipped && method->traits & ERROR_BACKENDS;
        for (size_t i = 0; i <= SCALES; i++) {
            run.scale = i == 0 ? 1 : error_scales[i - 1];
            if (has_backends)
                put_backends(&plan, run);
            else
                put(&plan, run);
        }
    }
    return plan.count;
}

static bool are_equal_knobs(const occ_cull_desc *a, const occ_cull_desc *b)
{
    return a->preset == b->preset && !(a->min_area < b->min_area) && !(a->min_area > b->min_area) &&
           a->max_occluders == b->max_occluders && a->grain == b->grain &&
           a->max_splits == b->max_splits && !(a->tolerance < b->tolerance) &&
           !(a->tolerance > b->tolerance);
}

static bool are_equal_rays(const measure_settings *a, const measure_settings *b)
{
    return a->rays_width == b->rays_width && a->rays_height == b->rays_height;
}

bool error_run_equals(const error_run *a, const error_run *b)
{
    return a->method == b->method && !(a->scale < b->scale) && !(a->scale > b->scale) &&
           are_equal_knobs(&a->settings.knobs, &b->settings.knobs) &&
           are_equal_rays(&a->settings, &b->settings);
}

bool error_run_is_default(const error_run *run)
{
    error_run usual = *run;
    usual.scale = 1;
    usual.settings.knobs = error_default_knobs;
    usual.settings.rays_width = error_rays[0].width;
    usual.settings.rays_height = error_rays[0].height;
    return error_run_equals(run, &usual);
}

bool error_run_is_one_sided(const error_run *run)
{
    return run->method->traits & ERROR_ONE_SIDED && !(run->settings.knobs.tolerance > 0.0f);
}

// NULL: none but the default one.
static const char *preset_name(occ_preset preset)
{
    for (int p = 0; p < PRESETS; p++)
        if (error_presets[p].preset == preset) return error_presets[p].name;
    return NULL;
}

void error_run_setting(const error_run *run, char *text, size_t size)
{
    const occ_cull_desc *knobs = &run->settings.knobs, *usual = &error_default_knobs;
    if (run->scale < 1 || run->scale > 1)
        snprintf(text, size, "scale %g", run->scale);
    else if (run->method->traits & ERROR_RAYS)
        snprintf(text, size, "%ux%u rays", run->settings.rays_width, run->settings.rays_height);
    else if (preset_name(knobs->preset))
        snprintf(text, size, "preset %s", preset_name(knobs->preset));
    else if (knobs->tolerance > 0.0f)
        snprintf(text, size, "tolerance %g", (double)knobs->tolerance);
    else if (knobs->min_area < usual->min_area || knobs->min_area > usual->min_area)
        snprintf(text, size, "min_area %g", (double)knobs->min_area);
    else if (knobs->max_occluders != usual->max_occluders)
        snprintf(text, size, "max_occluders %u", knobs->max_occluders);
    else if (knobs->grain != usual->grain)
        snprintf(text, size, "grain %u", knobs->grain);
    else
        snprintf(text, size, "default");
}

bool error_has_opencl(void)
{
    const occ_view_desc desc = {.backend = OCC_BACKEND_OPENCL};
    occ_view *view;
    if (occ_view_create(&desc, &view) != OCC_SUCCESS) return false;
    occ_view_destroy(view);
    return true;
}
