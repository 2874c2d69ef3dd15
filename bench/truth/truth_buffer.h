// SPDX-License-Identifier: Apache-2.0
/// @file
/// Counts, for every object, the samples of the viewport at which it is visible.
///
/// A sample knows its nearest occluder and the nearest one of any other owner, since an object is
/// never hidden by its own. The viewport is done in tiles, so that their number of samples, not
/// the viewport's, is what must fit into a cache.
#ifndef OCC_BENCH_TRUTH_BUFFER_H
#define OCC_BENCH_TRUTH_BUFFER_H

#include "truth_shape.h"

/// An object may be farther than what hides it by this share and still count as visible: it lies in
/// the occluder's very surface then.
#define TRUTH_SURFACE 0x1p-40

/// Solids by their depth, nearest first.
typedef struct truth_set {
    truth_solid *solids;
    uint32_t count, capacity;
} truth_set;

/// Adds to samples[owner], for every solid in `objects`. False when memory runs out.
bool truth_count_samples(const truth_view *view, const truth_set *occluders,
                         const truth_set *objects, uint32_t *samples);

#endif
