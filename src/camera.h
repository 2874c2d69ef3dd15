// SPDX-License-Identifier: Apache-2.0
#ifndef OCC_CAMERA_H
#define OCC_CAMERA_H

#include "verdict.h"

#include <occlude/cull.h>

#define OCC_NEAR_PLANE 4 // left, right, bottom, top, near, far

// What a frame knows of its camera, relative to the eye. For an orthographic camera the "eye" is a
// point of its axis, and every segment to the eye is a ray along `toward`.
typedef struct occ_camera {
    bool orthographic;
    double eye[3];
    double toward[3]; // orthographic: a direction to the viewer
    double plane[OCC_FRUSTUM_PLANES]
                [4];          // inside where n.x + d >= 0; the largest |n_i| is in [1/2, 1)
    uint32_t planes;          // bit p: plane p exists (an infinite far plane does not)
    bool clips_near;          // something between the eye and the near plane is cut away:
    double near_corner[4][3]; // the part of the frustum's rays in front of these
    double view_area;         // orthographic: of the view rectangle, in square units; else 0
    occ_eye constants;
} occ_camera;

// Derives all of it. On failure `*reason` says why.
occ_result occ_camera_init(occ_camera *camera, const occ_camera_desc *desc, const char **reason);

#endif
