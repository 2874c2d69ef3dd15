// SPDX-License-Identifier: Apache-2.0
#include "kit_sheets.h"

#include <math.h>

static float on_grid(kit_random *random, float reach)
{
    return rintf(kit_between(random, -reach, reach) * 256.0f) / 256.0f;
}

occ_box kit_flat_box(kit_random *random, float reach, float size)
{
    occ_box box = {.center = {0}};
    for (int j = 0; j < 3; j++) {
        box.center[j] = on_grid(random, reach);
        box.axis[0][j] = on_grid(random, size);
        box.axis[1][j] = on_grid(random, size);
    }
    return box;
}

occ_sheet kit_sheet_of_box(const occ_box *box)
{
    static const float sign[4][2] = {{1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
    occ_sheet sheet = {.corner_count = 4};
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 3; j++)
            sheet.corner[i][j] =
                box->center[j] + sign[i][0] * box->axis[0][j] + sign[i][1] * box->axis[1][j];
    return sheet;
}

occ_sheet kit_sheet_reversed(const occ_sheet *sheet)
{
    occ_sheet reversed = *sheet;
    for (uint32_t i = 0; i < sheet->corner_count; i++)
        memcpy(reversed.corner[i], sheet->corner[sheet->corner_count - 1 - i],
               sizeof *reversed.corner);
    return reversed;
}

bool kit_same_sheets(const occ_sheet *a, const occ_sheet *b)
{
    return a->corner_count == b->corner_count && a->sides == b->sides &&
           kit_same_bits(a->corner, b->corner, a->corner_count * sizeof *a->corner);
}

occ_sheet kit_round_sheet(kit_random *random, uint32_t corners, const float center[3], float size)
{
    occ_sheet sheet = {.corner_count = corners};
    float a[3], b[3];
    for (int j = 0; j < 3; j++) {
        a[j] = kit_between(random, -size, size);
        b[j] = kit_between(random, -size, size);
    }
    for (uint32_t i = 0; i < corners; i++) {
        float angle = ((float)i + kit_between(random, 0.1f, 0.9f)) * 6.2831853f / (float)corners;
        for (int j = 0; j < 3; j++)
            sheet.corner[i][j] = center[j] + cosf(angle) * a[j] + sinf(angle) * b[j];
    }
    return sheet;
}
