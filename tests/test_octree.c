// SPDX-License-Identifier: Apache-2.0
// timeout: 120
// The octree over boxes that are laid out, and come in an order, that could hurt it.
#include "kit_tree.h"
#include "support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COUNT = 1500 };

typedef void (*layout)(kit_random *random, occ_box *boxes);

static void scattered(kit_random *random, occ_box *boxes)
{
    for (int i = 0; i < COUNT; i++)
        boxes[i] = kit_box(random, 100, 2);
}

static void sorted(kit_random *random, occ_box *boxes)
{
    for (int i = 0; i < COUNT; i++)
        boxes[i] = kit_cube((float)i, kit_between(random, 0, 50), kit_between(random, 0, 50), 1);
}

static void reversed(kit_random *random, occ_box *boxes)
{
    for (int i = 0; i < COUNT; i++)
        boxes[i] = kit_cube((float)-i, kit_between(random, 0, 50), kit_between(random, 0, 50), 1);
}

static void all_in_one_point(kit_random *random, occ_box *boxes)
{
    for (int i = 0; i < COUNT; i++)
        boxes[i] = kit_cube(3, 4, 5, i % 7 ? kit_between(random, 0, 1) : 0);
}

static void along_a_line(kit_random *random, occ_box *boxes)
{
    for (int i = 0; i < COUNT; i++) {
        float t = kit_between(random, -1000, 1000);
        boxes[i] = kit_cube(t, t, t, 0.1f);
    }
}

static void along_an_axis_at_powers_of_two(kit_random *random, occ_box *boxes)
{
    (void)random;
    for (int i = 0; i < COUNT; i++)
        boxes[i] = kit_cube(ldexpf(1.0f, i % 150 - 110), 0, 0, ldexpf(1.0f, i % 41 - 40));
}

static void one_inside_the_other(kit_random *random, occ_box *boxes)
{
    (void)random;
    for (int i = 0; i < COUNT; i++)
        boxes[i] = kit_cube(0, 0, 0, ldexpf(1.0f + (float)i * 1e-4f, 40 - i % 100));
}

static void one_in_the_corner_of_the_other(kit_random *random, occ_box *boxes)
{
    (void)random;
    for (int i = 0; i < COUNT; i++) {
        float half = ldexpf(1.0f, 20 - i % 60);
        boxes[i] = kit_cube(half, half, half, half);
    }
}

static void huge_and_tiny(kit_random *random, occ_box *boxes)
{
    for (int i = 0; i < COUNT; i++)
        boxes[i] = i % 3 ? kit_box(random, 1, 1e-20f) : kit_box(random, 1e14f, 2e14f);
}

static void on_the_boundaries_of_cells(kit_random *random, occ_box *boxes)
{
    for (int i = 0; i < COUNT; i++) {
        float x = (float)kit_below(random, 17) * 16, y = (float)kit_below(random, 17) * 16;
        boxes[i] = kit_cube(x, y, (float)kit_below(random, 17) * 16, ldexpf(8, -(i % 6)));
    }
}

static void two_crowds_far_apart(kit_random *random, occ_box *boxes)
{
    for (int i = 0; i < COUNT; i++) {
        boxes[i] = kit_box(random, 1, 0.01f);
        if (i % 2) boxes[i].center[0] += 1e6f;
    }
}

static void denormal_world(kit_random *random, occ_box *boxes)
{
    for (int i = 0; i < COUNT; i++)
        boxes[i] = kit_box(random, 0x1p-128f, 0x1p-135f);
}

static void in_a_plane(kit_random *random, occ_box *boxes)
{
    for (int i = 0; i < COUNT; i++) {
        boxes[i] = kit_box(random, 100, 1);
        for (int k = 0; k < 3; k++)
            boxes[i].axis[k][1] = 0;
        boxes[i].center[1] = 0;
    }
}

static void offset_by(kit_random *random, occ_box *boxes, float offset)
{
    for (int i = 0; i < COUNT; i++) {
        boxes[i] = kit_box(random, 10, 0.001f);
        for (int j = 0; j < 3; j++)
            boxes[i].center[j] += j == 1 ? -offset : offset;
    }
}

static void offset_1e7(kit_random *random, occ_box *boxes)
{
    offset_by(random, boxes, 1e7f);
}

static void offset_1e10(kit_random *random, occ_box *boxes)
{
    offset_by(random, boxes, 1e10f);
}

static void offset_1e15(kit_random *random, occ_box *boxes)
{
    offset_by(random, boxes, 0.99e15f);
}

static const layout layouts[] = {
    scattered,
    sorted,
    reversed,
    all_in_one_point,
    along_a_line,
    along_an_axis_at_powers_of_two,
    one_inside_the_other,
    one_in_the_corner_of_the_other,
    huge_and_tiny,
    on_the_boundaries_of_cells,
    two_crowds_far_apart,
    denormal_world,
    in_a_plane,
    offset_1e7,
    offset_1e10,
    offset_1e15,
};
enum { LAYOUTS = (int)(sizeof layouts / sizeof *layouts) };

static occ_scene *new_scene(uint32_t leaf_objects)
{
    occ_scene_desc desc = {.leaf_objects = leaf_objects};
    occ_scene *scene;
    KIT_CHECK(!occ_scene_create(&desc, &scene), "no scene");
    return scene;
}

// Adds boxes as objects, each as an occluder that its object owns, and each as one that nobody
// does.
static void add(occ_scene *scene, const occ_box *boxes, size_t count)
{
    occ_box twice[2 * COUNT];
    occ_object objects[COUNT], owners[2 * COUNT];
    KIT_CHECK(!occ_scene_add_many(scene, boxes, count, objects), "the boxes are refused");
    for (size_t i = 0; i < 2 * count; i++) {
        twice[i] = boxes[i / 2];
        owners[i] = i % 2 ? objects[i / 2] : (occ_object){0, 0};
    }
    KIT_CHECK(!occ_scene_add_occluders(scene, twice, owners, 2 * count, NULL), "they are refused");
}

static void commit_and_check(occ_scene *scene)
{
    KIT_CHECK(!occ_scene_commit(scene), "no commit");
    kit_check_trees(scene);
}

START_TEST(tree_holds_whatever_the_layout)
{
    static const uint32_t leaves[] = {1, 8, 0, 1024};
    occ_box boxes[COUNT];
    for (size_t l = 0; l < sizeof leaves / sizeof *leaves; l++) {
        kit_random random = {(uint64_t)_i};
        layouts[_i](&random, boxes);
        occ_scene *scene = new_scene(leaves[l]);
        add(scene, boxes, COUNT);
        commit_and_check(scene);
        occ_scene_destroy(scene);
    }
}
END_TEST

START_TEST(nodes_are_the_same_whatever_the_order_of_insertion)
{
    occ_box boxes[COUNT];
    kit_random random = {(uint64_t)_i + 100};
    layouts[_i](&random, boxes);
    occ_scene *first = new_scene(8), *second = new_scene(8);
    add(first, boxes, COUNT);
    commit_and_check(first);
    for (uint32_t i = COUNT; i > 1; i--) { // a shuffle
        uint32_t j = kit_below(&random, i);
        occ_box swap = boxes[i - 1];
        boxes[i - 1] = boxes[j];
        boxes[j] = swap;
    }
    add(second, boxes, COUNT);
    commit_and_check(second);
    kit_check_same_tree(&first->object_tree, &second->object_tree);
    kit_check_same_tree(&first->occluder_tree, &second->occluder_tree);
    ck_assert_uint_eq(first->attached.count, second->attached.count);
    ck_assert_mem_eq(first->attached.data, second->attached.data,
                     first->attached.count * sizeof(occ_attached));
    occ_scene_destroy(first);
    occ_scene_destroy(second);
}
END_TEST

START_TEST(scene_committed_bit_by_bit_equals_one_committed_once)
{
    occ_box boxes[COUNT];
    kit_random random = {(uint64_t)_i + 200};
    layouts[_i](&random, boxes);
    occ_scene *once = new_scene(8), *often = new_scene(8);
    add(once, boxes, COUNT);
    commit_and_check(once);
    for (size_t i = 0, step = 1; i < COUNT; i += step, step *= 2) {
        add(often, boxes + i, i + step < COUNT ? step : COUNT - i);
        commit_and_check(often);
    }
    kit_check_same_scene(once, often);
    occ_scene_destroy(once);
    occ_scene_destroy(often);
}
END_TEST

START_TEST(scene_removed_bit_by_bit_stays_whole)
{
    occ_box boxes[COUNT];
    occ_object objects[COUNT];
    kit_random random = {(uint64_t)_i + 300};
    layouts[_i](&random, boxes);
    occ_scene *scene = new_scene(8);
    ck_assert_int_eq(occ_scene_add_many(scene, boxes, COUNT, objects), OCC_SUCCESS);
    uint32_t left = COUNT;
    for (uint32_t step = 400; left; step = left < 6 ? left : left / 2) {
        for (uint32_t i = 0; i < step; i++) {
            uint32_t j = kit_below(&random, left);
            KIT_CHECK(!occ_scene_remove(scene, objects[j]), "an object is not removed");
            objects[j] = objects[--left];
        }
        commit_and_check(scene);
        ck_assert_uint_eq(scene->boxes.count, left);
    }
    ck_assert_uint_eq(scene->object_tree.nodes.count, 0);
    occ_scene_destroy(scene);
}
END_TEST

START_TEST(million_identical_boxes_are_one_leaf)
{
    const uint32_t count = 1u << 20;
    occ_box *boxes = malloc(count * sizeof *boxes);
    ck_assert_ptr_nonnull(boxes);
    for (uint32_t i = 0; i < count; i++)
        boxes[i] = kit_cube(1, 2, 3, 0.5f);
    occ_scene *scene = new_scene(0);
    ck_assert_int_eq(occ_scene_add_many(scene, boxes, count, NULL), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
    kit_check_trees(scene);
    ck_assert_uint_eq(scene->object_tree.nodes.count, 1);
    for (uint32_t row = 0; row < count; row++)
        KIT_CHECK(occ_scene_slot_of(scene)[row] == row, "row %u changed places", row);
    occ_scene_destroy(scene);
    free(boxes);
}
END_TEST

START_TEST(ground_plane_inflates_no_leaf)
{
    occ_box boxes[COUNT];
    kit_random random = {5};
    scattered(&random, boxes);
    occ_scene *with = new_scene(8), *without = new_scene(8);
    ck_assert_int_eq(occ_scene_add_many(without, boxes, COUNT, NULL), OCC_SUCCESS);
    commit_and_check(without);
    occ_object ground;
    occ_box plane = {{1, 0, 1}, {{300, 0, 0}, {0, 0, 300}, {0, 0, 0}}};
    ck_assert_int_eq(occ_scene_add_many(with, boxes, COUNT, NULL), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_add(with, &plane, &ground), OCC_SUCCESS);
    commit_and_check(with);

    const occ_octree *wide = &with->object_tree, *tight = &without->object_tree;
    ck_assert_ptr_eq(kit_node_of(with, ground), occ_octree_nodes(wide));
    ck_assert_uint_eq(occ_node_own(wide, occ_octree_nodes(wide)), 1);
    ck_assert_uint_eq(wide->nodes.count, tight->nodes.count);
    for (uint32_t i = 1; i < wide->nodes.count; i++) { // all but the root
        const occ_node *a = &occ_octree_nodes(wide)[i], *b = &occ_octree_nodes(tight)[i];
        KIT_CHECK(kit_same_bits(a->min, b->min, sizeof a->min) &&
                      kit_same_bits(a->max, b->max, sizeof a->max),
                  "node %u is another with the plane", i);
    }
    occ_scene_destroy(with);
    occ_scene_destroy(without);
}
END_TEST

START_TEST(object_moves_to_the_level_its_new_size_deserves)
{
    occ_box boxes[COUNT];
    occ_object objects[COUNT];
    kit_random random = {6};
    scattered(&random, boxes);
    occ_scene *scene = new_scene(8);
    ck_assert_int_eq(occ_scene_add_many(scene, boxes, COUNT, objects), OCC_SUCCESS);
    occ_box box = boxes[77];
    unsigned deepest = OCC_TREE_BITS, last = 0;
    for (int i = 0; i < 8; i++) {
        float half = ldexpf(0.01f, 2 * i);
        for (int k = 0; k < 9; k++)
            box.axis[k / 3][k % 3] = k % 4 ? 0.0f : half;
        ck_assert_int_eq(occ_scene_move(scene, objects[77], &box), OCC_SUCCESS);
        commit_and_check(scene);
        last = kit_node_of(scene, objects[77])->level;
        ck_assert_uint_le(last, deepest);
        deepest = last;
    }
    ck_assert_uint_eq(last, 0);
    occ_scene_destroy(scene);
}
END_TEST

START_TEST(moved_object_leaves_its_old_node)
{
    occ_box boxes[COUNT];
    occ_object objects[COUNT];
    kit_random random = {7};
    scattered(&random, boxes);
    occ_scene *scene = new_scene(8);
    ck_assert_int_eq(occ_scene_add_many(scene, boxes, COUNT, objects), OCC_SUCCESS);
    commit_and_check(scene);
    for (uint32_t i = 0; i < COUNT; i += 300) {
        occ_node old = *kit_node_of(scene, objects[i]);
        occ_box box = boxes[i];
        for (int j = 0; j < 3; j++)
            box.center[j] = -box.center[j];
        ck_assert_int_eq(occ_scene_move(scene, objects[i], &box), OCC_SUCCESS);
        commit_and_check(scene);
        const occ_node *node = kit_node_of(scene, objects[i]);
        bool apart = false;
        for (int j = 0; j < 3; j++) {
            ck_assert(node->min[j] <= box.center[j] && box.center[j] <= node->max[j]);
            apart = apart || box.center[j] < old.min[j] || box.center[j] > old.max[j];
        }
        ck_assert(apart);
        ck_assert(node->min[0] != old.min[0] || node->max[0] != old.max[0]);
    }
    occ_scene_destroy(scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("octree");
    TCase *hurt = tcase_create("layouts");
    tcase_add_loop_test(hurt, tree_holds_whatever_the_layout, 0, LAYOUTS);
    tcase_add_loop_test(hurt, nodes_are_the_same_whatever_the_order_of_insertion, 0, LAYOUTS);
    tcase_add_loop_test(hurt, scene_committed_bit_by_bit_equals_one_committed_once, 0, LAYOUTS);
    tcase_add_loop_test(hurt, scene_removed_bit_by_bit_stays_whole, 0, LAYOUTS);
    suite_add_tcase(suite, hurt);
    TCase *many = tcase_create("million");
    tcase_add_test(many, million_identical_boxes_are_one_leaf);
    suite_add_tcase(suite, many);
    TCase *sizes = tcase_create("sizes");
    tcase_add_test(sizes, ground_plane_inflates_no_leaf);
    tcase_add_test(sizes, object_moves_to_the_level_its_new_size_deserves);
    tcase_add_test(sizes, moved_object_leaves_its_old_node);
    suite_add_tcase(suite, sizes);
    return test_run_suite(suite);
}
