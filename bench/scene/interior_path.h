// SPDX-License-Identifier: Apache-2.0
/// @file
/// The walk through the scene "interior".
#ifndef OCC_BENCH_INTERIOR_PATH_H
#define OCC_BENCH_INTERIOR_PATH_H

#include "interior_plan.h"
#include "obs.h"

/// Adds the frames of a walk through rooms, doorways and corridors near the middle of a storey, and
/// opens the doors in its way.
void interior_walk(obs_scene *scene, steady_random *random, interior_plan *plan, double floor);

#endif
