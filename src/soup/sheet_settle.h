// SPDX-License-Identifier: Apache-2.0
// From a convex region to a sheet whose corners are floats in the plane, exactly.
#ifndef OCC_SHEET_SETTLE_H
#define OCC_SHEET_SETTLE_H

#include "soup/sheet_grow.h"

// An empty array for the grower's `spots`.
occ_array occ_settle_spots(void);

// Sorts the coordinates of the grower's vertices.
occ_result occ_sort_places(occ_grower *grower);

// A large sheet within a region. Corners are where vertices are, or have coordinates that vertices
// have, where that is but a rounding away; others are moved inward, further with each `rounding`
// from 0 on. `*settled`: there is one. It is not proven.
occ_result occ_settle_region(occ_grower *grower, const occ_region *region, int rounding,
                             occ_sheet *sheet, bool *settled);

#endif
