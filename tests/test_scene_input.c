// SPDX-License-Identifier: Apache-2.0
// Bad input to a scene: refused by name with a reason in the log, and not a byte of the scene
// changes.
#include "kit_tree.h"
#include "support.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { COUNT = 40 };

static occ_scene *scene;
static kit_log record;
static occ_object objects[COUNT];
static occ_occluder occluders[COUNT];
static const occ_object nobody = {0, 0};

static void set_up(void)
{
    kit_forget(&record);
    occ_scene_desc desc = {.logger = kit_logger(&record), .leaf_objects = 4};
    ck_assert_int_eq(occ_scene_create(&desc, &scene), OCC_SUCCESS);
    kit_fill(scene, COUNT, 1, 3, objects, occluders);
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
}

static void tear_down(void)
{
    ck_assert_int_eq(occ_scene_validate(scene), OCC_SUCCESS);
    occ_scene_destroy(scene);
}

// --- not a byte changes --------------------------------------------------------------------------

// FNV-1a (Fowler, Noll and Vo).
static uint64_t hash(uint64_t sum, const void *data, size_t size)
{
    for (size_t i = 0; i < size; i++)
        sum = (sum ^ ((const unsigned char *)data)[i]) * 0x100000001b3u;
    return sum;
}

static uint64_t hash_array(uint64_t sum, const occ_array *array)
{
    return hash(sum, array->data, (size_t)array->count * array->element);
}

static uint64_t hash_slots(uint64_t sum, const occ_slots *slots)
{
    sum = hash(sum, slots->value, slots->count * sizeof *slots->value);
    return hash(sum, slots->generation, slots->count * sizeof *slots->generation);
}

// All that a scene is made of.
static uint64_t digest(void)
{
    uint64_t sum = hash(0xcbf29ce484222325u, scene, sizeof *scene);
    sum = hash_slots(hash_slots(sum, &scene->objects), &scene->occluders);
    size_t column = scene->boxes.count * sizeof(float);
    for (uint32_t c = 0; c < OCC_BOX_COLUMNS; c++)
        sum = hash(sum, occ_boxes_column(&scene->boxes, c), column);
    const occ_occluder_rows *rows = &scene->occluder_rows;
    sum = hash(sum, rows->boxes, rows->count * sizeof *rows->boxes);
    sum = hash(sum, rows->slot_of, rows->count * sizeof *rows->slot_of);
    sum = hash(sum, rows->owner_of, rows->count * sizeof *rows->owner_of);
    const occ_array *arrays[] = {&scene->slot_of,  &scene->object_tree.nodes,
                                 &scene->attached, &scene->occluder_tree.nodes,
                                 &scene->reach,    &scene->changed};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        sum = hash_array(sum, arrays[i]);
    return sum;
}

#define CHECK_REFUSED(call, expected)                                                              \
    do {                                                                                           \
        uint64_t before = digest();                                                                \
        kit_forget(&record);                                                                       \
        occ_result refused = (call);                                                               \
        KIT_CHECK(refused == (expected), "%s gives %s, not %s", #call, occ_result_name(refused),   \
                  occ_result_name(expected));                                                      \
        KIT_CHECK(digest() == before, "%s has changed the scene", #call);                          \
        KIT_CHECK(record.errors == 1 && kit_logged(&record, occ_result_name(expected)),            \
                  "%s logs \"%s\"", #call, record.text);                                           \
    } while (0)

START_TEST(digest_sees_an_edit)
{
    uint64_t before = digest();
    occ_box box;
    ck_assert_int_eq(occ_scene_box(scene, objects[3], &box), OCC_SUCCESS);
    ck_assert_uint_eq(digest(), before);
    box.axis[1][1] = nextafterf(box.axis[1][1], 0.0f);
    ck_assert_int_eq(occ_scene_move(scene, objects[3], &box), OCC_SUCCESS);
    ck_assert_uint_ne(digest(), before);
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
}
END_TEST

// --- numbers -------------------------------------------------------------------------------------

static const struct {
    float number;
    occ_result result;
} bad[] = {
    {NAN, OCC_ERROR_NOT_FINITE},        {INFINITY, OCC_ERROR_NOT_FINITE},
    {-INFINITY, OCC_ERROR_NOT_FINITE},  {FLT_MAX, OCC_ERROR_OUT_OF_RANGE},
    {-FLT_MAX, OCC_ERROR_OUT_OF_RANGE}, {1.1e15f, OCC_ERROR_OUT_OF_RANGE},
};
enum { BAD = (int)(sizeof bad / sizeof *bad) };

// A box whose k-th number is bad.
static occ_box bad_box(int k, float number)
{
    occ_box box = kit_cube(1, 2, 3, 4);
    if (k < 3) {
        box.center[k] = number;
    } else {
        box.axis[k / 3 - 1][k % 3] = number;
    }
    return box;
}

START_TEST(bad_number_in_a_box_is_refused)
{
    for (int k = 0; k < 12; k++) {
        occ_box box = bad_box(k, bad[_i].number);
        occ_object object = {7, 8};
        occ_occluder occluder = {9, 10};
        CHECK_REFUSED(occ_scene_add(scene, &box, &object), bad[_i].result);
        CHECK_REFUSED(occ_scene_move(scene, objects[5], &box), bad[_i].result);
        CHECK_REFUSED(occ_scene_add_occluder(scene, &box, nobody, &occluder), bad[_i].result);
        CHECK_REFUSED(occ_scene_add_occluder(scene, &box, objects[1], NULL), bad[_i].result);
        CHECK_REFUSED(occ_scene_move_occluder(scene, occluders[5], &box), bad[_i].result);
        ck_assert(object.index == 7 && object.generation == 8);
        ck_assert(occluder.index == 9 && occluder.generation == 10);
    }
}
END_TEST

START_TEST(bad_number_anywhere_refuses_all_of_many)
{
    static const int places[] = {0, 1, 6, 7};
    for (size_t p = 0; p < 4; p++) {
        for (int k = 0; k < 12; k++) {
            occ_box boxes[8];
            for (int i = 0; i < 8; i++)
                boxes[i] = i == places[p] ? bad_box(k, bad[_i].number) : kit_cube(1, 1, 1, 1);
            occ_object handles[8] = {{0, 0}};
            occ_occluder others[8] = {{0, 0}};
            CHECK_REFUSED(occ_scene_add_many(scene, boxes, 8, handles), bad[_i].result);
            CHECK_REFUSED(occ_scene_move_many(scene, objects, boxes, 8), bad[_i].result);
            CHECK_REFUSED(occ_scene_add_occluders(scene, boxes, NULL, 8, others), bad[_i].result);
            CHECK_REFUSED(occ_scene_add_occluders(scene, boxes, objects, 8, NULL), bad[_i].result);
            for (int i = 0; i < 8; i++)
                KIT_CHECK(!handles[i].index && !others[i].index, "a handle was given out");
        }
    }
}
END_TEST

START_TEST(log_names_the_box_and_the_reason)
{
    occ_box boxes[8];
    for (int i = 0; i < 8; i++)
        boxes[i] = i == 6 ? bad_box(2, NAN) : kit_cube(1, 1, 1, 1);
    CHECK_REFUSED(occ_scene_add_many(scene, boxes, 8, NULL), OCC_ERROR_NOT_FINITE);
    ck_assert(kit_logged(&record, "box 6 of 8"));
}
END_TEST

START_TEST(denormal_and_largest_numbers_are_numbers)
{
    static const float good[] = {0x1p-149f, -0x1p-149f, 0x1p-127f, -0.0f, FLT_MIN, 9e14f};
    for (int k = 0; k < 12; k++) {
        for (size_t g = 0; g < sizeof good / sizeof *good; g++) {
            occ_box box = bad_box(k, good[g]), back;
            occ_object object;
            ck_assert_int_eq(occ_scene_add(scene, &box, &object), OCC_SUCCESS);
            ck_assert_int_eq(occ_scene_box(scene, object, &back), OCC_SUCCESS);
            ck_assert_mem_eq(&back, &box, sizeof box);
            ck_assert_int_eq(occ_scene_add_occluder(scene, &box, object, NULL), OCC_SUCCESS);
        }
    }
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
    kit_check_trees(scene);
}
END_TEST

// --- handles -------------------------------------------------------------------------------------

START_TEST(stale_handle_anywhere_refuses_all_of_many)
{
    occ_box boxes[8];
    ck_assert_int_eq(occ_scene_remove(scene, objects[20]), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
    for (int i = 0; i < 8; i++)
        boxes[i] = kit_cube((float)i, 50, 0, 1);
    for (int place = 0; place < 8; place++) {
        occ_object handles[8];
        memcpy(handles, objects, sizeof handles);
        handles[place] = objects[20];
        CHECK_REFUSED(occ_scene_move_many(scene, handles, boxes, 8), OCC_ERROR_STALE_HANDLE);
        CHECK_REFUSED(occ_scene_add_occluders(scene, boxes, handles, 8, NULL),
                      OCC_ERROR_STALE_HANDLE);
        handles[place] = nobody;
        CHECK_REFUSED(occ_scene_move_many(scene, handles, boxes, 8), OCC_ERROR_STALE_HANDLE);
    }
}
END_TEST

START_TEST(stale_handle_changes_nothing)
{
    occ_box box = kit_cube(0, 0, 0, 1);
    CHECK_REFUSED(occ_scene_remove(scene, nobody), OCC_ERROR_STALE_HANDLE);
    CHECK_REFUSED(occ_scene_move(scene, nobody, &box), OCC_ERROR_STALE_HANDLE);
    CHECK_REFUSED(occ_scene_box(scene, nobody, &box), OCC_ERROR_STALE_HANDLE);
    occ_occluder none = {0, 0};
    CHECK_REFUSED(occ_scene_remove_occluder(scene, none), OCC_ERROR_STALE_HANDLE);
    CHECK_REFUSED(occ_scene_move_occluder(scene, none, &box), OCC_ERROR_STALE_HANDLE);
    CHECK_REFUSED(occ_scene_occluder_box(scene, none, &box, NULL), OCC_ERROR_STALE_HANDLE);
}
END_TEST

// --- counts and pointers -------------------------------------------------------------------------

START_TEST(more_than_an_index_can_name_is_refused)
{
    // Nothing of the arrays may be read: they are not as long as that.
    static const size_t too_many[] = {UINT32_MAX, (size_t)UINT32_MAX + 1, SIZE_MAX / 2, SIZE_MAX};
    occ_box box = kit_cube(0, 0, 0, 1);
    for (size_t i = 0; i < sizeof too_many / sizeof *too_many; i++) {
        CHECK_REFUSED(occ_scene_add_many(scene, &box, too_many[i], NULL), OCC_ERROR_LIMIT);
        CHECK_REFUSED(occ_scene_add_occluders(scene, &box, NULL, too_many[i], NULL),
                      OCC_ERROR_LIMIT);
    }
}
END_TEST

START_TEST(arrays_that_are_missing_are_refused)
{
    occ_box box = kit_cube(0, 0, 0, 1);
    CHECK_REFUSED(occ_scene_add_many(scene, NULL, 3, NULL), OCC_ERROR_INVALID_ARGUMENT);
    CHECK_REFUSED(occ_scene_add_occluders(scene, NULL, NULL, 3, NULL), OCC_ERROR_INVALID_ARGUMENT);
    CHECK_REFUSED(occ_scene_move_many(scene, NULL, &box, 1), OCC_ERROR_INVALID_ARGUMENT);
    CHECK_REFUSED(occ_scene_move_many(scene, objects, NULL, 1), OCC_ERROR_INVALID_ARGUMENT);
}
END_TEST

// Without a scene there is nowhere to log to.
#define CHECK_INVALID(call) ck_assert_int_eq((call), OCC_ERROR_INVALID_ARGUMENT)

START_TEST(missing_scene_is_refused)
{
    occ_box box = kit_cube(0, 0, 0, 1);
    occ_object object;
    occ_occluder occluder;
    occ_scene_stats stats;
    CHECK_INVALID(occ_scene_create(NULL, NULL));
    CHECK_INVALID(occ_scene_add(NULL, &box, &object));
    CHECK_INVALID(occ_scene_add_many(NULL, &box, 1, &object));
    CHECK_INVALID(occ_scene_move(NULL, objects[0], &box));
    CHECK_INVALID(occ_scene_move_many(NULL, objects, &box, 1));
    CHECK_INVALID(occ_scene_remove(NULL, objects[0]));
    CHECK_INVALID(occ_scene_add_occluder(NULL, &box, nobody, &occluder));
    CHECK_INVALID(occ_scene_add_occluders(NULL, &box, NULL, 1, &occluder));
    CHECK_INVALID(occ_scene_move_occluder(NULL, occluders[0], &box));
    CHECK_INVALID(occ_scene_remove_occluder(NULL, occluders[0]));
    CHECK_INVALID(occ_scene_commit(NULL));
    CHECK_INVALID(occ_scene_validate(NULL));
    CHECK_INVALID(occ_scene_box(NULL, objects[0], &box));
    CHECK_INVALID(occ_scene_occluder_box(NULL, occluders[0], &box, NULL));
    CHECK_INVALID(occ_scene_get_stats(NULL, &stats));
    ck_assert(!occ_scene_contains(NULL, objects[0]));
    ck_assert_uint_eq(occ_scene_slot_count(NULL), 0);
    occ_scene_destroy(NULL);
}
END_TEST

START_TEST(missing_box_or_result_is_refused)
{
    occ_box box = kit_cube(0, 0, 0, 1);
    occ_object object;
    occ_occluder occluder;
    CHECK_REFUSED(occ_scene_add(scene, NULL, &object), OCC_ERROR_INVALID_ARGUMENT);
    CHECK_REFUSED(occ_scene_add(scene, &box, NULL), OCC_ERROR_INVALID_ARGUMENT);
    CHECK_REFUSED(occ_scene_add_occluder(scene, NULL, nobody, &occluder),
                  OCC_ERROR_INVALID_ARGUMENT);
    CHECK_REFUSED(occ_scene_move(scene, objects[0], NULL), OCC_ERROR_INVALID_ARGUMENT);
    CHECK_REFUSED(occ_scene_move_occluder(scene, occluders[0], NULL), OCC_ERROR_INVALID_ARGUMENT);
    CHECK_REFUSED(occ_scene_box(scene, objects[0], NULL), OCC_ERROR_INVALID_ARGUMENT);
    CHECK_REFUSED(occ_scene_get_stats(scene, NULL), OCC_ERROR_INVALID_ARGUMENT);
}
END_TEST

START_TEST(scene_that_cannot_be_made_is_null)
{
    kit_heap heap = {0};
    occ_scene *made = scene;
    occ_scene_desc desc = {.logger = kit_logger(&record), .leaf_objects = 1025};
    CHECK_INVALID(occ_scene_create(&desc, &made));
    ck_assert_ptr_null(made);
    ck_assert(kit_logged(&record, "leaf_objects is 1025"));
    desc = (occ_scene_desc){.logger = desc.logger, .threads = 1025};
    made = scene;
    CHECK_INVALID(occ_scene_create(&desc, &made));
    ck_assert_ptr_null(made);
    ck_assert(kit_logged(&record, "1025 threads, at most 1024"));
    desc = (occ_scene_desc){.logger = desc.logger, .allocator = kit_allocator(&heap)};
    desc.allocator.free = NULL;
    made = scene;
    CHECK_INVALID(occ_scene_create(&desc, &made));
    ck_assert_ptr_null(made);
    ck_assert_uint_eq(record.errors, 3);
    desc = (occ_scene_desc){.logger = desc.logger, .object_count = UINT32_MAX};
    ck_assert_int_eq(occ_scene_create(&desc, &made), OCC_ERROR_LIMIT);
    desc = (occ_scene_desc){.logger = desc.logger, .occluder_count = UINT32_MAX};
    ck_assert_int_eq(occ_scene_create(&desc, &made), OCC_ERROR_LIMIT);
    ck_assert_ptr_null(made);
    ck_assert_uint_eq(record.errors, 5);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("scene_input");
    TCase *numbers = tcase_create("numbers");
    tcase_add_checked_fixture(numbers, set_up, tear_down);
    tcase_add_test(numbers, digest_sees_an_edit);
    tcase_add_loop_test(numbers, bad_number_in_a_box_is_refused, 0, BAD);
    tcase_add_loop_test(numbers, bad_number_anywhere_refuses_all_of_many, 0, BAD);
    tcase_add_test(numbers, log_names_the_box_and_the_reason);
    tcase_add_test(numbers, denormal_and_largest_numbers_are_numbers);
    suite_add_tcase(suite, numbers);
    TCase *arguments = tcase_create("arguments");
    tcase_add_checked_fixture(arguments, set_up, tear_down);
    tcase_add_test(arguments, stale_handle_anywhere_refuses_all_of_many);
    tcase_add_test(arguments, stale_handle_changes_nothing);
    tcase_add_test(arguments, more_than_an_index_can_name_is_refused);
    tcase_add_test(arguments, arrays_that_are_missing_are_refused);
    tcase_add_test(arguments, missing_scene_is_refused);
    tcase_add_test(arguments, missing_box_or_result_is_refused);
    tcase_add_test(arguments, scene_that_cannot_be_made_is_null);
    suite_add_tcase(suite, arguments);
    return test_run_suite(suite);
}
