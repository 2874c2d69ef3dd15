// SPDX-License-Identifier: Apache-2.0
// Blocks of boxes, wherever they lie, and what is made of each.
#ifndef OCC_BOUNDS_H
#define OCC_BOUNDS_H

#include "blocks.h"
#include "boxes.h"

// The bounds of `count` boxes of a table, OCC_BLOCK at most. `rows` lists them; NULL means `first`
// and those after it.
void occ_bounds_of_rows(const occ_boxes *boxes, const uint32_t *rows, uint32_t first,
                        uint32_t count, occ_block *block);

// The same of boxes that lie in an array.
void occ_bounds_of_array(const occ_box *boxes, const uint32_t *rows, uint32_t first, uint32_t count,
                         occ_block *block);

// The reaches (occ_occluder_reach()) of the boxes of an array.
void occ_reaches_of_array(const occ_box *boxes, uint32_t count, float *reaches);

#endif
