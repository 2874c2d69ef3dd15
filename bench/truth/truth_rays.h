// SPDX-License-Identifier: Apache-2.0
/// @file
/// Rays to points of one object, for objects that no sample of the viewport shows: small or thin
/// ones, and those that show a sliver between samples.
#ifndef OCC_BENCH_TRUTH_RAYS_H
#define OCC_BENCH_TRUTH_RAYS_H

#include "truth_tree.h"

/// Sends rays to the object's faces that look towards the eye, as far as they are in the frustum:
/// to their corners, to the middles of their edges, and spread over their areas. Returns how many
/// arrive, at most UINT16_MAX. `*hint` is the solid that stopped the last ray, or TRUTH_NONE:
/// neighbours tend to be hidden by the same.
uint16_t truth_count_rays(const truth_view *view, const truth_tree *occluders, const occ_box *box,
                          uint32_t object, uint32_t *hint);

#endif
