// SPDX-License-Identifier: Apache-2.0
// Views in several threads at once. What the assertions cannot see, ThreadSanitizer does.
#define _POSIX_C_SOURCE 200809L
#include "kit_tree.h"
#include "support.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

enum { THREADS = 4, FRAMES = 12, OBJECTS = 6000, WORDS = (OBJECTS + 31) / 32 };

static occ_scene *shared;

static void set_up(void)
{
    occ_scene_desc desc = {.leaf_objects = 4}; // many ranges, so that OpenMP's threads have work
    ck_assert_int_eq(occ_scene_create(&desc, &shared), OCC_SUCCESS);
    kit_fill(shared, OBJECTS, 4, 12, NULL, NULL);
    ck_assert_int_eq(occ_scene_commit(shared), OCC_SUCCESS);
}

static void tear_down(void)
{
    occ_scene_destroy(shared);
}

// One thread's work and its results.
typedef struct worker {
    pthread_t thread;
    occ_backend backend;
    uint32_t threads;
    uint64_t seed;
    kit_heap heap;
    uint32_t most_ranges;
    uint32_t masks[FRAMES][WORDS];
} worker;

static occ_view *view_of(worker *w)
{
    occ_view *view;
    occ_view_desc desc = {
        .allocator = kit_allocator(&w->heap), .backend = w->backend, .threads = w->threads};
    KIT_CHECK(!occ_view_create(&desc, &view), "no view");
    return view;
}

static void *cull_shared(void *argument)
{
    worker *w = argument;
    occ_view *view = view_of(w);
    for (uint32_t f = 0; f < FRAMES; f++) {
        occ_camera_desc camera = kit_path(f);
        occ_cull_desc knobs = {.grain = 1};
        kit_cull(view, shared, &camera, &knobs);
        KIT_CHECK(!occ_view_read_mask(view, w->masks[f], WORDS, NULL), "no mask");
        occ_view_stats stats;
        KIT_CHECK(!occ_view_get_stats(view, &stats), "no stats");
        w->most_ranges = stats.ranges > w->most_ranges ? stats.ranges : w->most_ranges;
    }
    occ_view_destroy(view);
    return NULL;
}

// Builds, edits and culls a scene of its own.
static void *edit_own(void *argument)
{
    worker *w = argument;
    occ_scene *scene;
    occ_object objects[600];
    occ_scene_desc desc = {.allocator = kit_allocator(&w->heap)};
    KIT_CHECK(!occ_scene_create(&desc, &scene), "no scene");
    kit_fill(scene, 600, 2, w->seed, objects, NULL);
    occ_view *view = view_of(w);
    for (uint32_t f = 0; f < FRAMES; f++) {
        KIT_CHECK(!occ_scene_remove(scene, objects[f]), "an object stays");
        KIT_CHECK(!occ_scene_commit(scene), "no commit");
        occ_camera_desc camera = kit_path(f);
        kit_cull(view, scene, &camera, NULL);
        KIT_CHECK(!occ_view_read_mask(view, w->masks[f], WORDS, NULL), "no mask");
    }
    occ_view_destroy(view);
    occ_scene_destroy(scene);
    return NULL;
}

// Runs a job in several threads, in several ways, and compares with how it goes in one. Returns the
// most ranges that a frame had.
static uint32_t run_and_compare(void *(*job)(void *))
{
    static const occ_backend backends[THREADS] = {OCC_BACKEND_PLAIN, OCC_BACKEND_OPENMP,
                                                  OCC_BACKEND_OPENMP, OCC_BACKEND_PLAIN};
    worker *alone = calloc(1, sizeof *alone), *workers = calloc(THREADS, sizeof *workers);
    ck_assert(alone && workers);
    alone->backend = OCC_BACKEND_PLAIN;
    alone->seed = 3;
    job(alone);
    for (uint32_t t = 0; t < THREADS; t++) {
        workers[t].backend = backends[t];
        workers[t].threads = t; // 0 asks OpenMP
        workers[t].seed = 3;
        ck_assert_int_eq(pthread_create(&workers[t].thread, NULL, job, &workers[t]), 0);
    }
    for (uint32_t t = 0; t < THREADS; t++)
        ck_assert_int_eq(pthread_join(workers[t].thread, NULL), 0);
    for (uint32_t t = 0; t < THREADS; t++) {
        ck_assert_mem_eq(workers[t].masks, alone->masks, sizeof alone->masks);
        ck_assert_uint_eq(workers[t].heap.blocks, 0);
    }
    uint32_t ranges = alone->most_ranges;
    free(alone);
    free(workers);
    return ranges;
}

START_TEST(views_in_several_threads_see_the_same_in_one_scene)
{
    ck_assert_uint_gt(run_and_compare(cull_shared), 64); // fewer are not worth threads
    kit_check_trees(shared);
}
END_TEST

START_TEST(scenes_in_several_threads_do_not_meet)
{
    (void)run_and_compare(edit_own);
}
END_TEST

static occ_view *wandering;

static void *cull_wandering(void *argument)
{
    worker *w = argument;
    for (uint32_t f = 0; f < FRAMES; f++) {
        occ_camera_desc camera = kit_path(f);
        kit_cull(wandering, shared, &camera, NULL);
        KIT_CHECK(!occ_view_read_mask(wandering, w->masks[f], WORDS, NULL), "no mask");
    }
    return NULL;
}

START_TEST(view_may_go_from_thread_to_thread)
{
    worker *workers = calloc(3, sizeof *workers);
    ck_assert_ptr_nonnull(workers);
    ck_assert_int_eq(occ_view_create(NULL, &wandering), OCC_SUCCESS);
    cull_wandering(&workers[0]);
    for (int t = 1; t < 3; t++) { // one after the other
        ck_assert_int_eq(pthread_create(&workers[t].thread, NULL, cull_wandering, &workers[t]), 0);
        ck_assert_int_eq(pthread_join(workers[t].thread, NULL), 0);
        ck_assert_mem_eq(workers[t].masks, workers[0].masks, sizeof workers->masks);
    }
    occ_view_destroy(wandering);
    free(workers);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("view_threads");
    TCase *threads = tcase_create("threads");
    tcase_add_checked_fixture(threads, set_up, tear_down);
    tcase_add_test(threads, views_in_several_threads_see_the_same_in_one_scene);
    tcase_add_test(threads, scenes_in_several_threads_do_not_meet);
    tcase_add_test(threads, view_may_go_from_thread_to_thread);
    suite_add_tcase(suite, threads);
    return test_run_suite(suite);
}
