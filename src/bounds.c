// SPDX-License-Identifier: Apache-2.0
#include "bounds.h"

// Boxes that do not lie in columns, copied into some.
typedef float picked_columns[OCC_BOX_COLUMNS][OCC_BLOCK];

void occ_bounds_of_rows(const occ_boxes *boxes, const uint32_t *rows, uint32_t first,
                        uint32_t count, occ_block *block)
{
    picked_columns picked;
    occ_block_columns from;
    for (uint32_t c = 0; c < OCC_BOX_COLUMNS; c++) {
        const float *column = occ_boxes_column(boxes, c);
        from[c] = rows ? picked[c] : column + first;
        for (uint32_t i = 0; rows && i < count; i++)
            picked[c][i] = column[rows[i]];
    }
    occ_blocks_choose()->bounds(from, count, block);
}

static void pick(const occ_box *boxes, const uint32_t *rows, uint32_t first, uint32_t count,
                 picked_columns picked, occ_block_columns from)
{
    for (uint32_t i = 0; i < count; i++) {
        const occ_box *box = &boxes[rows ? rows[i] : first + i];
        for (uint32_t j = 0; j < 3; j++) {
            picked[j][i] = box->center[j];
            for (uint32_t k = 0; k < 3; k++)
                picked[3 + 3 * k + j][i] = box->axis[k][j];
        }
    }
    for (uint32_t c = 0; c < OCC_BOX_COLUMNS; c++)
        from[c] = picked[c];
}

void occ_bounds_of_array(const occ_box *boxes, const uint32_t *rows, uint32_t first, uint32_t count,
                         occ_block *block)
{
    picked_columns picked;
    occ_block_columns from;
    pick(boxes, rows, first, count, picked, from);
    occ_blocks_choose()->bounds(from, count, block);
}

void occ_reaches_of_array(const occ_box *boxes, uint32_t count, float *reaches)
{
    picked_columns picked;
    occ_block_columns from;
    for (uint32_t i = 0; i < count; i += OCC_BLOCK) {
        uint32_t here = count - i < OCC_BLOCK ? count - i : OCC_BLOCK;
        pick(boxes, NULL, i, here, picked, from);
        occ_blocks_choose()->reaches(from, here, reaches + i);
    }
}
