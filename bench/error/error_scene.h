// SPDX-License-Identifier: Apache-2.0
/// @file
/// The scenes of `occlude-bench error`: by name from a folder or from the generators, scaled, and
/// cut down to some of their frames.
#ifndef OCC_BENCH_ERROR_SCENE_H
#define OCC_BENCH_ERROR_SCENE_H

#include "obs.h"

/// Where a named scene comes from when no folder has it.
typedef struct error_source {
    const char *name; ///< That of its file, without ".obs".
    const char *kind; ///< A generator of scenes.h, or NULL: a model, from a file alone.
    uint64_t seed;
    uint32_t count;
    bool is_quick;      ///< Small enough for --quick.
    bool has_tolerance; ///< Tolerances are turned on it.
} error_source;

/// All of them; the last has a NULL name.
extern const error_source error_sources[];

/// The source of that name, or NULL.
const error_source *error_source_find(const char *name);

/// Whether tolerances are to be turned on the scene: not on most of those that are listed.
bool error_scene_has_tolerance(const char *name);

typedef enum error_load {
    ERROR_LOADED,
    ERROR_ABSENT, ///< No file, and no generator makes it.
    ERROR_FAILED  ///< Said on standard error.
} error_load;

/// Reads FOLDER/NAME.obs if it is there (`folder` may be NULL), else makes the scene.
error_load error_scene_load(const char *folder, const char *name, obs_scene *scene);

/// The same for a source that need not be one of error_sources. `*is_file` tells which it was.
error_load error_scene_load_source(const char *folder, const error_source *source, obs_scene *scene,
                                   bool *is_file);

/// A copy of the scene as if its unit of length were another: every box, the eye, the translation
/// of the view and of the projection times `factor`. With a power of two nothing is rounded. False
/// when memory runs out.
bool error_scene_scale(const obs_scene *scene, double factor, obs_scene *scaled);

/// A scene that borrows the boxes and has only the frames listed, which are copied. Free its
/// `frames`, nothing else. False when memory runs out.
bool error_scene_cut(const obs_scene *scene, const uint32_t *frames, uint32_t count,
                     obs_scene *part);

/// A number that tells scenes apart: FNV-1a, 64 bits, over the bits of all that the scene holds.
uint64_t error_scene_identity(const obs_scene *scene);

#endif
