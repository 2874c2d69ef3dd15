// SPDX-License-Identifier: Apache-2.0
// An allocator that counts what goes through it.
#ifndef OCC_SOUP_TALLY_H
#define OCC_SOUP_TALLY_H

#include "memory.h"

typedef struct occ_tally {
    occ_allocator allocator; // the caller's
    uint64_t bytes, peak;
} occ_tally;

// From now on `hooks` allocate through the tally, which must stay where it is.
void occ_tally_start(occ_tally *tally, occ_hooks *hooks);

#endif
