// SPDX-License-Identifier: Apache-2.0
// Stable slots behind handles. A slot carries one number of the owner's choosing while it is taken
// and links the free list while it is not. The generation is odd while the slot is taken, so a
// handle fits if and only if its generation is the slot's; a slot whose generations are used up is
// retired rather than reused, so a stale handle never fits again.
#ifndef OCC_SLOTS_H
#define OCC_SLOTS_H

#include "memory.h"

#define OCC_NO_SLOT UINT32_MAX

typedef struct occ_slots {
    uint32_t *value;
    uint16_t *generation;
    uint32_t count; // slots ever used: the mask's length
    uint32_t taken;
    uint32_t free; // head of the free list, or OCC_NO_SLOT
    uint32_t free_count;
    uint32_t released; // head of the list of slots released since occ_slots_recycle()
    uint32_t released_last;
    uint32_t released_count;
    uint32_t capacity;
} occ_slots;

#define OCC_SLOTS ((occ_slots){.free = OCC_NO_SLOT, .released = OCC_NO_SLOT})

// Makes sure that `more` slots can be taken without another allocation.
occ_result occ_slots_reserve(occ_hooks *hooks, occ_slots *slots, size_t more);

void occ_slots_free(occ_hooks *hooks, occ_slots *slots);

// The next slot; room must have been reserved. Fresh slots come in ascending order.
uint32_t occ_slots_take(occ_slots *slots, uint32_t value);

// Handles to the slot are stale from here on; the slot itself waits for occ_slots_recycle().
void occ_slots_release(occ_slots *slots, uint32_t slot);

// Lets the released slots be taken again.
void occ_slots_recycle(occ_slots *slots);

// The slot that a handle (index = slot + 1) names, or OCC_NO_SLOT if it is stale.
uint32_t occ_slots_find(const occ_slots *slots, uint32_t index, uint32_t generation);

static inline bool occ_slots_is_taken(const occ_slots *slots, uint32_t slot)
{
    return slots->generation[slot] & 1u;
}

// NULL, or the name of the invariant that does not hold.
const char *occ_slots_validate(const occ_slots *slots);

#endif
