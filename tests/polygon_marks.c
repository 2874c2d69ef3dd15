// SPDX-License-Identifier: Apache-2.0
#include "polygon_marks.h"

#include "exact_side.h"
#include "kit.h"

#include <math.h>
#include <string.h>

// On which side of the plane of three corners a point is; 0 too where they have no area.
static int side_of_corners(const occ_sheet *sheet, uint32_t first, uint32_t second, uint32_t third,
                           const double point[3])
{
    const uint32_t corner[3] = {first, second, third};
    double a[3][3], b[3][3];
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3; j++) {
            a[k][j] = (double)sheet->corner[corner[k]][j];
            b[k][j] = point[j];
        }
    return exact_volume(a, b);
}

static bool is_coplanar(const occ_sheet *sheet)
{
    for (uint32_t c = 3; c < sheet->corner_count; c++) {
        const double point[3] = {(double)sheet->corner[c][0], (double)sheet->corner[c][1],
                                 (double)sheet->corner[c][2]};
        if (side_of_corners(sheet, 0, 1, 2, point) != 0) return false;
    }
    return true;
}

bool eye_in_a_sheets_plane(const family_world *w)
{
    for (uint32_t i = 0; i < w->sheet_count; i++) {
        const occ_sheet *sheet = &w->sheets[i].sheet;
        if (is_coplanar(sheet) && side_of_corners(sheet, 0, 1, 2, w->eye) == 0) return true;
    }
    return false;
}

// Two neighbouring corners and the eye are in one line: whatever the third point, no volume.
bool eye_on_a_sheets_edge(const family_world *w)
{
    for (uint32_t i = 0; i < w->sheet_count; i++) {
        const occ_sheet *sheet = &w->sheets[i].sheet;
        for (uint32_t c = 0; c < sheet->corner_count; c++) {
            occ_sheet probe = {.corner_count = 3};
            uint32_t next = (c + 1) % sheet->corner_count;
            memcpy(probe.corner[0], sheet->corner[c], sizeof probe.corner[0]);
            memcpy(probe.corner[1], sheet->corner[next], sizeof probe.corner[1]);
            bool is_in_line = true;
            for (int k = 0; k < 3; k++) {
                memcpy(probe.corner[2], sheet->corner[c], sizeof probe.corner[2]);
                probe.corner[2][k] += 2.0f * fabsf(probe.corner[2][k]) + 1.0f;
                is_in_line = is_in_line && side_of_corners(&probe, 0, 1, 2, w->eye) == 0;
            }
            if (is_in_line) return true;
        }
    }
    return false;
}

bool eye_in_a_sheets_corner(const family_world *w)
{
    for (uint32_t i = 0; i < w->sheet_count; i++)
        for (uint32_t c = 0; c < w->sheets[i].sheet.corner_count; c++) {
            const float *at = w->sheets[i].sheet.corner[c];
            if ((double)at[0] == w->eye[0] && (double)at[1] == w->eye[1] &&
                (double)at[2] == w->eye[2])
                return true;
        }
    return false;
}

// Of two sheets and each other's corners: how many are the same.
static int common_corners(const occ_sheet *a, const occ_sheet *b)
{
    int count = 0;
    for (uint32_t i = 0; i < a->corner_count; i++)
        for (uint32_t k = 0; k < b->corner_count; k++)
            count += kit_same_bits(a->corner[i], b->corner[k], sizeof a->corner[i]);
    return count;
}

bool sheets_have_a_common_edge(const family_world *w)
{
    for (uint32_t i = 0; i < w->sheet_count; i++)
        for (uint32_t k = 0; k < i; k++)
            if (common_corners(&w->sheets[i].sheet, &w->sheets[k].sheet) == 2) return true;
    return false;
}

// Of the six numbers of an edge in common one or two are a step off, or other corners are.
bool sheets_nearly_have_a_common_edge(const family_world *w)
{
    const occ_sheet *a = &w->sheets[0].sheet, *b = &w->sheets[1].sheet;
    int same = 0;
    for (int j = 0; j < 3; j++)
        same += (a->corner[1][j] == b->corner[0][j]) + (a->corner[2][j] == b->corner[3][j]);
    return same == 4 || same == 5 || (same == 6 && !is_coplanar(b));
}

bool some_sheet_is_bent(const family_world *w)
{
    for (uint32_t i = 0; i < w->sheet_count; i++)
        if (!is_coplanar(&w->sheets[i].sheet)) return true;
    return false;
}

bool backs_and_fronts_are_seen(const family_world *w)
{
    unsigned seen[3] = {0};
    for (uint32_t i = 0; i < w->sheet_count; i++)
        seen[1 + side_of_corners(&w->sheets[i].sheet, 0, 1, 2, w->eye)]++;
    return seen[0] > 0 && seen[2] > 0;
}

bool some_outline_is_not_convex(const family_world *w)
{
    for (uint32_t i = 0; i < w->sheet_count; i++) {
        const occ_sheet *sheet = &w->sheets[i].sheet;
        bool turns[3] = {false, false, false};
        for (uint32_t c = 2; c < sheet->corner_count; c++)
            turns[1 + side_of_corners(sheet, 0, c - 1, c, w->eye)] = true;
        if (turns[0] + turns[1] + turns[2] > 1) return true;
    }
    return false;
}
