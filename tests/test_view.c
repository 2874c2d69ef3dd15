// SPDX-License-Identifier: Apache-2.0
// Making views and reading results.
#include "kit_tree.h"
#include "support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { OBJECTS = 1000, SENTINEL = 0x5ca1ab1e };

static occ_scene *scene;
static occ_view *view;
static kit_log record;
static occ_object objects[OBJECTS];

static void set_up(void)
{
    kit_forget(&record);
    occ_view_desc desc = {.logger = kit_logger(&record), .backend = OCC_BACKEND_PLAIN};
    ck_assert_int_eq(occ_view_create(&desc, &view), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_create(NULL, &scene), OCC_SUCCESS);
    kit_fill(scene, OBJECTS, 2, 31, objects, NULL);
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
}

static void tear_down(void)
{
    occ_view_destroy(view);
    occ_scene_destroy(scene);
}

static void cull(uint32_t i)
{
    occ_camera_desc camera = kit_path(i);
    kit_cull(view, scene, &camera, NULL);
    kit_forget(&record);
}

// The three arrays of a result, through one kind of pointer.
typedef occ_result (*reader)(const occ_view *from, uint32_t *words, size_t capacity, size_t *count);

static occ_result read_occluders(const occ_view *from, uint32_t *words, size_t capacity,
                                 size_t *count)
{
    return occ_view_read_occluders(from, (occ_occluder *)(void *)words, capacity, count);
}

static const struct {
    reader read;
    size_t words; // of an element
} readers[] = {{occ_view_read_mask, 1}, {occ_view_read_visible, 1}, {read_occluders, 2}};
enum { READERS = (int)(sizeof readers / sizeof *readers) };

static void check_no_result(void)
{
    uint32_t words[2] = {SENTINEL, SENTINEL};
    occ_view_stats stats;
    for (int r = 0; r < READERS; r++) {
        size_t count = 77;
        kit_forget(&record);
        ck_assert_int_eq(readers[r].read(view, words, 1, &count), OCC_ERROR_NO_RESULT);
        ck_assert(kit_logged(&record, "OCC_ERROR_NO_RESULT"));
        ck_assert_uint_eq(count, 0);
        ck_assert_uint_eq(words[0], SENTINEL);
        ck_assert_int_eq(readers[r].read(view, NULL, 0, NULL), OCC_ERROR_NO_RESULT);
    }
    ck_assert_int_eq(occ_view_get_stats(view, &stats), OCC_ERROR_NO_RESULT);
    for (uint32_t i = 0; i < OBJECTS; i++)
        KIT_CHECK(!occ_view_is_visible(view, objects[i]), "object %u is visible", i);
}

START_TEST(view_without_a_cull_has_no_result)
{
    check_no_result();
}
END_TEST

START_TEST(failed_cull_takes_the_result_away)
{
    occ_camera_desc camera = kit_path(0), broken = camera;
    broken.view_projection[5] = NAN;
    occ_cull_desc knobs = {.min_area = -1.0f};
    cull(0);
    ck_assert_int_eq(occ_cull(view, scene, &broken, NULL), OCC_ERROR_NOT_FINITE);
    check_no_result();
    cull(0);
    ck_assert_int_eq(occ_cull(view, scene, &camera, &knobs), OCC_ERROR_INVALID_ARGUMENT);
    check_no_result();
    cull(0);
    ck_assert_int_eq(occ_cull(view, NULL, &camera, NULL), OCC_ERROR_INVALID_ARGUMENT);
    check_no_result();
    cull(0);
    ck_assert_int_eq(occ_cull(view, scene, NULL, NULL), OCC_ERROR_INVALID_ARGUMENT);
    check_no_result();
}
END_TEST

START_TEST(short_array_is_left_alone_and_the_size_told)
{
    reader read = readers[_i].read;
    size_t needed = 0, size = readers[_i].words;
    cull(1);
    ck_assert_int_eq(read(view, NULL, 0, &needed), OCC_ERROR_BUFFER_TOO_SMALL);
    ck_assert_uint_eq(record.lines, 0); // asking is no mistake
    ck_assert_uint_gt(needed, 10);
    uint32_t *words = malloc((needed + 1) * size * sizeof *words);
    ck_assert_ptr_nonnull(words);
    for (size_t capacity = 0; capacity <= needed + 1; capacity += capacity + 2 < needed ? 7 : 1) {
        for (size_t w = 0; w < (needed + 1) * size; w++)
            words[w] = SENTINEL;
        size_t count = 0, written = capacity < needed ? 0 : needed * size;
        occ_result result = read(view, words, capacity, &count);
        KIT_CHECK(result == (capacity < needed ? OCC_ERROR_BUFFER_TOO_SMALL : OCC_SUCCESS),
                  "%s for %zu of %zu", occ_result_name(result), capacity, needed);
        KIT_CHECK(count == needed, "%zu are needed, it says %zu", needed, count);
        for (size_t w = written; w < (needed + 1) * size; w++)
            KIT_CHECK(words[w] == SENTINEL, "word %zu was written", w);
    }
    ck_assert_int_eq(read(view, words, needed, NULL), OCC_SUCCESS);
    ck_assert_int_eq(read(view, NULL, needed, NULL), OCC_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(read(view, words, needed - 1, NULL), OCC_ERROR_BUFFER_TOO_SMALL);
    ck_assert(kit_logged(&record, "OCC_ERROR_BUFFER_TOO_SMALL"));
    free(words);
}
END_TEST

START_TEST(missing_view_or_stats_are_refused)
{
    size_t count = 77;
    occ_view_stats stats;
    for (int r = 0; r < READERS; r++) {
        ck_assert_int_eq(readers[r].read(NULL, NULL, 0, &count), OCC_ERROR_INVALID_ARGUMENT);
        ck_assert_uint_eq(count, 0);
    }
    cull(0);
    occ_camera_desc camera = kit_path(0);
    ck_assert_int_eq(occ_view_get_stats(NULL, &stats), OCC_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(occ_view_get_stats(view, NULL), OCC_ERROR_INVALID_ARGUMENT);
    ck_assert_uint_eq(record.errors, 1);
    ck_assert_int_eq(occ_cull(NULL, scene, &camera, NULL), OCC_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(occ_view_create(NULL, NULL), OCC_ERROR_INVALID_ARGUMENT);
    ck_assert(!occ_view_is_visible(NULL, objects[0]));
    occ_view_destroy(NULL);
}
END_TEST

START_TEST(list_holds_the_slots_of_the_mask_in_order)
{
    uint32_t slots[OBJECTS];
    for (uint32_t i = 0; i < 6; i++) {
        cull(i);
        size_t words, count;
        uint32_t *mask = kit_mask(view, &words);
        ck_assert_uint_eq(words, OCC_MASK_WORDS(occ_scene_slot_count(scene)));
        ck_assert_int_eq(occ_view_read_visible(view, slots, OBJECTS, &count), OCC_SUCCESS);
        ck_assert_uint_gt(count, 0);
        size_t next = 0;
        for (uint32_t s = 0; s < 32 * words; s++) {
            if (!(mask[s / 32] >> s % 32 & 1u)) continue;
            KIT_CHECK(next < count && slots[next] == s, "slot %u is missing in the list", s);
            next++;
        }
        ck_assert_uint_eq(next, count);
        free(mask);
    }
}
END_TEST

START_TEST(object_is_visible_if_its_bit_is_set)
{
    cull(2);
    uint32_t *mask = kit_mask(view, NULL);
    for (uint32_t i = 0; i < OBJECTS; i++) {
        uint32_t slot = occ_object_slot(objects[i]);
        bool bit = mask[slot / 32] >> slot % 32 & 1u;
        KIT_CHECK(occ_view_is_visible(view, objects[i]) == bit, "object %u", i);
    }
    ck_assert(!occ_view_is_visible(view, (occ_object){0, 0}));
    ck_assert(!occ_view_is_visible(view, (occ_object){OBJECTS + 1, 1}));
    ck_assert(!occ_view_is_visible(view, (occ_object){UINT32_MAX, 1}));
    free(mask);
}
END_TEST

START_TEST(slot_without_an_object_is_never_visible)
{
    for (uint32_t i = 0; i < OBJECTS; i += 3)
        ck_assert_int_eq(occ_scene_remove(scene, objects[i]), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
    cull(0);
    uint32_t *mask = kit_mask(view, NULL);
    for (uint32_t i = 0; i < OBJECTS; i += 3) {
        uint32_t slot = occ_object_slot(objects[i]);
        KIT_CHECK(!(mask[slot / 32] >> slot % 32 & 1u), "slot %u is visible", slot);
    }
    free(mask);
}
END_TEST

// The squared distance from the eye to the bounds of an occluder.
static double nearness(occ_occluder occluder, const float eye[3])
{
    occ_box box;
    ck_assert_int_eq(occ_scene_occluder_box(scene, occluder, &box, NULL), OCC_SUCCESS);
    double sum = 0.0;
    for (int j = 0; j < 3; j++) {
        double half = 0.0;
        for (int k = 0; k < 3; k++)
            half += fabs((double)box.axis[k][j]);
        double gap = fmax(0.0, fabs((double)box.center[j] - (double)eye[j]) - half);
        sum += gap * gap;
    }
    return sum;
}

START_TEST(occluders_that_took_part_come_front_to_back)
{
    static const float eye[3] = {95, 3, 0}, target[3] = {0, 2, 5};
    occ_camera_desc camera = kit_look(eye, target);
    kit_cull(view, scene, &camera, &(occ_cull_desc){.min_area = 1e-5f});
    occ_occluder used[OBJECTS];
    occ_view_stats stats;
    size_t count;
    ck_assert_int_eq(occ_view_read_occluders(view, used, OBJECTS, &count), OCC_SUCCESS);
    ck_assert_int_eq(occ_view_get_stats(view, &stats), OCC_SUCCESS);
    ck_assert_uint_eq(count, stats.occluders_used);
    ck_assert_uint_gt(count, 10);
    double last = 0.0;
    for (size_t i = 0; i < count; i++) {
        double now = nearness(used[i], eye);
        KIT_CHECK(now >= last * (15.0 / 16.0 - 1e-5) - 1e-5,
                  "occluder %zu is much nearer than the last", i);
        last = fmax(last, now);
        for (size_t k = 0; k < i; k++)
            KIT_CHECK(used[k].index != used[i].index, "occluder %zu took part twice", i);
    }
}
END_TEST

// --- stats ---------------------------------------------------------------------------------------

static occ_view_stats stats_of(void)
{
    occ_view_stats stats;
    ck_assert_int_eq(occ_view_get_stats(view, &stats), OCC_SUCCESS);
    return stats;
}

static void check_sums(const occ_view_stats *s)
{
    ck_assert_uint_eq(s->objects, OBJECTS);
    ck_assert_uint_eq(s->objects, s->walk_outside + s->walk_hidden + s->tested);
    ck_assert_uint_eq(s->tested, s->test_outside + s->test_hidden + s->visible);
    ck_assert_uint_le(s->occluders_used, s->occluders_tested);
    ck_assert_uint_le(s->ranges, s->tested);
    ck_assert_uint_ge(s->ranges * 64u, s->tested);
    ck_assert(s->walk_ms >= 0.0 && s->test_ms >= 0.0);
    size_t words, shown = 0;
    uint32_t *mask = kit_mask(view, &words);
    for (size_t w = 0; w < words; w++)
        shown += (size_t)__builtin_popcount(mask[w]);
    free(mask);
    ck_assert_uint_eq(s->visible, shown);
}

START_TEST(stages_add_up_to_all_objects)
{
    static const uint32_t grains[] = {1, 0, 200, UINT32_MAX};
    static const float areas[] = {0.0f, 1e-30f, 1e-3f, INFINITY};
    for (uint32_t i = 0; i < 16; i++) {
        occ_camera_desc camera = kit_path(i);
        occ_cull_desc knobs = {
            .method = (occ_method)_i, .grain = grains[i % 4], .min_area = areas[i / 4]};
        kit_cull(view, scene, &camera, &knobs);
        occ_view_stats stats = stats_of();
        check_sums(&stats);
    }
}
END_TEST

START_TEST(frustum_alone_hides_nothing)
{
    occ_camera_desc camera = kit_path(0);
    kit_cull(view, scene, &camera, &(occ_cull_desc){.method = OCC_METHOD_FRUSTUM});
    occ_view_stats stats = stats_of();
    ck_assert_uint_eq(stats.walk_hidden + stats.test_hidden + stats.occluders_used, 0);
    ck_assert_uint_gt(stats.walk_outside + stats.test_outside, 0);
}
END_TEST

START_TEST(pairs_are_tested_without_a_walk)
{
    occ_camera_desc camera = kit_path(0);
    kit_cull(view, scene, &camera, &(occ_cull_desc){.method = OCC_METHOD_PAIRWISE});
    occ_view_stats stats = stats_of();
    ck_assert_uint_eq(stats.tested, OBJECTS);
    ck_assert_uint_eq(stats.occluders_tested, OBJECTS / 2);
    ck_assert_uint_eq(stats.nodes_tested, 0);
}
END_TEST

START_TEST(no_more_occluders_are_used_than_asked_for)
{
    occ_camera_desc camera = kit_path(0);
    uint32_t last = 0;
    for (uint32_t most = 1; most < 40; most += 6) {
        kit_cull(view, scene, &camera, &(occ_cull_desc){.max_occluders = most});
        occ_view_stats stats = stats_of();
        ck_assert_uint_le(stats.occluders_used, most);
        ck_assert_uint_ge(stats.occluders_used, last);
        last = stats.occluders_used;
    }
    ck_assert_uint_gt(last, 10);
}
END_TEST

START_TEST(zero_stands_for_the_documented_default)
{
    static const occ_cull_desc documented = {
        .min_area = 3e-4f, .max_occluders = 1024, .grain = 64, .max_splits = 48};
    for (uint32_t i = 0; i < 5; i++) {
        occ_camera_desc camera = kit_path(i);
        uint32_t *masks[3];
        size_t words[3];
        occ_view_stats stats[3];
        for (int k = 0; k < 3; k++) {
            const occ_cull_desc zero = {.method = OCC_METHOD_FUSED};
            kit_cull(view, scene, &camera, k == 0 ? NULL : k == 1 ? &zero : &documented);
            masks[k] = kit_mask(view, &words[k]);
            stats[k] = stats_of();
        }
        for (int k = 1; k < 3; k++) {
            ck_assert_mem_eq(masks[0], masks[k], words[0] * sizeof *masks[0]);
            ck_assert_uint_eq(stats[0].ranges, stats[k].ranges);
            ck_assert_uint_eq(stats[0].occluders_used, stats[k].occluders_used);
        }
        for (int k = 0; k < 3; k++)
            free(masks[k]);
    }
}
END_TEST

START_TEST(culling_changes_nothing_in_the_scene)
{
    struct occ_scene before = *scene;
    for (uint32_t i = 0; i < 10; i++)
        cull(i);
    ck_assert_mem_eq(scene, &before, sizeof before);
    kit_check_trees(scene);
}
END_TEST

static TCase *with_fixture(TCase *group)
{
    tcase_add_checked_fixture(group, set_up, tear_down);
    return group;
}

int main(void)
{
    Suite *suite = suite_create("view");
    TCase *results = with_fixture(tcase_create("results"));
    tcase_add_test(results, view_without_a_cull_has_no_result);
    tcase_add_test(results, failed_cull_takes_the_result_away);
    tcase_add_loop_test(results, short_array_is_left_alone_and_the_size_told, 0, READERS);
    tcase_add_test(results, missing_view_or_stats_are_refused);
    tcase_add_test(results, list_holds_the_slots_of_the_mask_in_order);
    tcase_add_test(results, object_is_visible_if_its_bit_is_set);
    tcase_add_test(results, slot_without_an_object_is_never_visible);
    tcase_add_test(results, occluders_that_took_part_come_front_to_back);
    suite_add_tcase(suite, results);
    TCase *stats = with_fixture(tcase_create("stats"));
    tcase_add_loop_test(stats, stages_add_up_to_all_objects, OCC_METHOD_FUSED,
                        OCC_METHOD_SINGLE + 1);
    tcase_add_test(stats, frustum_alone_hides_nothing);
    tcase_add_test(stats, pairs_are_tested_without_a_walk);
    tcase_add_test(stats, no_more_occluders_are_used_than_asked_for);
    tcase_add_test(stats, zero_stands_for_the_documented_default);
    tcase_add_test(stats, culling_changes_nothing_in_the_scene);
    suite_add_tcase(suite, stats);
    return test_run_suite(suite);
}
