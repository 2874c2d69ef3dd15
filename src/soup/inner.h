// SPDX-License-Identifier: Apache-2.0
#ifndef OCC_SOUP_INNER_H
#define OCC_SOUP_INNER_H

#include "soup/search.h"

// Fills in the defaults of a desc, or says what is wrong with it.
occ_result occ_inner_take_desc(const occ_hooks *hooks, occ_inner_desc *desc);

// Says of each of `count` boxes, at least one, what occ_verify_inner() would say of it alone. All
// is valid, the desc taken.
occ_result occ_inner_judge(occ_hooks *hooks, const occ_soup *soup, const occ_inner_box *boxes,
                           size_t count, const occ_inner_desc *desc, occ_inner_reason *reasons);

#endif
