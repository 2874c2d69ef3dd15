// SPDX-License-Identifier: Apache-2.0
#ifndef OCC_CAMERA_H
#define OCC_CAMERA_H

#include "verdict.h"

#include <occlude/cull.h>

#define OCC_NEAR_PLANE 4 // left, right, bottom, top, near, far
#define OCC_NO_PLANE   OCC_FRUSTUM_PLANES

// What a frame knows of its camera, relative to the eye. For an orthographic camera the "eye" is a
// point of its axis, and every segment to the eye is a ray along `toward`.
typedef struct occ_camera {
    bool orthographic;
    double eye[3];
    double doubt[3];  // `eye` is off by at most 2^-50 of it: what deriving it may have rounded
    double toward[3]; // orthographic: a direction to the viewer
    double plane[OCC_FRUSTUM_PLANES][4]; // inside where n.x + d >= 0; the largest |n_i| is in
                                         // [1/2, 1)
    uint32_t planes;                     // bit p: plane p exists (an infinite far plane does not)
    uint32_t cutter;          // the plane that cuts away what is between it and the eye, moved
                              // inward; or OCC_NO_PLANE. The near plane, unless near and far are
                              // exchanged
    bool far_cuts_too;        // the eye is so near to both planes that either may be the cutter
    bool has_corners;         // whether all rays of the frustum meet the cutter:
    double near_corner[4][3]; // the part of them in front of it is the hull of these and the eye
    double view_area;         // orthographic: of the view rectangle, in square units; else 0
    double tolerance;         // the knob: for shadow.c
    occ_eye constants;
} occ_camera;

// Derives all of it. On failure `*reason` says why.
occ_result occ_camera_init(occ_camera *camera, const occ_camera_desc *desc, const char **reason);

#endif
