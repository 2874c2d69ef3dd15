// SPDX-License-Identifier: Apache-2.0
#include "slots.h"

#include <string.h>

occ_result occ_slots_reserve(occ_hooks *hooks, occ_slots *slots, size_t more)
{
    if (more >= OCC_NO_SLOT - 1u) return OCC_ERROR_LIMIT;
    size_t needed = more > slots->free_count ? slots->count + (more - slots->free_count) : 0;
    if (needed <= slots->capacity) return OCC_SUCCESS;
    if (needed >= OCC_NO_SLOT - 1u) return OCC_ERROR_LIMIT;
    size_t capacity = (size_t)slots->capacity + slots->capacity / 8;
    if (capacity < needed) capacity = needed;
    if (capacity >= OCC_NO_SLOT) capacity = OCC_NO_SLOT - 1u;
    uint32_t *value = occ_alloc(hooks, capacity * sizeof *value);
    uint16_t *generation = occ_alloc(hooks, capacity * sizeof *generation);
    if (!value || !generation) {
        occ_free(hooks, value, capacity * sizeof *value);
        occ_free(hooks, generation, capacity * sizeof *generation);
        return OCC_ERROR_OUT_OF_MEMORY;
    }
    if (slots->count) {
        memcpy(value, slots->value, slots->count * sizeof *value);
        memcpy(generation, slots->generation, slots->count * sizeof *generation);
    }
    occ_free(hooks, slots->value, slots->capacity * sizeof *value);
    occ_free(hooks, slots->generation, slots->capacity * sizeof *generation);
    slots->value = value;
    slots->generation = generation;
    slots->capacity = (uint32_t)capacity;
    return OCC_SUCCESS;
}

void occ_slots_free(occ_hooks *hooks, occ_slots *slots)
{
    occ_free(hooks, slots->value, slots->capacity * sizeof *slots->value);
    occ_free(hooks, slots->generation, slots->capacity * sizeof *slots->generation);
    *slots = OCC_SLOTS;
}

uint32_t occ_slots_take(occ_slots *slots, uint32_t value)
{
    uint32_t slot = slots->free;
    if (slot == OCC_NO_SLOT) {
        slot = slots->count++;
        slots->generation[slot] = 1;
    } else {
        slots->free = slots->value[slot];
        slots->free_count--;
        slots->generation[slot]++;
    }
    slots->value[slot] = value;
    slots->taken++;
    return slot;
}

void occ_slots_release(occ_slots *slots, uint32_t slot)
{
    slots->taken--;
    if (slots->generation[slot] == UINT16_MAX) { // every generation was given out: retire the slot
        slots->generation[slot] = 0;
        slots->value[slot] = OCC_NO_SLOT;
        return;
    }
    slots->generation[slot]++;
    slots->value[slot] = slots->released;
    if (slots->released == OCC_NO_SLOT) slots->released_last = slot;
    slots->released = slot;
    slots->released_count++;
}

void occ_slots_recycle(occ_slots *slots)
{
    if (slots->released == OCC_NO_SLOT) return;
    slots->value[slots->released_last] = slots->free;
    slots->free = slots->released;
    slots->free_count += slots->released_count;
    slots->released = OCC_NO_SLOT;
    slots->released_count = 0;
}

uint32_t occ_slots_find(const occ_slots *slots, uint32_t index, uint32_t generation)
{
    uint32_t slot = index - 1u; // index 0 becomes the largest number, which no slot has
    if (slot >= slots->count || !(generation & 1u) || slots->generation[slot] != generation) {
        return OCC_NO_SLOT;
    }
    return slot;
}

// The length of a list of untaken slots, or UINT32_MAX if it is no such list.
static uint32_t list_length(const occ_slots *slots, uint32_t head)
{
    uint32_t length = 0;
    for (uint32_t s = head; s != OCC_NO_SLOT; s = slots->value[s], length++) {
        if (s >= slots->count || length >= slots->count || occ_slots_is_taken(slots, s)) {
            return UINT32_MAX;
        }
    }
    return length;
}

const char *occ_slots_validate(const occ_slots *slots)
{
    uint32_t taken = 0, listed = 0;
    for (uint32_t s = 0; s < slots->count; s++) {
        taken += occ_slots_is_taken(slots, s);
        listed += !occ_slots_is_taken(slots, s) && slots->generation[s];
    }
    if (taken != slots->taken) return "the number of taken slots is their sum";
    if (list_length(slots, slots->free) != slots->free_count) {
        return "the free list holds the free slots";
    }
    if (list_length(slots, slots->released) != slots->released_count) {
        return "the released list holds the released slots";
    }
    if (listed != slots->free_count + slots->released_count) {
        return "a slot that is neither taken nor retired is in a list";
    }
    if (slots->released != OCC_NO_SLOT && (slots->released_last >= slots->count ||
                                           slots->value[slots->released_last] != OCC_NO_SLOT ||
                                           occ_slots_is_taken(slots, slots->released_last))) {
        return "the last released slot ends its list";
    }
    return NULL;
}
