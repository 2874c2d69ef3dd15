// SPDX-License-Identifier: Apache-2.0
// A judge of sheets in GMP's rationals, which shares no code and no idea with the library: lines of
// sight are drawn that a sheet blocks, and each must meet a triangle.
#ifndef OCC_TEST_SHEET_JUDGE_H
#define OCC_TEST_SHEET_JUDGE_H

#include "kit.h"
#include "shapes.h"

#include <gmp.h>

typedef struct judge_point {
    mpq_t at[3];
} judge_point;

// A line of sight from `eye` to `aim`, and room to reckon.
typedef struct sight_judge {
    judge_point eye, aim, corner[OCC_SHEET_CORNERS], triangle[3], edge[3], normal;
    mpq_t sum, part, side[2], height[3];
} sight_judge;

void sight_judge_init(sight_judge *judge);
void sight_judge_clear(sight_judge *judge);

// Draws a line of sight through a sheet, at random. False: the sheet does not block it, by the
// words of sheets.h; another line may do.
bool sight_draw(sight_judge *judge, const occ_sheet *sheet, kit_random *random);

// Whether the line meets a triangle of the soup that hides: none of the see-through ones and, if
// only fronts are drawn, one that turns its front to the eye.
bool sight_is_blocked(sight_judge *judge, const shapes *soup, const bool *see_through,
                      bool one_sided);

#endif
