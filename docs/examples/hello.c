// SPDX-License-Identifier: Apache-2.0
// The program of docs/hello.md: a wall, a crate behind it and a crate beside it.
#include <occlude/occlude.h>

#include <stdio.h>

static void print_line(occ_log_level level, const char *line, void *user_data)
{
    (void)user_data;
    if (level <= OCC_LOG_WARNING) fprintf(stderr, "occlude: %s\n", line);
}

int main(void)
{
    occ_scene_desc desc = {.logger = {print_line, NULL}};
    occ_scene *scene;
    if (occ_scene_create(&desc, &scene)) return 1;

    occ_box wall_box = {{0, 1, -5}, {{3, 0, 0}, {0, 2, 0}, {0, 0, 0.2f}}};
    occ_box crates[2] = {{{0, 0.5f, -9}, {{0.5f, 0, 0}, {0, 0.5f, 0}, {0, 0, 0.5f}}},
                         {{6, 0.5f, -9}, {{0.5f, 0, 0}, {0, 0.5f, 0}, {0, 0, 0.5f}}}};
    occ_object wall, crate[2];
    if (occ_scene_add(scene, &wall_box, &wall) || occ_scene_add_many(scene, crates, 2, crate) ||
        occ_scene_add_occluder(scene, &wall_box, wall, NULL) || // solid as it looks
        occ_scene_commit(scene)) {
        return 1;
    }

    occ_view *view;
    if (occ_view_create(NULL, &view)) return 1;

    // 90 degrees wide and high, near 0.1, infinite far, at the origin, looking along -z.
    occ_camera_desc camera = {
        .view_projection = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, -1, 0, 0, -0.2f, 0}};
    if (occ_cull(view, scene, &camera, NULL)) return 1;

    printf("wall: %s\n", occ_view_is_visible(view, wall) ? "visible" : "hidden");
    for (int i = 0; i < 2; i++)
        printf("crate %d: %s\n", i, occ_view_is_visible(view, crate[i]) ? "visible" : "hidden");

    // What an engine does instead: walk the list of slots.
    uint32_t slots[3];
    size_t count;
    if (occ_view_read_visible(view, slots, 3, &count)) return 1;
    for (size_t i = 0; i < count; i++)
        printf("draw slot %u\n", slots[i]);

    int right = occ_view_is_visible(view, wall) && !occ_view_is_visible(view, crate[0]) &&
                occ_view_is_visible(view, crate[1]);
    occ_view_destroy(view);
    occ_scene_destroy(scene);
    return right ? 0 : 1;
}
