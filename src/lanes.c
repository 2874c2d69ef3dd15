// SPDX-License-Identifier: Apache-2.0
// Compiled several times, each time with OCC_LANES_NAME set to the name of an instruction set. The
// vectors are GCC's and clang's vector extension, which either compiler maps to what the target
// has; intrinsics only where a comparison or a permutation gains from them (wide.h).
#include "wide.h"

#include "lanes_select.h"
#include "lanes_walk.h"

#ifndef OCC_LANES_NAME
#define OCC_LANES_NAME plain
#endif
#define OCC_PASTE2(a, b) a##b
#define OCC_PASTE(a, b)  OCC_PASTE2(a, b)
#define OCC_TEXT2(a)     #a
#define OCC_TEXT(a)      OCC_TEXT2(a)
#define OCC_LANES_TABLE  OCC_PASTE(occ_lanes_, OCC_LANES_NAME)

extern const occ_lanes OCC_LANES_TABLE;
const occ_lanes OCC_LANES_TABLE = {OCC_TEXT(OCC_LANES_NAME),
                                   OCC_SHADE(OCC_LANES_NAME),
                                   project,
                                   hide,
                                   gather,
                                   select_occluders,
                                   cut,
                                   test};
