// SPDX-License-Identifier: Apache-2.0
// labels: property
// The shrinker itself, on faults made up here whose simplest worlds are known.
#include "mini_check.h"
#include "mini_shrink.h"
#include "support.h"

#include <stdio.h>
#include <string.h>

enum { WORLDS = WORLD_SHARE(60) };

// --- faults --------------------------------------------------------------------------------------

static bool has_object_beyond_3(const mini *m, void *context)
{
    (void)context;
    for (uint32_t i = 0; i < m->object_count; i++)
        if (m->objects[i].center[0] > 3.0f) return true;
    return false;
}

// An occluder is higher than the object that owns it.
static bool has_high_occluder(const mini *m, void *context)
{
    (void)context;
    for (uint32_t k = 0; k < m->occluder_count; k++) {
        const world_occluder *occluder = &m->occluders[k];
        if (occluder->owner < 0) continue;
        if (m->objects[occluder->owner].center[1] < occluder->box.center[1]) return true;
    }
    return false;
}

// Of all worlds with two objects or more, those with a reversed depth and an eye between floats.
static bool has_odd_camera(const mini *m, void *context)
{
    (void)context;
    double x = m->camera.eye[0];
    return m->object_count >= 2 && m->camera.depth == OCC_DEPTH_ONE_TO_ZERO &&
           x != (double)(float)x;
}

// Something in the frustum is hidden: no fault, but an answer of the library.
static bool has_hidden_object(const mini *m, void *context)
{
    mini_views *views = context;
    views->count.hidden = 0;
    return !mini_breaks(m, views, NULL) && views->count.hidden > 0;
}

// --- shrinking -----------------------------------------------------------------------------------

// The next world from the seed on that has the fault.
static mini find_world(uint64_t *seed, mini_predicate *fails, void *context)
{
    mini m;
    do {
        mini_make(&m, (*seed)++);
    } while (!fails(&m, context));
    return m;
}

static void is_zero(const float *numbers, int count)
{
    for (int i = 0; i < count; i++)
        KIT_CHECK(numbers[i] == 0.0f, "number %d is %g", i, (double)numbers[i]);
}

static void has_no_axes(const occ_box *box)
{
    for (int k = 0; k < 3; k++)
        is_zero(box->axis[k], 3);
}

static void is_plain(const mini_camera *camera)
{
    ck_assert_int_eq(camera->depth, OCC_DEPTH_MINUS_ONE_TO_ONE);
    for (int j = 0; j < 3; j++)
        ck_assert(camera->eye[j] == 0.0);
}

START_TEST(one_number_of_one_object_is_all_that_is_left)
{
    uint64_t seed = 1;
    for (int n = 0; n < WORLDS; n++) {
        mini m = find_world(&seed, has_object_beyond_3, NULL);
        mini_shrink(&m, has_object_beyond_3, NULL);
        ck_assert_uint_eq(m.object_count, 1);
        ck_assert_uint_eq(m.occluder_count, 0);
        ck_assert(m.objects[0].center[0] == 4.0f);
        is_zero(&m.objects[0].center[1], 2);
        has_no_axes(&m.objects[0]);
        is_plain(&m.camera);
    }
}
END_TEST

START_TEST(an_occluder_and_its_owner_stay_together)
{
    uint64_t seed = 1000;
    for (int n = 0; n < WORLDS; n++) {
        mini m = find_world(&seed, has_high_occluder, NULL);
        mini_shrink(&m, has_high_occluder, NULL);
        ck_assert_uint_eq(m.object_count, 1);
        ck_assert_uint_eq(m.occluder_count, 1);
        ck_assert_int_eq(m.occluders[0].owner, 0);
        has_no_axes(&m.objects[0]);
        has_no_axes(&m.occluders[0].box);
        float low = m.objects[0].center[1], high = m.occluders[0].box.center[1];
        ck_assert_msg((low == 0.0f && high == 1.0f) || (low == -1.0f && high == 0.0f),
                      "%g and %g are not as simple as can be", (double)low, (double)high);
        is_plain(&m.camera);
    }
}
END_TEST

START_TEST(what_the_fault_needs_of_the_camera_stays)
{
    uint64_t seed = 2000;
    for (int n = 0; n < WORLDS / 10; n++) {
        mini m = find_world(&seed, has_odd_camera, NULL);
        mini_shrink(&m, has_odd_camera, NULL);
        ck_assert(has_odd_camera(&m, NULL));
        ck_assert_uint_eq(m.object_count, 2);
        ck_assert_uint_eq(m.occluder_count, 0);
        ck_assert(m.camera.eye[1] == 0.0 && m.camera.eye[2] == 0.0);
        for (int i = 0; i < 2; i++) {
            is_zero(m.objects[i].center, 3);
            has_no_axes(&m.objects[i]);
        }
        // And is said to be more than a file can hold.
        ck_assert_ptr_nonnull(mini_shrink_for_file(&m, has_odd_camera, NULL));
        ck_assert(has_odd_camera(&m, NULL));
    }
}
END_TEST

START_TEST(no_step_is_left_and_none_makes_it_dearer)
{
    uint64_t seed = 3000;
    for (int n = 0; n < WORLDS; n++) {
        mini m = find_world(&seed, has_high_occluder, NULL), once;
        uint64_t before = mini_cost(&m);
        ck_assert_uint_gt(mini_shrink(&m, has_high_occluder, NULL), 0);
        ck_assert_uint_lt(mini_cost(&m), before);
        once = m;
        mini_shrink(&m, has_high_occluder, NULL);
        ck_assert_uint_eq(mini_cost(&m), mini_cost(&once));
    }
}
END_TEST

// --- the library's answers, and files ------------------------------------------------------------

static void read_back(const mini *m, mini *read)
{
    const char *path = OCC_TEST_OUT "/mini_shrink.obs";
    uint32_t frames = 0;
    ck_assert(mini_write(m, path));
    ck_assert(mini_read(read, path, 0, &frames));
    ck_assert_uint_eq(frames, 1);
    ck_assert_int_eq(remove(path), 0);
}

static void is_same(const mini *a, const mini *b)
{
    ck_assert_uint_eq(a->object_count, b->object_count);
    ck_assert_uint_eq(a->occluder_count, b->occluder_count);
    ck_assert(kit_same_bits(a->objects, b->objects, a->object_count * sizeof *a->objects));
    for (uint32_t k = 0; k < a->occluder_count; k++) {
        ck_assert(kit_same_bits(&a->occluders[k].box, &b->occluders[k].box, sizeof(occ_box)));
        ck_assert_int_eq(a->occluders[k].owner, b->occluders[k].owner);
    }
    occ_camera_desc one = mini_view_of(a), other = mini_view_of(b);
    ck_assert(kit_same_bits(one.view_projection, other.view_projection, 16 * sizeof(float)));
    ck_assert_int_eq(one.depth, other.depth);
}

START_TEST(what_was_written_and_read_again_fails_as_before)
{
    mini_views views = mini_open_views(false);
    uint64_t seed = 4000;
    uint32_t in_files = 0;
    for (int n = 0; n < WORLDS; n++) {
        mini m = find_world(&seed, has_hidden_object, &views), read;
        mini_shrink(&m, has_hidden_object, &views);
        ck_assert(has_hidden_object(&m, &views));
        ck_assert_uint_eq(m.object_count, 1);
        ck_assert_uint_eq(m.occluder_count, 1);
        if (mini_shrink_for_file(&m, has_hidden_object, &views)) continue;
        in_files++;
        read_back(&m, &read);
        is_same(&m, &read);
        read.camera.eye_given = m.camera.eye_given;
        ck_assert(has_hidden_object(&read, &views));
    }
    ck_assert_uint_gt(in_files, WORLDS * 9 / 10);
    mini_close_views(&views);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("mini shrink");
    TCase *planted = tcase_create("planted");
    tcase_add_test(planted, one_number_of_one_object_is_all_that_is_left);
    tcase_add_test(planted, an_occluder_and_its_owner_stay_together);
    tcase_add_test(planted, what_the_fault_needs_of_the_camera_stays);
    tcase_add_test(planted, no_step_is_left_and_none_makes_it_dearer);
    suite_add_tcase(suite, planted);
    TCase *files = tcase_create("files");
    tcase_add_test(files, what_was_written_and_read_again_fails_as_before);
    suite_add_tcase(suite, files);
    return test_run_suite(suite);
}
