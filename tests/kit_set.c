// SPDX-License-Identifier: Apache-2.0
#include "kit_set.h"

#include <math.h>

void kit_set_add(kit_set *set, const occ_shadow *shadow)
{
    uint32_t i = set->count++, lane = i % OCC_SHADOW_LANES;
    occ_rect_block *block = &set->rects[i / OCC_SHADOW_LANES];
    ck_assert_uint_lt(i, KIT_SET_MOST);
    set->shadows[i] = *shadow;
    occ_wide_shadow_set(&set->wide[i], shadow);
    if (!lane) *block = (occ_rect_block){.key = {0.0f}};
    for (int j = 0; j < 2; j++) {
        block->min[j][lane] = -INFINITY;
        block->max[j][lane] = INFINITY;
    }
    block->key[lane] = 0.0f;
}

occ_shadow_set kit_set_view(const kit_set *set)
{
    return (occ_shadow_set){set->shadows, set->wide, set->rects, set->count};
}

void kit_anywhere(occ_projection *seen)
{
    *seen = (occ_projection){.min = {-INFINITY, -INFINITY}, .max = {INFINITY, INFINITY}};
}

kit_contact kit_contact_of(const occ_relative_box *box, const occ_shadow *shadow)
{
    kit_contact contact = {.inside = true};
    for (uint32_t p = 0; p < shadow->planes; p++) {
        const float *n = shadow->plane[p];
        float s = OCC_PLANE_AT(n[0], n[1], n[2], n[3], box->t[0], box->t[1], box->t[2]);
        float r = occ_box_reach(box, n[0], n[1], n[2]);
        bool inside = s - r > box->e;
        contact.apart |= s + r < -box->e;
        contact.inside &= inside;
        contact.faces |= !inside && p >= occ_shadow_silhouettes(shadow);
    }
    return contact;
}
