// SPDX-License-Identifier: Apache-2.0
/// @file
/// A scene file in the library, with the handles that its places in the file have there.
#ifndef OCC_BENCH_LOADED_H
#define OCC_BENCH_LOADED_H

#include "obs.h"

#include <occlude/cull.h>

/// All zero is empty; loaded_free() it when done. `file` must outlive it.
typedef struct loaded_scene {
    const obs_scene *file;
    occ_scene *scene;
    occ_object *objects; ///< In the file's order, as the occluders: boxes, then sheets.
    occ_occluder *occluders;
    uint32_t *places; ///< The place in the file of the occluder with a handle's index.
} loaded_scene;

/// Says on standard error what failed and why, unless the result is success. Returns whether it is.
bool loaded_succeeded(occ_result result, const char *what);

/// Adds and commits all of the file. On failure says why, zeroes `out` and returns false.
bool loaded_build(const obs_scene *file, loaded_scene *out);

/// occ_view_explain() in places of the file: `places` has room for every occluder of it. On failure
/// says why and returns false.
bool loaded_explain(const loaded_scene *loaded, const occ_view *view, uint32_t object,
                    occ_fate *fate, uint32_t *places, size_t *count);

void loaded_free(loaded_scene *loaded);

#endif
