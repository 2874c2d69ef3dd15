// SPDX-License-Identifier: Apache-2.0
#ifndef OCC_SHADOW_H
#define OCC_SHADOW_H

#include "camera.h"

#include <occlude/scene.h>

// Makes the shadow volume of an occluder. False if it hides nothing for certain: the eye is inside
// it, sees it edge-on, or sees through it where the near plane may cut it open.
bool occ_shadow_init(occ_shadow *shadow, const occ_camera *camera, const occ_box *box,
                     uint32_t owner);

#endif
