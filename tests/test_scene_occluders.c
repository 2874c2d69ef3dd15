// SPDX-License-Identifier: Apache-2.0
// The rows of occluders: what a commit does to them, and what it leaves alone.
#include "box.h"
#include "kit_tree.h"
#include "support.h"

#include <math.h>

enum { OBJECTS = 240, PER_KIND = 120 };

static const occ_object nobody = {0, 0};
static kit_heap heap;
static occ_scene *scene;
static occ_object objects[OBJECTS];
static occ_occluder owned[PER_KIND], nobodys[PER_KIND]; // added in turn

static occ_box small_box(kit_random *random)
{
    occ_box box = kit_cube(0, 0, 0, kit_between(random, 0.1f, 0.4f));
    for (int j = 0; j < 3; j++)
        box.center[j] = kit_between(random, -100, 100);
    return box;
}

// Owners have one occluder to three. Nothing is committed.
static void add_all(occ_scene *to)
{
    kit_random random = {17};
    for (int i = 0; i < OBJECTS; i++) {
        occ_box box = small_box(&random);
        ck_assert_int_eq(occ_scene_add(to, &box, &objects[i]), OCC_SUCCESS);
    }
    for (int i = 0; i < PER_KIND; i++) {
        occ_box box = small_box(&random);
        ck_assert_int_eq(occ_scene_add_occluder(to, &box, nobody, &nobodys[i]), OCC_SUCCESS);
        occ_object owner = objects[i % 2 ? OBJECTS - 1 - i : i / 6];
        ck_assert_int_eq(occ_scene_add_occluder(to, &box, owner, &owned[i]), OCC_SUCCESS);
    }
}

static void commit(void)
{
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
    kit_check_trees(scene);
}

static void set_up(void)
{
    heap = (kit_heap){0};
    occ_scene_desc desc = {.allocator = kit_allocator(&heap), .leaf_objects = 4};
    ck_assert_int_eq(occ_scene_create(&desc, &scene), OCC_SUCCESS);
    add_all(scene);
    commit();
}

static void tear_down(void)
{
    occ_scene_destroy(scene);
    ck_assert_uint_eq(heap.blocks, 0);
}

static uint32_t row_of(occ_occluder occluder)
{
    return scene->occluders.value[occluder.index - 1];
}

static occ_box box_of(occ_occluder occluder)
{
    occ_box box;
    ck_assert_int_eq(occ_scene_occluder_box(scene, occluder, &box, NULL), OCC_SUCCESS);
    return box;
}

// A commit without any sorting takes no memory, and the rows stay where they are.
static void commit_without_sorting(void)
{
    const occ_box *boxes = occ_scene_occluder_boxes(scene);
    uint64_t calls = heap.calls;
    commit();
    ck_assert_uint_eq(heap.calls, calls);
    ck_assert_ptr_eq(occ_scene_occluder_boxes(scene), boxes);
}

// The root of the objects knows how far the farthest of its occluders reaches.
static float reach_of_all(void)
{
    return ((const occ_attached *)scene->attached.data)->reach;
}

// --- what is sorted and what is not --------------------------------------------------------------

START_TEST(each_kind_has_its_rows)
{
    ck_assert_uint_eq(scene->attached_count, PER_KIND);
    ck_assert_uint_eq(scene->occluder_rows.count, 2 * PER_KIND);
    for (int i = 0; i < PER_KIND; i++) {
        ck_assert_uint_lt(row_of(owned[i]), PER_KIND);
        ck_assert_uint_ge(row_of(nobodys[i]), PER_KIND);
        ck_assert_uint_eq(occ_scene_owner_row(scene, row_of(nobodys[i])), OCC_NO_SLOT);
    }
    const occ_attached *root = scene->attached.data;
    ck_assert(root->first == 0 && root->count == PER_KIND);
}
END_TEST

START_TEST(occluders_of_one_owner_lie_together_by_slot)
{
    for (int i = 0; i + 4 < PER_KIND; i += 6) { // each even one of six has one owner
        uint32_t row = row_of(owned[i]);
        ck_assert(row_of(owned[i + 2]) == row + 1 && row_of(owned[i + 4]) == row + 2);
    }
}
END_TEST

START_TEST(moved_owned_occluder_keeps_its_row)
{
    static const float sizes[] = {50.0f, 0.01f, 3.0f};
    uint32_t row = row_of(owned[8]);
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        occ_box box = kit_cube(-900.0f * (float)i, 500, 0, sizes[i]); // far beyond its owner's cell
        ck_assert_int_eq(occ_scene_move_occluder(scene, owned[8], &box), OCC_SUCCESS);
        ck_assert(!scene->occluders_reordered);
        commit_without_sorting();
        ck_assert_uint_eq(row_of(owned[8]), row);
        occ_box moved = box_of(owned[8]);
        ck_assert_mem_eq(&moved, &box, sizeof box);
        if (sizes[i] > 1.0f) ck_assert_float_eq(reach_of_all(), occ_occluder_reach(&box));
    }
}
END_TEST

START_TEST(free_occluder_that_stays_in_its_cell_keeps_its_row)
{
    uint32_t row = row_of(nobodys[5]);
    occ_box box = box_of(nobodys[5]);
    box.axis[1][1] *= 0.999f;
    ck_assert_int_eq(occ_scene_move_occluder(scene, nobodys[5], &box), OCC_SUCCESS);
    ck_assert(!scene->occluders_reordered);
    commit_without_sorting();
    ck_assert_uint_eq(row_of(nobodys[5]), row);
}
END_TEST

START_TEST(free_occluder_that_leaves_its_cell_is_sorted_anew)
{
    occ_box box = box_of(nobodys[5]);
    box.center[0] = -box.center[0];
    box.center[2] = -box.center[2];
    ck_assert_int_eq(occ_scene_move_occluder(scene, nobodys[5], &box), OCC_SUCCESS);
    ck_assert(scene->occluders_reordered);
    commit();
    occ_box moved = box_of(nobodys[5]);
    ck_assert_mem_eq(&moved, &box, sizeof box);
}
END_TEST

START_TEST(free_occluder_far_away_makes_a_larger_root)
{
    double size = scene->occluder_tree.root.size;
    for (int round = 0; round < 2; round++) {
        occ_box box = round ? kit_cube(0, 0, 0, 0.2f) : kit_cube(1e6f, 0, 0, 0.2f);
        ck_assert_int_eq(occ_scene_move_occluder(scene, nobodys[7], &box), OCC_SUCCESS);
        commit();
        ck_assert(round ? scene->occluder_tree.root.size <= size
                        : scene->occluder_tree.root.size > size);
    }
}
END_TEST

START_TEST(objects_that_stay_in_their_cells_leave_the_occluders_alone)
{
    for (int i = 0; i < OBJECTS; i++) {
        occ_box box;
        ck_assert_int_eq(occ_scene_box(scene, objects[i], &box), OCC_SUCCESS);
        box.axis[2][2] *= 0.9999f;
        ck_assert_int_eq(occ_scene_move(scene, objects[i], &box), OCC_SUCCESS);
    }
    ck_assert(scene->objects_moved && !scene->objects_reordered);
    commit_without_sorting();
}
END_TEST

START_TEST(occluder_follows_its_owner)
{
    uint32_t before = row_of(owned[0]), changed = 0;
    for (int i = 0; i < 8; i++) { // once to each corner of the world
        occ_box box = kit_cube(i & 1 ? 90 : -90, i & 2 ? 90 : -90, i & 4 ? 90 : -90, 0.2f);
        ck_assert_int_eq(occ_scene_move(scene, objects[0], &box), OCC_SUCCESS);
        commit();
        uint32_t slot = occ_object_slot(objects[0]), row = row_of(owned[0]);
        ck_assert_uint_eq(scene->occluder_rows.owner_of[row], slot);
        ck_assert_uint_eq(occ_scene_owner_row(scene, row), scene->objects.value[slot]);
        changed += row != before;
        before = row;
    }
    ck_assert_uint_gt(changed, 4);
}
END_TEST

// --- what comes and goes -------------------------------------------------------------------------

START_TEST(rows_of_the_removed_are_holes_until_the_commit)
{
    uint32_t row = row_of(owned[10]);
    occ_box before = box_of(owned[11]), box = kit_cube(1, 2, 3, 4);
    occ_occluder added;
    ck_assert_int_eq(occ_scene_remove_occluder(scene, owned[10]), OCC_SUCCESS);
    ck_assert_uint_eq(scene->occluder_rows.slot_of[row], OCC_NO_SLOT);
    ck_assert_int_eq(occ_scene_add_occluder(scene, &box, objects[3], &added), OCC_SUCCESS);
    ck_assert_uint_eq(row_of(added), 2 * PER_KIND); // behind all others
    occ_box other = box_of(owned[11]), own = box_of(added);
    ck_assert_mem_eq(&other, &before, sizeof before);
    ck_assert_mem_eq(&own, &box, sizeof box);
    commit();
    ck_assert_uint_eq(scene->occluder_rows.count, 2 * PER_KIND);
    ck_assert_uint_lt(row_of(added), PER_KIND);
    own = box_of(added);
    ck_assert_mem_eq(&own, &box, sizeof box);
}
END_TEST

START_TEST(removed_owner_takes_its_occluders_along)
{
    ck_assert_int_eq(occ_scene_remove(scene, objects[1]), OCC_SUCCESS); // of 6, 8 and 10
    ck_assert_int_eq(occ_scene_remove(scene, objects[200]), OCC_SUCCESS);
    commit();
    occ_box box;
    for (int i = 0; i < PER_KIND; i++) {
        bool gone = i == 6 || i == 8 || i == 10 || i == OBJECTS - 1 - 200;
        ck_assert_int_eq(occ_scene_occluder_box(scene, owned[i], &box, NULL),
                         gone ? OCC_ERROR_STALE_HANDLE : OCC_SUCCESS);
        ck_assert_int_eq(occ_scene_occluder_box(scene, nobodys[i], &box, NULL), OCC_SUCCESS);
    }
    ck_assert_uint_eq(scene->attached_count, PER_KIND - 4);
}
END_TEST

START_TEST(one_kind_may_be_missing)
{
    for (int i = 0; i < PER_KIND; i++)
        ck_assert_int_eq(occ_scene_remove_occluder(scene, _i ? owned[i] : nobodys[i]), OCC_SUCCESS);
    commit();
    ck_assert_uint_eq(scene->attached_count, _i ? 0 : PER_KIND);
    ck_assert_int_eq(scene->occluder_tree.nodes.count > 0, _i);
    ck_assert(_i ? reach_of_all() == 0.0f : reach_of_all() > 0.0f);
    for (int i = 0; i < OBJECTS; i++) // and at last the owners, and the other kind
        ck_assert_int_eq(occ_scene_remove(scene, objects[i]), OCC_SUCCESS);
    for (int i = 0; i < PER_KIND && _i; i++)
        ck_assert_int_eq(occ_scene_remove_occluder(scene, nobodys[i]), OCC_SUCCESS);
    commit();
    ck_assert_uint_eq(scene->occluder_rows.count, 0);
    ck_assert_uint_eq(scene->attached.count, 0);
    add_all(scene);
    commit();
    ck_assert_uint_eq(scene->occluder_rows.count, 2 * PER_KIND);
}
END_TEST

START_TEST(occluder_that_is_replaced_over_and_over_takes_no_more_memory)
{
    uint64_t bytes = 0;
    for (int round = 0; round < 200; round++) {
        occ_box box = kit_cube((float)(round % 7), 0, 0, 0.2f);
        ck_assert_int_eq(occ_scene_remove_occluder(scene, owned[round % 5]), OCC_SUCCESS);
        ck_assert_int_eq(occ_scene_add_occluder(scene, &box, objects[round], &owned[round % 5]),
                         OCC_SUCCESS);
        if (round % 3 == 2) commit();
        if (round == 20) bytes = heap.bytes;
    }
    commit();
    ck_assert_uint_le(heap.bytes, bytes);
    ck_assert_uint_eq(scene->occluder_rows.count, 2 * PER_KIND);
}
END_TEST

// --- memory that runs out ------------------------------------------------------------------------

// Moves, removals and additions of both kinds. Returns what the first refused edit said.
static occ_result edit(occ_scene *to)
{
    occ_box far = kit_cube(95, -95, 95, 0.3f);
    occ_box more[40];
    occ_object owners[40];
    kit_random random = {3};
    for (int i = 0; i < 40; i++) {
        more[i] = small_box(&random);
        owners[i] = i % 2 ? objects[20 + i] : nobody;
    }
    occ_result result = occ_scene_add_occluders(to, more, owners, 40, NULL);
    if (result) return result;
    ck_assert_int_eq(occ_scene_move(to, objects[2], &far), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_move_occluder(to, owned[4], &far), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_move_occluder(to, nobodys[4], &far), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_remove_occluder(to, owned[50]), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_remove_occluder(to, nobodys[50]), OCC_SUCCESS);
    return occ_scene_remove(to, objects[3]);
}

// Whatever allocation fails, and whatever is edited before the commit is tried again, the scene
// becomes the one that never ran out of memory.
START_TEST(failed_commit_of_occluders_can_be_tried_again)
{
    occ_scene_desc desc = {.leaf_objects = 4};
    occ_scene *expected;
    ck_assert_int_eq(occ_scene_create(&desc, &expected), OCC_SUCCESS);
    add_all(expected);
    ck_assert_int_eq(occ_scene_commit(expected), OCC_SUCCESS);
    ck_assert_int_eq(edit(expected), OCC_SUCCESS);
    occ_box late = kit_cube(-3, -4, -5, 0.125f);
    ck_assert_int_eq(occ_scene_move_occluder(expected, nobodys[9], &late), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_move_occluder(expected, owned[9], &late), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_remove_occluder(expected, nobodys[11]), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_commit(expected), OCC_SUCCESS);
    kit_check_trees(expected);
    uint32_t failures = 0;
    for (uint64_t n = 1; n < 1000; n++) {
        tear_down();
        set_up();
        heap.fail_at = heap.calls + n;
        if (edit(scene)) {
            ck_assert_int_eq(edit(scene), OCC_SUCCESS);
            failures++;
        }
        occ_result result = occ_scene_commit(scene);
        if (heap.failures == 0) break;
        if (result) {
            ck_assert_int_eq(result, OCC_ERROR_OUT_OF_MEMORY);
            failures++;
        }
        ck_assert_int_eq(occ_scene_move_occluder(scene, nobodys[9], &late), OCC_SUCCESS);
        ck_assert_int_eq(occ_scene_move_occluder(scene, owned[9], &late), OCC_SUCCESS);
        ck_assert_int_eq(occ_scene_remove_occluder(scene, nobodys[11]), OCC_SUCCESS);
        commit();
        kit_check_same_scene(scene, expected);
    }
    ck_assert_uint_gt(failures, 8);
    occ_scene_destroy(expected);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("scene_occluders");
    TCase *order = tcase_create("order");
    tcase_add_checked_fixture(order, set_up, tear_down);
    tcase_add_test(order, each_kind_has_its_rows);
    tcase_add_test(order, occluders_of_one_owner_lie_together_by_slot);
    tcase_add_test(order, moved_owned_occluder_keeps_its_row);
    tcase_add_test(order, free_occluder_that_stays_in_its_cell_keeps_its_row);
    tcase_add_test(order, free_occluder_that_leaves_its_cell_is_sorted_anew);
    tcase_add_test(order, free_occluder_far_away_makes_a_larger_root);
    tcase_add_test(order, objects_that_stay_in_their_cells_leave_the_occluders_alone);
    tcase_add_test(order, occluder_follows_its_owner);
    suite_add_tcase(suite, order);
    TCase *edits = tcase_create("edits");
    tcase_add_checked_fixture(edits, set_up, tear_down);
    tcase_add_test(edits, rows_of_the_removed_are_holes_until_the_commit);
    tcase_add_test(edits, removed_owner_takes_its_occluders_along);
    tcase_add_loop_test(edits, one_kind_may_be_missing, 0, 2);
    tcase_add_test(edits, occluder_that_is_replaced_over_and_over_takes_no_more_memory);
    suite_add_tcase(suite, edits);
    TCase *memory = tcase_create("memory");
    tcase_add_checked_fixture(memory, set_up, tear_down);
    tcase_add_test(memory, failed_commit_of_occluders_can_be_tried_again);
    suite_add_tcase(suite, memory);
    return test_run_suite(suite);
}
