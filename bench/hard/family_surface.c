// SPDX-License-Identifier: Apache-2.0
// Families that live from surfaces which meet, pass through each other, or nearly do.
#include "families.h"

#include <math.h>

static void look(stage *s)
{
    const double eye[3] = {stage_whole(s, -2, 2), stage_whole(s, -2, 2), stage_whole(s, -2, 2)};
    const double target[3] = {stage_part(s, -2, 2), stage_part(s, -2, 2), -16};
    world_lens lens = stage_lens(s);
    stage_look(s, eye, stage_chance(s, 2) ? target : NULL, &lens);
}

static stage_box whole_box(stage *s, int nearest, int farthest)
{
    double c = stage_chance(s, 3) ? 0.0 : stage_whole(s, 1, 3);
    return stage_brick(stage_whole(s, -5, 5), stage_whole(s, -4, 4),
                       -c - stage_whole(s, nearest, farthest), stage_whole(s, 1, 6),
                       stage_whole(s, 1, 6), c);
}

FAMILY(coplanar)
{
    look(s);
    double z = -stage_whole(s, 6, 16);
    for (int i = 0; i < 4; i++) { // fronts, backs and sheets in the plane
        double c = stage_chance(s, 2) ? 0.0 : stage_whole(s, 1, 3);
        double side = c * stage_whole(s, -1, 1);
        stage_occluder(s,
                       stage_brick(stage_whole(s, -5, 5), stage_whole(s, -5, 5), z + side,
                                   stage_whole(s, 1, 5), stage_whole(s, 1, 5), c),
                       -1);
    }
    for (int i = 0; i < 12; i++) {
        double c = stage_chance(s, 2) ? 0.0 : stage_part(s, 0.0625, 3);
        stage_object(s, stage_brick(stage_whole(s, -5, 5), stage_whole(s, -5, 5),
                                    z + c * stage_whole(s, -1, 1), stage_part(s, 0, 3),
                                    stage_part(s, 0, 3), c));
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

// From each side of the box in turn, flush with some of its faces, edges or corners.
static stage_box touch(stage *s, const stage_box *box)
{
    stage_box object = *box;
    int across = (int)stage_whole(s, 0, 2);
    for (int j = 0; j < 3; j++) {
        double whole = box->axis[j][j], half = stage_part(s, 0, 2), reach;
        double sign = stage_sign(s);
        if (j == across || stage_chance(s, 6)) {
            reach = whole + half; // outside, touching
        } else if (stage_chance(s, 3)) {
            reach = whole - half; // inside, flush
        } else {
            reach = 0.5 * stage_whole(s, 0, 2) * whole;
        }
        object.center[j] += sign * reach;
        object.axis[j][j] = half;
    }
    return object;
}

FAMILY(touching)
{
    look(s);
    for (int i = 0; i < 3; i++)
        stage_occluder(s, whole_box(s, 6, 16), -1);
    for (int i = 0; i < 18; i++)
        stage_object(s, touch(s, &s->occluders[i % 3]));
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

// The same box, its axes in another order or with other signs.
static stage_box same_box(stage *s, const stage_box *box)
{
    stage_box same = *box;
    int first = (int)stage_whole(s, 0, 2);
    for (int k = 0; k < 3; k++) {
        double sign = stage_sign(s);
        for (int j = 0; j < 3; j++)
            same.axis[(k + first) % 3][j] = sign * box->axis[k][j];
    }
    return same;
}

FAMILY(identical)
{
    look(s);
    for (int i = 0; i < 3; i++) {
        stage_box box = whole_box(s, 4, 16);
        if (stage_chance(s, 3)) box = stage_any(s, WORLD_SHAPES, box.center, 4);
        for (uint32_t n = 0, times = 1 + steady_below(&s->random, 4); n < times; n++) {
            int object = stage_object(s, same_box(s, &box));
            stage_occluder(s, same_box(s, &box), stage_chance(s, 2) ? object : -1);
        }
        stage_object(s, box);
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

// On the far side of a point as the camera sees it: for a perspective eye by whole times.
static void far_side(const stage *s, const double point[3], double times, double out[3])
{
    for (int j = 0; j < 3; j++)
        out[j] = s->parallel ? point[j] - (j == 2 ? 4.0 * times : 0.0)
                             : s->eye[j] + times * (point[j] - s->eye[j]);
}

FAMILY(abutting)
{
    look(s);
    // Two boxes that share the edge line at (x, y, z), next to each other or one behind the other
    // with the second's edge behind the first's; a third and fourth close the ends of the seam.
    double x = stage_whole(s, -3, 3), z = -stage_whole(s, 6, 12), thick = stage_whole(s, 0, 2);
    double a = stage_whole(s, 2, 6), b = stage_whole(s, 3, 8), y = stage_whole(s, -2, 2);
    stage_occluder(s, stage_brick(x - a, y, z - thick, a, b, thick), -1);
    double times = stage_chance(s, 2) ? 1.0 : stage_whole(s, 2, 3), edge[3];
    const double seam[3] = {x, y, z};
    far_side(s, seam, times, edge);
    if (times == 1.0) edge[2] = z;
    stage_occluder(
        s, stage_brick(edge[0] + a * times, edge[1], edge[2] - thick, a * times, b * times, thick),
        -1);
    if (stage_chance(s, 2)) // a cross of four
        stage_occluder(s, stage_brick(x, y + b + 2, z - thick, a, 2, thick), -1);
    for (int i = 0; i < 16; i++) { // astride the line of sight through the seam
        double there[3], size = stage_part(s, 0, 1);
        const double point[3] = {x, y + stage_whole(s, -1, 1), z};
        far_side(s, point, times + stage_whole(s, 1, 3), there);
        stage_object(s, stage_brick(there[0] + size * stage_whole(s, -1, 1), there[1],
                                    there[2] - 2 * thick, size, stage_part(s, 0, 1),
                                    stage_part(s, 0, 1)));
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

FAMILY(overlapping)
{
    look(s);
    double x = stage_whole(s, -2, 2), y = stage_whole(s, -2, 2), z = -stage_whole(s, 6, 12);
    for (int i = 0; i < 6; i++) { // around one place, each over a part of it
        const double center[3] = {x + stage_part(s, -3, 3), y + stage_part(s, -3, 3),
                                  z - stage_part(s, 0, 3)};
        stage_box box = stage_brick(center[0], center[1], center[2], stage_part(s, 1, 4),
                                    stage_part(s, 1, 4), stage_part(s, 0, 2));
        if (stage_chance(s, 2))
            box = stage_any(s, (world_shape)steady_below(&s->random, WORLD_COPLANAR), center, 5);
        stage_occluder(s, box, -1);
    }
    for (int i = 0; i < 16; i++) {
        const double point[3] = {x, y, z - 6};
        double there[3], size = world_scale(&s->random, 0.3, 4);
        far_side(s, point, 1 + steady_unit(&s->random), there);
        stage_object(s, stage_any(s, WORLD_SHAPES, there, size));
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

FAMILY(panels)
{
    look(s);
    int across = (int)stage_whole(s, 2, 8), up = (int)stage_whole(s, 2, 8);
    double a = 0.5 * stage_whole(s, 1, 4), b = 0.5 * stage_whole(s, 1, 4);
    double z = -stage_whole(s, 6, 12), lean = 0.25 * stage_whole(s, -1, 1);
    double thick = stage_chance(s, 2) ? 0.0 : 0.25;
    for (int i = 0; i < across * up; i++) {
        double x = a * (2 * (i % across) - across + 1), y = b * (2 * (i / across) - up + 1);
        stage_box panel = stage_brick(x, y, z + lean * x, a, b, thick);
        panel.axis[0][2] = lean * a;
        stage_occluder(s, panel, -1);
    }
    for (int i = 0; i < 20; i++) {
        const double point[3] = {a * across * world_between(&s->random, -1, 1),
                                 b * up * world_between(&s->random, -1, 1), z - 4};
        double there[3];
        far_side(s, point, 1 + steady_unit(&s->random), there);
        stage_object(s, stage_any(s, WORLD_SHAPES, there, world_scale(&s->random, 0.1, 6)));
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

FAMILY(interpenetrating)
{
    look(s);
    for (int i = 0; i < 3; i++)
        stage_occluder(s, whole_box(s, 5, 12), -1);
    for (int i = 0; i < 18; i++) { // within, but for one end that sticks out by a little or nothing
        stage_box box = s->occluders[i % 3];
        for (int j = 0; j < 3; j++) {
            double half = 0.5 * box.axis[j][j], slack = stage_chance(s, 2) ? half : 0.25 * half;
            box.center[j] += slack * stage_whole(s, -1, 1);
            box.axis[j][j] = half;
        }
        int out = (int)stage_whole(s, 0, 2);
        double by = ldexp(1.0, -(int)stage_whole(s, 2, 30)) * stage_whole(s, -1, 1);
        double whole = s->occluders[i % 3].axis[out][out];
        box.center[out] = s->occluders[i % 3].center[out] + stage_sign(s) * 0.5 * whole;
        box.axis[out][out] = 0.5 * whole + by;
        stage_object(s, box);
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

FAMILY(pixel_gap)
{
    look(s);
    double z = -stage_whole(s, 4, 12), x = stage_whole(s, -2, 2), y = stage_whole(s, -2, 2);
    double gap = stage_chance(s, 8) ? 0.0 : ldexp(1.0, -(int)stage_whole(s, 4, 20));
    double thick = stage_chance(s, 2) ? 0.0 : 0.5, a = stage_whole(s, 2, 6),
           b = stage_whole(s, 2, 6);
    // The gap is beside the line through the eye, by its own width: the right one begins there.
    stage_occluder(s, stage_brick(x - a, y, z, a - gap, b, thick), -1);
    stage_occluder(s, stage_brick(x + a, y, z, a, b, thick), -1);
    if (stage_chance(s, 2))
        stage_occluder(s, stage_brick(x, y + b + 2, z, 2 * a, 2 - gap, thick), -1);
    for (int i = 0; i < 14; i++) {
        const double point[3] = {x - (stage_chance(s, 2) ? gap : 0.0), y + stage_whole(s, -1, 1),
                                 z};
        double there[3],
            size = stage_chance(s, 2) ? gap * stage_whole(s, 0, 4) : stage_part(s, 0, 1);
        far_side(s, point, stage_whole(s, 2, 4), there);
        stage_object(s, stage_brick(there[0] + size * stage_whole(s, -1, 1), there[1],
                                    there[2] - thick, size, size, size));
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}
