// SPDX-License-Identifier: Apache-2.0
#ifndef OCC_SHADOW_H
#define OCC_SHADOW_H

#include "camera.h"

#include <occlude/scene.h>

// Makes the shadow volume of an occluder. False if it hides nothing for certain: the eye is inside
// it, sees it edge-on, or sees through it where the near plane may cut it open.
bool occ_shadow_init(occ_shadow *shadow, const occ_camera *camera, const occ_box *box,
                     uint32_t owner);

// The same of a sheet (shadow_sheet.c). False also if the eye is not, for certain, on a side from
// which it hides, or if it has no area.
bool occ_shadow_of_sheet(occ_shadow *shadow, const occ_camera *camera, const occ_sheet *sheet,
                         uint32_t owner);

// What both are made with.

// Bounds the error of every component of ray x axis, where |ray_j| <= from[j].
double occ_cross_error(const double from[3], const double axis[3]);

// Stores n.x + d > 0, where the components of n are off by at most `normal_error` and d by at most
// `d_error`. False if n is too short for its error: then its direction means nothing.
bool occ_shadow_add_plane(occ_shadow *shadow, const double n[3], double normal_error, double d,
                          double d_error);

#endif
