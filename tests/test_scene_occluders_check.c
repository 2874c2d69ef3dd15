// SPDX-License-Identifier: Apache-2.0
// The validator has teeth: whatever is damaged in what a sound scene knows of its occluders, it
// sees.
#include "kit_damage.h"
#include "support.h"

#include <math.h>

// --- rows ----------------------------------------------------------------------------------------

static occ_occluder_rows *rows(void)
{
    return &kit_victim->occluder_rows;
}

static uint32_t first_free(void)
{
    return kit_victim->attached_count;
}

// Lets two occluders change rows, with all that belongs to them. Both are boxes from there on.
static void exchange(uint32_t i, uint32_t j)
{
    occ_occluder_rows *r = rows();
    occ_scene_drop_sheet(kit_victim, i);
    occ_scene_drop_sheet(kit_victim, j);
    occ_box box = r->boxes[i];
    uint32_t slot = r->slot_of[i], owner = r->owner_of[i];
    r->boxes[i] = r->boxes[j];
    r->slot_of[i] = r->slot_of[j];
    r->owner_of[i] = r->owner_of[j];
    r->boxes[j] = box;
    r->slot_of[j] = slot;
    r->owner_of[j] = owner;
    kit_victim->occluders.value[r->slot_of[i]] = i;
    kit_victim->occluders.value[r->slot_of[j]] = j;
}

static const occ_node *node_of_row(uint32_t row)
{
    uint32_t slot = occ_scene_slot_of(kit_victim)[row];
    occ_object object = {slot + 1, kit_victim->objects.generation[slot]};
    return kit_node_of(kit_victim, object);
}

// The first row whose neighbour has the same owner, or another in the same node: what is attached
// to nodes does not change with their order.
static uint32_t attached_row(bool same_owner)
{
    for (uint32_t i = 0; i + 1 < kit_victim->attached_count; i++) {
        uint32_t here = occ_scene_owner_row(kit_victim, i);
        uint32_t next = occ_scene_owner_row(kit_victim, i + 1);
        if ((here == next) == same_owner && node_of_row(here) == node_of_row(next)) return i;
    }
    ck_abort_msg("no such neighbours");
    return 0;
}

// The first free row whose neighbour has the same box, or another.
static uint32_t free_row(bool same_box)
{
    const occ_box *boxes = rows()->boxes;
    for (uint32_t i = first_free(); i + 1 < rows()->count; i++)
        if (kit_same_bits(&boxes[i], &boxes[i + 1], sizeof *boxes) == same_box) return i;
    ck_abort_msg("no such neighbours");
    return 0;
}

static void exchange_two_owners(void)
{
    uint32_t i = attached_row(false);
    exchange(i, i + 1);
}

static void exchange_two_of_one_owner(void)
{
    uint32_t i = attached_row(true);
    rows()->boxes[i + 1] = rows()->boxes[i]; // so that nothing else gives it away
    exchange(i, i + 1);
}

static void exchange_two_free_ones(void)
{
    uint32_t i = free_row(false);
    exchange(i, i + 1);
}

static void exchange_two_like_ones(void)
{
    uint32_t i = free_row(true);
    exchange(i, i + 1);
}

static void exchange_a_free_one_and_an_attached_one(void)
{
    rows()->boxes[first_free()] = rows()->boxes[first_free() - 1];
    exchange(first_free() - 1, first_free());
}

static void swap_occluders_slots(void)
{
    uint32_t *slots = rows()->slot_of, swap = slots[3];
    slots[3] = slots[4];
    slots[4] = swap;
}

static void repeat_an_occluder(void)
{
    rows()->slot_of[1] = rows()->slot_of[0];
}

static void name_an_occluder_outside(void)
{
    rows()->slot_of[3] = kit_victim->occluders.count;
}

static void leave_a_hole(void)
{
    rows()->slot_of[3] = OCC_NO_SLOT;
}

static void lose_an_occluder(void)
{
    rows()->count--;
}

static void untake_an_occluder(void)
{
    kit_victim->occluders.generation[rows()->slot_of[0]]++;
}

static void point_an_occluder_elsewhere(void)
{
    kit_victim->occluders.value[rows()->slot_of[first_free()]]++;
}

static void count_one_occluder_more(void)
{
    kit_victim->occluders.taken++;
}

static void release_and_forget_an_occluder(void)
{
    kit_victim->occluders.released_count++;
}

static void make_an_orphan(void)
{
    uint32_t gone = kit_victim->objects.free;
    ck_assert_uint_ne(gone, OCC_NO_SLOT);
    rows()->owner_of[0] = gone;
}

static void name_an_owner_outside(void)
{
    rows()->owner_of[0] = kit_victim->objects.count;
}

static void forget_an_owner(void)
{
    rows()->owner_of[first_free() - 1] = OCC_NO_SLOT;
}

static void own_a_free_one(void)
{
    uint32_t last = kit_victim->boxes.count - 1;
    rows()->owner_of[first_free()] = occ_scene_slot_of(kit_victim)[last];
}

// The last of them to the last of the objects: the order stays.
static void give_to_another_owner(void)
{
    uint32_t i = kit_victim->attached_count - 1, row = kit_victim->boxes.count - 1;
    ck_assert_ptr_ne(node_of_row(occ_scene_owner_row(kit_victim, i)), node_of_row(row));
    rows()->owner_of[i] = occ_scene_slot_of(kit_victim)[row];
}

static void move_a_free_one_secretly(void)
{
    rows()->boxes[first_free()].center[1] += 1000.0f;
}

static void make_an_attached_one_unknown(void)
{
    rows()->boxes[0].axis[2][2] = NAN;
}

static void make_a_free_one_unknown(void)
{
    rows()->boxes[first_free()].center[2] = NAN;
}

static void enlarge_an_attached_one_secretly(void)
{
    for (int k = 0; k < 3; k++)
        rows()->boxes[0].axis[k][k] += 1000.0f;
}

static void attach_one_more(void)
{
    kit_victim->attached_count++;
}

static void attach_one_less(void)
{
    kit_victim->attached_count--;
}

static void attach_far_too_many(void)
{
    kit_victim->attached_count = 0x7fffffff;
}

static void lose_what_is_attached_to_a_node(void)
{
    kit_victim->attached.count--;
}

static void lose_a_reach(void)
{
    kit_victim->reach.count--;
}

static const kit_damage row_damages[] = {
    {"occluders of two owners have changed rows", exchange_two_owners},
    {"occluders of one owner have changed rows", exchange_two_of_one_owner},
    {"free occluders have changed rows", exchange_two_free_ones},
    {"like occluders have changed rows", exchange_two_like_ones},
    {"a free occluder lies before an attached one", exchange_a_free_one_and_an_attached_one},
    {"two occluders have each other's slot", swap_occluders_slots},
    {"an occluder stands twice", repeat_an_occluder},
    {"a row names an occluder outside", name_an_occluder_outside},
    {"a row is a hole", leave_a_hole},
    {"an occluder is missing", lose_an_occluder},
    {"an occluder's slot is not taken", untake_an_occluder},
    {"an occluder's slot points elsewhere", point_an_occluder_elsewhere},
    {"an occluder too many is counted", count_one_occluder_more},
    {"the list of released occluders is not empty", release_and_forget_an_occluder},
    {"an owner is gone", make_an_orphan},
    {"an owner is outside", name_an_owner_outside},
    {"an owner is forgotten", forget_an_owner},
    {"a free occluder has an owner", own_a_free_one},
    {"an occluder has another owner", give_to_another_owner},
    {"a free occluder has moved", move_a_free_one_secretly},
    {"an attached occluder is NaN", make_an_attached_one_unknown},
    {"a free occluder is NaN", make_a_free_one_unknown},
    {"an attached occluder has grown", enlarge_an_attached_one_secretly},
    {"one too many is attached", attach_one_more},
    {"one too few is attached", attach_one_less},
    {"far too many are attached", attach_far_too_many},
    {"a node has nothing attached", lose_what_is_attached_to_a_node},
    {"a reach is missing", lose_a_reach},
};
enum { ROW_DAMAGES = (int)(sizeof row_damages / sizeof *row_damages) };

START_TEST(damage_to_the_rows_is_seen)
{
    row_damages[_i].do_it();
    kit_damage_check(row_damages[_i].what);
}
END_TEST

// --- what a node knows ---------------------------------------------------------------------------

static void earlier_first(occ_attached *attached)
{
    attached->first--;
}

static void later_first(occ_attached *attached)
{
    attached->first++;
}

static void larger_count(occ_attached *attached)
{
    attached->count++;
}

static void smaller_count(occ_attached *attached)
{
    attached->count--;
}

static void later_but_ending_there(occ_attached *attached)
{
    attached->first++;
    attached->count--;
}

static void longer_reach(occ_attached *attached)
{
    attached->reach = nextafterf(attached->reach, INFINITY);
}

static void shorter_reach(occ_attached *attached)
{
    attached->reach = nextafterf(attached->reach, -INFINITY);
}

static void unknown_reach(occ_attached *attached)
{
    attached->reach = NAN;
}

static const struct {
    const char *what;
    void (*do_it)(occ_attached *attached);
} attached_damages[] = {
    {"first, too early", earlier_first},
    {"first, too late", later_first},
    {"count, too large", larger_count},
    {"count, too small", smaller_count},
    {"first, too late, with the same end", later_but_ending_there},
    {"reach, too long", longer_reach},
    {"reach, too short", shorter_reach},
    {"reach, NaN", unknown_reach},
};
enum { ATTACHED_DAMAGES = (int)(sizeof attached_damages / sizeof *attached_damages) };

START_TEST(damage_to_what_is_attached_to_any_node_is_seen)
{
    occ_attached *attached = kit_victim->attached.data;
    ck_assert_uint_gt(kit_victim->attached.count, 50);
    for (uint32_t n = 0; n < kit_victim->attached.count; n++) {
        occ_attached whole = attached[n];
        attached_damages[_i].do_it(&attached[n]);
        kit_damage_check(attached_damages[_i].what);
        attached[n] = whole;
    }
    ck_assert_int_eq(occ_scene_validate(kit_victim), OCC_SUCCESS);
}
END_TEST

START_TEST(damage_to_the_reach_of_any_node_is_seen)
{
    float *reach = kit_victim->reach.data;
    ck_assert_uint_gt(kit_victim->reach.count, 10);
    for (uint32_t n = 0; n < kit_victim->reach.count; n++) {
        float whole = reach[n];
        reach[n] = nextafterf(whole, INFINITY);
        kit_damage_check("a reach is too long");
        reach[n] = nextafterf(whole, -INFINITY);
        kit_damage_check("a reach is too short");
        reach[n] = NAN;
        kit_damage_check("a reach is NaN");
        reach[n] = whole;
    }
    ck_assert_int_eq(occ_scene_validate(kit_victim), OCC_SUCCESS);
}
END_TEST

START_TEST(more_attached_than_there_are_is_seen)
{
    kit_log record = {.lines = 0};
    occ_scene_desc desc = {.logger = kit_logger(&record)};
    occ_scene *scene;
    ck_assert_int_eq(occ_scene_create(&desc, &scene), OCC_SUCCESS);
    kit_fill(scene, 20, 1, 1, NULL, NULL); // somebody owns each of them
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_validate(scene), OCC_SUCCESS);
    scene->attached_count++;
    ck_assert_int_eq(occ_scene_validate(scene), OCC_ERROR_CORRUPT);
    ck_assert(kit_logged(&record, "attached occluders have rows"));
    scene->attached_count--;
    occ_scene_destroy(scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("scene_occluders_check");
    TCase *table = tcase_create("rows");
    tcase_add_checked_fixture(table, kit_damage_set_up, kit_damage_tear_down);
    tcase_add_loop_test(table, damage_to_the_rows_is_seen, 0, ROW_DAMAGES);
    tcase_add_test(table, more_attached_than_there_are_is_seen);
    suite_add_tcase(suite, table);
    TCase *nodes = tcase_create("nodes");
    tcase_add_checked_fixture(nodes, kit_damage_set_up, kit_damage_tear_down);
    tcase_add_loop_test(nodes, damage_to_what_is_attached_to_any_node_is_seen, 0, ATTACHED_DAMAGES);
    tcase_add_test(nodes, damage_to_the_reach_of_any_node_is_seen);
    suite_add_tcase(suite, nodes);
    return test_run_suite(suite);
}
