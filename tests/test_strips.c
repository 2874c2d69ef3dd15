// SPDX-License-Identifier: Apache-2.0
// labels: unit opencl
// Occluders that are chosen strip by strip: each once, nearest first, with the same shadow as
// without strips; the same ones in every run; and nearly all that matter.
#include "strips.h"

#include "kit_obs.h"
#include "knobs.h"
#include "obs.h"
#include "scenes.h"
#include "support.h"

#include <stdlib.h>
#include <string.h>

static obs_scene file;
static occ_scene *scene;
static occ_hooks hooks;
static occ_frame frame, whole;
static occ_strips strips;

static void open_scene(const char *name, uint32_t count)
{
    ck_assert(scenes_make(name, count, 2, &file));
    scene = kit_obs_scene(&file, NULL, NULL, NULL);
    ck_assert_int_eq(occ_hooks_init(&hooks, &(occ_allocator){0}, &(occ_logger){0}), OCC_SUCCESS);
    occ_frame_init(&frame, &hooks, occ_lanes_choose());
    occ_frame_init(&whole, &hooks, occ_lanes_choose());
}

static void close_scene(void)
{
    occ_frame_free(&frame);
    occ_frame_free(&whole);
    ck_assert_uint_eq(hooks.bytes, 0);
    occ_scene_destroy(scene);
    obs_free(&file);
}

static void aim(occ_frame *f, uint32_t index)
{
    double eye[3];
    const char *reason;
    occ_camera_desc camera = kit_obs_camera(&file.frames[index], eye);
    occ_cull_desc knobs = {.min_area = 1e-4f};
    ck_assert_int_eq(occ_knobs_init(&f->knobs, &knobs, &hooks), OCC_SUCCESS);
    ck_assert_int_eq(occ_camera_init(&f->camera, &camera, &reason), OCC_SUCCESS);
    f->camera.constants.splits = f->knobs.max_splits;
    f->scene = scene;
}

static const occ_occluder *sources_of(const occ_frame *f)
{
    return f->sources.data;
}

// Where an occluder is in a set, or the set's length.
static uint32_t place_of(const occ_frame *f, uint32_t index)
{
    uint32_t i = 0;
    while (i < f->shadows.count && sources_of(f)[i].index != index)
        i++;
    return i;
}

// (What is beyond the last plane is whatever it is.)
static bool is_same_shadow(const occ_shadow *a, const occ_shadow *b)
{
    return a->planes == b->planes && a->silhouettes == b->silhouettes && a->owner == b->owner &&
           kit_same_bits(a->plane, b->plane, a->planes * sizeof a->plane[0]);
}

// Each once, and as the walk over the whole makes it. Returns how many it has that this has not.
static uint32_t compare_choice(void)
{
    const occ_shadow *mine = frame.shadows.data, *theirs = whole.shadows.data;
    uint32_t lost = 0;
    for (uint32_t i = 0; i < frame.shadows.count; i++) {
        uint32_t index = sources_of(&frame)[i].index, other = place_of(&whole, index);
        KIT_CHECK(place_of(&frame, index) == i, "occluder %u is there twice", index);
        if (other == whole.shadows.count) continue; // another occluder hides it, in another strip
        KIT_CHECK(is_same_shadow(&mine[i], &theirs[other]), "the shadow of %u", index);
    }
    for (uint32_t i = 0; i < whole.shadows.count; i++)
        lost += place_of(&frame, sources_of(&whole)[i].index) == frame.shadows.count;
    return lost;
}

START_TEST(strips_choose_what_one_walk_does_or_more)
{
    uint32_t chosen = 0, lost = 0, count = 2 + (uint32_t)_i % 3 * 7;
    open_scene(_i / 3 ? "forest" : "city", 2000);
    ck_assert_int_eq(occ_strips_open(&strips, &hooks, occ_lanes_choose(), count), OCC_SUCCESS);
    for (uint32_t f = 0; f < file.frame_count; f += 7) {
        aim(&frame, f);
        aim(&whole, f);
        ck_assert_int_eq(occ_walk(&whole), OCC_SUCCESS);
        ck_assert_int_eq(occ_strips_choose(&strips, &frame), OCC_SUCCESS);
        lost += compare_choice();
        chosen += whole.shadows.count;
    }
    occ_strips_close(&strips);
    ck_assert_uint_gt(chosen, 100);
    KIT_CHECK(20 * lost <= chosen, "%u of %u are lost", lost, chosen);
    close_scene();
}
END_TEST

START_TEST(one_strip_is_the_walk)
{
    open_scene("city", 1000);
    ck_assert_int_eq(occ_strips_open(&strips, &hooks, occ_lanes_choose(), 1), OCC_SUCCESS);
    aim(&frame, 3);
    aim(&whole, 3);
    ck_assert_int_eq(occ_walk(&whole), OCC_SUCCESS);
    ck_assert_int_eq(occ_strips_choose(&strips, &frame), OCC_SUCCESS);
    ck_assert_uint_eq(compare_choice(), 0);
    ck_assert_uint_eq(frame.shadows.count, whole.shadows.count);
    occ_strips_close(&strips);
    close_scene();
}
END_TEST

// Again and again, with helpers that come when they come.
START_TEST(every_run_chooses_the_same_in_the_same_order)
{
    occ_shadow first[1024];
    uint32_t count = 0;
    open_scene("city", 2000);
    ck_assert_int_eq(occ_strips_open(&strips, &hooks, occ_lanes_choose(), 5), OCC_SUCCESS);
    for (uint32_t run = 0; run < 50; run++) {
        aim(&frame, 5);
        ck_assert_int_eq(occ_strips_choose(&strips, &frame), OCC_SUCCESS);
        if (!run) {
            count = frame.shadows.count;
            ck_assert_uint_le(count, 1024);
            memcpy(first, frame.shadows.data, count * sizeof *first);
        }
        ck_assert_uint_eq(frame.shadows.count, count);
        for (uint32_t i = 0; i < count; i++)
            KIT_CHECK(is_same_shadow(&first[i], (const occ_shadow *)frame.shadows.data + i),
                      "shadow %u differs in run %u", i, run);
    }
    ck_assert_uint_gt(count, 10);
    occ_strips_close(&strips);
    close_scene();
}
END_TEST

START_TEST(no_more_than_the_most_and_those_the_nearest)
{
    open_scene("city", 2000);
    ck_assert_int_eq(occ_strips_open(&strips, &hooks, occ_lanes_choose(), 4), OCC_SUCCESS);
    aim(&whole, 5);
    ck_assert_int_eq(occ_strips_choose(&strips, &whole), OCC_SUCCESS);
    aim(&frame, 5);
    frame.knobs.max_occluders = 7;
    ck_assert_int_eq(occ_strips_choose(&strips, &frame), OCC_SUCCESS);
    ck_assert_uint_eq(frame.shadows.count, 7);
    for (uint32_t i = 0; i < 7; i++)
        ck_assert_uint_eq(sources_of(&frame)[i].index, sources_of(&whole)[i].index);
    occ_strips_close(&strips);
    close_scene();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("strips");
    TCase *choice = tcase_create("choice");
    tcase_add_loop_test(choice, strips_choose_what_one_walk_does_or_more, 0, 6);
    tcase_add_test(choice, one_strip_is_the_walk);
    tcase_add_test(choice, every_run_chooses_the_same_in_the_same_order);
    tcase_add_test(choice, no_more_than_the_most_and_those_the_nearest);
    suite_add_tcase(suite, choice);
    return test_run_suite(suite);
}
