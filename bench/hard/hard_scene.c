// SPDX-License-Identifier: Apache-2.0
#include "hard_scene.h"

#include "obs.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// Behind the camera, farther than anything is from it.
static occ_box point_behind(const family_world *world)
{
    double away = 1e-3;
    occ_box point;
    memset(&point, 0, sizeof point);
    for (int j = 0; j < 3; j++) {
        away += fabs(world->eye[j]) * 1e-6;
        for (uint32_t i = 0; i < world->object_count; i++)
            away += fabs((double)world->objects[i].center[j] - world->eye[j]);
    }
    for (int j = 0; j < 3; j++)
        point.center[j] = (float)(world->eye[j] + away * (double)world->view[4 * j + 2]);
    return point;
}

// Depths to those from -1 to 1: row 2 of the projection, less or more of row 3.
static void as_opengl(occ_depth depth, float proj[16])
{
    for (int c = 0; c < 4 && depth != OCC_DEPTH_MINUS_ONE_TO_ONE; c++) {
        double z = 2.0 * (double)proj[4 * c + 2], w = (double)proj[4 * c + 3];
        proj[4 * c + 2] = (float)(depth == OCC_DEPTH_ZERO_TO_ONE ? z - w : w - z);
    }
}

obs_frame hard_scene_frame(const family_world *world)
{
    obs_frame frame;
    for (int j = 0; j < 3; j++) {
        frame.eye[j] = (float)world->eye[j];
        frame.dir[j] = -world->view[4 * j + 2];
    }
    memcpy(frame.view, world->view, sizeof frame.view);
    memcpy(frame.proj, world->proj, sizeof frame.proj);
    as_opengl(world->camera.depth, frame.proj);
    return frame;
}

// The object that is the owner, or the one that all have who have none.
static uint32_t owner_in(obs_scene *scene, const family_world *world, int owner, uint32_t *nobody)
{
    if (owner >= 0) return (uint32_t)owner;
    const occ_box point = point_behind(world);
    if (*nobody == UINT32_MAX) *nobody = obs_add_object(scene, &point);
    return *nobody;
}

bool hard_scene_write(const char *path, const family_world *world)
{
    obs_scene scene = {0};
    obs_frame frame = hard_scene_frame(world);
    uint32_t nobody = UINT32_MAX;
    for (uint32_t i = 0; i < world->object_count; i++)
        obs_add_object(&scene, &world->objects[i]);
    for (uint32_t i = 0; i < world->occluder_count; i++)
        obs_add_occluder(&scene, &world->occluders[i].box,
                         owner_in(&scene, world, world->occluders[i].owner, &nobody));
    for (uint32_t i = 0; i < world->sheet_count; i++)
        obs_add_sheet(&scene, &world->sheets[i].sheet,
                      owner_in(&scene, world, world->sheets[i].owner, &nobody));
    obs_add_frame(&scene, &frame);
    bool good = obs_write(path, &scene);
    obs_free(&scene);
    return good;
}
