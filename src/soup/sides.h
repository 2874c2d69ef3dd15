// SPDX-License-Identifier: Apache-2.0
// Which side of a plane, and whether on a segment: answers free of rounding. Coordinates may be up
// to 8 * OCC_MAX_COORDINATE.
#ifndef OCC_SOUP_SIDES_H
#define OCC_SOUP_SIDES_H

#include <stdbool.h>

// The sign of (b - a) x (c - a) . (d - a).
int occ_side_of_plane(const float a[3], const float b[3], const float c[3], const float d[3]);

// The sign of (b - a) x (c - a) in the plane: 1 if a, b, c go counterclockwise.
int occ_turn(const float a[2], const float b[2], const float c[2]);

// Whether m is in the line through a and b, strictly between them.
bool occ_between(const float a[3], const float b[3], const float m[3]);

#endif
