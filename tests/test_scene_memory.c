// SPDX-License-Identifier: Apache-2.0
// What a scene holds, to the byte.
#include "kit_tree.h"
#include "support.h"

#include <stdlib.h>

enum { OBJECTS = 100000, MOST_BYTES = 128 }; // of library memory per object, all included

static kit_heap heap;

// How a scene comes by its content.
typedef enum how {
    RESERVED,   // announced in the desc, added all at once
    TOGETHER,   // added all at once
    ONE_BY_ONE, // not announced
    EDITED,     // and then a tenth of it replaced, over and over
    HOWS
} how;

static occ_scene *new_scene(how way, uint32_t occluders)
{
    occ_scene_desc desc = {.allocator = kit_allocator(&heap)};
    if (way == RESERVED) {
        desc.object_count = OBJECTS;
        desc.occluder_count = occluders;
    }
    occ_scene *scene;
    heap = (kit_heap){0};
    ck_assert_int_eq(occ_scene_create(&desc, &scene), OCC_SUCCESS);
    return scene;
}

static void check_bytes(const occ_scene *scene)
{
    occ_scene_stats stats;
    ck_assert_int_eq(occ_scene_get_stats(scene, &stats), OCC_SUCCESS);
    ck_assert_uint_eq(stats.bytes, heap.bytes);
}

// Every so-manieth occluder is nobody's; 0: none.
static uint32_t nobodys_every;

static void everybody(void)
{
    nobodys_every = 0;
}

static bool is_nobodys(uint32_t i)
{
    return nobodys_every && i % nobodys_every == 0;
}

static void fill(occ_scene *scene, how way, uint32_t occluders, occ_object *objects)
{
    occ_object *owners = calloc(OBJECTS, sizeof *owners);
    occ_box *boxes = malloc(OBJECTS * sizeof *boxes);
    ck_assert(owners && boxes);
    kit_random random = {1};
    for (uint32_t i = 0; i < OBJECTS; i++)
        boxes[i] = kit_box(&random, 1000, 1);
    bool single = way == ONE_BY_ONE || way == EDITED;
    for (uint32_t i = 0; i < OBJECTS && single; i++)
        KIT_CHECK(!occ_scene_add(scene, &boxes[i], &objects[i]), "an object is refused");
    if (!single) {
        ck_assert_int_eq(occ_scene_add_many(scene, boxes, OBJECTS, objects), OCC_SUCCESS);
    }
    for (uint32_t i = 0; i < occluders; i++)
        if (!is_nobodys(i)) owners[i] = objects[i];
    for (uint32_t i = 0; i < occluders && single; i++)
        KIT_CHECK(!occ_scene_add_occluder(scene, &boxes[i], owners[i], NULL), "refused");
    if (!single) {
        ck_assert_int_eq(occ_scene_add_occluders(scene, boxes, owners, occluders, NULL),
                         OCC_SUCCESS);
    }
    free(boxes);
    free(owners);
    check_bytes(scene);
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
    check_bytes(scene);
}

// Replaces a tenth of the objects, with their occluders, by others.
static void replace(occ_scene *scene, uint32_t occluders, occ_object *objects, uint32_t round)
{
    kit_random random = {round + 100};
    for (uint32_t i = round; i < OBJECTS; i += 10) {
        occ_box box = kit_box(&random, 1000, 1);
        KIT_CHECK(!occ_scene_remove(scene, objects[i]), "an object stays");
        KIT_CHECK(!occ_scene_add(scene, &box, &objects[i]), "an object is refused");
        if (i >= occluders || is_nobodys(i)) continue;
        KIT_CHECK(!occ_scene_add_occluder(scene, &box, objects[i], NULL), "refused");
    }
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
    check_bytes(scene);
}

static double bytes_per_object(how way, uint32_t occluders)
{
    occ_object *objects = malloc(OBJECTS * sizeof *objects);
    ck_assert_ptr_nonnull(objects);
    occ_scene *scene = new_scene(way, occluders);
    fill(scene, way, occluders, objects);
    for (uint32_t round = 0; way == EDITED && round < 3; round++)
        replace(scene, occluders, objects, round);
    occ_scene_stats stats;
    ck_assert_int_eq(occ_scene_get_stats(scene, &stats), OCC_SUCCESS);
    ck_assert_uint_eq(stats.objects, OBJECTS);
    ck_assert_uint_eq(stats.occluders, occluders);
    double bytes = (double)stats.bytes / OBJECTS;
    occ_scene_destroy(scene);
    ck_assert_uint_eq(heap.blocks, 0);
    ck_assert_uint_eq(heap.bytes, 0);
    free(objects);
    return bytes;
}

START_TEST(scene_with_half_as_many_occluders_stays_within_the_budget)
{
    double bytes = bytes_per_object((how)_i, OBJECTS * 46 / 100);
    ck_assert_double_gt(bytes, 48.0); // less than its box would be a mistake in counting
    ck_assert_double_le(bytes, MOST_BYTES);
}
END_TEST

START_TEST(scene_with_as_many_occluders_stays_within_the_budget)
{
    double bytes = bytes_per_object((how)_i, OBJECTS);
    ck_assert_double_gt(bytes, 96.0);
    ck_assert_double_le(bytes, MOST_BYTES);
}
END_TEST

START_TEST(free_occluders_take_no_more)
{
    nobodys_every = 1 + 2 * ((uint32_t)_i % 2);
    double bytes = bytes_per_object((how)(_i / 2), OBJECTS);
    ck_assert_double_gt(bytes, 96.0);
    ck_assert_double_le(bytes, MOST_BYTES);
    nobodys_every = 3;
    bytes = bytes_per_object(EDITED, OBJECTS / 2);
    ck_assert_double_le(bytes, MOST_BYTES);
}
END_TEST

START_TEST(scene_built_at_once_holds_little_more_than_its_tables)
{
    occ_object *objects = malloc(OBJECTS * sizeof *objects);
    ck_assert_ptr_nonnull(objects);
    occ_scene *scene = new_scene((how)_i, OBJECTS / 2);
    fill(scene, (how)_i, OBJECTS / 2, objects);
    occ_scene_stats stats;
    ck_assert_int_eq(occ_scene_get_stats(scene, &stats), OCC_SUCCESS);
    // A box, its slot, and the slot's value and generation for each, and an occluder's owner;
    // nodes, with what is attached to them, or their reach.
    uint64_t item = sizeof(occ_box) + sizeof(uint32_t) + sizeof(uint32_t) + sizeof(uint16_t);
    uint64_t tables = (stats.objects + stats.occluders) * item + sizeof *scene +
                      stats.occluders * sizeof(uint32_t) +
                      stats.object_nodes * (sizeof(occ_node) + sizeof(occ_attached)) +
                      stats.occluder_nodes * (sizeof(occ_node) + sizeof(float));
    ck_assert_uint_ge(stats.bytes, tables);
    ck_assert_uint_le(stats.bytes, tables + tables / 200);
    occ_scene_destroy(scene);
    free(objects);
}
END_TEST

START_TEST(commit_gives_back_what_it_borrowed)
{
    occ_scene *scene = new_scene(TOGETHER, 0);
    occ_object *objects = malloc(OBJECTS * sizeof *objects);
    ck_assert_ptr_nonnull(objects);
    fill(scene, TOGETHER, 1000, objects);
    uint64_t bytes = heap.bytes, blocks = heap.blocks;
    for (uint32_t round = 0; round < 5; round++) {
        occ_box box = kit_cube((float)round, 2, 3, 1); // one moves a little, one far
        ck_assert_int_eq(occ_scene_move(scene, objects[7], &box), OCC_SUCCESS);
        box = kit_cube(-500.0f * (float)round, 2, 3, 4);
        ck_assert_int_eq(occ_scene_move(scene, objects[8], &box), OCC_SUCCESS);
        ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
        ck_assert_uint_eq(heap.blocks, blocks);
        ck_assert_uint_lt(heap.bytes, bytes + bytes / 50);
    }
    check_bytes(scene);
    occ_scene_destroy(scene);
    ck_assert_uint_eq(heap.bytes, 0);
    free(objects);
}
END_TEST

START_TEST(reserved_room_is_enough)
{
    occ_scene *scene = new_scene(RESERVED, OBJECTS);
    occ_box box = kit_cube(0, 0, 0, 1);
    occ_object object, nobody = {0, 0};
    uint64_t calls = heap.calls;
    for (uint32_t i = 0; i < OBJECTS; i++) {
        KIT_CHECK(!occ_scene_add(scene, &box, &object), "an object is refused");
        KIT_CHECK(!occ_scene_add_occluder(scene, &box, nobody, NULL), "refused");
    }
    ck_assert_uint_eq(heap.calls, calls);
    occ_scene_destroy(scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("scene_memory");
    TCase *budget = tcase_create("budget");
    tcase_add_checked_fixture(budget, everybody, NULL);
    tcase_add_loop_test(budget, scene_with_half_as_many_occluders_stays_within_the_budget, 0, HOWS);
    // Grown one by one there may be an eighth of room to spare, which would not fit.
    tcase_add_loop_test(budget, scene_with_as_many_occluders_stays_within_the_budget, 0,
                        ONE_BY_ONE);
    tcase_add_loop_test(budget, free_occluders_take_no_more, 0, 2 * ONE_BY_ONE);
    tcase_add_loop_test(budget, scene_built_at_once_holds_little_more_than_its_tables, 0,
                        ONE_BY_ONE);
    suite_add_tcase(suite, budget);
    TCase *borrowed = tcase_create("borrowed");
    tcase_add_test(borrowed, commit_gives_back_what_it_borrowed);
    tcase_add_test(borrowed, reserved_room_is_enough);
    suite_add_tcase(suite, borrowed);
    return test_run_suite(suite);
}
