// SPDX-License-Identifier: Apache-2.0
// Families that live from the camera, from sheets, and from how many boxes there are.
#include "families.h"

#include <math.h>

// --- projections ---------------------------------------------------------------------------------

static void look_with(stage *s, const world_lens *lens)
{
    const double eye[3] = {stage_whole(s, -2, 2), stage_whole(s, -2, 2), stage_whole(s, -2, 2)};
    const double target[3] = {stage_part(s, -4, 4), stage_part(s, -4, 4), -16};
    stage_look(s, eye, stage_chance(s, 2) ? target : NULL, lens);
}

// Walls of every kind, one of them with an owner around it.
static void walls(stage *s)
{
    for (int i = 0; i < 4; i++) {
        double c = stage_chance(s, 2) ? 0.0 : stage_whole(s, 1, 2);
        stage_box box =
            stage_brick(stage_whole(s, -6, 6), stage_whole(s, -4, 4), -stage_whole(s, 6, 16) - c,
                        stage_whole(s, 1, 5), stage_whole(s, 1, 5), c);
        if (i == 1) box = stage_any(s, WORLD_TURNED, box.center, 5);
        int occluder = stage_occluder(s, box, -1);
        box.axis[0][0] *= 1.25;
        if (i == 2) s->world->occluders[occluder].owner = stage_object(s, box);
    }
}

// Across the near and the far plane, as exactly as the lens has them.
static void at_depths(stage *s, const world_lens *lens)
{
    for (int i = 0; i < 6; i++) {
        double depth = i % 2 ? (double)lens->far_z : (double)lens->near_z;
        double c = depth * stage_part(s, 0, 0.5), from = c * stage_whole(s, -1, 1), center[3];
        for (int j = 0; j < 3; j++)
            center[j] = s->eye[j] - (depth + from) * s->back[j];
        stage_object(s,
                     stage_brick(center[0], center[1], center[2], 0.25 * depth, 0.25 * depth, c));
    }
}

static void before_walls(stage *s, const world_lens *lens)
{
    look_with(s, lens);
    walls(s);
    at_depths(s, lens);
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

FAMILY(reversed_z)
{
    world_lens lens = stage_lens(s);
    lens.depth = OCC_DEPTH_ONE_TO_ZERO;
    before_walls(s, &lens);
}

static void with_projection(stage *s, world_projection projection)
{
    world_lens lens = stage_lens(s);
    if (lens.projection == WORLD_ORTHOGRAPHIC) lens.height = 1.0f;
    lens.projection = projection;
    if (projection == WORLD_ORTHOGRAPHIC) lens.height = (float)stage_whole(s, 8, 40);
    before_walls(s, &lens);
}

FAMILY(infinite_far)
{
    with_projection(s, WORLD_INFINITE);
}

FAMILY(orthographic)
{
    with_projection(s, WORLD_ORTHOGRAPHIC);
}

FAMILY(off_centre)
{
    with_projection(s, WORLD_OFF_CENTRE);
}

FAMILY(jittered)
{
    with_projection(s, WORLD_JITTERED);
}

// Up and down the picture reaches as far as it is deep, aside 16 for each 9: both on the grid.
FAMILY(viewport_edge)
{
    world_lens lens = stage_lens(s);
    lens.projection = stage_chance(s, 4) ? WORLD_INFINITE : WORLD_PERSPECTIVE;
    lens.height = 1.57079632679489662f;
    const double eye[3] = {stage_whole(s, -2, 2), stage_whole(s, -2, 2), stage_whole(s, -2, 2)};
    stage_look(s, eye, NULL, &lens);
    for (int i = 0; i < 20; i++) { // the corner or edge next to the plane is on it, or not quite
        double deep = 9.0 * stage_whole(s, 1, 4), half[3], center[3];
        double off = stage_chance(s, 2) ? 0.0 : ldexp(stage_sign(s), -(int)stage_whole(s, 1, 16));
        bool aside = stage_chance(s, 2), outside = stage_chance(s, 2);
        double side = stage_sign(s), reach = aside ? deep * 16.0 / 9.0 : deep;
        for (int j = 0; j < 3; j++)
            half[j] = stage_part(s, 0, 2);
        double from = (outside ? 1.0 : -1.0) * half[aside ? 0 : 1] + off;
        center[0] = eye[0] + (aside ? side * (reach + from) : stage_part(s, -4, 4));
        center[1] = eye[1] + (aside ? stage_part(s, -4, 4) : side * (reach + from));
        center[2] = eye[2] - deep + half[2]; // its far end is at the depth
        stage_object(s, stage_brick(center[0], center[1], center[2], half[0], half[1], half[2]));
        if (i % 6 == 0) // before it, and ending at the same plane or beyond it
            stage_occluder(s,
                           stage_brick(0.5 * (center[0] + eye[0]), 0.5 * (center[1] + eye[1]),
                                       0.5 * (center[2] + eye[2]), stage_whole(s, 1, 4),
                                       stage_whole(s, 1, 4), 0),
                           -1);
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

// --- how many ------------------------------------------------------------------------------------

FAMILY(few)
{
    world_lens lens = stage_lens(s);
    look_with(s, &lens);
    uint32_t kind = steady_below(&s->random, 8); // both, one of them, or none
    const double center[3] = {stage_whole(s, -1, 1), stage_whole(s, -1, 1), -stage_whole(s, 4, 8)};
    if (kind % 2) stage_occluder(s, stage_any(s, WORLD_SHAPES, center, 8), -1);
    if (kind == 7) {
        stage_object(s, stage_any(s, WORLD_SHAPES, center, 8));
        s->world->occluders[0].owner = 0;
    } else if (kind % 4 == 1 || kind == 3) {
        stage_behind(s, 0, 1 + steady_unit(&s->random), WORLD_SHAPES);
    } else if (kind < 6) {
        stage_object(s, stage_any(s, WORLD_SHAPES, center, 8));
    }
}

// --- sheets --------------------------------------------------------------------------------------

FAMILY(sheets_edge_on)
{
    world_lens lens = stage_lens(s);
    look_with(s, &lens);
    for (int i = 0; i < 5; i++) { // in a plane through the eye, or tilted out of it by a little
        double tilt = stage_chance(s, 2) ? 0.0 : ldexp(stage_sign(s), -(int)stage_whole(s, 1, 24));
        stage_box sheet = {
            {s->eye[0], s->eye[1] + stage_whole(s, -4, 4), s->eye[2] - stage_whole(s, 8, 16)},
            {{0, stage_whole(s, 1, 4), 0}, {0, 0, stage_whole(s, 1, 4)}, {0, 0, 0}}};
        int slope = (int)stage_whole(s, -1, 1); // the plane also leans against the axes
        sheet.axis[0][0] = slope * sheet.axis[0][1];
        sheet.center[0] += slope * (sheet.center[1] - s->eye[1]);
        sheet.axis[1][0] = tilt;
        stage_occluder(s, sheet, -1);
        for (int n = 0; n < 3; n++) { // behind it: in its plane, or astride
            stage_box box = sheet;
            box.center[2] -= stage_whole(s, 4, 20);
            if (n) box.axis[2][0] = stage_part(s, 0, 1);
            if (n == 2) box.axis[0][0] = box.axis[0][1] = 0.0;
            stage_object(s, box);
        }
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

FAMILY(sheets_both_sides)
{
    world_lens lens = stage_lens(s);
    look_with(s, &lens);
    for (int i = 0; i < 4; i++) { // axes in either order and with either sign
        double a = stage_sign(s) * stage_whole(s, 1, 5), b = stage_sign(s) * stage_whole(s, 1, 5);
        double lean = 0.5 * stage_whole(s, -2, 2);
        stage_box sheet = {{stage_whole(s, -6, 6), stage_whole(s, -4, 4), -stage_whole(s, 6, 16)},
                           {{0}, {0}, {0}}};
        int first = (int)stage_whole(s, 0, 2), second = (first + (int)stage_whole(s, 1, 2)) % 3;
        sheet.axis[first][0] = a;
        sheet.axis[first][2] = lean * a;
        sheet.axis[second][1] = b;
        stage_occluder(s, sheet, -1);
        for (int side = -1; side <= 1; side += 2) { // a slab on each side, flush or a little off
            stage_box slab = sheet;
            double thick = stage_part(s, 0.0625, 1), off = stage_chance(s, 2) ? 0.0 : 0.0625;
            slab.axis[3 - first - second][2] = thick;
            slab.center[2] += side * (thick + off);
            stage_object(s, slab);
        }
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

FAMILY(sheet_flush)
{
    world_lens lens = stage_lens(s);
    look_with(s, &lens);
    for (int i = 0; i < 4; i++) {
        stage_box bound =
            stage_brick(stage_whole(s, -6, 6), stage_whole(s, -4, 4), -stage_whole(s, 8, 16),
                        stage_whole(s, 1, 4), stage_whole(s, 1, 4), stage_whole(s, 1, 4));
        int object = stage_object(s, bound), face = (int)stage_whole(s, 0, 2);
        stage_box sheet = bound; // most of them the front
        if (stage_chance(s, 2)) face = 2;
        double side = face == 2 && !stage_chance(s, 4) ? 1.0 : stage_sign(s);
        sheet.center[face] += side * bound.axis[face][face];
        sheet.axis[face][face] = 0.0;
        stage_occluder(s, sheet, stage_chance(s, 4) ? -1 : object);
        for (int n = 0; n < 2; n++) { // others in it, and with a face in the same plane
            stage_box other = sheet;
            if (n) other.axis[face][face] = stage_part(s, 0, 1);
            if (n) other.center[face] -= side * other.axis[face][face];
            for (int j = 0; j < 3; j++)
                if (j != face) other.axis[j][j] *= stage_chance(s, 2) ? 0.5 : 1.0;
            stage_object(s, other);
        }
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}
