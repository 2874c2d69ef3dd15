// SPDX-License-Identifier: Apache-2.0
// Scenes of the measuring program, loaded for a test. Who includes this includes "obs.h" itself, so
// that what is behind it gets linked.
#ifndef OCC_TEST_KIT_OBS_H
#define OCC_TEST_KIT_OBS_H

#include "kit.h"
#include "obs.h"

#include <check.h>
#include <stdlib.h>

// A committed scene. `objects` and `occluders` receive the handles; each may be NULL.
static inline occ_scene *kit_obs_scene(const obs_scene *file, const occ_scene_desc *desc,
                                       occ_object *objects, occ_occluder *occluders)
{
    occ_scene *scene = NULL;
    ck_assert_int_eq(occ_scene_create(desc, &scene), OCC_SUCCESS);
    occ_object *made = calloc((size_t)file->object_count + 1, sizeof *made);
    ck_assert_ptr_nonnull(made);
    ck_assert_int_eq(occ_scene_add_many(scene, file->objects, file->object_count, made),
                     OCC_SUCCESS);
    for (uint32_t i = 0; i < file->occluder_count; i++) {
        const obs_occluder *from = &file->occluders[i];
        occ_occluder occluder;
        ck_assert_int_eq(occ_scene_add_occluder(scene, &from->box, made[from->owner], &occluder),
                         OCC_SUCCESS);
        if (occluders) occluders[i] = occluder;
    }
    for (uint32_t i = 0; i < file->sheet_count; i++) {
        const obs_sheet *from = &file->sheets[i];
        occ_occluder occluder;
        ck_assert_int_eq(occ_scene_add_sheet(scene, &from->sheet, made[from->owner], &occluder),
                         OCC_SUCCESS);
        if (occluders) occluders[file->occluder_count + i] = occluder;
    }
    for (uint32_t i = 0; objects && i < file->object_count; i++)
        objects[i] = made[i];
    free(made);
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
    return scene;
}

// The camera of a frame. `eye` is filled in, and must live as long as the camera.
static inline occ_camera_desc kit_obs_camera(const obs_frame *frame, double eye[3])
{
    occ_camera_desc camera = {.depth = OCC_DEPTH_MINUS_ONE_TO_ONE, .eye = eye};
    obs_view_projection(frame, camera.view_projection);
    for (int j = 0; j < 3; j++)
        eye[j] = (double)frame->eye[j];
    return camera;
}

#endif
