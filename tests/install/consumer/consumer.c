// SPDX-License-Identifier: Apache-2.0
// What a program outside does with an installed library: a wall, something behind it, something
// beside it. Valid C99 and C++11.

#include <occlude/occlude.h>
#include <stdio.h>

enum { WALL, BEHIND, BESIDE, OBJECTS };

static int fail(const char *what, occ_result result)
{
    fprintf(stderr, "%s: %s\n", what, occ_result_message(result));
    return 1;
}

int main(void)
{
    // Perspective, 90 degrees, near 1, infinite far; the eye at the origin looks down -z.
    occ_camera_desc camera = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, -1, 0, 0, -2, 0},
                              OCC_DEPTH_MINUS_ONE_TO_ONE,
                              NULL,
                              NULL};
    const occ_box boxes[OBJECTS] = {
        {{0, 0, -10}, {{3, 0, 0}, {0, 3, 0}, {0, 0, 1}}},
        {{0, 0, -20}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
        {{15, 0, -20}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
    };
    occ_object objects[OBJECTS];
    occ_scene *scene = NULL;
    occ_view *view = NULL;
    uint32_t slots[OBJECTS];
    size_t count = 0;

    occ_result result = occ_scene_create(NULL, &scene);
    if (result == OCC_SUCCESS) result = occ_scene_add_many(scene, boxes, OBJECTS, objects);
    if (result == OCC_SUCCESS)
        result = occ_scene_add_occluder(scene, &boxes[WALL], objects[WALL], NULL);
    if (result == OCC_SUCCESS) result = occ_scene_commit(scene);
    if (result == OCC_SUCCESS) result = occ_view_create(NULL, &view);
    if (result == OCC_SUCCESS) result = occ_cull(view, scene, &camera, NULL);
    if (result == OCC_SUCCESS) result = occ_view_read_visible(view, slots, OBJECTS, &count);
    occ_view_destroy(view);
    occ_scene_destroy(scene);
    if (result != OCC_SUCCESS) return fail("occlude", result);

    printf("occlude %d: %u of %d objects visible\n", occ_version(), (unsigned)count, (int)OBJECTS);
    return count == 2 && slots[0] == WALL && slots[1] == BESIDE ? 0 : 1;
}
