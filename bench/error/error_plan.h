// SPDX-License-Identifier: Apache-2.0
/// @file
/// What `occlude-bench error` runs on a scene: methods, backends and settings.
#ifndef OCC_BENCH_ERROR_PLAN_H
#define OCC_BENCH_ERROR_PLAN_H

#include "measure.h"

/// What may be varied of a method, and how it is run.
typedef enum error_traits {
    ERROR_BACKENDS = 1,   ///< Runs on every backend; their verdicts must be the same.
    ERROR_THREADS = 2,    ///< Runs on one thread and on all; their verdicts must be the same.
    ERROR_KNOBS = 4,      ///< Takes min_area, max_occluders and grain.
    ERROR_RAYS = 8,       ///< Takes a size of its buffer of rays.
    ERROR_SCALES = 16,    ///< Is shown at scales 0.01, 1 and 100.
    ERROR_BRIEF = 32,     ///< Slow: once, on the truth's frames alone.
    ERROR_ONE_SIDED = 64, ///< Promises that nothing visible is reported hidden.
    ERROR_PRESETS = 128 ///< Is shown with all presets, and with a tolerance: then it promises less.
} error_traits;

/// A method that is reported. A new one is a line in error_plan.c.
typedef struct error_method {
    const char *name; ///< As measure_run() takes it.
    unsigned traits;
} error_method;

/// All of them; the last has a NULL name.
extern const error_method error_methods[];

/// The method of that name, or NULL.
const error_method *error_method_find(const char *name);

/// A run. Its settings state all knobs, also where they are the library's defaults.
typedef struct error_run {
    const error_method *method;
    measure_settings settings;
    double scale;        ///< The scene's unit of length, see error_scene_scale().
    const char *skipped; ///< Why it is not run, or NULL: it is.
} error_run;

/// What a plan depends on.
typedef struct error_options {
    uint32_t repeats;
    uint32_t settle; ///< Most disagreements of a result with sampling that the exact judge decides.
    uint32_t hidden; ///< Most objects hidden for both that it looks at.
    bool is_quick;   ///< Fewer knobs.
    bool has_opencl; ///< There is a device.
    bool has_tolerance; ///< Tolerances are shown as well.
} error_options;

/// Most runs of a scene.
enum { ERROR_MAX_RUNS = 128 };

/// Fills `runs` with what is to be run on the scene and returns how many. Runs whose verdicts must
/// be equal stand together: see error_run_equals().
size_t error_plan(const error_options *options, const obs_scene *scene,
                  error_run runs[ERROR_MAX_RUNS]);

/// The same for the hard families: every method at its default setting and scales 1, 0.01 and 100.
size_t error_plan_hard(const error_options *options, error_run runs[ERROR_MAX_RUNS]);

/// Whether the two must give the same verdicts: one method, one setting, one scale.
bool error_run_equals(const error_run *a, const error_run *b);

/// Whether the run is its method's default one, whatever the backend.
bool error_run_is_default(const error_run *run);

/// Whether the run promises that nothing visible is reported hidden.
bool error_run_is_one_sided(const error_run *run);

/// What is set: "default", "min_area 0.002", "preset fast", "256x144 rays", "scale 0.01".
void error_run_setting(const error_run *run, char *text, size_t size);

/// The library's defaults, stated.
extern const occ_cull_desc error_default_knobs;

/// Whether an OpenCL device can be used.
bool error_has_opencl(void);

#endif
