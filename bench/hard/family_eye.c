// SPDX-License-Identifier: Apache-2.0
// Families that live from where the eye is.
#include "families.h"

// An eye at a whole point near the origin, and any camera from there: straight in half of them.
static void look(stage *s)
{
    double eye[3], target[3];
    world_lens lens = stage_lens(s);
    for (int j = 0; j < 3; j++) {
        eye[j] = stage_whole(s, -2, 2);
        target[j] = eye[j] + (j == 2 ? -16.0 : stage_part(s, -8, 8));
    }
    stage_look(s, eye, stage_chance(s, 2) ? target : NULL, &lens);
}

// Some occluder straight ahead, at a whole distance.
static int ahead(stage *s, int nearest, int farthest)
{
    double half[3] = {stage_whole(s, 1, 6), stage_whole(s, 1, 6),
                      stage_chance(s, 2) ? 0.0 : stage_whole(s, 1, 3)};
    return stage_occluder(s,
                          stage_brick(s->eye[0] + stage_whole(s, -4, 4),
                                      s->eye[1] + stage_whole(s, -4, 4),
                                      s->eye[2] - half[2] - stage_whole(s, nearest, farthest),
                                      half[0], half[1], half[2]),
                          -1);
}

// A box ahead, of whole numbers, of which some faces' planes across x and y hold the eye.
static stage_box level_box(stage *s, bool in_x, bool in_y)
{
    double a = stage_whole(s, 1, 6), b = stage_whole(s, 1, 6), c = stage_whole(s, 1, 6);
    double x = in_x ? stage_sign(s) * a : stage_whole(s, -6, 6);
    double y = in_y ? stage_sign(s) * b : stage_whole(s, -6, 6);
    return stage_brick(s->eye[0] + x, s->eye[1] + y, s->eye[2] - c - stage_whole(s, 2, 16), a, b,
                       c);
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

// A box with a corner at the eye, in the octant of the signs.
static stage_box cornered(stage *s, double x, double y, double z)
{
    double a = stage_whole(s, 1, 6), b = stage_whole(s, 1, 6), c = stage_whole(s, 1, 6);
    return stage_brick(s->eye[0] + x * a, s->eye[1] + y * b, s->eye[2] + z * c, a, b, c);
}

FAMILY(eye_corner)
{
    look(s);
    for (uint32_t i = 0, boxes = 1 + steady_below(&s->random, 3); i < boxes; i++)
        stage_occluder(s, cornered(s, stage_sign(s), stage_sign(s), stage_sign(s)), -1);
    ahead(s, 8, 16);
    ahead(s, 8, 16);
    stage_object(s, cornered(s, stage_sign(s), stage_sign(s), -1));
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

// Around the eye: wholly, or with the eye on one of its faces or edges.
static stage_box around(stage *s, int smallest, int largest)
{
    double half[3], from[3];
    for (int j = 0; j < 3; j++) {
        half[j] = stage_whole(s, smallest, largest);
        from[j] =
            stage_chance(s, 4) ? stage_sign(s) * half[j] : 0.5 * half[j] * stage_whole(s, -1, 1);
    }
    return stage_brick(s->eye[0] + from[0], s->eye[1] + from[1], s->eye[2] + from[2], half[0],
                       half[1], half[2]);
}

FAMILY(eye_in_occluder)
{
    look(s);
    for (uint32_t i = 0, boxes = 1 + steady_below(&s->random, 2); i < boxes; i++)
        stage_occluder(s, around(s, 2, 8), -1);
    if (stage_chance(s, 4)) { // in a sheet
        stage_occluder(s, stage_brick(s->eye[0], s->eye[1] + 1, s->eye[2], 8, 8, 0), -1);
    }
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
    stage_occluder(s, around(s, 16, 32), stage_chance(s, 2) ? 0 : -1);
    ahead(s, 4, 16);
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

FAMILY(occluder_behind_eye)
{
    look(s);
    for (int i = 0; i < 3; i++) {
        double half[3] = {stage_whole(s, 2, 16), stage_whole(s, 2, 16), stage_whole(s, 0, 4)};
        double z = s->eye[2] + stage_whole(s, 0, 8) + (stage_chance(s, 2) ? half[2] : 0.0);
        stage_occluder(s,
                       stage_brick(s->eye[0] + stage_whole(s, -20, 20),
                                   s->eye[1] + stage_whole(s, -4, 4), z, half[0], half[1], half[2]),
                       -1);
    }
    for (int i = 0; i < 8; i++) // where it would be, seen through the eye
        stage_behind(s, i % 3, -world_scale(&s->random, 0.1, 8), WORLD_SHAPES);
    ahead(s, 4, 16);
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

FAMILY(object_at_eye)
{
    look(s);
    ahead(s, 2, 4);
    ahead(s, 8, 16);
    stage_occluder(s, stage_brick(s->eye[0], s->eye[1], s->eye[2] - 20, 40, 40, 1), -1);
    for (int i = 0; i < 6; i++) {
        stage_object(s, around(s, 1, 4));
        stage_object(s, cornered(s, stage_sign(s), stage_sign(s), stage_sign(s)));
        double c = stage_whole(s, 0, 4); // behind the eye, some with a face at it
        stage_object(s, stage_brick(s->eye[0] + stage_whole(s, -4, 4),
                                    s->eye[1] + stage_whole(s, -4, 4),
                                    s->eye[2] + c + stage_whole(s, 0, 2), stage_whole(s, 0, 4),
                                    stage_whole(s, 0, 4), c));
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

// Straight ahead, with the near plane at a whole distance.
static double look_past_near(stage *s)
{
    const double eye[3] = {stage_whole(s, -2, 2), stage_whole(s, -2, 2), stage_whole(s, -2, 2)};
    world_lens lens = stage_lens(s);
    lens.near_z = (float)stage_whole(s, 1, 4);
    stage_look(s, eye, NULL, &lens);
    return eye[2] - (double)lens.near_z;
}

// Behind the plane across z, touching it, through it, in it, or beyond it.
static stage_box at_plane(stage *s, double z)
{
    double a = stage_part(s, 0, 4), b = stage_part(s, 0, 4), c = stage_part(s, 0, 2);
    double from = stage_chance(s, 2) ? c * stage_whole(s, -1, 1) : stage_part(s, -2, 2);
    if (stage_chance(s, 8)) c = 0.0;
    return stage_brick(s->eye[0] + stage_whole(s, -2, 2), s->eye[1] + stage_whole(s, -2, 2),
                       z + from, a, b, c);
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
