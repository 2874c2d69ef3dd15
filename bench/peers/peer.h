// SPDX-License-Identifier: Apache-2.0
/// @file
/// Methods that are not the library's, measured beside it on the same scenes: the thesis's test and
/// two ways to use Embree. docs/peers.md describes them. None of them is conservative.
#ifndef OCC_BENCH_PEER_H
#define OCC_BENCH_PEER_H

#include "obs.h"

#include <occlude/cull.h>

/// What a peer may be told.
typedef struct peer_options {
    uint32_t threads;                 ///< For culling. At least 1.
    uint32_t rays_width, rays_height; ///< Of embree-depth's buffer: one ray for each pixel.
} peer_options;

/// The largest width and height of that buffer.
enum { PEER_MOST_RAYS = 4096 };

/// What a peer says of itself once it is open.
typedef struct peer_info {
    uint64_t bytes;   ///< Memory that it holds for the scene.
    char driver[256]; ///< What it stands on, with the version. Empty: nothing.
} peer_info;

/// A method. `open` makes its state for a scene, which must outlive it, or returns NULL after a
/// line on standard error. `cull` fills OCC_MASK_WORDS(object_count) words, and of `stats` the
/// counts that have a meaning for it, `walk_ms` and `test_ms`. `close` frees the state.
typedef struct peer_method {
    const char *name;
    const char *missing; ///< NULL, or what this program was built without and the method needs.
    bool takes_threads;  ///< Runs on the openmp backend too, else on one thread alone.
    bool is_quadratic;   ///< In the objects.
    void *(*open)(const obs_scene *scene, const peer_options *options, peer_info *info);
    void (*cull)(void *state, const obs_frame *frame, uint32_t *mask, occ_view_stats *stats);
    void (*close)(void *state);
} peer_method;

/// The peer of that name, or NULL.
const peer_method *peer_find(const char *name);

/// All of them; the last has a NULL name.
extern const peer_method peer_methods[];

#endif
