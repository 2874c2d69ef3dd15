// SPDX-License-Identifier: Apache-2.0
// The table of a scene's sheets. Where one lies in it depends on how the scene came about, and does
// not matter: the occluder's row names it.
#ifndef OCC_SHEET_TABLE_H
#define OCC_SHEET_TABLE_H

#include "memory.h"
#include "slots.h"

#include <occlude/scene.h>

typedef struct occ_sheet_entry {
    occ_sheet sheet;
    uint32_t slot; // of the occluder that it is; OCC_NO_SLOT: a free entry
    uint32_t next; // the free entry after a free one, or OCC_NO_SLOT
} occ_sheet_entry;

typedef struct occ_sheets {
    occ_array entries; // of occ_sheet_entry
    uint32_t free;     // the first free entry, or OCC_NO_SLOT
    uint32_t taken;
} occ_sheets;

#define OCC_SHEETS ((occ_sheets){.entries = OCC_ARRAY(occ_sheet_entry), .free = OCC_NO_SLOT})

static inline occ_sheet_entry *occ_sheets_at(const occ_sheets *sheets, uint32_t index)
{
    return (occ_sheet_entry *)sheets->entries.data + index;
}

// Makes sure that `more` sheets can be taken without another allocation.
occ_result occ_sheets_reserve(occ_hooks *hooks, occ_sheets *sheets, size_t more);

void occ_sheets_free(occ_hooks *hooks, occ_sheets *sheets);

// Stores a sheet, for which room must have been reserved, and returns where.
uint32_t occ_sheets_take(occ_sheets *sheets, const occ_sheet *sheet, uint32_t slot);

void occ_sheets_release(occ_sheets *sheets, uint32_t index);

// NULL, or the name of the invariant that does not hold.
const char *occ_sheets_validate(const occ_sheets *sheets);

#endif
