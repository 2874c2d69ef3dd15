// SPDX-License-Identifier: Apache-2.0
// Families that live from surfaces which meet, pass through each other, or nearly do.
#include "families.h"

#include <math.h>

static void look(stage *s)
{
    world_lens lens = stage_lens(s);
    stage_look_about(s, 2, &lens);
}

static stage_box whole_box(stage *s, int nearest, int farthest)
{
    double c = stage_chance(s, 3) ? 0.0 : stage_whole(s, 1, 3);
    stage_box box =
        stage_any_brick(s, stage_ones(-5, 5), stage_ones(-4, 4), stage_ones(-farthest, -nearest),
                        stage_ones(1, 6), stage_ones(1, 6), stage_just(c));
    box.center[2] -= c;
    return box;
}

// In a plane across z, or with the front or the back in it.
static stage_box in_plane(stage *s, double z, stage_range size, stage_range depth)
{
    stage_box box =
        stage_any_brick(s, stage_ones(-5, 5), stage_ones(-5, 5), stage_just(z), size, size, depth);
    if (stage_chance(s, 2)) box.axis[2][2] = 0.0;
    box.center[2] += box.axis[2][2] * stage_whole(s, -1, 1);
    return box;
}

FAMILY(coplanar)
{
    look(s);
    double z = -stage_whole(s, 6, 16);
    for (int i = 0; i < 4; i++)
        stage_occluder(s, in_plane(s, z, stage_ones(1, 5), stage_ones(1, 3)), -1);
    for (int i = 0; i < 12; i++)
        stage_object(s, in_plane(s, z, stage_parts(0, 3), stage_parts(0.0625, 3)));
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

// Outside of the box but for a face, an edge or a corner, or inside and flush with it.
static stage_box touch(stage *s, const stage_box *box)
{
    stage_box object = *box;
    int across = (int)stage_whole(s, 0, 2);
    for (int j = 0; j < 3; j++) {
        double whole = box->axis[j][j], half = stage_part(s, 0, 2), sign = stage_sign(s), reach;
        if (j == across || stage_chance(s, 6)) {
            reach = whole + half;
        } else if (stage_chance(s, 3)) {
            reach = whole - half;
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

// The same box, its axes in another order and with other signs.
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
            stage_box occluder = same_box(s, &box);
            stage_occluder(s, occluder, stage_chance(s, 2) ? object : -1);
        }
        stage_object(s, box);
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

// On the far side of a point as the camera sees it: for a perspective eye `times` as far.
static void far_side(const stage *s, const double point[3], double times, double out[3])
{
    for (int j = 0; j < 3; j++)
        out[j] = s->parallel ? point[j] - (j == 2 ? 4.0 * times : 0.0)
                             : s->eye[j] + times * (point[j] - s->eye[j]);
}

// Aligned, flush with a point or astride it in x.
static void put_at(stage *s, const double there[3], double a, double b, double c)
{
    double x = there[0] + a * stage_whole(s, -1, 1);
    stage_object(s, stage_brick(x, there[1], there[2], a, b, c));
}

// Two boxes that share the edge line at (x, y, z), next to each other, or the second so far behind
// that only the eye sees the edges meet. A third may close the upper end of the seam.
FAMILY(abutting)
{
    look(s);
    double x = stage_whole(s, -3, 3), y = stage_whole(s, -2, 2), z = -stage_whole(s, 6, 12);
    double a = stage_whole(s, 2, 6), b = stage_whole(s, 3, 8), thick = stage_whole(s, 0, 2);
    double times = stage_chance(s, 2) ? 1.0 : stage_whole(s, 2, 3), edge[3] = {x, y, z};
    stage_occluder(s, stage_brick(x - a, y, z - thick, a, b, thick), -1);
    if (times > 1.0) far_side(s, (double[3]){x, y, z}, times, edge);
    stage_occluder(
        s, stage_brick(edge[0] + a * times, edge[1], edge[2] - thick, a * times, b * times, thick),
        -1);
    if (stage_chance(s, 2))
        stage_occluder(s, stage_brick(x, y + b + 2, z - thick, a, 2, thick), -1);
    for (int i = 0; i < 16; i++) { // on the line of sight through the seam
        const double point[3] = {x, y + stage_whole(s, -1, 1), z};
        double there[3], half[3];
        far_side(s, point, times + stage_whole(s, 1, 3), there);
        stage_point(s, stage_parts(0, 1), stage_parts(0, 1), stage_parts(0, 1), half);
        there[2] -= 2 * thick;
        put_at(s, there, half[0], half[1], half[2]);
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

FAMILY(overlapping)
{
    look(s);
    double x = stage_whole(s, -2, 2), y = stage_whole(s, -2, 2), z = -stage_whole(s, 6, 12);
    for (int i = 0; i < 9; i++) { // three by three, each over its neighbours' rims
        int column = i % 3 - 1, row = i / 3 - 1;
        stage_box box = stage_any_brick(s, stage_just(x + 2 * column), stage_just(y + 2 * row),
                                        stage_parts(z - 2, z), stage_parts(1.0625, 1.75),
                                        stage_parts(1.0625, 1.75), stage_parts(0, 2));
        world_shape shape = (world_shape)steady_below(&s->random, WORLD_COPLANAR);
        if (stage_chance(s, 4)) box = stage_any(s, shape, box.center, 2.5);
        stage_occluder(s, box, -1);
    }
    for (int i = 0; i < 20; i++) {
        double point[3], there[3], size = world_scale(&s->random, 0.1, 3);
        stage_point(s, stage_parts(x - 2, x + 2), stage_parts(y - 2, y + 2), stage_just(z - 6),
                    point);
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
        int column = 2 * (i % across) - across + 1, row = 2 * (i / across) - up + 1;
        stage_box panel = stage_brick(a * column, b * row, z + lean * a * column, a, b, thick);
        panel.axis[0][2] = lean * a;
        stage_occluder(s, panel, -1);
    }
    for (int i = 0; i < 20; i++) {
        double point[3], there[3], size = world_scale(&s->random, 0.1, 6);
        stage_point(s, stage_parts(-a * across, a * across), stage_parts(-b * up, b * up),
                    stage_just(z - 4), point);
        far_side(s, point, 1 + steady_unit(&s->random), there);
        stage_object(s, stage_any(s, WORLD_SHAPES, there, size));
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

// Within an occluder, but for one end that sticks out by a little, ends flush, or stays inside.
static stage_box sticking_out(stage *s, const stage_box *box)
{
    stage_box object = *box;
    for (int j = 0; j < 3; j++) {
        object.axis[j][j] *= 0.5;
        object.center[j] += 0.5 * stage_whole(s, -2, 2) * object.axis[j][j];
    }
    int out = (int)stage_whole(s, 0, 2), places = (int)stage_whole(s, 2, 30);
    double half = object.axis[out][out];
    object.center[out] = box->center[out] + stage_sign(s) * half;
    object.axis[out][out] = half + ldexp(stage_whole(s, -1, 1), -places);
    return object;
}

FAMILY(interpenetrating)
{
    look(s);
    for (int i = 0; i < 3; i++)
        stage_occluder(s, whole_box(s, 5, 12), -1);
    for (int i = 0; i < 18; i++)
        stage_object(s, sticking_out(s, &s->occluders[i % 3]));
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

// The gap ends at x, where the right panel begins; its other end is by its own width to the left.
FAMILY(pixel_gap)
{
    look(s);
    double x = stage_whole(s, -2, 2), y = stage_whole(s, -2, 2), z = -stage_whole(s, 4, 12);
    double gap = ldexp(1.0, -(int)stage_whole(s, 4, 20)), thick = stage_chance(s, 2) ? 0.0 : 0.5;
    double a = stage_whole(s, 2, 6), b = stage_whole(s, 2, 6);
    if (stage_chance(s, 8)) gap = 0.0;
    stage_occluder(s, stage_brick(x - a, y, z, a - gap, b, thick), -1);
    stage_occluder(s, stage_brick(x + a, y, z, a, b, thick), -1);
    if (stage_chance(s, 2))
        stage_occluder(s, stage_brick(x, y + b + 2, z, 2 * a, 2 - gap, thick), -1);
    for (int i = 0; i < 14; i++) {
        double point[3] = {x, y + stage_whole(s, -1, 1), z}, there[3];
        if (stage_chance(s, 2)) point[0] -= gap;
        double size = stage_chance(s, 2) ? gap * stage_whole(s, 0, 4) : stage_part(s, 0, 1);
        far_side(s, point, stage_whole(s, 2, 4), there);
        there[2] -= thick;
        put_at(s, there, size, size, size);
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}
