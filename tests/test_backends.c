// SPDX-License-Identifier: Apache-2.0
// labels: unit property
// The same scene, camera and knobs give the same mask bit for bit on every backend, with any number
// of threads, however often, and in several views at a time.
#define _POSIX_C_SOURCE 200809L

#include "kit_crew.h"
#include "kit_obs.h"
#include "obs.h"
#include "scenes.h"
#include "support.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

static kit_crew crew;

static void gather(void)
{
    kit_crew_gather(&crew);
}

static void dismiss(void)
{
    kit_crew_dismiss(&crew);
}

// --- named scenes --------------------------------------------------------------------------------

static const occ_cull_desc all_knobs[] = {
    {.method = OCC_METHOD_SINGLE, .grain = 1},
    {.method = OCC_METHOD_SINGLE, .grain = 64},
    {.method = OCC_METHOD_SINGLE, .grain = 100000},
    {.method = OCC_METHOD_SINGLE, .min_area = 1e-30f, .max_occluders = 1u << 30, .grain = 16},
    {.method = OCC_METHOD_SINGLE, .min_area = 1e-2f, .max_occluders = 5, .grain = 64},
    {.method = OCC_METHOD_FRUSTUM, .grain = 1},
    {.method = OCC_METHOD_FRUSTUM, .grain = 100000},
    {.method = OCC_METHOD_FUSED, .grain = 1},
    {.method = OCC_METHOD_FUSED, .grain = 64},
    {.method = OCC_METHOD_PAIRWISE}};

enum { KNOBS = sizeof all_knobs / sizeof *all_knobs, FRAMES = 3, RUNS = FRAMES * KNOBS };

static const occ_scene_desc small_leaves = {.leaf_objects = 4};

static void make_scene(obs_scene *file, const char *name)
{
    ck_assert(scenes_make(name, OCC_TEST_SLOWNESS > 1 ? 1000 : 3000, 1, file));
}

static uint32_t *run(const occ_scene *scene, const obs_scene *file, unsigned i)
{
    double eye[3];
    uint32_t frame = (uint32_t)((uint64_t)(i / KNOBS) * file->frame_count / FRAMES);
    occ_camera_desc camera = kit_obs_camera(&file->frames[frame], eye);
    return kit_crew_cull(&crew, scene, &camera, &all_knobs[i % KNOBS]);
}

START_TEST(every_backend_and_thread_count_gives_the_same_mask_on_every_run)
{
    obs_scene file;
    make_scene(&file, scenes_kinds[_i].name);
    occ_scene *scene = kit_obs_scene(&file, &small_leaves, NULL, NULL);
    uint32_t *first[RUNS], hidden = 0, most_ranges = 0;
    for (unsigned i = 0; i < RUNS; i++) {
        first[i] = run(scene, &file, i);
        occ_view_stats stats = kit_stats(crew.view[0]);
        hidden += stats.walk_hidden + stats.test_hidden;
        most_ranges = stats.ranges > most_ranges ? stats.ranges : most_ranges;
    }
    ck_assert_msg(hidden > 0, "nothing was hidden: the scene shows nothing");
    ck_assert_msg(most_ranges > 64, "at most %u ranges: not worth threads", most_ranges);
    for (unsigned i = RUNS; i-- > 0;) { // backwards: no run may depend on the one before it
        uint32_t *again = run(scene, &file, i);
        ck_assert_msg(kit_same_words(first[i], again, occ_scene_slot_count(scene)),
                      "run %u differs when repeated", i);
        free(again);
        free(first[i]);
    }
    occ_scene_destroy(scene);
    obs_free(&file);
}
END_TEST

// --- owners
// ---------------------------------------------------------------------------------------

// Each object stands behind a wall of its own: it is the one object that the wall must not hide.
START_TEST(no_backend_lets_an_object_be_hidden_by_what_it_owns)
{
    enum { PLACES = 200 };
    occ_scene *scene = NULL;
    ck_assert_int_eq(occ_scene_create(&small_leaves, &scene), OCC_SUCCESS);
    occ_object owner[PLACES], other[PLACES];
    for (int i = 0; i < PLACES; i++) {
        int column = i % 20 - 10, line = i / 20 - 5;
        float x = (float)column, y = (float)line;
        occ_box near = kit_cube(1.05f * x, 1.05f * y, -21.0f, 0.1f);
        occ_box far = kit_cube(1.075f * x, 1.075f * y, -21.5f, 0.1f);
        occ_box wall = kit_cube(x, y, -20.0f, 0.4f);
        ck_assert_int_eq(occ_scene_add(scene, &near, &owner[i]), OCC_SUCCESS);
        ck_assert_int_eq(occ_scene_add(scene, &far, &other[i]), OCC_SUCCESS);
        ck_assert_int_eq(occ_scene_add_occluder(scene, &wall, owner[i], NULL), OCC_SUCCESS);
    }
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
    const float eye[3] = {0.0f, 0.0f, 0.0f}, target[3] = {0.0f, 0.0f, -1.0f};
    occ_camera_desc camera = kit_look(eye, target);
    for (unsigned k = 0; k < KNOBS; k++) {
        if (all_knobs[k].method == OCC_METHOD_FRUSTUM || all_knobs[k].max_occluders == 5) continue;
        free(kit_crew_cull(&crew, scene, &camera, &all_knobs[k]));
        for (int i = 0; i < PLACES; i++) {
            ck_assert(occ_view_is_visible(crew.view[0], owner[i]));
            ck_assert(!occ_view_is_visible(crew.view[0], other[i]));
        }
    }
    occ_scene_destroy(scene);
}
END_TEST

// --- awkward numbers -----------------------------------------------------------------------------

// Boxes of one size class, some of them flat, segments, points or mixed with their opposites.
static occ_box awkward_box(kit_random *random, float unit)
{
    occ_box box = kit_box(random, 40.0f * unit, 3.0f * unit);
    for (int k = 0; k < 3; k++) {
        uint32_t what = kit_below(random, 12);
        for (int j = 0; j < 3; j++) {
            if (what == 0) box.axis[k][j] = 0.0f;
            if (what == 1) box.axis[k][j] = 1e-40f;
            if (what == 2) box.axis[k][j] *= 1e-12f;
            if (what == 3 && j != k) box.axis[k][j] = 0.0f;
        }
    }
    return box;
}

// A camera in the middle that sees `unit` as 1.
static occ_camera_desc scaled_camera(float unit)
{
    const float eye[3] = {0.0f, 0.0f, 60.0f}, target[3] = {1.0f, 2.0f, 0.0f};
    occ_camera_desc camera = kit_look(eye, target);
    for (int i = 0; i < 12; i++)
        camera.view_projection[i] /= unit;
    return camera;
}

static const float units[] = {1.0f, 1e13f, 1e-30f, 1e-38f, 1e-6f};

START_TEST(every_backend_gives_the_same_mask_for_huge_tiny_and_denormal_boxes)
{
    kit_random random = {(uint64_t)_i + 77};
    occ_scene *scene = NULL;
    ck_assert_int_eq(occ_scene_create(&small_leaves, &scene), OCC_SUCCESS);
    for (int i = 0; i < 1200; i++) {
        occ_box box = awkward_box(&random, units[_i]);
        occ_object object;
        ck_assert_int_eq(occ_scene_add(scene, &box, &object), OCC_SUCCESS);
        if (i % 3) continue;
        box = awkward_box(&random, 2.0f * units[_i]);
        ck_assert_int_eq(
            occ_scene_add_occluder(scene, &box, i % 2 ? object : (occ_object){0, 0}, NULL),
            OCC_SUCCESS);
    }
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
    occ_camera_desc camera = scaled_camera(units[_i]);
    for (unsigned k = 0; k < KNOBS; k++)
        free(kit_crew_cull(&crew, scene, &camera, &all_knobs[k]));
    occ_view_stats stats = kit_stats(crew.view[0]);
    ck_assert_uint_gt(stats.visible, 0);
    if (units[_i] > 1e-20f) ck_assert_uint_gt(stats.test_hidden, 0);
    occ_scene_destroy(scene);
}
END_TEST

// --- two views -----------------------------------------------------------------------------------

START_TEST(two_views_on_one_scene_keep_their_own_results)
{
    obs_scene file;
    make_scene(&file, "interior");
    occ_scene *scene = kit_obs_scene(&file, &small_leaves, NULL, NULL);
    double eye[2][3];
    occ_camera_desc camera[2] = {kit_obs_camera(&file.frames[0], eye[0]),
                                 kit_obs_camera(&file.frames[30], eye[1])};
    for (unsigned i = 1; i < crew.size; i++) { // the plain view looks one way, the others another
        kit_cull(crew.view[i], scene, &camera[0], NULL);
        uint32_t *mine = kit_mask(crew.view[i], NULL);
        kit_cull(crew.view[0], scene, &camera[1], NULL);
        uint32_t *other = kit_mask(crew.view[0], NULL), *still = kit_mask(crew.view[i], NULL);
        ck_assert(kit_same_words(mine, still, occ_scene_slot_count(scene)));
        ck_assert_msg(!kit_same_words(mine, other, occ_scene_slot_count(scene)),
                      "the cameras see the same");
        free(mine);
        free(other);
        free(still);
    }
    occ_scene_destroy(scene);
    obs_free(&file);
}
END_TEST

typedef struct worker {
    occ_view *view;
    const occ_scene *scene;
    const obs_scene *file;
    uint32_t frames, stride;
    uint32_t *masks;
    bool failed;
} worker;

// Culls every frame of the file, several times over.
static void *work(void *data)
{
    worker *w = data;
    for (uint32_t i = 0; i < 4 * w->frames; i++) {
        double eye[3];
        size_t count;
        uint32_t frame = i % w->frames;
        occ_camera_desc camera = kit_obs_camera(&w->file->frames[frame], eye);
        w->failed |= occ_cull(w->view, w->scene, &camera, NULL) != OCC_SUCCESS;
        w->failed |= occ_view_read_mask(w->view, w->masks + (size_t)frame * w->stride, w->stride,
                                        &count) != OCC_SUCCESS;
    }
    return NULL;
}

START_TEST(views_in_several_threads_cull_one_scene_at_the_same_time)
{
    obs_scene file;
    make_scene(&file, "forest");
    occ_scene *scene = kit_obs_scene(&file, &small_leaves, NULL, NULL);
    uint32_t stride = (uint32_t)OCC_MASK_WORDS(occ_scene_slot_count(scene));
    uint32_t frames = file.frame_count / 4;
    worker workers[KIT_CREW_MOST];
    pthread_t threads[KIT_CREW_MOST];
    for (unsigned i = 0; i < crew.size; i++) {
        workers[i] = (worker){crew.view[i], scene, &file, frames, stride, NULL, false};
        workers[i].masks = calloc((size_t)file.frame_count * stride, sizeof(uint32_t));
        ck_assert_ptr_nonnull(workers[i].masks);
        ck_assert_int_eq(pthread_create(&threads[i], NULL, work, &workers[i]), 0);
    }
    for (unsigned i = 0; i < crew.size; i++)
        ck_assert_int_eq(pthread_join(threads[i], NULL), 0);
    size_t bytes = (size_t)frames * stride * sizeof(uint32_t);
    for (unsigned i = 0; i < crew.size; i++) {
        ck_assert_msg(!workers[i].failed, "%s failed", crew.name[i]);
        ck_assert_msg(!memcmp(workers[0].masks, workers[i].masks, bytes), "%s differs",
                      crew.name[i]);
    }
    for (unsigned i = 0; i < crew.size; i++)
        free(workers[i].masks);
    occ_scene_destroy(scene);
    obs_free(&file);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("backends");
    TCase *scenes = tcase_create("scenes");
    tcase_add_checked_fixture(scenes, gather, dismiss);
    tcase_add_loop_test(scenes, every_backend_and_thread_count_gives_the_same_mask_on_every_run, 0,
                        5);
    tcase_add_test(scenes, no_backend_lets_an_object_be_hidden_by_what_it_owns);
    suite_add_tcase(suite, scenes);

    TCase *numbers = tcase_create("numbers");
    tcase_add_checked_fixture(numbers, gather, dismiss);
    tcase_add_loop_test(numbers, every_backend_gives_the_same_mask_for_huge_tiny_and_denormal_boxes,
                        0, sizeof units / sizeof *units);
    suite_add_tcase(suite, numbers);

    TCase *views = tcase_create("views");
    tcase_add_checked_fixture(views, gather, dismiss);
    tcase_add_test(views, two_views_on_one_scene_keep_their_own_results);
    tcase_add_test(views, views_in_several_threads_cull_one_scene_at_the_same_time);
    suite_add_tcase(suite, views);
    return test_run_suite(suite);
}
