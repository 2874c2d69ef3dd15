// SPDX-License-Identifier: Apache-2.0
/// @file
/// What stands in a room of the scene "interior".
#ifndef OCC_BENCH_INTERIOR_FURNITURE_H
#define OCC_BENCH_INTERIOR_FURNITURE_H

#include "interior_plan.h"
#include "obs.h"

/// Furnishes one room and leaves the ways between its doors free.
void interior_furnish(obs_scene *scene, steady_random *random, const interior_plan *plan,
                      double floor, uint32_t band, uint32_t row, uint32_t column);

#endif
