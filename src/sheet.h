// SPDX-License-Identifier: Apache-2.0
#ifndef OCC_SHEET_H
#define OCC_SHEET_H

#include <occlude/scene.h>

// OCC_SUCCESS, or what is wrong with a sheet; `*reason` then says it in words.
occ_result occ_sheet_check(const occ_sheet *sheet, const char **reason);

// The same sheet, all that is not read of it zero.
occ_sheet occ_sheet_plain(const occ_sheet *sheet);

// A box that holds the corners of a valid sheet but for what its numbers round: the smallest
// parallelogram around them, as thick as they are out of its plane. The trees and the walk know a
// sheet by it.
occ_box occ_sheet_proxy(const occ_sheet *sheet);

// Twice the area of a sheet as a vector: it points to where its corners go counterclockwise. Not
// exact.
void occ_sheet_normal(const occ_sheet *sheet, double normal[3]);

#endif
