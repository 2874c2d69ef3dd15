// SPDX-License-Identifier: Apache-2.0
// Sheets over triangles that are nearly in a plane, but not quite: those of models that were turned
// or bent a little. All their corners are on the outline, so that they are proven by these.
#ifndef OCC_SHEET_PATCH_H
#define OCC_SHEET_PATCH_H

#include "soup/sheet_proof.h"

// Corners of a patch are within this share of the root of its area to either side of a plane.
#define OCC_PATCH_DEPTH 0x1p-11

// Adds patches to `found` (occ_found_sheet) without area and gain, and sets `used` for their
// triangles. Others have false there.
occ_result occ_patches_find(occ_hooks *hooks, const occ_surface *surface,
                            const occ_sheets_desc *desc, bool *used, occ_array *found);

#endif
