// SPDX-License-Identifier: Apache-2.0
// labels: unit
// timeout: 120
// 2^20 boxes in one place: no cell can tell them apart, and one wall hides all or none.
#include "support.h"
#include "worlds.h"

#include <stdlib.h>

enum { BOXES = 1 << 20 };

static uint32_t seen_of(occ_scene *scene, occ_view *view, occ_method method)
{
    occ_camera_desc camera = kit_look((float[3]){0, 0, 0}, (float[3]){0, 0, -1});
    occ_cull_desc knobs = {.method = method};
    occ_view_stats stats;
    kit_cull(view, scene, &camera, &knobs);
    ck_assert_int_eq(occ_view_get_stats(view, &stats), OCC_SUCCESS);
    ck_assert_uint_eq(stats.objects, BOXES);
    return stats.visible;
}

static void check_scene(const occ_box *boxes, int owner)
{
    static const occ_method methods[] = {OCC_METHOD_SINGLE, OCC_METHOD_PAIRWISE, OCC_METHOD_FUSED};
    const world_occluder walls[2] = {{{{0, 0, -10}, {{9, 0, 0}, {0, 9, 0}, {0, 0, 0}}}, owner},
                                     {{{0, 0, 50}, {{9, 0, 0}, {0, 9, 0}, {0, 0, 1}}}, -1}};
    occ_scene *bare = world_scene(boxes, BOXES, walls + 1, 1, 0);
    occ_scene *walled = world_scene(boxes, BOXES, walls, 2, 0);
    ck_assert_int_eq(occ_scene_validate(walled), OCC_SUCCESS);
    for (uint32_t threads = 0; threads < 2; threads++) {
        occ_view *view = world_view(threads ? OCC_BACKEND_OPENMP : OCC_BACKEND_PLAIN, 2);
        for (int m = 0; m < 2; m++) {
            ck_assert_uint_eq(seen_of(bare, view, methods[m]), BOXES);
            ck_assert_uint_eq(seen_of(walled, view, methods[m]), owner >= 0);
            if (owner >= 0) ck_assert(world_sees(view, (uint32_t)owner));
        }
        occ_view_destroy(view);
    }
    occ_scene_destroy(bare);
    occ_scene_destroy(walled);
}

START_TEST(a_million_identical_boxes_are_all_seen_or_all_hidden_but_for_the_owner)
{
    occ_box *boxes = malloc(BOXES * sizeof *boxes);
    ck_assert_ptr_nonnull(boxes);
    for (uint32_t i = 0; i < BOXES; i++)
        boxes[i] = kit_cube(0.25f, 0.5f, -20, 0.75f);
    check_scene(boxes, -1);
    check_scene(boxes, 777777);
    free(boxes);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("identical boxes");
    TCase *cases = tcase_create("identical");
    tcase_add_test(cases, a_million_identical_boxes_are_all_seen_or_all_hidden_but_for_the_owner);
    suite_add_tcase(suite, cases);
    return test_run_suite(suite);
}
