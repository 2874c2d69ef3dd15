// SPDX-License-Identifier: Apache-2.0
#include "crowds.h"

#include <check.h>
#include <math.h>

void crowd_put(crowd *c, const occ_box *box, int owner)
{
    ck_assert_uint_lt(c->occluder_count, CROWD_OCCLUDERS);
    c->occluders[c->occluder_count++] = (world_occluder){*box, owner};
}

static void any_camera(kit_random *random, crowd *c)
{
    float scale = c->scale;
    world_lens lens = {.projection = (world_projection)kit_below(random, WORLD_PROJECTIONS),
                       .depth = (occ_depth)kit_below(random, 3),
                       .near_z = 0.05f * scale,
                       .far_z = 1000 * scale};
    if (lens.projection == WORLD_ORTHOGRAPHIC) lens.height = 20 * scale;
    float eye[3], target[3];
    for (int j = 0; j < 3; j++) {
        target[j] = scale * kit_between(random, -1, 1);
        eye[j] = scale * (j == 2 ? 12.0f : kit_between(random, -4, 4));
        c->eye[j] = (double)eye[j];
    }
    c->camera = world_camera(eye, target, &lens);
    if (lens.projection != WORLD_ORTHOGRAPHIC && kit_below(random, 2)) c->camera.eye = c->eye;
}

static void begin(kit_random *random, crowd *c, uint32_t objects)
{
    *c = (crowd){.scale = ldexpf(1, (int)kit_below(random, 40) - 20)};
    ck_assert_uint_le(objects, CROWD_OBJECTS);
    any_camera(random, c);
}

// Owners hold what they own, unless the world is strange.
static void hold_occluders(kit_random *random, crowd *c)
{
    for (uint32_t k = 0; k < c->occluder_count && !c->strange; k++) {
        int owner = c->occluders[k].owner;
        if (owner < 0) continue;
        c->objects[owner] = world_scaled(&c->occluders[k].box, 1.0f + kit_between(random, 0, 0.5f));
        for (int j = 0; j < 3; j++)
            c->objects[owner].center[j] = c->occluders[k].box.center[j];
    }
}

void crowd_about(kit_random *random, crowd *c, uint32_t objects)
{
    begin(random, c, objects);
    double scale = (double)c->scale;
    c->strange = kit_below(random, 4) == 0;
    for (int i = 0; i < 12; i++) {
        double center[3];
        for (int j = 0; j < 3; j++)
            center[j] = scale * world_between(random, -3, 3);
        center[2] += 2.0 * scale;
        world_shape shape = (world_shape)kit_below(random, WORLD_COPLANAR);
        occ_box box = world_box(random, shape, center, scale * world_between(random, 0.3, 1.6));
        int owner = kit_below(random, 4) ? -1 : (int)kit_below(random, objects);
        for (uint32_t k = 0; k < c->occluder_count && !c->strange; k++)
            if (c->occluders[k].owner == owner) owner = -1;
        crowd_put(c, &box, owner);
    }
    for (; c->object_count < objects; c->object_count++) {
        double center[3];
        for (int j = 0; j < 3; j++)
            center[j] = scale * world_between(random, -4, 4);
        center[2] -= 6.0 * scale;
        c->objects[c->object_count] =
            world_box(random, (world_shape)kit_below(random, WORLD_SHAPES), center,
                      scale * world_scale(random, 0.05, 2));
    }
    hold_occluders(random, c);
}

void crowd_panels(kit_random *random, crowd *c, uint32_t objects)
{
    begin(random, c, objects);
    float scale = c->scale;
    int across = 1 + (int)kit_below(random, 4), up = 1 + (int)kit_below(random, 4);
    float width = scale * 8.0f / (float)across, height = scale * 8.0f / (float)up;
    float thickness = kit_below(random, 2) ? 0.0f : 0.1f * scale;
    double grow = kit_below(random, 3) ? world_scale(random, 1e-8, 1e-2) : 0.0;
    if (kit_below(random, 4) == 0) grow = -grow;
    double lean = kit_below(random, 2) ? world_between(random, -0.5, 0.5) : 0.0;
    for (int x = 0; x < across; x++)
        for (int y = 0; y < up; y++) {
            occ_box box = {{0}, {{0}}};
            box.center[0] = ((float)x + 0.5f) * width - 4 * scale;
            box.center[1] = ((float)y + 0.5f) * height - 4 * scale;
            box.center[2] = (float)(lean * (double)box.center[0]) + scale * 4;
            box.axis[0][0] = (float)(0.5 * (double)width * (1.0 + grow));
            box.axis[0][2] = (float)(lean * (double)box.axis[0][0]);
            box.axis[1][1] = (float)(0.5 * (double)height * (1.0 + grow));
            box.axis[2][2] = thickness;
            crowd_put(c, &box, -1);
        }
    for (; c->object_count < objects; c->object_count++) {
        double center[3];
        for (int j = 0; j < 3; j++)
            center[j] = (double)scale * world_between(random, -4, 4);
        center[2] -= 4.0 * (double)scale;
        c->objects[c->object_count] =
            world_box(random, (world_shape)kit_below(random, WORLD_SHAPES), center,
                      (double)scale * world_scale(random, 0.05, 3));
    }
}

// A box somewhere about the eye: in any direction, and rather near.
static occ_box box_around(kit_random *random, const crowd *c, double nearest, double farthest)
{
    double center[3], direction[3], distance = world_scale(random, nearest, farthest);
    world_direction(random, direction);
    for (int j = 0; j < 3; j++)
        center[j] = c->eye[j] + (double)c->scale * distance * direction[j];
    return world_box(random, (world_shape)kit_below(random, WORLD_COPLANAR), center,
                     (double)c->scale * distance * world_between(random, 0.1, 1.5));
}

void crowd_around(kit_random *random, crowd *c, uint32_t objects)
{
    begin(random, c, objects);
    if (kit_below(random, 2)) {
        c->scale = ldexpf(1, (int)kit_below(random, 100) - 60);
        any_camera(random, c);
    } else if (kit_below(random, 3) == 0) {
        c->scale = 1.0f;
        c->camera = world_skewed_camera(random, 0.0); // which has its eye at the origin
        c->camera.eye = NULL;
        c->eye[0] = c->eye[1] = c->eye[2] = 0.0;
    }
    float factor = ldexpf(1, kit_below(random, 2) ? 0 : (int)kit_below(random, 80) - 40);
    for (int i = 0; i < 16; i++)
        c->camera.view_projection[i] *= factor;
    while (c->occluder_count < CROWD_OCCLUDERS - 8) {
        occ_box box = box_around(random, c, 0.2, 10);
        crowd_put(c, &box, kit_below(random, 4) ? -1 : (int)kit_below(random, objects));
    }
    for (; c->object_count < objects; c->object_count++)
        c->objects[c->object_count] = box_around(random, c, 0.3, 100);
    c->strange = true;
}

// --- frames --------------------------------------------------------------------------------------

static void add_shadow(crowd_frame *f, uint32_t row)
{
    const occ_box *box = &occ_scene_occluder_boxes(f->scene)[row];
    occ_relative_box relative = occ_frame_relative(&f->frame, box);
    float h[3];
    for (int j = 0; j < 3; j++)
        h[j] = fabsf(relative.a[j]) + fabsf(relative.a[3 + j]) + fabsf(relative.a[6 + j]);
    occ_projection seen;
    f->frame.lanes->project(&f->frame.camera.screen, &relative, &seen);
    float key = occ_frame_nearness(&f->frame, relative.t, h);
    ck_assert_int_eq(occ_occluders_add(&f->frame, row, key, &seen), OCC_SUCCESS);
}

void crowd_frame_open(crowd_frame *f, const crowd *c, double tolerance)
{
    static const occ_allocator heap;
    static const occ_logger silence;
    const char *reason = "";
    ck_assert_int_eq(occ_hooks_init(&f->hooks, &heap, &silence), OCC_SUCCESS);
    f->scene = world_scene(c->objects, c->object_count, c->occluders, c->occluder_count, 8);
    occ_frame_init(&f->frame, &f->hooks, occ_lanes_choose());
    occ_result result = occ_camera_init(&f->frame.camera, &c->camera, &reason);
    ck_assert_msg(result == OCC_SUCCESS, "%s", reason);
    f->frame.scene = f->scene;
    f->frame.camera.tolerance = tolerance;
    occ_occluders_clear(&f->frame);
    for (uint32_t row = 0; row < c->occluder_count; row++)
        add_shadow(f, row);
}

void crowd_frame_close(crowd_frame *f)
{
    occ_frame_free(&f->frame);
    occ_scene_destroy(f->scene);
}
