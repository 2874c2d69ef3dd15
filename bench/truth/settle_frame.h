// SPDX-License-Identifier: Apache-2.0
/// @file
/// Which occluders can matter to an object in a frame, so that the exact judge need not be given
/// all of them. Works in double with bounds on what roundings lose, and leaves out only what surely
/// plays no part.
#ifndef OCC_BENCH_SETTLE_FRAME_H
#define OCC_BENCH_SETTLE_FRAME_H

#include "truth_shape.h"

/// Where a box or a sheet is for the camera: no point of it that is in the frustum is outside of
/// these intervals. x and y run over the viewport's [-1, 1]; the third is the depth of
/// truth_view.h.
typedef struct settle_extent {
    double low[3], high[3];
    uint32_t occluder; ///< Whose extent it is: its number in the scene, as in obs.h.
    uint32_t place;    ///< Where its middle is in the viewport, near places having near numbers.
} settle_extent;

/// An occluder, and how much of an object it may cover, 0 to 1.
typedef struct settle_candidate {
    double cover;
    uint32_t occluder;
} settle_candidate;

/// A frame's camera, and the occluders that reach into its frustum. All zero is none;
/// settle_frame_free() it when done.
typedef struct settle_frame {
    const obs_scene *scene;
    truth_view view;
    double least_depth;     ///< Surely less than that of any point in the frustum; 0: unknown.
    settle_extent *extents; ///< By place.
    settle_extent *runs;    ///< For each SETTLE_RUN extents what holds them all.
    uint32_t count;
} settle_frame;

enum { SETTLE_RUN = 32 };

/// NULL, or why there is none. The scene must outlive the frame.
const char *settle_frame_make(settle_frame *frame, const obs_scene *scene, uint32_t index);

void settle_frame_free(settle_frame *frame);

/// How many candidates settle_frame_select() puts in order.
enum { SETTLE_BEST = 24 };

/// Lists the other objects' occluders that can hide some of what the frustum holds of an object,
/// first the SETTLE_BEST that may cover most of it, and returns how many. `list` has room for
/// `frame->count`.
/// None of the others meets, beyond the near plane, a segment from the eye to a point of the object
/// in the frustum: what is seen of it does not depend on them.
uint32_t settle_frame_select(const settle_frame *frame, uint32_t object, settle_candidate *list);

/// Whether an occluder hides by every reading what is behind it: it is not seen edge-on, the near
/// plane does not cut it open within the frustum, and nothing of the object is in a surface of it
/// that looks towards the eye.
bool settle_frame_is_plain(const settle_frame *frame, uint32_t occluder, const occ_box *object);

#endif
