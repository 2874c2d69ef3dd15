// SPDX-License-Identifier: Apache-2.0
// The validator has teeth: whatever is damaged in a sound octree, it sees.
#include "kit_damage.h"
#include "support.h"

#include <math.h>

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
        kit_damage_check(damage->what);
        nodes[i] = whole;
    }
    ck_assert_int_eq(occ_scene_validate(kit_victim), OCC_SUCCESS);
}

START_TEST(damage_to_any_node_of_the_objects_is_seen)
{
    damage_nodes(&kit_victim->object_tree, &node_damages[_i]);
}
END_TEST

START_TEST(damage_to_any_node_of_the_occluders_is_seen)
{
    damage_nodes(&kit_victim->occluder_tree, &node_damages[_i]);
}
END_TEST

START_TEST(boundary_moved_between_siblings_is_seen)
{
    occ_node *nodes = kit_victim->object_tree.nodes.data;
    uint32_t tried = 0;
    for (uint32_t i = 0; i < kit_victim->object_tree.nodes.count; i++) {
        if (nodes[i].children < 2) continue;
        occ_node *left = &nodes[nodes[i].child], *right = left + 1;
        if (left->children || right->children || right->count < 2) continue;
        occ_node whole[2] = {*left, *right};
        left->count++;
        right->first++;
        right->count--;
        kit_damage_check("an item that lies in its node's sibling");
        *left = whole[0];
        *right = whole[1];
        tried++;
    }
    ck_assert_uint_gt(tried, 5);
}
END_TEST

// --- trees ---------------------------------------------------------------------------------------

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

static const kit_damage tree_damages[] = {
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
    tree = &kit_victim->object_tree;
    tree_damages[_i].do_it();
    kit_damage_check(tree_damages[_i].what);
    kit_damage_mend();
    tree = &kit_victim->occluder_tree;
    tree_damages[_i].do_it();
    kit_damage_check(tree_damages[_i].what);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("octree_check");
    TCase *nodes = tcase_create("nodes");
    tcase_add_checked_fixture(nodes, kit_damage_set_up, kit_damage_tear_down);
    tcase_add_loop_test(nodes, damage_to_any_node_of_the_objects_is_seen, 0, NODE_DAMAGES);
    tcase_add_loop_test(nodes, damage_to_any_node_of_the_occluders_is_seen, 0, NODE_DAMAGES);
    tcase_add_test(nodes, boundary_moved_between_siblings_is_seen);
    suite_add_tcase(suite, nodes);
    TCase *trees = tcase_create("trees");
    tcase_add_checked_fixture(trees, kit_damage_set_up, kit_damage_tear_down);
    tcase_add_loop_test(trees, damage_to_a_tree_is_seen, 0, TREE_DAMAGES);
    suite_add_tcase(suite, trees);
    return test_run_suite(suite);
}
