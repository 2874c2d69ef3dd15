// SPDX-License-Identifier: Apache-2.0
#ifndef OCC_BOX_H
#define OCC_BOX_H

#include "verdict.h"

#include <occlude/scene.h>

// OCC_SUCCESS, or what is wrong with the numbers of a box.
occ_result occ_box_check(const occ_box *box);

// The axis-aligned bounds of a box, rounded outward: by at most two floats, or where center and
// axes cancel, by 2^-49 of their sum.
void occ_box_bounds(const occ_box *box, float min[3], float max[3]);

// An upper bound on the area that a box shows to any direction.
float occ_occluder_reach(const occ_box *box);

// A box relative to the eye, with its error bound.
occ_relative_box occ_box_relative(const occ_box *box, const occ_eye *eye);

#endif
