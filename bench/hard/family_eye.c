// SPDX-License-Identifier: Apache-2.0
// Families that live from where the eye is.
#include "families.h"

static void look(stage *s)
{
    world_lens lens = stage_lens(s);
    stage_look_about(s, 8, &lens);
}

// Whole numbers around one of the eye's coordinates.
static stage_range about(const stage *s, int axis, double low, double high)
{
    return stage_ones(s->eye[axis] + low, s->eye[axis] + high);
}

// Some occluder straight ahead, at a whole distance.
static int ahead(stage *s, int nearest, int farthest)
{
    double c = stage_chance(s, 2) ? 0.0 : stage_whole(s, 1, 3);
    const stage_range size = stage_ones(1, 6);
    stage_box box = stage_any_brick(s, about(s, 0, -4, 4), about(s, 1, -4, 4),
                                    about(s, 2, -farthest, -nearest), size, size, stage_just(c));
    box.center[2] -= c;
    return stage_occluder(s, box, -1);
}

// A box ahead, of whole numbers, of which some faces' planes across x and y hold the eye.
static stage_box level_box(stage *s, bool in_x, bool in_y)
{
    const stage_range size = stage_ones(1, 6);
    stage_box box = stage_any_brick(s, about(s, 0, -6, 6), about(s, 1, -6, 6), about(s, 2, -16, -2),
                                    size, size, size);
    box.center[2] -= box.axis[2][2];
    if (in_x) box.center[0] = s->eye[0] + stage_sign(s) * box.axis[0][0];
    if (in_y) box.center[1] = s->eye[1] + stage_sign(s) * box.axis[1][1];
    return box;
}

FAMILY(eye_face_plane)
{
    look(s);
    for (int i = 0; i < 3; i++) {
        bool in_x = stage_chance(s, 2);
        stage_box box = level_box(s, in_x, !in_x);
        if (stage_chance(s, 4)) { // beside the eye, its front level with it
            box = stage_brick(s->eye[0] + 8, s->eye[1], s->eye[2] - 4, stage_whole(s, 1, 7), 4, 4);
        }
        stage_occluder(s, box, -1);
        box.center[2] -= stage_whole(s, 8, 24); // behind it and in the same plane, astride or flat
        int axis = in_x ? 0 : 1;
        if (stage_chance(s, 2)) box.center[axis] = s->eye[axis];
        if (stage_chance(s, 2)) box.axis[axis][axis] = 0.0;
        stage_object(s, box);
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

FAMILY(eye_edge_line)
{
    look(s);
    for (int i = 0; i < 3; i++) {
        stage_box box = level_box(s, true, true);
        stage_occluder(s, box, -1);
        double depth = stage_whole(s, 0, 4), z = box.center[2] - stage_whole(s, 4, 24);
        stage_object(s, stage_brick(s->eye[0], s->eye[1], z, 0, 0, depth)); // on the line
        double x = s->eye[0] + (box.center[0] > s->eye[0] ? 2.0 : -2.0);
        double y = s->eye[1] + (box.center[1] > s->eye[1] ? 2.0 : -2.0);
        stage_object(s, stage_brick(x, y, z, 2, 2, depth)); // with an edge on it
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

// A box with a corner at the eye, ahead of it or in any octant.
static stage_box cornered(stage *s, bool is_ahead)
{
    const stage_range size = stage_ones(1, 6);
    stage_box box =
        stage_any_brick(s, stage_just(0), stage_just(0), stage_just(0), size, size, size);
    for (int j = 0; j < 3; j++) {
        double sign = j == 2 && is_ahead ? -1.0 : stage_sign(s);
        box.center[j] = s->eye[j] + sign * box.axis[j][j];
    }
    return box;
}

FAMILY(eye_corner)
{
    look(s);
    for (uint32_t i = 0, boxes = 1 + steady_below(&s->random, 3); i < boxes; i++)
        stage_occluder(s, cornered(s, false), -1);
    ahead(s, 8, 16);
    ahead(s, 8, 16);
    stage_object(s, cornered(s, true));
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

// Around the eye: wholly, or with the eye on some of its faces.
static stage_box around(stage *s, int smallest, int largest)
{
    const stage_range size = stage_ones(smallest, largest);
    stage_box box =
        stage_any_brick(s, stage_just(0), stage_just(0), stage_just(0), size, size, size);
    for (int j = 0; j < 3; j++) {
        double part = stage_chance(s, 4) ? stage_sign(s) : 0.5 * stage_whole(s, -1, 1);
        box.center[j] = s->eye[j] + part * box.axis[j][j];
    }
    return box;
}

FAMILY(eye_in_occluder)
{
    look(s);
    for (uint32_t i = 0, boxes = 1 + steady_below(&s->random, 2); i < boxes; i++)
        stage_occluder(s, around(s, 2, 8), -1);
    if (stage_chance(s, 4)) // in a sheet
        stage_occluder(s, stage_brick(s->eye[0], s->eye[1] + 1, s->eye[2], 8, 8, 0), -1);
    ahead(s, 2, 16);
    ahead(s, 8, 16);
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

FAMILY(eye_in_object)
{
    look(s);
    for (int i = 0; i < 4; i++)
        stage_object(s, around(s, 1, i < 2 ? 4 : 64));
    int occluder = ahead(s, 2, 12);
    stage_box owner = s->occluders[occluder];
    owner.axis[0][0] += 1.0;
    s->world->occluders[occluder].owner = stage_object(s, owner);
    stage_box shell = around(s, 16, 32);
    stage_occluder(s, shell, stage_chance(s, 2) ? 0 : -1);
    ahead(s, 4, 16);
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

FAMILY(occluder_behind_eye)
{
    look(s);
    for (int i = 0; i < 3; i++) {
        stage_box box =
            stage_any_brick(s, about(s, 0, -20, 20), about(s, 1, -4, 4), about(s, 2, 0, 8),
                            stage_ones(2, 16), stage_ones(2, 16), stage_ones(0, 4));
        if (stage_chance(s, 2)) box.center[2] += box.axis[2][2];
        stage_occluder(s, box, -1);
    }
    for (int i = 0; i < 8; i++) // where it would be, seen through the eye
        stage_behind(s, i % 3, -world_scale(&s->random, 0.1, 8), WORLD_SHAPES);
    ahead(s, 4, 16);
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

FAMILY(object_at_eye)
{
    const stage_range size = stage_ones(0, 4);
    look(s);
    ahead(s, 2, 4);
    ahead(s, 8, 16);
    stage_occluder(s, stage_brick(s->eye[0], s->eye[1], s->eye[2] - 20, 40, 40, 1), -1);
    for (int i = 0; i < 6; i++) {
        stage_object(s, around(s, 1, 4));
        stage_object(s, cornered(s, false));
        stage_box box = stage_any_brick(s, about(s, 0, -4, 4), about(s, 1, -4, 4),
                                        about(s, 2, 0, 2), size, size, size);
        box.center[2] += box.axis[2][2]; // behind the eye, some with a face at it
        stage_object(s, box);
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

// Straight ahead, with the near plane at a whole distance.
static double look_past_near(stage *s)
{
    double eye[3];
    const stage_range near_by = stage_ones(-2, 2);
    stage_point(s, near_by, near_by, near_by, eye);
    world_lens lens = stage_lens(s);
    lens.near_z = (float)stage_whole(s, 1, 4);
    stage_look(s, eye, NULL, &lens);
    return eye[2] - (double)lens.near_z;
}

// Behind the plane across z, touching it, through it, in it, or beyond it.
static stage_box at_plane(stage *s, double z)
{
    stage_box box = stage_any_brick(s, about(s, 0, -2, 2), about(s, 1, -2, 2), stage_just(z),
                                    stage_parts(0, 4), stage_parts(0, 4), stage_parts(0, 2));
    if (stage_chance(s, 8)) {
        box.axis[2][2] = 0.0;
    } else if (stage_chance(s, 2)) {
        box.center[2] += box.axis[2][2] * stage_whole(s, -1, 1);
    } else {
        box.center[2] += stage_part(s, -2, 2);
    }
    return box;
}

FAMILY(object_at_near)
{
    double z = look_past_near(s);
    ahead(s, 6, 16);
    stage_occluder(s, stage_brick(s->eye[0], s->eye[1], z - 1, stage_whole(s, 1, 4), 4, 0), -1);
    for (int i = 0; i < 14; i++)
        stage_object(s, at_plane(s, z));
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

FAMILY(occluder_at_near)
{
    double z = look_past_near(s);
    for (int i = 0; i < 4; i++)
        stage_occluder(s, at_plane(s, z), -1);
    ahead(s, 6, 16);
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}
