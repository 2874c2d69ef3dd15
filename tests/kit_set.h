// SPDX-License-Identifier: Apache-2.0
// Sets of shadows as a frame has them, and what scalar C says of a shadow and a box.
#ifndef OCC_TEST_KIT_SET_H
#define OCC_TEST_KIT_SET_H

#include "fusion.h"
#include "kit.h"
#include "lanes.h"

enum { KIT_SET_MOST = 112, KIT_SET_BLOCKS = KIT_SET_MOST / OCC_SHADOW_LANES };

typedef struct kit_set {
    occ_shadow shadows[KIT_SET_MOST];
    occ_wide_shadow wide[KIT_SET_MOST];
    occ_rect_block rects[KIT_SET_BLOCKS];
    uint32_t count;
} kit_set;

// Adds a shadow that may be anywhere on the screen, and right before the eye.
void kit_set_add(kit_set *set, const occ_shadow *shadow);

occ_shadow_set kit_set_view(const kit_set *set);

// Where something that may be anywhere is.
void kit_anywhere(occ_projection *seen);

// How a box and a shadow lie.
typedef struct kit_contact {
    bool apart;  // the shadow holds nothing of the box
    bool inside; // all of it
    bool faces;  // one of its faces cuts the box
} kit_contact;

kit_contact kit_contact_of(const occ_relative_box *box, const occ_shadow *shadow);

#endif
