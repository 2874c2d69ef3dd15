// SPDX-License-Identifier: Apache-2.0
// How a triangle and a box meet, from linear inequalities in rational numbers: slow, and without
// any separating axis.
#ifndef OCC_TEST_CONTACT_ORACLE_H
#define OCC_TEST_CONTACT_ORACLE_H

#include "soup/overlap.h"

// Whether they have a point in common; `open`: one of the box's interior, which must not be flat.
bool contact_oracle_meet(const occ_box *box, float corner[3][3], bool open);

bool contact_oracle_has_volume(const occ_box *box);

occ_contact contact_oracle(const occ_box *box, float corner[3][3]);

#endif
