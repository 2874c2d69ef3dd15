// SPDX-License-Identifier: Apache-2.0
/// @file
/// A small depth buffer and its mip chain of farthest depths, and the question whether something
/// behind a rectangle of it is covered.
#ifndef OCC_BENCH_PEER_PYRAMID_H
#define OCC_BENCH_PEER_PYRAMID_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { PEER_MOST_LEVELS = 16 };

/// One level: `depth[y * width + x]`.
typedef struct peer_level {
    int width, height;
    float *depth;
} peer_level;

/// All zero is closed.
typedef struct peer_pyramid {
    int level_count;
    peer_level levels[PEER_MOST_LEVELS]; ///< levels[0] is the buffer itself.
    float *memory;
    size_t size; ///< Floats at `memory`.
} peer_pyramid;

/// Sides from 1 to PEER_MOST_RAYS. False when memory runs out.
bool peer_pyramid_open(peer_pyramid *pyramid, uint32_t width, uint32_t height);

void peer_pyramid_close(peer_pyramid *pyramid);

/// Makes every level from the one before it: the farthest of the pixels that a pixel covers.
void peer_pyramid_update(peer_pyramid *pyramid);

/// Whether all of the buffer around a rectangle is nearer than `depth`, or as near. The rectangle
/// (least x, least y, most x, most y) runs over [0, 1] and is widened by a pixel on each side.
bool peer_pyramid_covers(const peer_pyramid *pyramid, const float rectangle[4], float depth);

#endif
