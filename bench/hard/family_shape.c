// SPDX-License-Identifier: Apache-2.0
// Families that live from the shapes and sizes of boxes.
#include "families.h"

#include <math.h>
#include <string.h>

static void look(stage *s)
{
    world_lens lens = stage_lens(s);
    stage_look_about(s, 2, &lens);
}

static int put_ahead(stage *s, world_shape shape, double size)
{
    double center[3];
    stage_point(s, stage_ones(-4, 4), stage_ones(-4, 4), stage_ones(-16, -6), center);
    return stage_occluder(s, stage_any(s, shape, center, size), -1);
}

static stage_box solid(stage *s, double reach)
{
    return stage_any_brick(s, stage_ones(-4, 4), stage_ones(-4, 4), stage_ones(-16, -6),
                           stage_just(reach), stage_just(reach), stage_parts(0, 2));
}

// --- without thickness ---------------------------------------------------------------------------

// Whole numbers, with the last axes zero, or those behind the first in line with it.
static stage_box flat_box(stage *s, int zero, int parallel)
{
    stage_box box = solid(s, 1);
    for (int k = 0; k < 3; k++)
        for (int j = 0; j < 3; j++)
            box.axis[k][j] = stage_whole(s, -3, 3);
    for (int j = 0; j < 3; j++) {
        double first = box.axis[0][j];
        for (int k = 3 - zero; k < 3; k++)
            box.axis[k][j] = 0.0;
        for (int k = 1; k <= parallel; k++)
            box.axis[k][j] = first * (k == 1 ? -2.0 : 0.5);
    }
    return box;
}

FAMILY(zero_thickness)
{
    look(s);
    for (int i = 0; i < 3; i++)
        put_ahead(s, WORLD_SHEET, 8);
    stage_occluder(s, flat_box(s, 1, 0), -1);
    for (int i = 0; i < 8; i++) {
        stage_box box = flat_box(s, 1, 0);
        box.center[2] *= 2.0;
        stage_object(s, box);
    }
    stage_crowd(s, FAMILY_CROWD, stage_chance(s, 2) ? WORLD_SHEET : WORLD_SHAPES);
}

FAMILY(zero_area)
{
    look(s);
    put_ahead(s, WORLD_SHEET, 8);
    stage_occluder(s, solid(s, 4), -1);
    for (int i = 0; i < 3; i++)
        stage_occluder(s, i ? flat_box(s, 1, 1) : flat_box(s, 2, 0), -1);
    for (int i = 0; i < 8; i++) {
        stage_box box = stage_chance(s, 2) ? flat_box(s, 2, 0) : flat_box(s, 0, 2);
        box.center[2] *= 2.0;
        stage_object(s, box);
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SEGMENT);
}

FAMILY(zero_volume)
{
    look(s);
    put_ahead(s, WORLD_COPLANAR, 8);
    stage_occluder(s, solid(s, 4), -1);
    for (int i = 0; i < 3; i++)
        stage_occluder(s, i ? flat_box(s, 3, 0) : flat_box(s, 0, 1), -1);
    for (int i = 0; i < 8; i++) {
        stage_box box = flat_box(s, 0, 1);
        box.center[2] *= 2.0;
        stage_object(s, box);
    }
    stage_crowd(s, FAMILY_CROWD, stage_chance(s, 2) ? WORLD_POINT : WORLD_COPLANAR);
}

// --- proportions ---------------------------------------------------------------------------------

FAMILY(needles)
{
    look(s);
    for (int i = 0; i < 3; i++) {
        double size = world_scale(&s->random, 4, 64);
        put_ahead(s, stage_chance(s, 2) ? WORLD_NEEDLE : WORLD_PLATE, size);
    }
    stage_occluder(s, solid(s, 3), -1);
    stage_box pole = solid(s, 0x1p-8); // of 1 : 2^20, along x or y, exactly
    int along = (int)stage_whole(s, 0, 1);
    pole.axis[along][along] = 0x1p12;
    pole.axis[2][2] = 0x1p-8;
    stage_occluder(s, pole, -1);
    for (int i = 0; i < 6; i++) { // behind it and as long, or across it
        stage_box needle = pole;
        needle.center[2] -= stage_whole(s, 1, 8);
        for (int j = 0; j < 3; j++)
            needle.axis[j][j] *= stage_chance(s, 2) ? 0.5 : 1.0;
        if (stage_chance(s, 4)) needle.axis[1 - along][1 - along] = 4.0;
        stage_object(s, needle);
    }
    stage_crowd(s, FAMILY_CROWD, stage_chance(s, 2) ? WORLD_NEEDLE : WORLD_SHAPES);
}

FAMILY(scales)
{
    const double eye[3] = {0, 0, 0};
    world_lens lens = stage_lens(s);
    if (lens.projection == WORLD_ORTHOGRAPHIC) lens.projection = WORLD_PERSPECTIVE;
    lens.height = 1.0f;
    lens.near_z = 0x1p-30f;
    lens.far_z = 0x1p30f;
    stage_look(s, eye, NULL, &lens);
    const stage_range aside = stage_parts(-0.5, 0.5), size = stage_parts(0.0625, 0.5);
    for (int i = 0; i < 12; i++) { // each as large in the picture as the others
        double distance = ldexp(1.0, (int)stage_whole(s, -20, 16));
        stage_box box = stage_any_brick(s, aside, aside, stage_just(-1), size, size,
                                        (stage_range){0, 0.25, 0.25});
        for (int j = 0; j < 3; j++) {
            box.center[j] *= distance;
            box.axis[j][j] *= distance;
        }
        stage_occluder(s, box, -1);
    }
    for (int i = 0; i < 20; i++) {
        int occluder = (int)stage_whole(s, 0, 11);
        stage_behind(s, occluder, world_scale(&s->random, 1.001, 1e3), WORLD_SHAPES);
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

// The place is ten million local units off, whatever was asked for; floats step by about one unit
// there. Centers are whole numbers of two units, the eye is between them, and the detail is in the
// axes.
FAMILY(far_detail)
{
    double eye[3];
    for (int j = 0; j < 3; j++) {
        s->place[j] = s->length * 10027008.0 * stage_whole(s, -1, 1);
        eye[j] = stage_part(s, -1, 1);
    }
    world_lens lens = stage_lens(s);
    stage_look(s, eye, NULL, &lens);
    const stage_range ends = {0.999, 3.999, 1}, deep = {0, 1.999, 1.999};
    const stage_range near_by = {-4, 4, 2}, about = {-8, 8, 2}, millimetres = {0, 2, 0.001};
    for (int i = 0; i < 5; i++)
        stage_occluder(
            s, stage_any_brick(s, near_by, near_by, (stage_range){-12, -6, 2}, ends, ends, deep),
            -1);
    while (s->world->object_count < FAMILY_CROWD)
        stage_object(s, stage_any_brick(s, about, about, (stage_range){-20, -6, 2}, millimetres,
                                        millimetres, millimetres));
}

FAMILY(huge_occluder)
{
    look(s);
    double z = -stage_whole(s, 2, 8), huge = stage_whole(s, 1, 8) * 0x1p17;
    double depth = stage_chance(s, 2) ? 0.0 : huge;
    double side = stage_chance(s, 2) ? huge - stage_whole(s, 1, 4) : 0.0; // some end beside the eye
    stage_occluder(s, stage_brick(side, 0, z - depth, huge, huge, depth), -1);
    stage_occluder(s, stage_any(s, WORLD_TURNED, (double[3]){0, -huge, -huge}, huge), -1);
    for (int i = 0; i < 18; i++) {
        double tiny = world_scale(&s->random, 1e-4, 1e-1), center[3];
        double behind =
            stage_chance(s, 2) ? world_scale(&s->random, 1e-5, 1) : world_scale(&s->random, 1, 64);
        if (stage_chance(s, 8)) behind = -behind;
        stage_point(s, stage_parts(-4, 4), stage_parts(-4, 4), stage_just(z - behind), center);
        stage_object(s, stage_any(s, WORLD_SHAPES, center, tiny));
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

FAMILY(tiny_occluder)
{
    look(s);
    for (int i = 0; i < 4; i++) {
        double tiny = world_scale(&s->random, 1e-4, 1e-1), center[3];
        memcpy(center, s->eye, sizeof center);
        for (int j = 0; j < 3; j++)
            center[j] += tiny * world_between(&s->random, -0.5, 0.5) - 4.0 * tiny * s->back[j];
        if (stage_chance(s, 2)) center[2] -= 4.0;
        stage_occluder(s, stage_any(s, WORLD_SHAPES, center, 4.0 * tiny), -1);
    }
    for (int i = 0; i < 8; i++) {
        double huge = world_scale(&s->random, 1e2, 1e6), center[3];
        stage_point(s, stage_parts(-1, 1), stage_parts(-1, 1), stage_parts(-4, -0.25), center);
        for (int j = 0; j < 3; j++)
            center[j] *= huge;
        stage_object(s, stage_any(s, WORLD_SHAPES, center, huge));
    }
    for (int i = 0; i < 10; i++)
        stage_behind(s, i % 4, world_scale(&s->random, 10, 1e6), WORLD_SHAPES);
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

// --- axes ----------------------------------------------------------------------------------------

// The same world seen in a mirror: what the camera sees changes sides, nothing else.
static void mirror_camera(stage *s)
{
    float *m = s->world->camera.view_projection;
    for (int c = 0; c < 4; c++) {
        m[4 * c] = -m[4 * c];
        s->world->proj[4 * c] = -s->world->proj[4 * c];
    }
}

FAMILY(mirrored)
{
    look(s);
    if (stage_chance(s, 2)) mirror_camera(s);
    for (int i = 0; i < 4; i++) {
        int occluder = put_ahead(s, stage_chance(s, 2) ? WORLD_MIRRORED : WORLD_ALIGNED, 6);
        stage_box box = s->occluders[occluder];
        for (int k = 0; k < 3; k++) { // inside of it, with axes turned round
            double part = stage_sign(s) * 0.5;
            for (int j = 0; j < 3; j++)
                box.axis[k][j] *= part;
        }
        stage_object(s, box);
        for (int j = 0; j < 3; j++)
            box.center[j] += stage_whole(s, -1, 1) * s->occluders[occluder].axis[2][j];
        stage_object(s, box);
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_MIRRORED);
}

FAMILY(sheared)
{
    look(s);
    for (int i = 0; i < 4; i++) {
        stage_box box = solid(s, stage_whole(s, 1, 4));
        for (int k = 0; k < 3; k++) // whole shears keep every corner on the grid
            box.axis[k][(k + 1) % 3] += stage_whole(s, -4, 4);
        stage_occluder(s, box, -1);
        for (int j = 0; j < 3; j++)
            box.center[j] -= 2.0 * s->back[j] * box.axis[2][2];
        box.axis[0][1] += stage_whole(s, -1, 1);
        stage_object(s, box);
    }
    put_ahead(s, WORLD_SHEARED, 8);
    stage_crowd(s, FAMILY_CROWD, WORLD_SHEARED);
}

// --- the ends of float ---------------------------------------------------------------------------

// Either single numbers are denormal, or the whole world is.
FAMILY(denormal)
{
    if (stage_chance(s, 3)) {
        s->length *= 0x1p-130 / s->unit;
        s->unit = 0x1p-130;
        memset(s->place, 0, sizeof s->place);
    }
    look(s);
    double tiny = 0x1p-149 / s->unit;
    for (int i = 0; i < 4; i++) {
        stage_box box = solid(s, stage_whole(s, 1, 4));
        int level = (int)stage_whole(s, 0, 1);
        box.center[level] = tiny * stage_whole(s, -100, 100);
        box.axis[2][2] = tiny * stage_whole(s, 0, 2);
        box.axis[0][1] = tiny * stage_whole(s, -2, 2);
        stage_occluder(s, box, -1);
        for (int n = 0; n < 4; n++) {
            box.center[2] -= stage_whole(s, 0, 8);
            box.axis[n % 3][n % 3] = tiny * stage_whole(s, 0, 1 << 20);
            stage_object(s, box);
        }
    }
    stage_crowd(s, FAMILY_CROWD, WORLD_SHAPES);
}

// Whatever scale and offset were asked for: 2^8 units are nearly 1e15.
FAMILY(largest)
{
    double factor = s->length / s->unit;
    s->unit = world_few_bits(0x1.8p41 / factor, 8);
    s->length = s->unit * factor;
    memset(s->place, 0, sizeof s->place);
    look(s);
    const stage_range size = stage_ones(0, 64);
    for (int i = 0; i < 4; i++) {
        stage_occluder(s, solid(s, stage_whole(s, 1, 4)), -1);
        stage_object(s, stage_any_brick(s, (stage_range){-32, 32, 32}, stage_just(0),
                                        stage_ones(-128, -32), size, size, stage_just(8)));
    }
    for (int i = 0; i < 16; i++)
        stage_behind(s, i % 4, 1 + 4 * steady_unit(&s->random), WORLD_SHAPES);
}
