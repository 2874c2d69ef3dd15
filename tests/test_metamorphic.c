// SPDX-License-Identifier: Apache-2.0
// labels: property
// timeout: 120
// The same large scene told in other words: scaled, renumbered, moved, mirrored, turned. What must
// be the same bit for bit is compared so; where rounding or the octree's cells may differ, the
// exact judge sees nothing of what is left out, and nearly nothing differs.
#include "meta.h"
#include "support.h"

#include <math.h>
#include <stdlib.h>

// A method with the knobs it is tried with. All pairs take long: they get a smaller scene.
typedef struct trial {
    const char *name;
    occ_cull_desc knobs;
    bool small;
} trial;

static const trial trials[] = {
    {"pairwise", {.method = OCC_METHOD_PAIRWISE}, true},
    {"single", {.method = OCC_METHOD_SINGLE}, false},
    {"single with all occluders",
     {.method = OCC_METHOD_SINGLE, .min_area = 1e-30f, .max_occluders = 1u << 30, .grain = 1},
     false},
    {"fused", {.method = OCC_METHOD_FUSED}, false},
    {"frustum", {.method = OCC_METHOD_FRUSTUM}, false},
};

// Whether the order in which occluders are met may show in what is missed.
static bool has_an_order(const trial *t)
{
    return t->knobs.method == OCC_METHOD_SINGLE || t->knobs.method == OCC_METHOD_FUSED;
}

enum { TRIALS = sizeof trials / sizeof *trials, SCENES = 5, BACKENDS = 2 };

static const char *const names[SCENES] = {"city", "forest", "soup", "seedscene", "interior"};
static const uint32_t counts[SCENES] = {6000, 4000, 4000, 2000, 12000};

static meta scene_for(int number, bool small)
{
    return meta_scene(names[number], small ? 600 : WORLD_SHARE(counts[number]), 3);
}

// One answer in each telling.
typedef struct pair {
    const trial *t;
    const meta *m; // as it was
    uint32_t camera;
    uint32_t every;     // so manieth of all that is left out is judged
    const bool *before; // what is seen of it
    const bool *now;    // what is seen of it in other words, in the old order
    const char *what;
} pair;

typedef void check(const pair *p, uint32_t sums[2]);

// sums: how many answers there are, and how many differ.
static void is_same(const pair *p, uint32_t sums[2])
{
    sums[0] += p->m->object_count;
    for (uint32_t i = 0; i < p->m->object_count; i++)
        KIT_CHECK(p->before[i] == p->now[i], "%s, %s, camera %u: object %u is %s only now",
                  p->t->name, p->what, p->camera, i, p->now[i] ? "visible" : "left out");
}

static void is_true(const pair *p, uint32_t sums[2])
{
    meta_difference d = meta_compare(p->m, p->camera, p->before, p->now, p->every);
    sums[0] += p->m->object_count;
    sums[1] += d.gone + d.come;
}

// Two tellings of a scene, and what is demanded of them. Object i of the other is object order[i];
// order NULL: object i.
typedef struct telling {
    const trial *t;
    const meta *m, *other;
    const uint32_t *order;
    const char *what;
    check *good;
} telling;

static void compare_cameras(const telling *w, occ_view *view, uint32_t every, uint32_t sums[2])
{
    uint32_t count = w->m->object_count;
    occ_scene *scenes[2] = {meta_build(w->m), meta_build(w->other)};
    for (uint32_t c = 0; c < META_CAMERAS; c++) {
        bool *before = meta_seen(view, scenes[0], w->m, c, &w->t->knobs);
        bool *there = meta_seen(view, scenes[1], w->other, c, &w->t->knobs);
        bool *now = calloc(count + 1u, sizeof *now);
        ck_assert_ptr_nonnull(now);
        for (uint32_t i = 0; i < count; i++)
            now[w->order ? w->order[i] : i] = there[i];
        pair p = {w->t, w->m, c, every, before, now, w->what};
        w->good(&p, sums);
        free(before);
        free(there);
        free(now);
    }
    for (int i = 0; i < 2; i++)
        occ_scene_destroy(scenes[i]);
}

static void compare(const telling *w, uint32_t sums[2])
{
    for (int b = 0; b < BACKENDS; b++) {
        occ_view *view = world_view(b ? OCC_BACKEND_OPENMP : OCC_BACKEND_PLAIN, 2);
        compare_cameras(w, view, b ? 0 : 1000, sums);
        occ_view_destroy(view);
    }
}

// --- scaling -------------------------------------------------------------------------------------

START_TEST(a_power_of_two_changes_no_verdict)
{
    static const int powers[] = {-30, -11, 4, 30};
    uint32_t sums[2] = {0, 0};
    for (int t = 0; t < TRIALS; t++) {
        meta m = scene_for(_i, trials[t].small);
        for (int i = 0; i < 4; i++) {
            meta_map map = meta_identity;
            map.factor = ldexpf(1.0f, powers[i]);
            meta other = meta_mapped(&m, &map);
            compare(&(telling){&trials[t], &m, &other, NULL, "scaled", is_same}, sums);
            meta_free(&other);
        }
        meta_free(&m);
    }
    ck_assert_uint_gt(sums[0], 0);
}
END_TEST

// --- renumbering ---------------------------------------------------------------------------------

START_TEST(renumbered_objects_have_the_verdicts_they_had)
{
    uint32_t sums[2] = {0, 0};
    for (int t = 0; t < TRIALS; t++) {
        meta m = scene_for(_i, trials[t].small);
        uint32_t *order = meta_order(m.object_count, (uint64_t)_i + 1);
        meta other = meta_objects_in_order(&m, order);
        compare(&(telling){&trials[t], &m, &other, order, "objects renumbered", is_same}, sums);
        meta_free(&other);
        meta_free(&m);
        free(order);
    }
}
END_TEST

START_TEST(renumbered_occluders_hide_what_they_hid)
{
    uint32_t sums[2] = {0, 0}, exact[2] = {0, 0};
    for (int t = 0; t < TRIALS; t++) {
        meta m = scene_for(_i, trials[t].small);
        uint32_t *order = meta_order(m.occluder_count, (uint64_t)_i + 1);
        meta other = meta_occluders_in_order(&m, order);
        bool single = has_an_order(&trials[t]);
        check *good = single ? is_true : is_same;
        compare(&(telling){&trials[t], &m, &other, NULL, "occluders renumbered", good},
                single ? sums : exact);
        meta_free(&other);
        meta_free(&m);
        free(order);
    }
    ck_assert_msg(sums[1] <= sums[0] / 1000, "%u of %u verdicts differ", sums[1], sums[0]);
}
END_TEST

// --- moving, mirroring, turning ------------------------------------------------------------------

static void tell(const meta_map *maps, int count, const char *what, int number, bool exact)
{
    uint32_t sums[2] = {0, 0};
    for (int t = 0; t < TRIALS; t++) {
        meta m = scene_for(number, trials[t].small);
        bool same = exact && !has_an_order(&trials[t]);
        for (int i = 0; i < count; i++) {
            for (int c = 0; c < META_CAMERAS; c++)
                m.cameras[c].derived = maps[i].by_origin;
            meta other = meta_mapped(&m, &maps[i]);
            check *good = same ? is_same : is_true;
            compare(&(telling){&trials[t], &m, &other, NULL, what, good}, sums);
            meta_free(&other);
        }
        meta_free(&m);
    }
    ck_assert_msg(sums[1] <= sums[0] / 1000, "%u of %u verdicts differ", sums[1], sums[0]);
}

START_TEST(a_scene_moved_by_exact_amounts_hides_nothing_that_is_seen)
{
    static const meta_map maps[] = {
        {{0, 1, 2}, {1, 1, 1}, 1, {-16384, 16384, 8192}, false},
        {{0, 1, 2}, {1, 1, 1}, 1, {16384, -32.5, 100}, true},
    };
    tell(maps, 2, "moved", _i, false);
}
END_TEST

START_TEST(a_mirrored_scene_hides_nothing_that_is_seen)
{
    static const meta_map maps[] = {
        {{0, 1, 2}, {-1, 1, 1}, 1, {0, 0, 0}, false},
        {{0, 1, 2}, {-1, -1, -1}, 1, {0, 0, 0}, false},
    };
    tell(maps, 2, "mirrored", _i, true);
}
END_TEST

START_TEST(a_scene_turned_by_90_degrees_hides_nothing_that_is_seen)
{
    static const meta_map maps[] = {
        {{1, 2, 0}, {1, 1, 1}, 1, {0, 0, 0}, false},
        {{1, 0, 2}, {-1, 1, 1}, 1, {0, 0, 0}, false},
    };
    tell(maps, 2, "turned", _i, false);
}
END_TEST

// --- on a device ---------------------------------------------------------------------------------

// Scaled and mirrored at once; and renumbered. Every method gives what it gave.
START_TEST(an_opencl_device_gives_the_same_in_other_words)
{
    occ_view *device = world_view(OCC_BACKEND_OPENCL, 0);
    for (int number = 0; device && number < SCENES; number++)
        for (int t = 0; t < TRIALS; t++) {
            meta m = meta_scene(names[number], 300, 3);
            meta_map map = {{0, 1, 2}, {-1, 1, -1}, 0x1p20f, {0, 0, 0}, false};
            bool single = has_an_order(&trials[t]);
            for (int j = 0; single && j < 3; j++) // which has other cells when mirrored
                map.sign[j] = 1.0f;
            uint32_t *order = meta_order(m.object_count, 5), sums[2] = {0, 0};
            meta mapped = meta_mapped(&m, &map), other = meta_objects_in_order(&mapped, order);
            telling w = {&trials[t], &m, &other, order, "on a device", is_same};
            compare_cameras(&w, device, 0, sums);
            free(order);
            meta_free(&mapped);
            meta_free(&other);
            meta_free(&m);
        }
    occ_view_destroy(device);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("metamorphic");
    TCase *exact = tcase_create("exact");
    tcase_add_loop_test(exact, a_power_of_two_changes_no_verdict, 0, SCENES);
    tcase_add_loop_test(exact, renumbered_objects_have_the_verdicts_they_had, 0, SCENES);
    tcase_add_loop_test(exact, renumbered_occluders_hide_what_they_hid, 0, SCENES);
    suite_add_tcase(suite, exact);
    TCase *judged = tcase_create("judged");
    tcase_add_loop_test(judged, a_scene_moved_by_exact_amounts_hides_nothing_that_is_seen, 0,
                        SCENES);
    tcase_add_loop_test(judged, a_mirrored_scene_hides_nothing_that_is_seen, 0, SCENES);
    tcase_add_loop_test(judged, a_scene_turned_by_90_degrees_hides_nothing_that_is_seen, 0, SCENES);
    suite_add_tcase(suite, judged);
    TCase *device = tcase_create("device");
    tcase_add_test(device, an_opencl_device_gives_the_same_in_other_words);
    suite_add_tcase(suite, device);
    return test_run_suite(suite);
}
