// SPDX-License-Identifier: Apache-2.0
// Worlds to be judged: boxes and cameras of every awkward kind (world.h), small scenes, and what
// every method on every backend makes of them.
#ifndef OCC_TEST_WORLDS_H
#define OCC_TEST_WORLDS_H

#include "kit.h"
#include "world.h"

#include <occlude/occlude.h>

// Instrumented builds are slow: there, a part of the work has to do.
#define WORLD_SHARE(count) ((count) / (OCC_TEST_SLOWNESS))

// A committed scene in which object i has slot i.
occ_scene *world_scene(const occ_box *objects, uint32_t object_count,
                       const world_occluder *occluders, uint32_t occluder_count,
                       uint32_t leaf_objects);

// A view, or NULL if the backend is OpenCL and there is no device, which CI takes for a failure.
occ_view *world_view(occ_backend backend, uint32_t threads);

// What a cull makes of object i.
bool world_sees(const occ_view *view, uint32_t object);

// All occluders, however small.
occ_cull_desc world_knobs(occ_method method);

#endif
