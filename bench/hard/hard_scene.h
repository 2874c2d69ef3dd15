// SPDX-License-Identifier: Apache-2.0
/// @file
/// A family's world as a scene file.
#ifndef OCC_BENCH_HARD_SCENE_H
#define OCC_BENCH_HARD_SCENE_H

#include "family.h"
#include "obs.h"

/// Writes the world with one frame. A scene file knows neither an origin of its own for the camera
/// nor an eye in double, and only one range of depths: the frame's numbers are those of the world's
/// camera, rounded to float. An occluder without an owner gets one, a point behind the camera,
/// since a file's occluders must have one. On failure says why and returns false.
bool hard_scene_write(const char *path, const family_world *world);

/// The world's camera as a scene file would have it.
obs_frame hard_scene_frame(const family_world *world);

#endif
