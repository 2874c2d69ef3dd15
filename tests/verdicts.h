// SPDX-License-Identifier: Apache-2.0
// One verdict at a time, straight from the library's insides.
#ifndef OCC_TEST_VERDICTS_H
#define OCC_TEST_VERDICTS_H

#include "frame.h"
#include "lanes.h"

#include <check.h>
#include <string.h>

// A frame that knows a camera and nothing else.
static inline occ_frame verdict_frame(const occ_camera_desc *desc)
{
    occ_frame frame = {.hooks = NULL};
    const char *reason = "";
    occ_result result = occ_camera_init(&frame.camera, desc, &reason);
    ck_assert_msg(result == OCC_SUCCESS, "%s", reason);
    return frame;
}

// A camera whose near plane goes through the eye, so that it cuts nothing away.
static inline occ_frame verdict_frame_at(const double eye[3])
{
    static const float ahead[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, -1, 0, 0, 0, 0};
    occ_camera_desc desc = {.depth = OCC_DEPTH_ZERO_TO_ONE, .eye = eye};
    memcpy(desc.view_projection, ahead, sizeof ahead);
    occ_frame frame = verdict_frame(&desc);
    ck_assert_uint_eq(frame.camera.cutter, OCC_NO_PLANE);
    return frame;
}

// The number of planes of the occluder's shadow, 0 if it has none.
static inline uint32_t verdict_planes(const occ_frame *frame, const occ_box *occluder)
{
    occ_shadow shadow;
    if (!occ_lanes_choose()->shade(&shadow, &frame->camera, occluder, OCC_NOBODY)) return 0;
    return shadow.planes;
}

static inline bool verdict_hides(const occ_frame *frame, const occ_box *occluder,
                                 const occ_box *object)
{
    occ_shadow shadow;
    if (!occ_lanes_choose()->shade(&shadow, &frame->camera, occluder, OCC_NOBODY)) return false;
    occ_relative_box box = occ_frame_relative(frame, object);
    return occ_box_in_shadow(&box, shadow.plane[0], shadow.planes);
}

static inline bool verdict_outside(const occ_frame *frame, const occ_box *object)
{
    occ_relative_box box = occ_frame_relative(frame, object);
    return occ_box_outside(&box, frame->camera.constants.plane[0], frame->camera.planes);
}

#endif
