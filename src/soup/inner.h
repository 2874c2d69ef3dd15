// SPDX-License-Identifier: Apache-2.0
#ifndef OCC_SOUP_INNER_H
#define OCC_SOUP_INNER_H

#include "soup/search.h"

// Fills in the defaults of a desc, or says what is wrong with it.
occ_result occ_inner_take_desc(const occ_hooks *hooks, occ_inner_desc *desc);

#endif
