// SPDX-License-Identifier: Apache-2.0
#ifndef OCC_SHEET_DESC_H
#define OCC_SHEET_DESC_H

#include "memory.h"

#include <occlude/sheets.h>

// Refuses what a desc may not hold.
occ_result occ_sheets_take_desc(const occ_hooks *hooks, const occ_sheets_desc *desc);

#endif
