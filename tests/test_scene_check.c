// SPDX-License-Identifier: Apache-2.0
// The validator has teeth: whatever is damaged in the tables of a sound scene, it sees.
#include "kit_damage.h"
#include "support.h"

#include <math.h>

static void swap_words(uint32_t *words, uint32_t i)
{
    uint32_t swap = words[i];
    words[i] = words[i + 1];
    words[i + 1] = swap;
}

static void swap_rows(void)
{
    swap_words(kit_victim->slot_of.data, 5);
}

static void repeat_a_slot(void)
{
    uint32_t *slots = kit_victim->slot_of.data;
    slots[6] = slots[5];
}

static void name_a_slot_outside(void)
{
    ((uint32_t *)kit_victim->slot_of.data)[7] = kit_victim->objects.count;
}

static void lose_a_row(void)
{
    kit_victim->boxes.count--;
}

static void lose_a_slot(void)
{
    kit_victim->slot_of.count--;
}

static void point_a_slot_elsewhere(void)
{
    kit_victim->objects.value[occ_scene_slot_of(kit_victim)[5]]++;
}

static void untake_an_object(void)
{
    kit_victim->objects.generation[occ_scene_slot_of(kit_victim)[5]]++;
}

static void count_one_object_more(void)
{
    kit_victim->objects.taken++;
}

static void move_an_object_secretly(void)
{
    occ_boxes_column(&kit_victim->boxes, 0)[5] += 1000.0f;
}

static void make_a_box_infinite(void)
{
    occ_boxes_column(&kit_victim->boxes, 4)[5] = INFINITY;
}

static void make_a_box_unknown(void)
{
    occ_boxes_column(&kit_victim->boxes, 2)[5] = NAN;
}

static void lose_the_bits_of_change(void)
{
    kit_victim->changed.count = 0;
}

static void release_and_forget(void)
{
    kit_victim->objects.released = 0;
}

static const kit_damage table_damages[] = {
    {"two slots have changed rows", swap_rows},
    {"a slot stands twice", repeat_a_slot},
    {"a row names a slot outside", name_a_slot_outside},
    {"a row is missing", lose_a_row},
    {"a row's slot is missing", lose_a_slot},
    {"a slot points elsewhere", point_a_slot_elsewhere},
    {"a row's slot is not taken", untake_an_object},
    {"an object too many is counted", count_one_object_more},
    {"a box has moved", move_an_object_secretly},
    {"a box is infinite", make_a_box_infinite},
    {"a box is NaN", make_a_box_unknown},
    {"the bits of change are missing", lose_the_bits_of_change},
    {"the released list is not empty", release_and_forget},
};
enum { TABLE_DAMAGES = (int)(sizeof table_damages / sizeof *table_damages) };

START_TEST(damage_to_a_table_is_seen)
{
    table_damages[_i].do_it();
    kit_damage_check(table_damages[_i].what);
}
END_TEST

START_TEST(scene_with_edits_is_not_validated_but_committed_first)
{
    occ_scene *scene;
    occ_object object;
    occ_box box = kit_cube(0, 0, 0, 1);
    ck_assert_int_eq(occ_scene_create(NULL, &scene), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_add(scene, &box, &object), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_validate(scene), OCC_ERROR_NOT_COMMITTED);
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_validate(scene), OCC_SUCCESS);
    occ_scene_destroy(scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("scene_check");
    TCase *tables = tcase_create("tables");
    tcase_add_checked_fixture(tables, kit_damage_set_up, kit_damage_tear_down);
    tcase_add_loop_test(tables, damage_to_a_table_is_seen, 0, TABLE_DAMAGES);
    tcase_add_test(tables, scene_with_edits_is_not_validated_but_committed_first);
    suite_add_tcase(suite, tables);
    return test_run_suite(suite);
}
