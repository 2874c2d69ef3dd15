// SPDX-License-Identifier: Apache-2.0
// Numbers, boxes and planes that sit on the edge of a verdict: a rounding more or less would turn
// it.
#ifndef OCC_TEST_KIT_EDGE_H
#define OCC_TEST_KIT_EDGE_H

#include "kit.h"
#include "verdict.h"

// Zero, tiny, denormal and ordinary numbers of magnitude up to `most`.
float edge_number(kit_random *random, float most);

// From 1e-38 to 1e15.
float edge_size(kit_random *random);

occ_relative_box edge_box(kit_random *random, float size, float slack_floor);

// A plane that has the box just inside or just not, just outside or just not, clearly inside, or
// anywhere.
void edge_plane(kit_random *random, const occ_relative_box *box, float size, float plane[4]);

// An eye without planes.
occ_eye edge_eye(kit_random *random, float size);

// A shadow of such planes, whose owner is nobody or a row below `rows`.
void edge_shadow(kit_random *random, const occ_relative_box *box, float size, uint32_t rows,
                 occ_shadow *shadow);

#endif
