// SPDX-License-Identifier: Apache-2.0
// Where a point is as seen past a box, in doubles that round.
#ifndef OCC_TEST_SIGHT_H
#define OCC_TEST_SIGHT_H

#include <occlude/cull.h>

// The sine of the angle between the direction x, of length 1, and that of the nearest point of a
// box; 0 if the box is seen there.
double sight_sine(const double eye[3], const occ_box *box, const double x[3]);

// Whether a point relative to the eye is behind the planes of all faces that the eye sees.
bool sight_is_behind(const double eye[3], const occ_box *box, const double point[3]);

#endif
