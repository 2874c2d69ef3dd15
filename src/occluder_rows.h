// SPDX-License-Identifier: Apache-2.0
// The table of occluders. A row is read as a whole, so unlike the objects' boxes these lie one
// after the other.
#ifndef OCC_OCCLUDER_ROWS_H
#define OCC_OCCLUDER_ROWS_H

#include "memory.h"
#include "slots.h"
#include "team.h"

#include <occlude/scene.h>

typedef struct occ_occluder_rows {
    occ_box *boxes;     // of a sheet its proxy; and behind them, in one block of memory:
    uint32_t *slot_of;  // OCC_NO_SLOT where an occluder was removed
    uint32_t *owner_of; // the owner's slot; OCC_NO_SLOT where nobody owns it
    uint32_t *sheet_of; // where a sheet lies among the scene's; OCC_NO_SLOT for a box. NULL as long
                        // as there has been no sheet
    uint32_t count;
    uint32_t capacity;
} occ_occluder_rows;

// Makes room for `capacity` rows, and for `sheets` among them. On failure nothing changes.
occ_result occ_occluder_rows_reserve(occ_hooks *hooks, occ_occluder_rows *rows, uint32_t capacity,
                                     bool sheets);

void occ_occluder_rows_free(occ_hooks *hooks, occ_occluder_rows *rows);

// Row i becomes what row source[i] was, for i < count, and its slot's value i; `count` becomes the
// new length. On failure nothing changes.
occ_result occ_occluder_rows_gather(occ_hooks *hooks, occ_occluder_rows *rows, occ_slots *slots,
                                    const uint32_t *source, uint32_t count, occ_team *team);

#endif
