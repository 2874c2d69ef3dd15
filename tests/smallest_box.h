// SPDX-License-Identifier: Apache-2.0
// The smallest box around points, found slowly.
#ifndef OCC_TEST_SMALLEST_BOX_H
#define OCC_TEST_SMALLEST_BOX_H

#include <stdint.h>

enum { SMALLEST_MOST = 64 };

// The volume of the smallest box, turned in any way, around at most SMALLEST_MOST points that are
// in no plane. What is returned is the volume of a box that there is, and a search finds no
// smaller one.
double smallest_box_volume(const float (*points)[3], uint32_t count);

#endif
