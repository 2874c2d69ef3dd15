// SPDX-License-Identifier: Apache-2.0
// Knobs: what presets stand for, and that a larger budget of splits only ever hides more.
#include "knobs.h"
#include "support.h"
#include "worlds.h"

#include <stdio.h>

enum { OBJECTS = 40, ACROSS = 5 };

static occ_cull_desc filled(const occ_cull_desc *desc)
{
    occ_cull_desc knobs;
    occ_hooks hooks;
    static const occ_allocator no_allocator;
    static const occ_logger no_logger;
    ck_assert_int_eq(occ_hooks_init(&hooks, &no_allocator, &no_logger), OCC_SUCCESS);
    ck_assert_int_eq(occ_knobs_init(&knobs, desc, &hooks), OCC_SUCCESS);
    return knobs;
}

START_TEST(nothing_said_is_balanced)
{
    const occ_cull_desc balanced = {.preset = OCC_PRESET_BALANCED};
    occ_cull_desc knobs = filled(NULL), same = filled(&balanced);
    ck_assert(kit_same_bits(&knobs, &same, sizeof knobs));
    ck_assert(knobs.min_area > 0.0f && knobs.max_occluders && knobs.grain && knobs.max_splits);
    ck_assert(!(knobs.tolerance > 0.0f));
}
END_TEST

START_TEST(presets_go_from_fast_to_thorough)
{
    static const occ_preset order[] = {OCC_PRESET_FAST, OCC_PRESET_BALANCED, OCC_PRESET_THOROUGH};
    occ_cull_desc knobs[3];
    for (int i = 0; i < 3; i++) {
        const occ_cull_desc desc = {.preset = order[i]};
        knobs[i] = filled(&desc);
        ck_assert(!(knobs[i].tolerance > 0.0f));
        ck_assert_uint_gt(knobs[i].grain, 0);
    }
    for (int i = 0; i < 2; i++) {
        ck_assert(knobs[i].min_area > knobs[i + 1].min_area);
        ck_assert_uint_le(knobs[i].max_occluders, knobs[i + 1].max_occluders);
        ck_assert_uint_lt(knobs[i].max_splits, knobs[i + 1].max_splits);
    }
}
END_TEST

START_TEST(a_preset_leaves_alone_what_is_said)
{
    for (int preset = 0; preset < 3; preset++) {
        const occ_cull_desc desc = {.method = OCC_METHOD_FUSED,
                                    .preset = (occ_preset)preset,
                                    .min_area = 0.125f,
                                    .max_occluders = 7,
                                    .grain = 3,
                                    .max_splits = 5,
                                    .tolerance = 0.0625f};
        occ_cull_desc knobs = filled(&desc);
        ck_assert(kit_same_bits(&knobs, &desc, sizeof knobs));
    }
}
END_TEST

// --- splits --------------------------------------------------------------------------------------

// A wall of overlapping panels and objects of all sizes behind it. Returns how many are seen.
static uint32_t count_seen(uint32_t max_splits, bool seen[OBJECTS])
{
    static const float eye[3] = {0, 0, 0}, target[3] = {0, 0, -1};
    occ_box objects[OBJECTS];
    world_occluder panels[ACROSS * ACROSS];
    for (int i = 0; i < ACROSS * ACROSS; i++) {
        occ_box box = {{0}, {{0}}};
        int column = i % ACROSS - ACROSS / 2, row = i / ACROSS - ACROSS / 2;
        box.center[0] = 2.0f * (float)column;
        box.center[1] = 2.0f * (float)row;
        box.center[2] = -4;
        box.axis[0][0] = box.axis[1][1] = 1.02f;
        panels[i] = (world_occluder){box, -1};
    }
    for (int i = 0; i < OBJECTS; i++) {
        int column = i % 8 - 4, row = i / 8 - 2;
        objects[i] =
            kit_cube(1.5f * (float)column, 1.5f * (float)row, -12, 0.1f + 0.07f * (float)i);
    }
    occ_scene *scene = world_scene(objects, OBJECTS, panels, ACROSS * ACROSS, 4);
    occ_view *view = world_view(OCC_BACKEND_PLAIN, 0);
    occ_camera_desc camera = world_camera(eye, target, NULL);
    occ_cull_desc knobs = world_knobs(OCC_METHOD_FUSED);
    knobs.max_splits = max_splits;
    kit_cull(view, scene, &camera, &knobs);
    uint32_t count = 0;
    for (uint32_t i = 0; i < OBJECTS; i++)
        count += seen[i] = world_sees(view, i);
    occ_view_destroy(view);
    occ_scene_destroy(scene);
    return count;
}

START_TEST(more_splits_hide_all_that_fewer_hide_and_more)
{
    bool before[OBJECTS], now[OBJECTS];
    uint32_t first = count_seen(1, before), last = first;
    for (uint32_t splits = 2; splits <= 64; splits++) {
        last = count_seen(splits, now);
        for (int i = 0; i < OBJECTS; i++) {
            KIT_CHECK(before[i] || !now[i], "object %d is hidden, but no longer with %u splits", i,
                      splits);
            before[i] = now[i];
        }
    }
    printf("seen: %u with one split, %u with 64\n", first, last);
    ck_assert_uint_gt(first, last + OBJECTS / 4);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("knobs");
    TCase *presets = tcase_create("presets");
    tcase_add_test(presets, nothing_said_is_balanced);
    tcase_add_test(presets, presets_go_from_fast_to_thorough);
    tcase_add_test(presets, a_preset_leaves_alone_what_is_said);
    suite_add_tcase(suite, presets);
    TCase *splits = tcase_create("splits");
    tcase_add_test(splits, more_splits_hide_all_that_fewer_hide_and_more);
    suite_add_tcase(suite, splits);
    return test_run_suite(suite);
}
