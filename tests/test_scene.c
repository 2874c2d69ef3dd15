// SPDX-License-Identifier: Apache-2.0
// Handles, owners, and edits of many at once.
#include "kit_tree.h"
#include "support.h"

#include <stdlib.h>
#include <string.h>

static occ_scene *scene;
static kit_heap heap;
static kit_log record;
static const occ_object nobody = {0, 0};

static void set_up(void)
{
    heap = (kit_heap){0};
    kit_forget(&record);
    occ_scene_desc desc = {.allocator = kit_allocator(&heap), .logger = kit_logger(&record)};
    ck_assert_int_eq(occ_scene_create(&desc, &scene), OCC_SUCCESS);
}

static void tear_down(void)
{
    occ_scene_destroy(scene);
    ck_assert_uint_eq(heap.blocks, 0);
    ck_assert_uint_eq(heap.bytes, 0);
}

static occ_object add(float x)
{
    occ_object object;
    occ_box box = kit_cube(x, 0, 0, 1);
    ck_assert_int_eq(occ_scene_add(scene, &box, &object), OCC_SUCCESS);
    return object;
}

static occ_occluder add_occluder(float x, occ_object owner)
{
    occ_occluder occluder;
    occ_box box = kit_cube(x, 0, 0, 0.5f);
    ck_assert_int_eq(occ_scene_add_occluder(scene, &box, owner, &occluder), OCC_SUCCESS);
    return occluder;
}

static void commit(void)
{
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
    kit_check_trees(scene);
}

static occ_scene_stats stats_of(void)
{
    occ_scene_stats stats;
    ck_assert_int_eq(occ_scene_get_stats(scene, &stats), OCC_SUCCESS);
    return stats;
}

static bool has_occluder(occ_occluder occluder)
{
    occ_result result = occ_scene_occluder_box(scene, occluder, NULL, NULL);
    ck_assert(result == OCC_SUCCESS || result == OCC_ERROR_STALE_HANDLE);
    return result == OCC_SUCCESS;
}

// --- handles -------------------------------------------------------------------------------------

static void check_stale(occ_object object)
{
    occ_box box = kit_cube(0, 0, 0, 1), untouched = box;
    ck_assert(!occ_scene_contains(scene, object));
    ck_assert_int_eq(occ_scene_box(scene, object, &box), OCC_ERROR_STALE_HANDLE);
    ck_assert_mem_eq(&box, &untouched, sizeof box);
    ck_assert_int_eq(occ_scene_move(scene, object, &box), OCC_ERROR_STALE_HANDLE);
    ck_assert_int_eq(occ_scene_remove(scene, object), OCC_ERROR_STALE_HANDLE);
    kit_forget(&record);
    occ_occluder occluder = {0, 0};
    if (!object.index && !object.generation) return; // as an owner that is nobody
    ck_assert_int_eq(occ_scene_add_occluder(scene, &box, object, &occluder),
                     OCC_ERROR_STALE_HANDLE);
    ck_assert_uint_eq(record.errors, 1);
    ck_assert(kit_logged(&record, "OCC_ERROR_STALE_HANDLE"));
    ck_assert_uint_eq(occluder.index, 0);
}

START_TEST(stale_handle_is_rejected)
{
    occ_object object = add(1), other = add(2);
    ck_assert_int_eq(occ_scene_remove(scene, object), OCC_SUCCESS);
    check_stale(object);
    commit();
    check_stale(object);
    occ_object successor = add(3);
    ck_assert_uint_eq(occ_object_slot(successor), occ_object_slot(object));
    check_stale(object);
    ck_assert(occ_scene_contains(scene, successor) && occ_scene_contains(scene, other));
}
END_TEST

START_TEST(handle_that_was_never_given_is_rejected)
{
    occ_object object = add(1);
    check_stale(nobody);
    check_stale((occ_object){object.index + 1, object.generation});
    check_stale((occ_object){object.index, object.generation + 1});
    check_stale((occ_object){object.index, object.generation + 2});
    check_stale((occ_object){object.index, 0});
    check_stale((occ_object){0, object.generation});
    check_stale((occ_object){UINT32_MAX, UINT32_MAX});
    ck_assert(occ_scene_contains(scene, object));
}
END_TEST

START_TEST(slot_is_not_used_again_before_the_commit)
{
    occ_object object = add(1);
    commit();
    ck_assert_int_eq(occ_scene_remove(scene, object), OCC_SUCCESS);
    occ_object next = add(2);
    ck_assert_uint_ne(occ_object_slot(next), occ_object_slot(object));
    commit();
    occ_object later = add(3);
    ck_assert_uint_eq(occ_object_slot(later), occ_object_slot(object));
    ck_assert_uint_ne(later.generation, object.generation);
    ck_assert_uint_eq(occ_scene_slot_count(scene), 2);
}
END_TEST

START_TEST(slots_count_up_from_zero_and_stay)
{
    occ_object objects[100];
    for (uint32_t i = 0; i < 100; i++) {
        objects[i] = add((float)(100 - i));
        ck_assert_uint_eq(occ_object_slot(objects[i]), i);
        ck_assert_uint_eq(occ_scene_slot_count(scene), i + 1);
    }
    commit();
    for (uint32_t i = 0; i < 100; i++) {
        occ_box box;
        ck_assert_int_eq(occ_scene_box(scene, objects[i], &box), OCC_SUCCESS);
        ck_assert(box.center[0] == (float)(100 - i));
    }
    for (uint32_t i = 0; i < 100; i++)
        ck_assert_int_eq(occ_scene_remove(scene, objects[i]), OCC_SUCCESS);
    commit();
    ck_assert_uint_eq(occ_scene_slot_count(scene), 100);
}
END_TEST

START_TEST(slot_with_no_generation_left_is_retired)
{
    occ_object first = add(1), object = first;
    uint32_t lives = 1;
    for (; object.index == first.index; lives++) {
        KIT_CHECK(lives < 40000, "the slot never retires");
        KIT_CHECK(!occ_scene_remove(scene, object), "the object stays");
        KIT_CHECK(!occ_scene_commit(scene), "no commit");
        occ_box box = kit_cube((float)lives, 0, 0, 1);
        KIT_CHECK(!occ_scene_add(scene, &box, &object), "no other object");
        KIT_CHECK(!occ_scene_contains(scene, first), "the first handle fits again");
    }
    ck_assert_uint_gt(lives, 1000);
    ck_assert_uint_eq(object.index, first.index + 1);
    commit();
    for (uint32_t generation = 0; generation < 0x20000; generation++)
        KIT_CHECK(!occ_scene_contains(scene, (occ_object){first.index, generation}),
                  "generation %u of the retired slot fits", generation);
}
END_TEST

// --- owners --------------------------------------------------------------------------------------

START_TEST(occluder_may_belong_to_nobody)
{
    occ_object object = add(1), owner;
    occ_occluder occluder = add_occluder(2, nobody);
    ck_assert_int_eq(occ_scene_occluder_box(scene, occluder, NULL, &owner), OCC_SUCCESS);
    ck_assert(owner.index == 0 && owner.generation == 0);
    ck_assert_int_eq(occ_scene_remove(scene, object), OCC_SUCCESS);
    commit();
    ck_assert(has_occluder(occluder));
    ck_assert_uint_eq(stats_of().occluders, 1);
}
END_TEST

START_TEST(occluder_knows_its_owner_and_its_box)
{
    occ_object object = add(1), owner;
    occ_occluder occluder = add_occluder(7, object);
    occ_box box, expected = kit_cube(7, 0, 0, 0.5f);
    ck_assert_int_eq(occ_scene_occluder_box(scene, occluder, &box, &owner), OCC_SUCCESS);
    ck_assert_mem_eq(&box, &expected, sizeof box);
    ck_assert(owner.index == object.index && owner.generation == object.generation);
    ck_assert_int_eq(occ_scene_occluder_box(scene, occluder, &box, NULL), OCC_SUCCESS);
}
END_TEST

START_TEST(occluder_leaves_with_its_owner)
{
    occ_object object = add(1), other = add(2);
    occ_occluder first = add_occluder(1, object), second = add_occluder(1.2f, object);
    occ_occluder third = add_occluder(2, other);
    commit();
    ck_assert_int_eq(occ_scene_remove(scene, object), OCC_SUCCESS);
    for (int committed = 0; committed < 2; committed++) {
        ck_assert(!has_occluder(first) && !has_occluder(second) && has_occluder(third));
        occ_box box = kit_cube(0, 0, 0, 1);
        ck_assert_int_eq(occ_scene_move_occluder(scene, first, &box), OCC_ERROR_STALE_HANDLE);
        ck_assert_int_eq(occ_scene_remove_occluder(scene, second), OCC_ERROR_STALE_HANDLE);
        commit();
    }
    ck_assert_uint_eq(stats_of().occluders, 1);
}
END_TEST

START_TEST(next_object_in_the_slot_inherits_no_occluder)
{
    occ_object object = add(1);
    occ_occluder occluder = add_occluder(1, object);
    commit();
    ck_assert_int_eq(occ_scene_remove(scene, object), OCC_SUCCESS);
    commit();
    occ_object successor = add(5);
    ck_assert_uint_eq(occ_object_slot(successor), occ_object_slot(object));
    ck_assert(!has_occluder(occluder));
    commit();
    ck_assert(!has_occluder(occluder));
    ck_assert_uint_eq(stats_of().occluders, 0);
    occ_occluder own = add_occluder(5, successor);
    ck_assert(has_occluder(own) && !has_occluder(occluder));
}
END_TEST

START_TEST(removed_occluder_is_stale_and_its_owner_is_not)
{
    occ_object object = add(1);
    occ_occluder occluder = add_occluder(1, object);
    commit();
    ck_assert_int_eq(occ_scene_remove_occluder(scene, occluder), OCC_SUCCESS);
    ck_assert(!has_occluder(occluder));
    ck_assert_int_eq(occ_scene_remove_occluder(scene, occluder), OCC_ERROR_STALE_HANDLE);
    occ_occluder next = add_occluder(2, object);
    ck_assert_uint_ne(next.index, occluder.index);
    commit();
    ck_assert(occ_scene_contains(scene, object) && has_occluder(next) && !has_occluder(occluder));
}
END_TEST

START_TEST(moved_occluder_has_its_new_box)
{
    occ_occluder occluder = add_occluder(1, nobody);
    commit();
    for (int i = 1; i < 1000000; i *= 3) {
        occ_box box = kit_cube((float)i, 2, 3, 0.1f), back;
        ck_assert_int_eq(occ_scene_move_occluder(scene, occluder, &box), OCC_SUCCESS);
        commit();
        ck_assert_int_eq(occ_scene_occluder_box(scene, occluder, &back, NULL), OCC_SUCCESS);
        ck_assert_mem_eq(&back, &box, sizeof box);
    }
}
END_TEST

// --- many at once --------------------------------------------------------------------------------

START_TEST(added_together_is_as_added_one_by_one)
{
    occ_box boxes[50];
    occ_object together[50], handles[50];
    kit_random random = {1};
    for (int i = 0; i < 50; i++)
        boxes[i] = kit_box(&random, 10, 1);
    ck_assert_int_eq(occ_scene_add_many(scene, boxes, 50, together), OCC_SUCCESS);
    occ_scene *other;
    ck_assert_int_eq(occ_scene_create(NULL, &other), OCC_SUCCESS);
    for (int i = 0; i < 50; i++)
        ck_assert_int_eq(occ_scene_add(other, &boxes[i], &handles[i]), OCC_SUCCESS);
    ck_assert_mem_eq(together, handles, sizeof handles);
    commit();
    ck_assert_int_eq(occ_scene_commit(other), OCC_SUCCESS);
    kit_check_same_scene(scene, other);
    occ_scene_destroy(other);
}
END_TEST

START_TEST(nothing_added_or_moved_is_no_edit)
{
    add(1);
    commit();
    ck_assert_int_eq(occ_scene_add_many(scene, NULL, 0, NULL), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_add_occluders(scene, NULL, NULL, 0, NULL), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_move_many(scene, NULL, NULL, 0), OCC_SUCCESS);
    ck_assert(occ_scene_is_committed(scene));
    ck_assert_int_eq(occ_scene_validate(scene), OCC_SUCCESS);
}
END_TEST

START_TEST(object_moved_twice_at_once_has_its_last_box)
{
    occ_object object = add(1), twice[2] = {object, object};
    occ_box boxes[2] = {kit_cube(5, 0, 0, 1), kit_cube(9, 0, 0, 2)}, box;
    ck_assert_int_eq(occ_scene_move_many(scene, twice, boxes, 2), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_box(scene, object, &box), OCC_SUCCESS);
    ck_assert_mem_eq(&box, &boxes[1], sizeof box);
    commit();
}
END_TEST

START_TEST(handles_need_not_be_taken)
{
    occ_box boxes[3] = {kit_cube(1, 0, 0, 1), kit_cube(2, 0, 0, 1), kit_cube(3, 0, 0, 1)};
    ck_assert_int_eq(occ_scene_add_many(scene, boxes, 3, NULL), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_add_occluders(scene, boxes, NULL, 3, NULL), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_add_occluder(scene, boxes, nobody, NULL), OCC_SUCCESS);
    commit();
    ck_assert_uint_eq(stats_of().objects, 3);
    ck_assert_uint_eq(stats_of().occluders, 4);
}
END_TEST

START_TEST(scene_of_nothing_is_valid)
{
    commit();
    occ_scene_stats stats = stats_of();
    ck_assert_uint_eq(stats.objects + stats.occluders + stats.slots, 0);
    ck_assert_uint_eq(stats.object_nodes + stats.occluder_nodes + stats.levels, 0);
    occ_object object = add(1);
    commit();
    ck_assert_uint_eq(stats_of().object_nodes, 1);
    ck_assert_int_eq(occ_scene_remove(scene, object), OCC_SUCCESS);
    commit();
    ck_assert_uint_eq(stats_of().objects, 0);
    ck_assert_uint_eq(stats_of().object_nodes, 0);
}
END_TEST

START_TEST(stats_say_what_is_there)
{
    kit_fill(scene, 500, 2, 9, NULL, NULL);
    commit();
    occ_scene_stats stats = stats_of();
    ck_assert_uint_eq(stats.objects, 500);
    ck_assert_uint_eq(stats.occluders, 250);
    ck_assert_uint_eq(stats.slots, 500);
    ck_assert_uint_eq(stats.object_nodes, scene->object_tree.nodes.count);
    ck_assert_uint_eq(stats.occluder_nodes, scene->occluder_tree.nodes.count);
    ck_assert_uint_eq(stats.levels, scene->object_tree.levels);
    ck_assert_uint_eq(stats.bytes, heap.bytes);
}
END_TEST

static TCase *with_fixture(TCase *group)
{
    tcase_add_checked_fixture(group, set_up, tear_down);
    return group;
}

int main(void)
{
    Suite *suite = suite_create("scene");
    TCase *handles = with_fixture(tcase_create("handles"));
    tcase_add_test(handles, stale_handle_is_rejected);
    tcase_add_test(handles, handle_that_was_never_given_is_rejected);
    tcase_add_test(handles, slot_is_not_used_again_before_the_commit);
    tcase_add_test(handles, slots_count_up_from_zero_and_stay);
    tcase_add_test(handles, slot_with_no_generation_left_is_retired);
    suite_add_tcase(suite, handles);
    TCase *owners = with_fixture(tcase_create("owners"));
    tcase_add_test(owners, occluder_may_belong_to_nobody);
    tcase_add_test(owners, occluder_knows_its_owner_and_its_box);
    tcase_add_test(owners, occluder_leaves_with_its_owner);
    tcase_add_test(owners, next_object_in_the_slot_inherits_no_occluder);
    tcase_add_test(owners, removed_occluder_is_stale_and_its_owner_is_not);
    tcase_add_test(owners, moved_occluder_has_its_new_box);
    suite_add_tcase(suite, owners);
    TCase *many = with_fixture(tcase_create("many"));
    tcase_add_test(many, added_together_is_as_added_one_by_one);
    tcase_add_test(many, nothing_added_or_moved_is_no_edit);
    tcase_add_test(many, object_moved_twice_at_once_has_its_last_box);
    tcase_add_test(many, handles_need_not_be_taken);
    tcase_add_test(many, scene_of_nothing_is_valid);
    tcase_add_test(many, stats_say_what_is_there);
    suite_add_tcase(suite, many);
    return test_run_suite(suite);
}
