// SPDX-License-Identifier: Apache-2.0
/// @file
/// Sixteen boxes at a time: where they are on the screen, and how far away at least.
#ifndef OCC_BENCH_PEER_BATCH_H
#define OCC_BENCH_PEER_BATCH_H

#include "peer_boxes.h"

enum { PEER_BATCH = 16 };

/// Boxes that wait, and what was found of them.
typedef struct peer_batch {
    uint32_t count;
    uint32_t objects[PEER_BATCH];
    float center[3][PEER_BATCH], axis[3][3][PEER_BATCH]; ///< axis[a][k] as in occ_box.
    float rectangle[4][PEER_BATCH]; ///< Least x and y, most x and y, over [0, 1] of the screen.
    float depth[PEER_BATCH];        ///< No point is nearer to the eye.
} peer_batch;

/// Adds a box to a batch that is not full.
void peer_batch_add(peer_batch *batch, uint32_t object, const occ_box *box);

/// Finds rectangles and depths. Returns bits of the boxes that may be hidden: those whose point
/// next to the eye is beyond the near plane.
uint32_t peer_batch_project(peer_batch *batch, const peer_camera *camera);

#endif
