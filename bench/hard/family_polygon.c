// SPDX-License-Identifier: Apache-2.0
// Families of sheets: what they are made of, and how they meet each other.
#include "families.h"

#include <math.h>
#include <string.h>

static void look(stage *s)
{
    world_lens lens = stage_lens(s);
    stage_look_about(s, 2, &lens);
}

// On the far side of a point as the camera sees it: for a perspective eye `times` as far.
static void far_side(const stage *s, const double point[3], double times, double out[3])
{
    for (int j = 0; j < 3; j++)
        out[j] = s->parallel ? point[j] - (j == 2 ? 4.0 * times : 0.0)
                             : s->eye[j] + times * (point[j] - s->eye[j]);
}

// Objects behind what is around (x, y, z), flush with the line of sight through it or astride.
static void put_behind(stage *s, int count, double x, double y, double z)
{
    const stage_range size = stage_parts(0, 1);
    for (int i = 0; i < count; i++) {
        const double point[3] = {x, y + stage_whole(s, -1, 1), z};
        double there[3], half[3], times = 1.0 + 0.5 * stage_whole(s, 1, 4);
        far_side(s, point, times, there);
        stage_point(s, size, size, size, half);
        there[0] += half[0] * stage_whole(s, -1, 1);
        stage_object(s, stage_brick(there[0], there[1], there[2], half[0], half[1], half[2]));
    }
}

// So slanted that whole numbers stay multiples of 1/16.
static void lean(stage *s, stage_sheet *sheets, int count)
{
    double by_x = 0.25 * stage_whole(s, -1, 1), by_y = 0.25 * stage_whole(s, -1, 1);
    for (int i = 0; i < count; i++)
        stage_lean(&sheets[i], by_x, by_y);
}

// The corners of one of the triangles of a fan.
static stage_sheet triangle_of(const stage_sheet *sheet, int t)
{
    stage_sheet triangle = {.count = 3};
    memcpy(triangle.corner[0], sheet->corner[0], sizeof triangle.corner[0]);
    memcpy(triangle.corner[1], sheet->corner[t + 1], 2 * sizeof triangle.corner[0]);
    return triangle;
}

// --- next to each other --------------------------------------------------------------------------

// Two quads with the edge x in common, or the four triangles of both; or the second so far behind
// that only the eye sees the edges meet.
FAMILY(polygon_abutting)
{
    look(s);
    double x = stage_whole(s, -3, 3), y = stage_whole(s, -2, 2), z = -stage_whole(s, 6, 12);
    double a = stage_whole(s, 2, 6), b = stage_whole(s, 3, 8);
    stage_sheet half[2] = {stage_quad(x - a, x, y - b, y + b, z),
                           stage_quad(x, x + a, y - b, y + b, z)};
    lean(s, half, 2);
    double times = stage_chance(s, 2) ? 1.0 : stage_whole(s, 2, 3);
    for (int c = 0; c < 4 && times > 1.0; c++)
        far_side(s, half[1].corner[c], times, half[1].corner[c]);
    bool is_split = stage_chance(s, 2);
    for (int i = 0; i < (is_split ? 4 : 2); i++)
        stage_put(s, is_split ? triangle_of(&half[i / 2], i % 2) : half[i], stage_any_sides(s), -1);
    put_behind(s, 16, x, y, (s->parallel ? 1.0 : times) * (z - 2));
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

// One number of one or more corners of the later sheet goes to a neighbouring float: what was an
// edge in common is a gap, an overlap, or both.
static void step_aside(stage *s, int sheet)
{
    occ_sheet *stepped = &stage_world_sheet(s, sheet)->sheet;
    for (int i = 0, steps = 1 + (int)steady_below(&s->random, 2); i < steps; i++) {
        uint32_t corner = steady_below(&s->random, stepped->corner_count);
        uint32_t axis = steady_below(&s->random, 3);
        float *number = &stepped->corner[corner][axis];
        *number = nextafterf(*number, stage_chance(s, 2) ? 1e16f : -1e16f);
    }
}

FAMILY(polygon_gap)
{
    look(s);
    double x = stage_whole(s, -2, 2), y = stage_whole(s, -2, 2), z = -stage_whole(s, 4, 12);
    double a = stage_whole(s, 2, 6), b = stage_whole(s, 2, 6);
    stage_sheet half[2] = {stage_quad(x - a, x, y - b, y + b, z),
                           stage_quad(x, x + a, y - b, y + b, z)};
    lean(s, half, 2);
    stage_put(s, half[0], stage_any_sides(s), -1);
    step_aside(s, stage_put(s, half[1], stage_any_sides(s), -1));
    put_behind(s, 16, x, y, z - 2);
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

enum { MOST_CELLS = 5 };

// Corners of a grid, some of them moved about: in the plane, or across it too.
static void grid_corners(stage *s, double z, double size, bool is_bent,
                         double corner[MOST_CELLS + 1][MOST_CELLS + 1][3])
{
    double by_x = 0.25 * stage_whole(s, -1, 1), by_y = 0.25 * stage_whole(s, -1, 1);
    for (int i = 0; i <= MOST_CELLS; i++)
        for (int k = 0; k <= MOST_CELLS; k++) {
            double *at = corner[i][k];
            at[0] = size * (i - 2) + stage_whole(s, -1, 1) * 0.25 * size;
            at[1] = size * (k - 2) + stage_whole(s, -1, 1) * 0.25 * size;
            at[2] = z + by_x * at[0] + by_y * at[1];
            if (is_bent) at[2] += stage_part(s, -1, 1);
        }
}

FAMILY(polygon_tiles)
{
    look(s);
    double corner[MOST_CELLS + 1][MOST_CELLS + 1][3], z = -stage_whole(s, 6, 12);
    double size = stage_whole(s, 1, 4);
    grid_corners(s, z, size, stage_chance(s, 3), corner);
    int across = (int)stage_whole(s, 2, MOST_CELLS), up = (int)stage_whole(s, 2, MOST_CELLS);
    occ_sides sides = stage_any_sides(s);
    for (int i = 0; i < 2 * across * up; i++) {
        int x = i / 2 % across, y = i / 2 / across;
        const double *quad[4] = {corner[x][y], corner[x + 1][y], corner[x + 1][y + 1],
                                 corner[x][y + 1]};
        stage_sheet tile = {.count = 3};
        for (int c = 0; c < 3; c++) // halves on either side of one of the diagonals
            memcpy(tile.corner[c], quad[(i % 2 ? c + 2 : c) % 4], sizeof tile.corner[c]);
        stage_put(s, tile, sides, -1);
    }
    double middle = size * (0.5 * across - 2), height = size * (0.5 * up - 2);
    put_behind(s, 18, middle, height, z - 2 * size);
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

// Octagons in rows of `across`, and the squares on their tips that fill the gaps between four.
FAMILY(polygon_octagons)
{
    look(s);
    int across = (int)stage_whole(s, 2, 4), up = (int)stage_whole(s, 2, 3), count = 0;
    double z = -stage_whole(s, 6, 14), size = stage_whole(s, 1, 3);
    stage_sheet sheets[24];
    for (int i = 0; i < across * up; i++) {
        int column = i % across, row = i / across;
        double x = 4 * size * (column - 1), y = 4 * size * (row - 1);
        sheets[count++] = stage_octagon(x, y, z, 2 * size, size);
        if (column == 0 || row == 0) continue;
        x -= 2 * size;
        y -= 2 * size;
        sheets[count++] = (stage_sheet){
            4, {{x - size, y, z}, {x, y - size, z}, {x + size, y, z}, {x, y + size, z}}};
    }
    lean(s, sheets, count);
    for (int i = 0; i < count; i++) {
        if (stage_chance(s, 8)) stage_turn_round(&sheets[i]);
        stage_put(s, sheets[i], stage_any_sides(s), -1);
    }
    put_behind(s, 8, 2 * size * stage_whole(s, -2, 2), 0, z - 4 * size);
    for (int i = 0; i < 8; i++) // where a corner is cut off, or just beside
        stage_on_rim(s, FAMILY_OCCLUDERS + i % (int)s->world->sheet_count);
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

// --- shapes --------------------------------------------------------------------------------------

static stage_sheet any_outline(stage *s, double z)
{
    double x = stage_whole(s, -3, 3), y = stage_whole(s, -3, 3), a = stage_whole(s, 2, 6);
    stage_sheet sheet = stage_octagon(x, y, z, a, 0.5 * a);
    uint32_t kind = steady_below(&s->random, 3);
    if (kind == 0) sheet = stage_quad(x - a, x + a, y - a, y + a, z);
    if (kind == 1) sheet.count = (uint32_t)stage_whole(s, 3, 7); // part of an octagon
    return sheet;
}

// In front of the surface, in it and behind, by steps that floats just tell apart.
static void put_near_surface(stage *s, const stage_sheet *sheet, int count)
{
    for (int i = 0; i < count; i++) {
        double middle[3] = {0, 0, 0};
        for (uint32_t c = 0; c < sheet->count; c++)
            for (int j = 0; j < 3; j++)
                middle[j] += sheet->corner[c][j] / sheet->count;
        double size = stage_part(s, 0, 1), depth = stage_chance(s, 2) ? 0.0 : stage_part(s, 0, 1);
        double off = stage_chance(s, 3) ? 0.0 : ldexp(1.0, -(int)stage_whole(s, 0, 22));
        middle[2] -= depth + (stage_chance(s, 4) ? -off : off);
        stage_object(s, stage_brick(middle[0], middle[1], middle[2], size, size, depth));
    }
}

FAMILY(polygon_bent)
{
    look(s);
    for (int i = 0; i < 4; i++) {
        stage_sheet sheet = any_outline(s, -stage_whole(s, 5, 14));
        if (stage_chance(s, 2)) lean(s, &sheet, 1);
        if (stage_chance(s, 3)) {
            double out = stage_part(s, -2, 2);
            sheet.corner[stage_chance(s, 3) ? 0 : 2][2] += out;
        }
        int put = stage_put(s, sheet, stage_any_sides(s), -1);
        if (stage_chance(s, 4)) continue;
        for (int times = (int)stage_whole(s, 1, 4); times > 0; times--)
            step_aside(s, put);
        put_near_surface(s, &sheet, 4);
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

FAMILY(polygon_needles)
{
    look(s);
    for (int i = 0; i < 5; i++) {
        double x = stage_whole(s, -3, 3), y = stage_whole(s, -3, 3), z = -stage_whole(s, 4, 14);
        double half = ldexp(1.0, -(int)stage_whole(s, 6, 10)), far = 0x1p11;
        stage_sheet sheet = stage_quad(x - half, x + half, y - far, y + far, z);
        if (stage_chance(s, 2)) sheet = stage_quad(x - far, x + far, y - half, y + half, z);
        if (stage_chance(s, 2)) sheet = triangle_of(&sheet, 0);
        if (stage_chance(s, 2)) lean(s, &sheet, 1);
        stage_put(s, sheet, stage_any_sides(s), -1);
        double size = half * stage_part(s, 0, 2);
        stage_object(s, stage_brick(x, y, z - stage_whole(s, 1, 8), size, size, size));
    }
    stage_put(s, stage_quad(-4, 4, -4, 4, -16), stage_any_sides(s), -1);
    stage_crowd(s, FAMILY_CROWD, stage_chance(s, 2) ? WORLD_NEEDLE : WORLD_SHAPES);
}

// An arrow head, a star, a bow, an outline that goes back on itself, corners that coincide, and
// corners in a line.
static stage_sheet odd_outline(stage *s, double z)
{
    static const struct {
        uint32_t count;
        double xy[8][2];
    } outlines[6] = {
        {4, {{0, -1}, {4, -4}, {0, 4}, {-4, -4}}},
        {8, {{0, -4}, {1, -1}, {4, 0}, {1, 1}, {0, 4}, {-1, 1}, {-4, 0}, {-1, -1}}},
        {4, {{-4, -2}, {4, 2}, {4, -2}, {-4, 2}}},
        {6, {{-4, -4}, {4, -4}, {4, 4}, {4, -4}, {-4, -4}, {-4, 4}}},
        {7, {{-4, -4}, {-4, -4}, {4, -4}, {4, 4}, {4, 4}, {-4, 4}, {-4, -4}}},
        {5, {{-4, -4}, {0, -4}, {4, -4}, {4, 4}, {0, 0}}},
    };
    uint32_t kind = steady_below(&s->random, 6), first = steady_below(&s->random, 8);
    double x = stage_whole(s, -2, 2), y = stage_whole(s, -2, 2), size = stage_part(s, 0.5, 2);
    stage_sheet sheet = {.count = outlines[kind].count};
    for (uint32_t c = 0; c < sheet.count; c++) {
        const double *at = outlines[kind].xy[(c + first) % sheet.count];
        sheet.corner[c][0] = x + size * at[0];
        sheet.corner[c][1] = y + size * at[1];
        sheet.corner[c][2] = z;
    }
    return sheet;
}

FAMILY(polygon_concave)
{
    look(s);
    for (int i = 0; i < 5; i++) {
        stage_sheet sheet = odd_outline(s, -stage_whole(s, 5, 14));
        if (stage_chance(s, 2)) lean(s, &sheet, 1);
        if (stage_chance(s, 2)) stage_turn_round(&sheet);
        for (uint32_t c = 0; stage_chance(s, 3) && c < sheet.count; c++)
            sheet.corner[c][2] += stage_part(s, -1, 1);
        stage_put(s, sheet, stage_any_sides(s), -1);
        put_behind(s, 3, sheet.corner[0][0], sheet.corner[0][1], -16);
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

// --- with boxes ----------------------------------------------------------------------------------

FAMILY(polygon_mixed)
{
    look(s);
    double x = stage_whole(s, -2, 2), y = stage_whole(s, -2, 2), z = -stage_whole(s, 6, 12);
    for (int i = 0; i < 9; i++) { // three by three, flush with their neighbours or over their rims
        int column = i % 3, row = i / 3;
        double left = x + 2 * column - 3, low = y + 2 * row - 3;
        double over = stage_chance(s, 2) ? 0.0 : stage_part(s, 0, 0.5);
        double thick = stage_chance(s, 2) ? 0.0 : stage_part(s, 0, 1);
        stage_sheet sheet = stage_quad(left - over, left + 2, low, low + 2 + over, z);
        if (stage_chance(s, 2))
            stage_put(s, sheet, stage_any_sides(s), -1);
        else
            stage_occluder(s, stage_brick(left + 1, low + 1, z - thick, 1 + over, 1 + over, thick),
                           -1);
    }
    int owner = stage_object(s, stage_brick(x, y, z - 3, 3, 3, 0.5)); // with a sheet as its front
    stage_put(s, stage_quad(x - 3, x + 3, y - 3, y + 3, z - 2.5), stage_any_sides(s), owner);
    put_behind(s, 14, x, y, z - 4);
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

// Owners around a sheet in one of their faces; decals, and boxes whose fronts or backs are in it.
FAMILY(polygon_flush)
{
    look(s);
    for (int i = 0; i < 4; i++) {
        stage_sheet sheet = any_outline(s, -stage_whole(s, 5, 14));
        double z = sheet.corner[0][2], depth = stage_part(s, 0.0625, 2);
        double back = stage_chance(s, 2) ? z - depth : z + depth;
        int owner = stage_chance(s, 2) ? stage_object(s, stage_brick(0, 0, back, 9, 9, depth)) : -1;
        stage_put(s, sheet, stage_any_sides(s), owner);
        for (int n = 0; n < 4; n++) {
            const stage_range about = stage_ones(-3, 3), size = stage_parts(0, 2);
            stage_box box = stage_any_brick(s, about, about, stage_just(z), size, size, size);
            if (stage_chance(s, 3)) box.axis[2][2] = 0.0;
            box.center[2] += box.axis[2][2] * stage_whole(s, -1, 1);
            stage_object(s, box);
        }
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}
