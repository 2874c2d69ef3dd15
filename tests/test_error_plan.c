// SPDX-License-Identifier: Apache-2.0
// What the error report runs on a scene.
#include "error_plan.h"
#include "kit.h"
#include "kit_obs.h"
#include "knobs.h"
#include "obs.h"
#include "scenes.h"
#include "support.h"

#include <stdlib.h>
#include <string.h>

typedef struct plan {
    error_run runs[ERROR_MAX_RUNS];
    size_t count;
} plan;

static plan planned(uint32_t objects, uint32_t occluders, bool is_quick, bool has_opencl)
{
    const obs_scene scene = {.object_count = objects, .occluder_count = occluders};
    const error_options options = {
        .repeats = 3, .is_quick = is_quick, .has_opencl = has_opencl, .has_tolerance = true};
    plan p;
    p.count = error_plan(&options, &scene, p.runs);
    return p;
}

static size_t count_runs(const plan *p, const char *method, const char *backend, bool is_skipped)
{
    size_t count = 0;
    for (size_t i = 0; i < p->count; i++)
        count += strcmp(p->runs[i].method->name, method) == 0 &&
                 strcmp(p->runs[i].settings.backend, backend) == 0 &&
                 (p->runs[i].skipped != NULL) == is_skipped;
    return count;
}

START_TEST(every_method_is_in_the_plan)
{
    plan small = planned(1000, 1000, false, true), quick = planned(1000, 1000, true, true);
    ck_assert_uint_lt(small.count, ERROR_MAX_RUNS);
    ck_assert_uint_lt(quick.count, small.count);
    for (const error_method *method = error_methods; method->name; method++) {
        ck_assert_uint_ge(count_runs(&small, method->name, "plain", false) +
                              count_runs(&small, method->name, "plain", true),
                          1);
        ck_assert_ptr_eq(error_method_find(method->name), method);
    }
    ck_assert_ptr_null(error_method_find("nameless"));
}
END_TEST

START_TEST(runs_that_can_be_started_are_complete)
{
    plan p = planned(1000, 1000, false, true);
    for (size_t i = 0; i < p.count; i++) {
        measure_settings settings = p.runs[i].settings;
        ck_assert_str_eq(settings.method, p.runs[i].method->name);
        ck_assert(p.runs[i].skipped || !measure_complete(&settings));
        ck_assert_uint_ge(settings.repeats, 1);
    }
}
END_TEST

// Their verdicts are compared with those of the first of them.
START_TEST(runs_that_must_agree_stand_together_and_plain_is_first)
{
    plan p = planned(1000, 1000, false, true);
    for (size_t i = 0; i < p.count; i++) {
        bool begins = i == 0 || !error_run_equals(&p.runs[i - 1], &p.runs[i]);
        if (!begins) continue;
        ck_assert_str_eq(p.runs[i].settings.backend, "plain");
        for (size_t k = 0; k + 1 < i; k++)
            ck_assert_msg(!error_run_equals(&p.runs[k], &p.runs[i]), "runs %zu and %zu", k, i);
    }
}
END_TEST

START_TEST(quadratic_methods_sit_out_large_scenes)
{
    plan large = planned(100000, 100000, false, true);
    ck_assert_uint_eq(count_runs(&large, "thesis", "plain", true), 1);
    ck_assert_uint_eq(count_runs(&large, "thesis", "plain", false), 0);
    ck_assert_uint_eq(count_runs(&large, "pairwise", "plain", false), 0);
    ck_assert_uint_ge(count_runs(&large, "single", "opencl", false), 1);
    for (size_t i = 0; i < large.count; i++)
        ck_assert(!(large.runs[i].scale < 1) && !(large.runs[i].scale > 1));
    plan small = planned(1000, 1000, false, true);
    ck_assert_uint_eq(count_runs(&small, "thesis", "plain", false), 3); // scales
}
END_TEST

START_TEST(without_a_device_opencl_is_skipped)
{
    plan p = planned(1000, 1000, false, false);
    ck_assert_uint_eq(count_runs(&p, "single", "opencl", false), 0);
    ck_assert_uint_ge(count_runs(&p, "single", "opencl", true), 1);
    ck_assert_uint_ge(count_runs(&p, "single", "openmp", false), 2);
}
END_TEST

START_TEST(settings_have_names_of_their_own)
{
    plan p = planned(1000, 1000, false, true);
    for (size_t i = 0; i < p.count; i++)
        for (size_t k = 0; k < i; k++) {
            char a[64], b[64];
            error_run_setting(&p.runs[i], a, sizeof a);
            error_run_setting(&p.runs[k], b, sizeof b);
            bool is_one = p.runs[i].method == p.runs[k].method && strcmp(a, b) == 0;
            ck_assert_msg(is_one == error_run_equals(&p.runs[i], &p.runs[k]), "%s and %s", a, b);
        }
}
END_TEST

// How many runs have the setting; all of them with or without the promise.
static size_t count_setting(const plan *p, const char *setting, bool promises)
{
    size_t count = 0;
    for (size_t i = 0; i < p->count; i++) {
        char text[64];
        error_run_setting(&p->runs[i], text, sizeof text);
        if (strcmp(text, setting) != 0) continue;
        ck_assert_str_eq(p->runs[i].method->name, "fused");
        ck_assert(error_run_is_one_sided(&p->runs[i]) == promises);
        ck_assert(!error_run_is_default(&p->runs[i]));
        count++;
    }
    return count;
}

START_TEST(fused_is_run_with_presets_and_where_asked_with_tolerances)
{
    const obs_scene scene = {.object_count = 1000, .occluder_count = 1000};
    const error_options options = {.repeats = 3};
    plan p = planned(1000, 1000, true, false), without;
    without.count = error_plan(&options, &scene, without.runs);
    ck_assert_uint_eq(count_setting(&p, "preset fast", true), 2);
    ck_assert_uint_eq(count_setting(&p, "preset thorough", true), 2);
    ck_assert_uint_eq(count_setting(&without, "preset thorough", true), 2);
    static const char *const tolerances[] = {"tolerance 0.0003", "tolerance 0.001",
                                             "tolerance 0.003"};
    for (int i = 0; i < 3; i++) {
        ck_assert_uint_eq(count_setting(&p, tolerances[i], false), 2);
        ck_assert_uint_eq(count_setting(&without, tolerances[i], false), 0);
    }
}
END_TEST

// What a cull did is told by its statistics: equal knobs, equal figures.
static bool does_the_same(const occ_view_stats *a, const occ_view_stats *b)
{
    return a->visible == b->visible && a->tested == b->tested && a->ranges == b->ranges &&
           a->nodes_tested == b->nodes_tested && a->occluders_tested == b->occluders_tested &&
           a->occluders_used == b->occluders_used;
}

static occ_view_stats cull(occ_view *view, const occ_scene *scene, const obs_frame *frame,
                           const occ_cull_desc *knobs)
{
    double eye[3];
    occ_camera_desc camera = kit_obs_camera(frame, eye);
    occ_view_stats stats;
    ck_assert_int_eq(occ_cull(view, scene, &camera, knobs), OCC_SUCCESS);
    ck_assert_int_eq(occ_view_get_stats(view, &stats), OCC_SUCCESS);
    return stats;
}

// A wall of 1,600 boxes that do not hide each other, seen from the front. Some are as large as
// min_area asks for, some are not.
static obs_scene make_wall(void)
{
    enum { SIDE = 40 };
    const double eye[3] = {0, 0, 0}, ahead[3] = {0, 0, -1};
    obs_scene scene = {0};
    for (int i = 0; i < SIDE * SIDE; i++) {
        double half = 0.05 + 0.04 * (i % 7) / 6;
        int column = i % SIDE - SIDE / 2, row = i / SIDE - SIDE / 2;
        occ_box box = scenes_box(0.25 * column, 0.25 * row, -10, half, half, half);
        obs_add_occluder(&scene, &box, obs_add_object(&scene, &box));
    }
    obs_frame frame = obs_look(eye, ahead, 1, 1, 0.1, 100);
    obs_add_frame(&scene, &frame);
    ck_assert(!scene.out_of_memory);
    return scene;
}

// The report states all knobs, so the defaults must be what the library takes them to be: and each
// of them, were it another, would show.
START_TEST(stated_defaults_are_the_librarys)
{
    const occ_scene_desc fine = {.leaf_objects = 4};
    const occ_view_desc plain = {.backend = OCC_BACKEND_PLAIN};
    const occ_cull_desc *usual = &error_default_knobs;
    occ_cull_desc implied[3] = {*usual, *usual, *usual}, stated[3], altered[3];
    implied[1].min_area = 1e-7f; // so that there are more occluders than may be used
    memcpy(stated, implied, sizeof stated);
    memcpy(altered, implied, sizeof altered);
    implied[0].min_area = 0;
    implied[1].max_occluders = 0;
    implied[2].grain = 0;
    altered[0].min_area *= 1.25f;
    altered[1].max_occluders -= 24;
    altered[2].grain /= 2;

    occ_cull_desc library;
    occ_hooks hooks;
    static const occ_allocator no_allocator;
    static const occ_logger no_logger;
    ck_assert_int_eq(occ_hooks_init(&hooks, &no_allocator, &no_logger), OCC_SUCCESS);
    ck_assert_int_eq(occ_knobs_init(&library, NULL, &hooks), OCC_SUCCESS);
    ck_assert(kit_same_bits(&library, usual, sizeof library));

    obs_scene file = make_wall();
    occ_scene *scene = kit_obs_scene(&file, &fine, NULL, NULL);
    occ_view *view;
    ck_assert_int_eq(occ_view_create(&plain, &view), OCC_SUCCESS);
    for (int k = 0; k < 3; k++) {
        occ_view_stats ours = cull(view, scene, &file.frames[0], &stated[k]);
        occ_view_stats theirs = cull(view, scene, &file.frames[0], &implied[k]);
        occ_view_stats other = cull(view, scene, &file.frames[0], &altered[k]);
        ck_assert_msg(does_the_same(&ours, &theirs), "knob %d is another", k);
        ck_assert_msg(!does_the_same(&ours, &other), "knob %d does not show", k);
    }
    occ_view_destroy(view);
    occ_scene_destroy(scene);
    obs_free(&file);
}
END_TEST

START_TEST(hard_families_are_run_at_three_scales)
{
    const error_options options = {.has_opencl = true};
    static error_run runs[ERROR_MAX_RUNS];
    size_t count = error_plan_hard(&options, runs), ones = 0, small = 0, large = 0;
    ck_assert_uint_lt(count, ERROR_MAX_RUNS);
    for (size_t i = 0; i < count; i++) {
        ones += !(runs[i].scale < 1) && !(runs[i].scale > 1);
        small += runs[i].scale < 1;
        large += runs[i].scale > 1;
    }
    ck_assert_uint_eq(ones, small);
    ck_assert_uint_eq(ones, large);
    ck_assert_uint_eq(ones + small + large, count);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("error_plan");
    TCase *runs = tcase_create("runs");
    tcase_add_test(runs, every_method_is_in_the_plan);
    tcase_add_test(runs, runs_that_can_be_started_are_complete);
    tcase_add_test(runs, runs_that_must_agree_stand_together_and_plain_is_first);
    tcase_add_test(runs, quadratic_methods_sit_out_large_scenes);
    tcase_add_test(runs, without_a_device_opencl_is_skipped);
    tcase_add_test(runs, settings_have_names_of_their_own);
    tcase_add_test(runs, fused_is_run_with_presets_and_where_asked_with_tolerances);
    tcase_add_test(runs, hard_families_are_run_at_three_scales);
    suite_add_tcase(suite, runs);
    TCase *knobs = tcase_create("knobs");
    tcase_add_test(knobs, stated_defaults_are_the_librarys);
    suite_add_tcase(suite, knobs);
    return test_run_suite(suite);
}
