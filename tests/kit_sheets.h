// SPDX-License-Identifier: Apache-2.0
// Sheets to test with.
#ifndef OCC_TEST_KIT_SHEETS_H
#define OCC_TEST_KIT_SHEETS_H

#include "kit.h"

// A flat box whose corners are floats, each on a grid of 2^-8: center and two axes within ±reach
// and ±size.
occ_box kit_flat_box(kit_random *random, float reach, float size);

// The sheet that such a box is, its corners counterclockwise for who looks against axis[0] x
// axis[1].
occ_sheet kit_sheet_of_box(const occ_box *box);

// The same corners the other way round.
occ_sheet kit_sheet_reversed(const occ_sheet *sheet);

// Whether two are the same in all that is read of them.
bool kit_same_sheets(const occ_sheet *a, const occ_sheet *b);

// A convex polygon of so many corners around a point, in a plane that goes through three of them,
// but for what the floats round.
occ_sheet kit_round_sheet(kit_random *random, uint32_t corners, const float center[3], float size);

#endif
