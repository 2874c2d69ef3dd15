// SPDX-License-Identifier: Apache-2.0
// Asking what hid an object: a scene where that is plain, and every way to ask wrongly.
#include "kit.h"
#include "support.h"

#include <occlude/occlude.h>

// The eye is at the origin and looks along -z. Two panels with their rims on top of each other hide
// `both` together; the left one hides `left` alone, and its owner, which is as it should be not
// hidden by it. A crumb stands before the seam and a plate far behind all.
typedef struct stand {
    occ_scene *scene;
    occ_view *view;
    occ_camera_desc camera;
    occ_object left, both, owner, aside, shown;
    occ_occluder left_panel, right_panel, crumb, plate;
    kit_heap heap;
    kit_log log;
} stand;

static stand s;

static occ_box brick(float x, float y, float z, float a, float b, float c)
{
    return (occ_box){{x, y, z}, {{a, 0, 0}, {0, b, 0}, {0, 0, c}}};
}

static occ_object add(occ_box box)
{
    occ_object object;
    ck_assert_int_eq(occ_scene_add(s.scene, &box, &object), OCC_SUCCESS);
    return object;
}

static occ_occluder add_occluder(occ_box box, occ_object owner)
{
    occ_occluder occluder;
    ck_assert_int_eq(occ_scene_add_occluder(s.scene, &box, owner, &occluder), OCC_SUCCESS);
    return occluder;
}

static void cull(occ_method method)
{
    occ_cull_desc knobs = {.method = method, .min_area = 1e-30f};
    kit_cull(s.view, s.scene, &s.camera, &knobs);
}

static void set_up(void)
{
    const occ_object nobody = {0, 0};
    const float eye[3] = {0, 0, 0}, target[3] = {0, 0, -1};
    s = (stand){.camera = kit_look(eye, target)};
    occ_view_desc desc = {.allocator = kit_allocator(&s.heap), .logger = kit_logger(&s.log)};
    ck_assert_int_eq(occ_scene_create(NULL, &s.scene), OCC_SUCCESS);
    ck_assert_int_eq(occ_view_create(&desc, &s.view), OCC_SUCCESS);
    s.left = add(brick(-5, 0, -30, 1, 1, 1));
    s.both = add(brick(0, 0, -30, 3, 1, 1));
    s.owner = add(brick(-2, 0, -12.5f, 1, 1, 2));
    s.aside = add(brick(0, 0, 30, 1, 1, 1));
    s.shown = add(brick(0, 8, -30, 1, 1, 1));
    s.plate = add_occluder(brick(0, 0, -29, 0.5f, 0.5f, 0), nobody);
    s.right_panel = add_occluder(brick(1.9f, 0, -11, 2, 2, 0), nobody);
    s.left_panel = add_occluder(brick(-1.9f, 0, -10, 2, 2, 0), s.owner);
    s.crumb = add_occluder(brick(0, 0, -5, 0.2f, 0.2f, 0.01f), nobody);
    ck_assert_int_eq(occ_scene_commit(s.scene), OCC_SUCCESS);
    cull(OCC_METHOD_FUSED);
}

static void tear_down(void)
{
    occ_view_destroy(s.view);
    occ_scene_destroy(s.scene);
    ck_assert_uint_eq(s.heap.blocks, 0);
}

static bool is(occ_occluder a, occ_occluder b)
{
    return a.index == b.index && a.generation == b.generation;
}

// Fate and number of occluders, which are put into `named`.
static occ_fate ask(occ_object object, occ_occluder named[4], size_t *count)
{
    occ_fate fate;
    ck_assert_int_eq(occ_view_explain(s.view, s.scene, object, &fate, named, 4, count),
                     OCC_SUCCESS);
    return fate;
}

// --- answers -------------------------------------------------------------------------------------

START_TEST(two_that_hide_together_are_named_nearest_first_and_no_others)
{
    occ_occluder named[4];
    size_t count;
    ck_assert_int_eq(ask(s.both, named, &count), OCC_FATE_HIDDEN);
    ck_assert_uint_eq(count, 2);
    ck_assert(is(named[0], s.left_panel));
    ck_assert(is(named[1], s.right_panel));
}
END_TEST

START_TEST(one_that_hides_alone_is_named_alone)
{
    occ_occluder named[4];
    size_t count;
    ck_assert_int_eq(ask(s.left, named, &count), OCC_FATE_HIDDEN);
    ck_assert_uint_eq(count, 1);
    ck_assert(is(named[0], s.left_panel));
    cull(OCC_METHOD_SINGLE);
    ck_assert_int_eq(ask(s.left, named, &count), OCC_FATE_HIDDEN);
    ck_assert_uint_eq(count, 1);
    ck_assert(is(named[0], s.left_panel));
}
END_TEST

START_TEST(what_is_not_hidden_has_a_fate_and_no_occluders)
{
    occ_occluder named[4];
    size_t count = 7;
    ck_assert_int_eq(ask(s.owner, named, &count), OCC_FATE_VISIBLE);
    ck_assert_uint_eq(count, 0);
    ck_assert_int_eq(ask(s.shown, named, &count), OCC_FATE_VISIBLE);
    ck_assert_uint_eq(count, 0);
    ck_assert_int_eq(ask(s.aside, named, &count), OCC_FATE_OUTSIDE);
    ck_assert_uint_eq(count, 0);
    cull(OCC_METHOD_SINGLE);
    ck_assert_int_eq(ask(s.both, named, &count), OCC_FATE_VISIBLE);
    cull(OCC_METHOD_FRUSTUM);
    ck_assert_int_eq(ask(s.left, named, &count), OCC_FATE_VISIBLE);
    ck_assert_int_eq(ask(s.aside, named, &count), OCC_FATE_OUTSIDE);
}
END_TEST

// Of a heap that fell with its node, each object has a reason of its own: the small ones here are
// behind one of the panels each, and only the heap as a whole needs both.
START_TEST(an_object_that_fell_with_a_node_gets_the_reason_that_is_its_own)
{
    occ_object heap[200];
    occ_occluder named[4];
    occ_view_stats stats;
    size_t count;
    for (int i = 0; i < 200; i++)
        heap[i] = add(brick(-4.5f + 9 * (float)(i % 2), 0, -40 - 0.01f * (float)i, 0.5f, 0.5f, 0));
    ck_assert_int_eq(occ_scene_commit(s.scene), OCC_SUCCESS);
    cull(OCC_METHOD_FUSED);
    ck_assert_int_eq(occ_view_get_stats(s.view, &stats), OCC_SUCCESS);
    ck_assert_uint_ge(stats.walk_hidden, 100);
    for (int i = 0; i < 200; i++) {
        ck_assert_int_eq(ask(heap[i], named, &count), OCC_FATE_HIDDEN);
        ck_assert_uint_eq(count, 1);
        ck_assert(is(named[0], i % 2 ? s.right_panel : s.left_panel));
    }
}
END_TEST

START_TEST(asking_allocates_nothing)
{
    occ_occluder named[4];
    size_t count;
    uint64_t calls = s.heap.calls;
    ask(s.both, named, &count);
    ask(s.left, named, &count);
    ck_assert_uint_eq(s.heap.calls, calls);
}
END_TEST

// --- the caller's array --------------------------------------------------------------------------

START_TEST(the_number_can_be_asked_for)
{
    size_t count = 0;
    occ_fate fate = OCC_FATE_VISIBLE;
    kit_forget(&s.log);
    ck_assert_int_eq(occ_view_explain(s.view, s.scene, s.both, &fate, NULL, 0, &count),
                     OCC_ERROR_BUFFER_TOO_SMALL);
    ck_assert_uint_eq(count, 2);
    ck_assert_int_eq(fate, OCC_FATE_HIDDEN);
    ck_assert_uint_eq(s.log.lines, 0);
    ck_assert_int_eq(occ_view_explain(s.view, s.scene, s.shown, NULL, NULL, 0, NULL), OCC_SUCCESS);
}
END_TEST

START_TEST(an_array_that_is_too_short_is_not_written_to)
{
    occ_occluder named[1] = {{77, 78}};
    size_t count = 0;
    ck_assert_int_eq(occ_view_explain(s.view, s.scene, s.both, NULL, named, 1, &count),
                     OCC_ERROR_BUFFER_TOO_SMALL);
    ck_assert_uint_eq(count, 2);
    ck_assert_uint_eq(named[0].index, 77);
    ck_assert(kit_logged(&s.log, "1 elements, 2 are needed"));
    ck_assert_int_eq(occ_view_explain(s.view, s.scene, s.both, NULL, NULL, 4, &count),
                     OCC_ERROR_INVALID_ARGUMENT);
    ck_assert(kit_logged(&s.log, "the array is NULL"));
}
END_TEST

// --- wrong questions -----------------------------------------------------------------------------

// That the question fails so, with a log line that holds `reason`.
static void refuse(const occ_scene *scene, occ_object object, occ_result expected,
                   const char *reason)
{
    occ_occluder named[4];
    size_t count = 9;
    occ_fate fate = OCC_FATE_HIDDEN;
    kit_forget(&s.log);
    ck_assert_int_eq(occ_view_explain(s.view, scene, object, &fate, named, 4, &count), expected);
    ck_assert_uint_eq(count, 0);
    ck_assert_int_eq(fate, OCC_FATE_VISIBLE);
    ck_assert_msg(kit_logged(&s.log, reason), "not logged: %s", reason);
}

START_TEST(without_a_view_a_scene_or_a_result_there_is_no_answer)
{
    size_t count = 9;
    occ_view *culled = s.view;
    ck_assert_int_eq(occ_view_explain(NULL, s.scene, s.both, NULL, NULL, 0, &count),
                     OCC_ERROR_INVALID_ARGUMENT);
    ck_assert_uint_eq(count, 0);
    refuse(NULL, s.both, OCC_ERROR_INVALID_ARGUMENT, "the scene is NULL");
    occ_view_desc desc = {.logger = kit_logger(&s.log)};
    ck_assert_int_eq(occ_view_create(&desc, &s.view), OCC_SUCCESS);
    refuse(s.scene, s.both, OCC_ERROR_NO_RESULT, "call occ_cull() first");
    occ_view_destroy(s.view);
    s.view = culled;
    ck_assert_int_eq(occ_cull(s.view, s.scene, NULL, NULL), OCC_ERROR_INVALID_ARGUMENT);
    refuse(s.scene, s.both, OCC_ERROR_NO_RESULT, "call occ_cull() first");
}
END_TEST

START_TEST(another_scene_is_refused)
{
    occ_scene *other;
    ck_assert_int_eq(occ_scene_create(NULL, &other), OCC_SUCCESS);
    refuse(other, s.both, OCC_ERROR_INVALID_ARGUMENT, "another scene was culled");
    occ_scene_destroy(other);
}
END_TEST

START_TEST(a_scene_that_has_changed_is_refused)
{
    occ_box box = brick(1.9f, 0, -11, 2, 2, 0.5f);
    ck_assert_int_eq(occ_scene_move_occluder(s.scene, s.right_panel, &box), OCC_SUCCESS);
    refuse(s.scene, s.both, OCC_ERROR_NOT_COMMITTED, "has changed");
    ck_assert_int_eq(occ_scene_commit(s.scene), OCC_SUCCESS);
    refuse(s.scene, s.both, OCC_ERROR_NO_RESULT, "has changed since it was culled");
    cull(OCC_METHOD_FUSED);
    box = brick(0, 0, -30, 3, 1, 0.5f);
    ck_assert_int_eq(occ_scene_move(s.scene, s.both, &box), OCC_SUCCESS);
    refuse(s.scene, s.both, OCC_ERROR_NOT_COMMITTED, "has changed");
    ck_assert_int_eq(occ_scene_commit(s.scene), OCC_SUCCESS);
    refuse(s.scene, s.both, OCC_ERROR_NO_RESULT, "has changed since it was culled");
}
END_TEST

START_TEST(a_handle_of_nothing_is_refused)
{
    occ_object gone = s.shown, nothing = {0, 0}, beyond = {1000, 1};
    refuse(s.scene, nothing, OCC_ERROR_STALE_HANDLE, "object {0, 0}");
    refuse(s.scene, beyond, OCC_ERROR_STALE_HANDLE, "object {1000, 1}");
    ck_assert_int_eq(occ_scene_remove(s.scene, gone), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_commit(s.scene), OCC_SUCCESS);
    cull(OCC_METHOD_FUSED);
    refuse(s.scene, gone, OCC_ERROR_STALE_HANDLE, "object {");
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("explain_calls");
    TCase *answers = tcase_create("answers");
    tcase_add_checked_fixture(answers, set_up, tear_down);
    tcase_add_test(answers, two_that_hide_together_are_named_nearest_first_and_no_others);
    tcase_add_test(answers, one_that_hides_alone_is_named_alone);
    tcase_add_test(answers, what_is_not_hidden_has_a_fate_and_no_occluders);
    tcase_add_test(answers, an_object_that_fell_with_a_node_gets_the_reason_that_is_its_own);
    tcase_add_test(answers, asking_allocates_nothing);
    suite_add_tcase(suite, answers);
    TCase *questions = tcase_create("questions");
    tcase_add_checked_fixture(questions, set_up, tear_down);
    tcase_add_test(questions, the_number_can_be_asked_for);
    tcase_add_test(questions, an_array_that_is_too_short_is_not_written_to);
    tcase_add_test(questions, without_a_view_a_scene_or_a_result_there_is_no_answer);
    tcase_add_test(questions, another_scene_is_refused);
    tcase_add_test(questions, a_scene_that_has_changed_is_refused);
    tcase_add_test(questions, a_handle_of_nothing_is_refused);
    suite_add_tcase(suite, questions);
    return test_run_suite(suite);
}
