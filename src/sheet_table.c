// SPDX-License-Identifier: Apache-2.0
#include "sheet_table.h"

#include "sheet.h"

occ_result occ_sheets_reserve(occ_hooks *hooks, occ_sheets *sheets, size_t more)
{
    occ_array *entries = &sheets->entries;
    size_t needed = sheets->taken + more; // what is free lies before the last
    if (needed <= entries->capacity) return OCC_SUCCESS;
    size_t grown = (size_t)entries->capacity + entries->capacity / 8;
    return occ_array_reserve(hooks, entries, grown > needed ? grown : needed);
}

void occ_sheets_free(occ_hooks *hooks, occ_sheets *sheets)
{
    occ_array_free(hooks, &sheets->entries);
    *sheets = OCC_SHEETS;
}

uint32_t occ_sheets_take(occ_sheets *sheets, const occ_sheet *sheet, uint32_t slot)
{
    uint32_t index = sheets->free;
    if (index == OCC_NO_SLOT) {
        index = sheets->entries.count++;
    } else {
        sheets->free = occ_sheets_at(sheets, index)->next;
    }
    sheets->taken++;
    *occ_sheets_at(sheets, index) =
        (occ_sheet_entry){.sheet = occ_sheet_plain(sheet), .slot = slot, .next = OCC_NO_SLOT};
    return index;
}

void occ_sheets_release(occ_sheets *sheets, uint32_t index)
{
    occ_sheet_entry *entry = occ_sheets_at(sheets, index);
    entry->slot = OCC_NO_SLOT;
    entry->next = sheets->free;
    sheets->free = index;
    sheets->taken--;
}

const char *occ_sheets_validate(const occ_sheets *sheets)
{
    uint32_t free_count = sheets->entries.count - sheets->taken;
    if (sheets->taken > sheets->entries.count) return "there are as many sheets as are taken";
    uint32_t index = sheets->free;
    for (; index != OCC_NO_SLOT && free_count; free_count--) {
        if (index >= sheets->entries.count || occ_sheets_at(sheets, index)->slot != OCC_NO_SLOT) {
            return "free sheets are nobody's";
        }
        index = occ_sheets_at(sheets, index)->next;
    }
    return free_count || index != OCC_NO_SLOT ? "a sheet that is not free is taken" : NULL;
}
