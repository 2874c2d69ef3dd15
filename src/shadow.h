// SPDX-License-Identifier: Apache-2.0
#ifndef OCC_SHADOW_H
#define OCC_SHADOW_H

#include "camera.h"

#include <occlude/scene.h>

// Makes the shadow volume of an occluder. False if it hides nothing for certain: the eye is inside
// it, sees it edge-on, or sees through it where the near plane may cut it open.
typedef bool occ_shade(occ_shadow *shadow, const occ_camera *camera, const occ_box *box,
                       uint32_t owner);

// shadow.c is compiled as lanes.c is, and all give the same bits. (lanes.h: occ_lanes.)
#define OCC_SHADE2(isa) occ_shade_##isa
#define OCC_SHADE(isa)  OCC_SHADE2(isa)
extern occ_shade occ_shade_plain, occ_shade_avx2, occ_shade_avx512;

// The same of a sheet (shadow_sheet.c). False also if the eye is not, for certain, on a side from
// which it hides, or if it has no area.
bool occ_shadow_of_sheet(occ_shadow *shadow, const occ_camera *camera, const occ_sheet *sheet,
                         uint32_t owner);

#endif
