// SPDX-License-Identifier: Apache-2.0
/// @file
/// The named scenes: made from a count and a seed, the same on every machine. docs/scenes.md
/// describes each.
#ifndef OCC_BENCH_SCENES_H
#define OCC_BENCH_SCENES_H

#include "obs.h"

/// A named scene.
typedef struct scenes_kind {
    const char *name;  ///< As on the command line.
    const char *brief; ///< One line.
    void (*make)(obs_scene *scene, uint32_t count, uint64_t seed);
} scenes_kind;

/// The largest count that scenes_make() takes.
enum { SCENES_MAX_COUNT = 20000000 };

/// All kinds; the last has a NULL name.
extern const scenes_kind scenes_kinds[];

/// The kind of that name, or NULL.
const scenes_kind *scenes_find(const char *name);

/// Makes a scene of about `count` objects (1 to SCENES_MAX_COUNT). False when no kind has that
/// name, or when memory runs out; `scene` is empty then.
bool scenes_make(const char *name, uint32_t count, uint64_t seed, obs_scene *scene);

void scenes_seedscene(obs_scene *scene, uint32_t count, uint64_t seed);
void scenes_city(obs_scene *scene, uint32_t count, uint64_t seed);
void scenes_forest(obs_scene *scene, uint32_t count, uint64_t seed);
void scenes_soup(obs_scene *scene, uint32_t count, uint64_t seed);
void scenes_interior(obs_scene *scene, uint32_t count, uint64_t seed);

/// An axis-aligned box.
occ_box scenes_box(double x, double y, double z, double half_x, double half_y, double half_z);

/// The box turned about the vertical through its own center.
occ_box scenes_turned(const occ_box *box, double angle);

/// The box with its axes scaled, about its own center.
occ_box scenes_shrunk(const occ_box *box, double x, double y, double z);

#endif
