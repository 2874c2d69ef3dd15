// SPDX-License-Identifier: Apache-2.0
/// @file
/// Builds the scene of a file, as often as one likes, and times it.
#ifndef OCC_BENCH_MEASURE_BUILD_H
#define OCC_BENCH_MEASURE_BUILD_H

#include "obs.h"

/// What came out.
typedef struct measure_build {
    occ_scene *scene;           ///< The last one built, or what there is of it. The caller's.
    double build_ms, commit_ms; ///< Medians: all of it, and the commit alone.
    const char *step;           ///< What failed.
} measure_build;

/// Makes, fills and commits a scene `builds` times, each time from nothing. `desc` may leave out
/// how much to reserve.
occ_result measure_building(const obs_scene *file, const occ_scene_desc *desc, uint32_t builds,
                            measure_build *build);

#endif
