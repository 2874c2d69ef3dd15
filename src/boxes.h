// SPDX-License-Identifier: Apache-2.0
// A table of boxes, one column per number, so that sixteen neighbours load as vectors and a range
// goes to a device as twelve copies.
//
//     data: | center x ... | center y ... | center z ... | axis[0] x ... | ... | axis[2] z ... |
//            <- stride ->
#ifndef OCC_BOXES_H
#define OCC_BOXES_H

#include "blocks.h"
#include "memory.h"
#include "team.h"

#include <occlude/scene.h>

#define OCC_BOX_LANES   16u
#define OCC_BOX_PADDING (OCC_BOX_LANES - 1u) // rows that a vector load from the last row touches

typedef struct occ_boxes {
    float *data;
    uint32_t count;
    uint32_t stride; // a multiple of OCC_BOX_LANES; the last OCC_BOX_PADDING rows are never used
} occ_boxes;

static inline float *occ_boxes_column(const occ_boxes *boxes, uint32_t column)
{
    return boxes->data + (size_t)column * boxes->stride;
}

// Makes room for `capacity` boxes. On failure nothing changes.
occ_result occ_boxes_reserve(occ_hooks *hooks, occ_boxes *boxes, size_t capacity);

void occ_boxes_free(occ_hooks *hooks, occ_boxes *boxes);

occ_box occ_boxes_get(const occ_boxes *boxes, uint32_t row);
void occ_boxes_set(occ_boxes *boxes, uint32_t row, const occ_box *box);

// Rows [first, first + count), for which there is room, become these boxes. Wakes the team if it is
// worth while.
void occ_boxes_put(occ_boxes *boxes, uint32_t first, const occ_box *from, uint32_t count,
                   occ_team *team);

// Which of these boxes is the first that may not be used (occ_box_check()), or `count`. As above.
uint32_t occ_boxes_first_bad(const occ_box *boxes, uint32_t count, occ_team *team);

// Row i becomes what row source[i] was, for i < count; `count` becomes the new length. `scratch`
// has room for `scratch_columns` times `count` floats, 1 to OCC_BOX_COLUMNS.
void occ_boxes_gather(occ_boxes *boxes, const uint32_t *source, uint32_t count, float *scratch,
                      uint32_t scratch_columns, occ_team *team);

#endif
