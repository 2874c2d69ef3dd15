// SPDX-License-Identifier: Apache-2.0
// The flat test in plain C, straight from kernels/flat.h: what tables on devices must answer, bit
// for bit.
#ifndef OCC_TEST_KIT_FLAT_H
#define OCC_TEST_KIT_FLAT_H

#include "kit.h"

typedef struct kit_flat {
    const occ_box *boxes; // slot by slot
    uint32_t count;
    const uint32_t *slot_of;
    uint32_t strips; // as in occ_cl_table_desc
} kit_flat;

// What a frame came to.
typedef struct kit_flat_counts {
    uint32_t visible, outside, hidden; // objects that were looked at
    uint32_t unresolved;               // of them: by fusion
    uint32_t blocks_dropped, groups_dropped;
} kit_flat_counts;

// The mask of a frame, to be freed. `owners` as in occ_cl_frame; `counts` may be NULL.
uint32_t *kit_flat_mask(const kit_flat *table, const occ_scene *occluders, const uint32_t *owners,
                        const occ_camera_desc *camera, const occ_cull_desc *knobs,
                        kit_flat_counts *counts);

// The order that occ_cl_table_arrange() chooses, to be freed.
uint32_t *kit_flat_order(const occ_box *boxes, uint32_t count);

#endif
