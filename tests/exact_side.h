// SPDX-License-Identifier: Apache-2.0
// On which side of a plane a point is, in rational arithmetic.
#ifndef OCC_TEST_EXACT_SIDE_H
#define OCC_TEST_EXACT_SIDE_H

#include <occlude/scene.h>

// The sign of u . (v x w), whose numbers are differences: a[i] - b[i].
int exact_volume(double a[3][3], double b[3][3]);

// On which side of the plane through one of a box's faces a point is: negative is the box's own,
// and 0 the plane. A face without area has none. `end` is 1 or -1. The middle of a face is a sum of
// two floats, which must be a double.
int exact_side(const occ_box *box, int face, int end, const double point[3]);

#endif
