// SPDX-License-Identifier: Apache-2.0
// Families that live from the camera, from sheets, and from how many boxes there are.
#include "families.h"

// --- projections ---------------------------------------------------------------------------------

// Walls of every kind, one of them with an owner around it.
static void walls(stage *s)
{
    for (int i = 0; i < 4; i++) {
        stage_box box =
            stage_any_brick(s, stage_ones(-6, 6), stage_ones(-4, 4), stage_ones(-16, -6),
                            stage_ones(1, 5), stage_ones(1, 5), stage_ones(0, 2));
        if (i == 1) box = stage_any(s, WORLD_TURNED, box.center, 5);
        int occluder = stage_occluder(s, box, -1);
        box.axis[0][0] *= 1.25;
        if (i == 2) s->world->occluders[occluder].owner = stage_object(s, box);
    }
}

// Across the near and the far plane, or with a face in it, as far as the lens has few bits.
static void at_depths(stage *s, const world_lens *lens)
{
    for (int i = 0; i < 6; i++) {
        double depth = i % 2 ? (double)lens->far_z : (double)lens->near_z, center[3];
        double c = depth * stage_part(s, 0, 0.5), from = depth + c * stage_whole(s, -1, 1);
        for (int j = 0; j < 3; j++)
            center[j] = s->eye[j] - from * s->back[j];
        stage_object(s,
                     stage_brick(center[0], center[1], center[2], 0.25 * depth, 0.25 * depth, c));
    }
}

static void before_walls(stage *s, const world_lens *lens)
{
    stage_look_about(s, 4, lens);
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

// With its edge next to one of the side planes in that plane, or not quite, on either side of it.
// Up and down the picture reaches as far as it is deep, aside 16 for each 9: both on the grid.
static stage_box at_edge(stage *s)
{
    double deep = 9.0 * stage_whole(s, 1, 4), side = stage_sign(s);
    double off = stage_sliver(s, 1, 16);
    int axis = (int)stage_whole(s, 0, 1);
    const stage_range about = stage_parts(-4, 4), size = stage_parts(0, 2);
    stage_box box = stage_any_brick(s, about, about, stage_just(-deep), size, size, size);
    double half = box.axis[axis][axis], reach = axis ? deep : deep * 16.0 / 9.0;
    if (stage_chance(s, 2)) half = -half;
    if (stage_chance(s, 2)) reach += off;
    box.center[axis] = side * (reach + half);
    box.center[2] += box.axis[2][2]; // its far end is at the depth
    for (int j = 0; j < 3; j++)
        box.center[j] += s->eye[j];
    return box;
}

FAMILY(viewport_edge)
{
    double eye[3];
    const stage_range near_by = stage_ones(-2, 2);
    world_lens lens = stage_lens(s);
    lens.projection = stage_chance(s, 4) ? WORLD_INFINITE : WORLD_PERSPECTIVE;
    lens.height = 1.57079632679489662f;
    stage_point(s, near_by, near_by, near_by, eye);
    stage_look(s, eye, NULL, &lens);
    for (int i = 0; i < 20; i++) {
        stage_box box = at_edge(s);
        stage_object(s, box);
        for (int j = 0; j < 3; j++) {
            box.center[j] = 0.5 * (box.center[j] + eye[j]);
            box.axis[j][j] = j < 2 ? stage_whole(s, 1, 4) : 0.0;
        }
        if (i % 6 == 0) stage_occluder(s, box, -1); // before it, and through the plane
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

// --- how many ------------------------------------------------------------------------------------

FAMILY(few)
{
    world_lens lens = stage_lens(s);
    stage_look_about(s, 4, &lens);
    double center[3];
    stage_point(s, stage_ones(-1, 1), stage_ones(-1, 1), stage_ones(-8, -4), center);
    uint32_t kind = steady_below(&s->random, 8);
    if (kind >= 2) stage_occluder(s, stage_any(s, WORLD_SHAPES, center, 8), -1);
    switch (kind) {
    case 0: // nothing at all
    case 2: // nothing to hide
        break;
    case 1: // nothing that hides
    case 3: // an object about where the occluder is
        stage_object(s, stage_any(s, WORLD_SHAPES, center, 8));
        break;
    case 4: // its own occluder
        s->world->occluders[0].owner = stage_object(s, stage_any(s, WORLD_SHAPES, center, 8));
        break;
    default:
        stage_behind(s, 0, 1 + steady_unit(&s->random), WORLD_SHAPES);
    }
}

// --- sheets --------------------------------------------------------------------------------------

// In a plane through the eye that stands upright or leans, or tilted out of it by a little.
static stage_box edge_on(stage *s)
{
    double tilt = stage_sliver(s, 1, 24);
    double slope = stage_whole(s, -1, 1), up = stage_whole(s, -4, 4);
    stage_box sheet = {{s->eye[0] + slope * up, s->eye[1] + up, s->eye[2]}, {{0}, {0}, {0}}};
    sheet.center[2] -= stage_whole(s, 8, 16);
    sheet.axis[0][1] = stage_whole(s, 1, 4);
    sheet.axis[0][0] = slope * sheet.axis[0][1];
    sheet.axis[1][2] = stage_whole(s, 1, 4);
    if (stage_chance(s, 2)) sheet.axis[1][0] = tilt;
    return sheet;
}

FAMILY(sheets_edge_on)
{
    world_lens lens = stage_lens(s);
    stage_look_about(s, 4, &lens);
    for (int i = 0; i < 5; i++) {
        stage_box sheet = edge_on(s);
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

// Its axes in any order and with either sign; `zero` is the one that it lacks.
static stage_box one_sheet(stage *s, int *zero)
{
    double a = stage_signed(s, 1, 5), b = stage_signed(s, 1, 5);
    double lean = 0.5 * stage_whole(s, -2, 2);
    stage_box sheet = {{0}, {{0}, {0}, {0}}};
    int first = (int)stage_whole(s, 0, 2), second = (first + (int)stage_whole(s, 1, 2)) % 3;
    stage_point(s, stage_ones(-6, 6), stage_ones(-4, 4), stage_ones(-16, -6), sheet.center);
    sheet.axis[first][0] = a;
    sheet.axis[first][2] = lean * a;
    sheet.axis[second][1] = b;
    *zero = 3 - first - second;
    return sheet;
}

FAMILY(sheets_both_sides)
{
    world_lens lens = stage_lens(s);
    stage_look_about(s, 4, &lens);
    for (int i = 0; i < 4; i++) {
        int zero;
        stage_box sheet = one_sheet(s, &zero);
        stage_occluder(s, sheet, -1);
        for (int side = -1; side <= 1; side += 2) { // a slab on each side, flush or a little off
            stage_box slab = sheet;
            double thick = stage_part(s, 0.0625, 1), off = stage_chance(s, 2) ? 0.0 : 0.0625;
            slab.axis[zero][2] = thick;
            slab.center[2] += side * (thick + off);
            stage_object(s, slab);
        }
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

FAMILY(sheet_flush)
{
    world_lens lens = stage_lens(s);
    const stage_range size = stage_ones(1, 4);
    stage_look_about(s, 4, &lens);
    for (int i = 0; i < 4; i++) {
        stage_box bound = stage_any_brick(s, stage_ones(-6, 6), stage_ones(-4, 4),
                                          stage_ones(-16, -8), size, size, size);
        int object = stage_object(s, bound), face = (int)stage_whole(s, 0, 2);
        if (stage_chance(s, 2)) face = 2; // most of them the front
        double side = face == 2 && !stage_chance(s, 4) ? 1.0 : stage_sign(s);
        stage_box sheet = bound;
        sheet.center[face] += side * bound.axis[face][face];
        sheet.axis[face][face] = 0.0;
        stage_occluder(s, sheet, stage_chance(s, 4) ? -1 : object);
        for (int n = 0; n < 2; n++) { // others in it, and with a face in the same plane
            stage_box other = sheet;
            if (n) other.axis[face][face] = stage_part(s, 0, 1);
            other.center[face] -= side * other.axis[face][face];
            for (int j = 0; j < 3; j++)
                if (j != face && stage_chance(s, 2)) other.axis[j][j] *= 0.5;
            stage_object(s, other);
        }
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}
