// SPDX-License-Identifier: Apache-2.0
#include "occluder_rows.h"

#include <string.h>

static size_t row_bytes(bool sheets)
{
    return sizeof(occ_box) + (sheets ? 3 : 2) * sizeof(uint32_t);
}

// A table without rows. `boxes` is NULL if there is no memory, or no capacity.
static occ_occluder_rows make_rows(occ_hooks *hooks, size_t capacity, bool sheets)
{
    occ_occluder_rows rows = {.capacity = (uint32_t)capacity};
    size_t bytes = row_bytes(sheets);
    rows.boxes = capacity > SIZE_MAX / bytes ? NULL : occ_alloc(hooks, capacity * bytes);
    if (!rows.boxes) return (occ_occluder_rows){.capacity = 0};
    rows.slot_of = (uint32_t *)(rows.boxes + capacity);
    rows.owner_of = rows.slot_of + capacity;
    if (sheets) rows.sheet_of = rows.owner_of + capacity;
    return rows;
}

occ_result occ_occluder_rows_reserve(occ_hooks *hooks, occ_occluder_rows *rows, uint32_t capacity,
                                     bool sheets)
{
    sheets = sheets || rows->sheet_of;
    if (capacity <= rows->capacity && sheets == (rows->sheet_of != NULL)) return OCC_SUCCESS;
    if (capacity < rows->capacity) capacity = rows->capacity;
    occ_occluder_rows grown = make_rows(hooks, capacity, sheets);
    if (!grown.boxes) return OCC_ERROR_OUT_OF_MEMORY;
    grown.count = rows->count;
    if (rows->count) {
        memcpy(grown.boxes, rows->boxes, rows->count * sizeof *rows->boxes);
        memcpy(grown.slot_of, rows->slot_of, rows->count * sizeof *rows->slot_of);
        memcpy(grown.owner_of, rows->owner_of, rows->count * sizeof *rows->owner_of);
    }
    for (uint32_t row = 0; sheets && row < rows->count; row++)
        grown.sheet_of[row] = rows->sheet_of ? rows->sheet_of[row] : OCC_NO_SLOT;
    occ_occluder_rows_free(hooks, rows);
    *rows = grown;
    return OCC_SUCCESS;
}

void occ_occluder_rows_free(occ_hooks *hooks, occ_occluder_rows *rows)
{
    occ_free(hooks, rows->boxes, rows->capacity * row_bytes(rows->sheet_of != NULL));
    *rows = (occ_occluder_rows){.capacity = 0};
}

typedef struct gather_job {
    const occ_occluder_rows *from;
    occ_occluder_rows *to;
    const uint32_t *source;
    uint32_t *row_of;
    uint32_t parts;
} gather_job;

static void gather_part(void *context, uint32_t part)
{
    const gather_job *job = context;
    const occ_occluder_rows from = *job->from, to = *job->to;
    uint32_t end = occ_part_first(to.count, job->parts, part + 1);
    for (uint32_t i = occ_part_first(to.count, job->parts, part); i < end; i++) {
        uint32_t row = job->source[i];
        to.boxes[i] = from.boxes[row];
        to.slot_of[i] = from.slot_of[row];
        to.owner_of[i] = from.owner_of[row];
        if (to.sheet_of) to.sheet_of[i] = from.sheet_of[row];
        job->row_of[from.slot_of[row]] = i;
    }
}

// Into a table of its own: that takes no more memory for a while than scratch columns would.
occ_result occ_occluder_rows_gather(occ_hooks *hooks, occ_occluder_rows *rows, occ_slots *slots,
                                    const uint32_t *source, uint32_t count, occ_team *team)
{
    occ_occluder_rows gathered = make_rows(hooks, rows->capacity, rows->sheet_of != NULL);
    if (rows->capacity && !gathered.boxes) return OCC_ERROR_OUT_OF_MEMORY;
    gathered.count = count;
    gather_job job = {rows, &gathered, source, slots->value, occ_parts_of(count)};
    occ_do_parts(team, job.parts, gather_part, &job);
    occ_occluder_rows_free(hooks, rows);
    *rows = gathered;
    return OCC_SUCCESS;
}
