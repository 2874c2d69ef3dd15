// SPDX-License-Identifier: Apache-2.0
// Families of sheets that live from where the eye is.
#include "families.h"

#include <math.h>
#include <string.h>

static void look(stage *s)
{
    world_lens lens = stage_lens(s);
    stage_look_about(s, 8, &lens);
}

// Some sheet straight ahead.
static void ahead(stage *s)
{
    double x = s->eye[0] + stage_whole(s, -3, 3), y = s->eye[1] + stage_whole(s, -3, 3);
    double z = s->eye[2] - stage_whole(s, 6, 16), a = stage_whole(s, 2, 6);
    stage_sheet sheet = stage_octagon(x, y, z, a, 0.5 * a);
    if (stage_chance(s, 2)) sheet = stage_quad(x - a, x + a, y - a, y + a, z);
    stage_put(s, sheet, stage_any_sides(s), -1);
}

// With x and y changed about the eye, so that what was across x is across y.
static void change_sides(const stage *s, stage_sheet *sheet)
{
    for (uint32_t c = 0; c < sheet->count; c++) {
        double x = sheet->corner[c][0] - s->eye[0], y = sheet->corner[c][1] - s->eye[1];
        sheet->corner[c][0] = s->eye[0] + y;
        sheet->corner[c][1] = s->eye[1] + x;
    }
}

// An octagon or a rectangle in a plane that holds the eye: x = the eye's, or slanted about it.
static stage_sheet level_sheet(stage *s)
{
    double y = stage_whole(s, -6, 6), z = -stage_whole(s, 2, 12), a = stage_whole(s, 1, 6);
    double slant = stage_chance(s, 2) ? 0.0 : 0.5 * stage_whole(s, -2, 2);
    stage_sheet flat = stage_octagon(y, z, 0, a, 0.5 * a);
    if (stage_chance(s, 2)) flat = stage_quad(y - a, y + a, z - a, z + a, 0);
    for (uint32_t c = 0; c < flat.count; c++) {
        double at_y = flat.corner[c][0], at_z = flat.corner[c][1];
        flat.corner[c][0] = s->eye[0] + slant * at_y;
        flat.corner[c][1] = s->eye[1] + at_y;
        flat.corner[c][2] = s->eye[2] + at_z;
    }
    return flat;
}

FAMILY(polygon_eye_plane)
{
    look(s);
    for (int i = 0; i < 3; i++) {
        stage_sheet sheet = level_sheet(s);
        bool is_changed = stage_chance(s, 2);
        if (is_changed) change_sides(s, &sheet);
        stage_put(s, sheet, stage_any_sides(s), -1);
        const stage_range size = stage_parts(0, 3);
        double z = s->eye[2] - stage_whole(s, 8, 24), depth = stage_part(s, 0, 3), half[3];
        stage_point(s, size, size, size, half);
        stage_box box = stage_brick(s->eye[0], s->eye[1], z, half[0], half[1], depth);
        if (stage_chance(s, 2)) box.axis[is_changed][is_changed] = 0.0;
        if (stage_chance(s, 3)) box.center[is_changed] += half[is_changed];
        stage_object(s, box); // in the same plane, astride or flush
    }
    ahead(s);
    ahead(s);
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

// A sheet ahead whose first edge goes straight away from the eye, on its line; the other corners
// anywhere in whole numbers.
static stage_sheet edge_at_eye(stage *s)
{
    double near_z = stage_whole(s, -2, 12), far_z = near_z + stage_whole(s, 1, 8);
    double x = stage_signed(s, 1, 6), y = stage_whole(s, -6, 6);
    stage_sheet sheet = {4, {{0, 0, -near_z}, {0, 0, -far_z}, {x, y, -far_z}, {x, y, -near_z}}};
    if (stage_chance(s, 3)) sheet.count = 3;
    for (uint32_t c = 0; c < sheet.count; c++)
        for (int j = 0; j < 3; j++)
            sheet.corner[c][j] += s->eye[j];
    if (stage_chance(s, 2)) stage_turn_round(&sheet);
    return sheet;
}

// The edges lie on a line through the eye: the sheets are seen edge-on, but for those with a bend.
FAMILY(polygon_eye_edge)
{
    look(s);
    for (int i = 0; i < 4; i++) {
        stage_sheet sheet = edge_at_eye(s);
        if (sheet.count == 4 && stage_chance(s, 2)) {
            double across = stage_part(s, -2, 2);
            sheet.corner[stage_chance(s, 2) ? 0 : 3][1] += across;
        }
        stage_put(s, sheet, stage_any_sides(s), -1);
        double z = s->eye[2] - stage_whole(s, 8, 32), depth = stage_whole(s, 0, 4);
        stage_object(s, stage_brick(s->eye[0], s->eye[1], z, 0, 0, depth)); // on the line
        double aside = stage_sign(s) * 2.0;
        stage_object(s, stage_brick(s->eye[0] + aside, s->eye[1] + 2, z, 2, 2, depth));
    }
    ahead(s);
    ahead(s);
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

// In any direction, with a corner where the eye is.
FAMILY(polygon_eye_corner)
{
    look(s);
    for (uint32_t i = 0, sheets = 1 + steady_below(&s->random, 4); i < sheets; i++) {
        const stage_range any = stage_ones(-6, 6);
        double u[3], v[3];
        stage_sheet sheet = {.count = (uint32_t)stage_whole(s, 3, 4)};
        stage_point(s, any, any, any, u);
        stage_point(s, any, any, any, v);
        for (uint32_t c = 0; c < sheet.count; c++)
            for (int j = 0; j < 3; j++)
                sheet.corner[c][j] =
                    s->eye[j] + (c == 1 || c == 2 ? u[j] : 0.0) + (c >= 2 ? v[j] : 0.0);
        if (stage_chance(s, 2)) stage_turn_round(&sheet);
        stage_put(s, sheet, stage_any_sides(s), -1);
    }
    ahead(s);
    ahead(s);
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

// All hide from the front alone; half of them show their backs, some are between two that do not.
FAMILY(polygon_one_sided)
{
    look(s);
    for (int i = 0; i < 5; i++) {
        double x = s->eye[0] + stage_whole(s, -4, 4), y = s->eye[1] + stage_whole(s, -4, 4);
        double z = s->eye[2] - stage_whole(s, 4, 16), a = stage_whole(s, 2, 6), size;
        double by_x = 0.25 * stage_whole(s, -4, 4), by_y = 0.25 * stage_whole(s, -4, 4);
        stage_sheet sheet = stage_octagon(0, 0, 0, a, 0.5 * a);
        if (stage_chance(s, 2)) sheet = stage_quad(-a, a, -a, a, 0);
        stage_lean(&sheet, by_x, by_y);
        for (uint32_t c = 0; c < sheet.count; c++) {
            sheet.corner[c][0] += x;
            sheet.corner[c][1] += y;
            sheet.corner[c][2] += z;
        }
        if (stage_chance(s, 2)) stage_turn_round(&sheet);
        stage_put(s, sheet, OCC_SIDES_FRONT, -1);
        if (stage_chance(s, 4)) { // the other side of the same thing
            stage_turn_round(&sheet);
            stage_put(s, sheet, OCC_SIDES_FRONT, -1);
        }
        size = stage_part(s, 0, 1);
        stage_object(s, stage_brick(x, y, z - 12, size, size, size));
        stage_object(s, stage_brick(x, y, z + 1, size, size, 0.5 * size));
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

// Through the eye's plane and the near plane, in the near plane, before it, and behind the eye.
FAMILY(polygon_at_near)
{
    world_lens lens = stage_lens(s);
    lens.near_z = stage_chance(s, 2) ? 1.0f : 0x1p-4f;
    stage_look(s, (double[3]){0, 0, 0}, NULL, &lens);
    for (int i = 0; i < 5; i++) {
        double x = stage_whole(s, -3, 3), y = stage_whole(s, -3, 3), a = stage_whole(s, 1, 8);
        double near_z = (double)lens.near_z, z = -near_z * 0.5 * stage_whole(s, -1, 6);
        stage_sheet sheet = stage_octagon(x, y, z, a, 0.5 * a);
        double by_x = stage_whole(s, -2, 2), by_y = stage_whole(s, -2, 2);
        if (stage_chance(s, 2)) sheet = stage_quad(x - a, x + a, y - a, y + a, z);
        if (stage_chance(s, 2)) stage_lean(&sheet, by_x, by_y);
        if (stage_chance(s, 3)) stage_turn_round(&sheet);
        stage_put(s, sheet, stage_any_sides(s), -1);
        double size = stage_part(s, 0, 2);
        stage_object(s, stage_brick(x, y, z - stage_whole(s, 1, 16), size, size, size));
    }
    ahead(s);
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}
