// SPDX-License-Identifier: Apache-2.0
// What the families of sheets live from, told exactly: see test_family_marks.c.
#ifndef OCC_TEST_POLYGON_MARKS_H
#define OCC_TEST_POLYGON_MARKS_H

#include "family.h"

bool eye_in_a_sheets_plane(const family_world *w);
bool eye_on_a_sheets_edge(const family_world *w);
bool eye_in_a_sheets_corner(const family_world *w);
bool sheets_have_a_common_edge(const family_world *w);
bool sheets_nearly_have_a_common_edge(const family_world *w);
bool some_sheet_is_bent(const family_world *w);
bool backs_and_fronts_are_seen(const family_world *w);
bool some_outline_is_not_convex(const family_world *w);

#endif
