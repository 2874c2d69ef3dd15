// SPDX-License-Identifier: Apache-2.0
/// @file
/// The two methods that stand on Embree 3, and what they share: the occluders as triangles in one
/// static tree.
#ifndef OCC_BENCH_PEER_EMBREE_H
#define OCC_BENCH_PEER_EMBREE_H

#include "peer.h"

#include <embree3/rtcore.h>

#include <stdatomic.h>

/// The triangles of all occluders: 12 for a box, 2 for a flat one, those of its fan for a sheet.
/// All zero is closed.
typedef struct peer_tree {
    RTCDevice device;
    RTCScene scene;
    uint32_t triangle_count;
    uint32_t *owners;  ///< For each triangle, the object that its occluder is part of.
    atomic_llong held; ///< Bytes that Embree has allocated and not freed.
} peer_tree;

/// Builds the tree, at Embree's high quality and with all its threads. `with_filters`: rays may
/// bring a filter of their own. Returns false after a line on standard error. `tree` must not move
/// afterwards.
bool peer_tree_open(peer_tree *tree, const obs_scene *scene, bool with_filters);

/// Frees what a tree holds.
void peer_tree_close(peer_tree *tree);

/// Tells the tree's size and Embree's version.
void peer_tree_tell(const peer_tree *tree, peer_info *info);

/// Flushes denormal numbers in this thread, as Embree wants it, and returns what the processor's
/// control word was, for peer_float_restore(). Nothing else may be computed in between: denormals
/// are numbers to the library.
unsigned peer_float_flush(void);
void peer_float_restore(unsigned control);

void *peer_depth_open(const obs_scene *scene, const peer_options *options, peer_info *info);
void peer_depth_cull(void *state, const obs_frame *frame, uint32_t *mask, occ_view_stats *stats);
void peer_depth_close(void *state);

void *peer_rays_open(const obs_scene *scene, const peer_options *options, peer_info *info);
void peer_rays_cull(void *state, const obs_frame *frame, uint32_t *mask, occ_view_stats *stats);
void peer_rays_close(void *state);

#endif
