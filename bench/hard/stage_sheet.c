// SPDX-License-Identifier: Apache-2.0
// Sheets on the stage.
#include "stage.h"

#include <string.h>

stage_sheet stage_quad(double low_x, double high_x, double low_y, double high_y, double z)
{
    return (stage_sheet){
        4, {{low_x, low_y, z}, {high_x, low_y, z}, {high_x, high_y, z}, {low_x, high_y, z}}};
}

stage_sheet stage_octagon(double x, double y, double z, double a, double cut)
{
    double b = a - cut;
    return (stage_sheet){8,
                         {{x + b, y - a, z},
                          {x + a, y - b, z},
                          {x + a, y + b, z},
                          {x + b, y + a, z},
                          {x - b, y + a, z},
                          {x - a, y + b, z},
                          {x - a, y - b, z},
                          {x - b, y - a, z}}};
}

void stage_lean(stage_sheet *sheet, double by_x, double by_y)
{
    for (uint32_t c = 0; c < sheet->count; c++)
        sheet->corner[c][2] += by_x * sheet->corner[c][0] + by_y * sheet->corner[c][1];
}

void stage_turn_round(stage_sheet *sheet)
{
    stage_sheet turned = *sheet;
    for (uint32_t c = 0; c < sheet->count; c++)
        memcpy(turned.corner[c], sheet->corner[sheet->count - 1 - c], sizeof turned.corner[c]);
    *sheet = turned;
}

occ_sides stage_any_sides(stage *s)
{
    return stage_chance(s, 2) ? OCC_SIDES_FRONT : OCC_SIDES_BOTH;
}

world_sheet *stage_world_sheet(stage *s, int occluder)
{
    return &s->world->sheets[occluder - FAMILY_OCCLUDERS];
}

// Around the mean of the corners, half the first two edges.
static stage_box stand_in(const stage_sheet *sheet)
{
    stage_box box = {{0}, {{0}}};
    for (int j = 0; j < 3; j++) {
        for (uint32_t c = 0; c < sheet->count; c++)
            box.center[j] += sheet->corner[c][j] / sheet->count;
        for (int k = 0; k < 2; k++)
            box.axis[k][j] = 0.5 * (sheet->corner[k + 1][j] - sheet->corner[k][j]);
    }
    return box;
}

int stage_put(stage *s, stage_sheet sheet, occ_sides sides, int owner)
{
    uint32_t i = s->world->sheet_count;
    if (i == FAMILY_SHEETS) return -1;
    world_sheet *put = &s->world->sheets[i];
    put->owner = owner;
    put->sheet.corner_count = sheet.count;
    put->sheet.sides = sides;
    for (uint32_t c = 0; c < sheet.count; c++) {
        double v[3];
        stage_carry(s, sheet.corner[c], v);
        for (int j = 0; j < 3; j++)
            put->sheet.corner[c][j] = (float)(s->place[j] + v[j]);
    }
    s->occluders[FAMILY_OCCLUDERS + i] = stand_in(&sheet);
    s->world->sheet_count++;
    return (int)(FAMILY_OCCLUDERS + i);
}
