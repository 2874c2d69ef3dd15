// SPDX-License-Identifier: Apache-2.0
/// @file
/// What the peers on Embree share before any ray: the camera in floats, the bounds of the objects
/// laid out for vector instructions, and the test of them against the frustum.
#ifndef OCC_BENCH_PEER_BOXES_H
#define OCC_BENCH_PEER_BOXES_H

#include "obs.h"

/// A frame in floats. `depth` of a point is how far it is in front of the eye along the view.
typedef struct peer_camera {
    float matrix[16];   ///< proj * view.
    float planes[6][4]; ///< Inside is not negative.
    float eye[3], right[3], up[3], forward[3];
    float scale[2], shift[2]; ///< x / depth of a direction is (ndc x + shift) / scale.
    float near_depth, far_depth;
    bool is_perspective; ///< Else nothing above but the planes holds, and nothing is hidden.
} peer_camera;

peer_camera peer_camera_of(const obs_frame *frame);

/// Objects to a block: as many as bits in a word of a mask.
enum { PEER_BLOCK = 32 };

/// Axis-aligned bounds of PEER_BLOCK objects: centers and half extents.
typedef struct peer_block {
    float center[3][PEER_BLOCK], half[3][PEER_BLOCK];
} peer_block;

/// The objects of a scene. All zero is empty.
typedef struct peer_boxes {
    const obs_scene *scene;
    peer_block *blocks;
    size_t block_count;
} peer_boxes;

/// False after a line on standard error.
bool peer_boxes_open(peer_boxes *boxes, const obs_scene *scene);

void peer_boxes_close(peer_boxes *boxes);

uint64_t peer_boxes_bytes(const peer_boxes *boxes);

/// The bits of a block's objects that meet the frustum: the bounds decide, and where a plane cuts
/// those, the box itself.
uint32_t peer_boxes_in_frustum(const peer_boxes *boxes, const peer_camera *camera, size_t block);

/// Decides the objects of the blocks from `first` on and before `end`, whose words of the mask hold
/// what is in the frustum: clears the bits of the hidden ones.
typedef void peer_test(const void *state, const peer_camera *camera, size_t first, size_t end,
                       uint32_t *mask);

/// The frustum and then `test` for all blocks, on so many threads. Returns how many objects are in
/// the frustum. Without a perspective camera `test` is left out.
uint32_t peer_boxes_test(const peer_boxes *boxes, const peer_camera *camera, int threads,
                         peer_test *test, const void *state, uint32_t *mask);

#endif
