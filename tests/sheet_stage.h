// SPDX-License-Identifier: Apache-2.0
// Objects to hide behind sheets, and who looks: scenes, cameras and knobs.
#ifndef OCC_TEST_SHEET_STAGE_H
#define OCC_TEST_SHEET_STAGE_H

#include "kit_crew.h"
#include "worlds.h"

enum { OBJECTS = 3000 / (OCC_TEST_SLOWNESS), OCCLUDERS = 90, FRAMES = 12 };

// Objects scattered over ±100, and no occluders.
static inline occ_scene *stage_scene(uint64_t seed, occ_object *objects)
{
    occ_scene *scene;
    const occ_scene_desc desc = {.leaf_objects = 8};
    ck_assert_int_eq(occ_scene_create(&desc, &scene), OCC_SUCCESS);
    kit_fill(scene, OBJECTS, 0, seed, objects, NULL);
    return scene;
}

static inline void stage_commit(occ_scene *scene)
{
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_validate(scene), OCC_SUCCESS);
}

static inline uint32_t stage_hidden(const occ_view *view)
{
    occ_view_stats stats = kit_stats(view);
    return stats.walk_hidden + stats.test_hidden;
}

// Cameras of every projection among the objects, some with a near plane that cuts many occluders.
static inline occ_camera_desc stage_camera(uint32_t i)
{
    if (i % 3 == 0) return kit_path(i);
    kit_random random = {i + 1000};
    float eye[3], target[3];
    for (int j = 0; j < 3; j++) {
        eye[j] = kit_between(&random, -120, 120);
        target[j] = kit_between(&random, -40, 40);
    }
    world_lens lens = {.projection = (world_projection)(i % WORLD_PROJECTIONS),
                       .depth = OCC_DEPTH_ZERO_TO_ONE,
                       .near_z = i % 2 ? 0.1f : 25.0f,
                       .far_z = 500.0f};
    if (lens.projection == WORLD_ORTHOGRAPHIC) lens.height = 150.0f;
    return world_camera(eye, target, &lens);
}

static const occ_cull_desc stage_knobs[] = {{.method = OCC_METHOD_SINGLE},
                                            {.method = OCC_METHOD_SINGLE, .min_area = 1e-12f},
                                            {.method = OCC_METHOD_FUSED},
                                            {.method = OCC_METHOD_FUSED, .min_area = 1e-12f},
                                            {.method = OCC_METHOD_FUSED, .tolerance = 0.005f},
                                            {.method = OCC_METHOD_PAIRWISE}};
enum { KNOBS = (int)(sizeof stage_knobs / sizeof *stage_knobs) };

#endif
