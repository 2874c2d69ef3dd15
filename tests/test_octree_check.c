// SPDX-License-Identifier: Apache-2.0
// The validator has teeth: whatever is damaged in a sound scene, it sees.
#include "kit_model.h"
#include "support.h"

#include <math.h>
#include <string.h>

static kit_model *model;
static occ_scene *scene, sound; // the scene, and what was in it before the damage
static kit_log record;

static void set_up(void)
{
    kit_forget(&record);
    occ_scene_desc desc = {.leaf_objects = 4, .logger = kit_logger(&record)};
    model = kit_model_create(4711, &desc);
    while (model->object_count < 400 || model->occluder_count < 90)
        kit_model_edit(model);
    scene = model->scene;
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_validate(scene), OCC_SUCCESS);
    ck_assert_uint_eq(record.errors, 0);
    sound = *scene;
}

static void tear_down(void)
{
    *scene = sound; // its arrays are freed by the sizes it had
    kit_model_destroy(model);
}

// The scene is damaged: the validator says so, and names what does not hold.
static void check_seen(const char *what)
{
    kit_forget(&record);
    occ_result result = occ_scene_validate(scene);
    KIT_CHECK(result == OCC_ERROR_CORRUPT, "%s: %s", what, occ_result_name(result));
    KIT_CHECK(record.errors == 1 && kit_logged(&record, "OCC_ERROR_CORRUPT: it does not hold that"),
              "%s: the log says \"%s\"", what, record.text);
}

// --- nodes ---------------------------------------------------------------------------------------

typedef struct node_damage {
    const char *what;
    void (*do_it)(occ_node *node);
    bool to_leaves; // also a damage of a node without children
} node_damage;

static void lower_min(occ_node *node)
{
    node->min[1] = nextafterf(node->min[1], -INFINITY);
}

static void raise_min(occ_node *node)
{
    node->min[2] = nextafterf(node->min[2], INFINITY);
}

static void lower_max(occ_node *node)
{
    node->max[0] = nextafterf(node->max[0], -INFINITY);
}

static void raise_max(occ_node *node)
{
    node->max[1] = nextafterf(node->max[1], INFINITY);
}

static void unknown_min(occ_node *node)
{
    node->min[0] = NAN;
}

static void unknown_max(occ_node *node)
{
    node->max[2] = NAN;
}

static void later_first(occ_node *node)
{
    node->first++;
}

static void earlier_first(occ_node *node)
{
    node->first--;
}

static void larger_count(occ_node *node)
{
    node->count++;
}

static void smaller_count(occ_node *node)
{
    node->count--;
}

static void zero_count(occ_node *node)
{
    node->count = 0;
}

static void later_child(occ_node *node)
{
    node->child++;
}

static void earlier_child(occ_node *node)
{
    node->child--;
}

static void child_far_outside(occ_node *node)
{
    node->child = 0x7fffffff;
}

static void one_child_more(occ_node *node)
{
    node->children++;
}

static void one_child_less(occ_node *node)
{
    node->children--;
}

static void far_too_many_children(occ_node *node)
{
    node->children = 255;
}

static void deeper_level(occ_node *node)
{
    node->level++;
}

static void higher_level(occ_node *node)
{
    node->level--;
}

static void no_such_level(occ_node *node)
{
    node->level = 255;
}

static const node_damage node_damages[] = {
    {"min, too low", lower_min, true},
    {"min, too high", raise_min, true},
    {"max, too low", lower_max, true},
    {"max, too high", raise_max, true},
    {"min, NaN", unknown_min, true},
    {"max, NaN", unknown_max, true},
    {"first, too late", later_first, true},
    {"first, too early", earlier_first, true},
    {"count, too large", larger_count, true},
    {"count, too small", smaller_count, true},
    {"count, zero", zero_count, true},
    {"child, too late", later_child, false},
    {"child, too early", earlier_child, false},
    {"child, far outside", child_far_outside, false},
    {"children, one too many", one_child_more, true},
    {"children, one too few", one_child_less, false},
    {"children, 255", far_too_many_children, true},
    {"level, too deep", deeper_level, true},
    {"level, too high", higher_level, true},
    {"level, 255", no_such_level, true},
};
enum { NODE_DAMAGES = (int)(sizeof node_damages / sizeof *node_damages) };

// Damages one node after the other and mends it again.
static void damage_nodes(occ_octree *tree, const node_damage *damage)
{
    occ_node *nodes = tree->nodes.data;
    ck_assert_uint_gt(tree->levels, 3);
    for (uint32_t i = 0; i < tree->nodes.count; i++) {
        if (!damage->to_leaves && !nodes[i].children) continue;
        occ_node whole = nodes[i];
        damage->do_it(&nodes[i]);
        check_seen(damage->what);
        nodes[i] = whole;
    }
    ck_assert_int_eq(occ_scene_validate(scene), OCC_SUCCESS);
}

START_TEST(damage_to_any_node_of_the_objects_is_seen)
{
    damage_nodes(&scene->object_tree, &node_damages[_i]);
}
END_TEST

START_TEST(damage_to_any_node_of_the_occluders_is_seen)
{
    damage_nodes(&scene->occluder_tree, &node_damages[_i]);
}
END_TEST

START_TEST(boundary_moved_between_siblings_is_seen)
{
    occ_node *nodes = scene->object_tree.nodes.data;
    uint32_t tried = 0;
    for (uint32_t i = 0; i < scene->object_tree.nodes.count; i++) {
        if (nodes[i].children < 2) continue;
        occ_node *left = &nodes[nodes[i].child], *right = left + 1;
        if (left->children || right->children || right->count < 2) continue;
        occ_node whole[2] = {*left, *right};
        left->count++;
        right->first++;
        right->count--;
        check_seen("an item that lies in its node's sibling");
        *left = whole[0];
        *right = whole[1];
        tried++;
    }
    ck_assert_uint_gt(tried, 5);
}
END_TEST

// --- trees ---------------------------------------------------------------------------------------

typedef struct damage {
    const char *what;
    void (*do_it)(void);
} damage;

static occ_octree *tree; // the one to damage

static void one_level_more(void)
{
    tree->levels++;
}

static void one_level_less(void)
{
    tree->levels--;
}

static void a_thousand_levels(void)
{
    tree->levels = 1000;
}

static void level_begins_late(void)
{
    tree->level_first[2]++;
}

static void level_begins_early(void)
{
    tree->level_first[3]--;
}

static void level_begins_far_outside(void)
{
    tree->level_first[2] = 0x7fffffff;
}

static void first_level_is_not_the_root(void)
{
    tree->level_first[0] = 1;
}

static void last_level_ends_early(void)
{
    tree->level_first[tree->levels]--;
}

static void one_node_less(void)
{
    tree->nodes.count--;
}

static void no_nodes(void)
{
    tree->nodes.count = 0;
}

static void larger_root(void)
{
    tree->root.size *= 2.0;
}

static void shifted_root(void)
{
    tree->root.origin[1] += tree->root.size / 8.0;
}

static void smaller_leaves(void)
{
    tree->leaf_items = 1;
}

static void larger_leaves(void)
{
    tree->leaf_items = 1000;
}

static const damage tree_damages[] = {
    {"one level more", one_level_more},
    {"one level less", one_level_less},
    {"a thousand levels", a_thousand_levels},
    {"a level begins late", level_begins_late},
    {"a level begins early", level_begins_early},
    {"a level begins far outside", level_begins_far_outside},
    {"the first level is not the root", first_level_is_not_the_root},
    {"the last level ends early", last_level_ends_early},
    {"one node less", one_node_less},
    {"no nodes", no_nodes},
    {"a larger root", larger_root},
    {"a shifted root", shifted_root},
    {"smaller leaves", smaller_leaves},
    {"larger leaves", larger_leaves},
};
enum { TREE_DAMAGES = (int)(sizeof tree_damages / sizeof *tree_damages) };

START_TEST(damage_to_a_tree_is_seen)
{
    tree = &scene->object_tree;
    tree_damages[_i].do_it();
    check_seen(tree_damages[_i].what);
    *scene = sound;
    tree = &scene->occluder_tree;
    tree_damages[_i].do_it();
    check_seen(tree_damages[_i].what);
}
END_TEST

// --- tables --------------------------------------------------------------------------------------

// The first place from `from` on in the order of the occluders whose neighbour has another key,
// or, if `ties`, the same one: the boxes are alike then.
static uint32_t place_of(bool ties)
{
    const uint32_t *order = scene->occluder_order.data;
    const occ_box *boxes = occ_scene_occluder_boxes(scene);
    for (uint32_t i = 0; i + 1 < scene->occluder_order.count; i++) {
        bool same = kit_same_bits(&boxes[order[i]], &boxes[order[i + 1]], sizeof *boxes);
        if (same == ties) return i;
    }
    ck_abort_msg("no such neighbours");
    return 0;
}

static void swap_words(uint32_t *words, uint32_t i)
{
    uint32_t swap = words[i];
    words[i] = words[i + 1];
    words[i + 1] = swap;
}

static void swap_rows(void)
{
    swap_words(scene->slot_of.data, 5);
}

static void repeat_a_slot(void)
{
    uint32_t *slots = scene->slot_of.data;
    slots[6] = slots[5];
}

static void name_a_slot_outside(void)
{
    ((uint32_t *)scene->slot_of.data)[7] = scene->objects.count;
}

static void lose_a_row(void)
{
    scene->boxes.count--;
}

static void lose_a_slot(void)
{
    scene->slot_of.count--;
}

static void point_a_slot_elsewhere(void)
{
    scene->objects.value[occ_scene_slot_of(scene)[5]]++;
}

static void untake_an_object(void)
{
    scene->objects.generation[occ_scene_slot_of(scene)[5]]++;
}

static void count_one_object_more(void)
{
    scene->objects.taken++;
}

static void move_an_object_secretly(void)
{
    occ_boxes_column(&scene->boxes, 0)[5] += 1000.0f;
}

static void make_a_box_infinite(void)
{
    occ_boxes_column(&scene->boxes, 4)[5] = INFINITY;
}

static void make_a_box_unknown(void)
{
    occ_boxes_column(&scene->boxes, 2)[5] = NAN;
}

static void lose_the_bits_of_change(void)
{
    scene->changed.count = 0;
}

static void swap_occluders(void)
{
    swap_words(scene->occluder_order.data, place_of(false));
}

static void swap_like_occluders(void)
{
    swap_words(scene->occluder_order.data, place_of(true));
}

static void repeat_an_occluder(void)
{
    uint32_t *order = scene->occluder_order.data, i = place_of(true);
    order[i + 1] = order[i];
}

static void name_an_occluder_outside(void)
{
    ((uint32_t *)scene->occluder_order.data)[3] = scene->occluders.count;
}

static void lose_an_occluder(void)
{
    scene->occluder_order.count--;
}

static void untake_an_occluder(void)
{
    scene->occluders.generation[*(uint32_t *)scene->occluder_order.data]++;
}

static void make_an_orphan(void)
{
    uint32_t gone = scene->objects.free;
    ck_assert_uint_ne(gone, OCC_NO_SLOT);
    scene->occluders.value[*(uint32_t *)scene->occluder_order.data] = gone;
}

static void name_an_owner_outside(void)
{
    scene->occluders.value[*(uint32_t *)scene->occluder_order.data] = scene->objects.count;
}

static void move_an_occluder_secretly(void)
{
    uint32_t slot = *(uint32_t *)scene->occluder_order.data;
    ((occ_box *)scene->occluder_boxes.data)[slot].center[1] += 1000.0f;
}

static void make_an_occluder_unknown(void)
{
    uint32_t slot = *(uint32_t *)scene->occluder_order.data;
    ((occ_box *)scene->occluder_boxes.data)[slot].axis[2][2] = NAN;
}

static void shorten_a_reach(void)
{
    float *reach = scene->reach.data;
    reach[1] = nextafterf(reach[1], 0.0f);
}

static void lengthen_a_reach(void)
{
    float *reach = scene->reach.data;
    reach[0] = nextafterf(reach[0], INFINITY);
}

static void lose_a_reach(void)
{
    scene->reach.count--;
}

static void release_and_forget(void)
{
    scene->objects.released = 0;
}

static const damage table_damages[] = {
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
    {"two occluders have changed places", swap_occluders},
    {"two like occluders have changed places", swap_like_occluders},
    {"an occluder stands twice", repeat_an_occluder},
    {"the order names an occluder outside", name_an_occluder_outside},
    {"an occluder is missing", lose_an_occluder},
    {"an occluder's slot is not taken", untake_an_occluder},
    {"an owner is gone", make_an_orphan},
    {"an owner is outside", name_an_owner_outside},
    {"an occluder has moved", move_an_occluder_secretly},
    {"an occluder is NaN", make_an_occluder_unknown},
    {"a reach is too short", shorten_a_reach},
    {"a reach is too long", lengthen_a_reach},
    {"a reach is missing", lose_a_reach},
    {"the released list is not empty", release_and_forget},
};
enum { TABLE_DAMAGES = (int)(sizeof table_damages / sizeof *table_damages) };

START_TEST(damage_to_a_table_is_seen)
{
    table_damages[_i].do_it();
    check_seen(table_damages[_i].what);
}
END_TEST

START_TEST(scene_with_edits_is_not_validated_but_committed_first)
{
    occ_object object;
    occ_box box = kit_cube(0, 0, 0, 1);
    ck_assert_int_eq(occ_scene_add(scene, &box, &object), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_validate(scene), OCC_ERROR_NOT_COMMITTED);
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_validate(scene), OCC_SUCCESS);
    sound = *scene;
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("octree_check");
    TCase *nodes = tcase_create("nodes");
    tcase_add_checked_fixture(nodes, set_up, tear_down);
    tcase_add_loop_test(nodes, damage_to_any_node_of_the_objects_is_seen, 0, NODE_DAMAGES);
    tcase_add_loop_test(nodes, damage_to_any_node_of_the_occluders_is_seen, 0, NODE_DAMAGES);
    tcase_add_test(nodes, boundary_moved_between_siblings_is_seen);
    suite_add_tcase(suite, nodes);
    TCase *tables = tcase_create("tables");
    tcase_add_checked_fixture(tables, set_up, tear_down);
    tcase_add_loop_test(tables, damage_to_a_tree_is_seen, 0, TREE_DAMAGES);
    tcase_add_loop_test(tables, damage_to_a_table_is_seen, 0, TABLE_DAMAGES);
    tcase_add_test(tables, scene_with_edits_is_not_validated_but_committed_first);
    suite_add_tcase(suite, tables);
    return test_run_suite(suite);
}
