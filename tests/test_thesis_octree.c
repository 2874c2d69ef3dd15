// SPDX-License-Identifier: Apache-2.0
// labels: unit
// The four checks that the 2019 thesis made of its octree, restated over identities: which object
// is in which node.
#include "kit_obs.h"
#include "obs.h"
#include "scene_data.h"
#include "scenes.h"
#include "support.h"

#include <stdlib.h>

enum { OBJECTS = 2000 };

static obs_scene file;
static occ_scene *scene;
static occ_object *handles;

static void build(int kind)
{
    static const occ_scene_desc desc = {.leaf_objects = 8};
    ck_assert(scenes_make(scenes_kinds[kind].name, OBJECTS, 4, &file));
    handles = calloc(file.object_count, sizeof *handles);
    ck_assert_ptr_nonnull(handles);
    scene = kit_obs_scene(&file, &desc, handles, NULL);
    ck_assert_uint_gt(scene->object_tree.levels, 2);
}

static void demolish(void)
{
    occ_scene_destroy(scene);
    free(handles);
    obs_free(&file);
}

static const occ_node *node_at(uint32_t index)
{
    if (index >= scene->object_tree.nodes.count) ck_abort_msg("there is no node %u", index);
    return &occ_octree_nodes(&scene->object_tree)[index];
}

static bool same_box(const occ_box *a, const occ_box *b)
{
    bool same = true;
    for (int j = 0; j < 3; j++) {
        same = same && a->center[j] == b->center[j];
        for (int k = 0; k < 3; k++)
            same = same && a->axis[k][j] == b->axis[k][j];
    }
    return same;
}

// The row of the box that was given for an object.
static uint32_t row_of(uint32_t object)
{
    uint32_t slot = occ_object_slot(handles[object]), row = scene->objects.value[slot];
    if (row >= scene->boxes.count || occ_scene_slot_of(scene)[row] != slot)
        ck_abort_msg("object %u has lost its row", object);
    occ_box box = occ_boxes_get(&scene->boxes, row);
    if (!same_box(&box, &file.objects[object]))
        ck_abort_msg("row %u holds another's box than that of object %u", row, object);
    return row;
}

START_TEST(every_object_is_in_exactly_one_node)
{
    build(_i);
    uint32_t *nodes_with = calloc(file.object_count, sizeof *nodes_with);
    ck_assert_ptr_nonnull(nodes_with);
    for (uint32_t n = 0; n < scene->object_tree.nodes.count; n++) {
        const occ_node *node = node_at(n);
        uint32_t own = occ_node_own(&scene->object_tree, node);
        for (uint32_t row = node->first; row < node->first + own; row++) {
            if (row >= file.object_count) ck_abort_msg("node %u has row %u", n, row);
            nodes_with[row]++;
        }
    }
    for (uint32_t i = 0; i < file.object_count; i++)
        if (nodes_with[row_of(i)] != 1)
            ck_abort_msg("object %u is in %u nodes", i, nodes_with[row_of(i)]);
    free(nodes_with);
    demolish();
}
END_TEST

static bool node_holds(const occ_node *node, const occ_box *box)
{
    for (int corner = 0; corner < 8; corner++) {
        for (int j = 0; j < 3; j++) {
            double x = (double)box->center[j];
            for (int k = 0; k < 3; k++)
                x += (corner >> k & 1 ? 1.0 : -1.0) * (double)box->axis[k][j];
            if (x < (double)node->min[j] || x > (double)node->max[j]) return false;
        }
    }
    return true;
}

START_TEST(every_object_is_inside_the_bounds_of_its_node_and_of_all_above)
{
    build(_i);
    for (uint32_t i = 0; i < file.object_count; i++) {
        uint32_t row = row_of(i), above = 0;
        for (uint32_t n = 0; n < scene->object_tree.nodes.count; n++) {
            const occ_node *node = node_at(n);
            if (row - node->first >= node->count) continue;
            above++;
            if (!node_holds(node, &file.objects[i])) ck_abort_msg("object %u, node %u", i, n);
        }
        ck_assert_uint_gt(above, 0);
    }
    demolish();
}
END_TEST

START_TEST(the_counts_of_the_nodes_sum_up)
{
    build(_i);
    uint32_t in_all = 0;
    for (uint32_t n = 0; n < scene->object_tree.nodes.count; n++) {
        const occ_node *node = node_at(n);
        uint32_t own = occ_node_own(&scene->object_tree, node), sum = own;
        for (uint32_t c = 0; c < node->children; c++)
            sum += node_at(node->child + c)->count;
        if (node->count != sum) ck_abort_msg("node %u has %u objects, not %u", n, node->count, sum);
        in_all += own;
    }
    ck_assert_uint_eq(node_at(0)->count, file.object_count);
    ck_assert_uint_eq(in_all, file.object_count);
    demolish();
}
END_TEST

// Level by level, the children of a level are the next one: all of it, in order.
START_TEST(the_levels_are_complete_and_ordered)
{
    build(_i);
    const occ_octree *tree = &scene->object_tree;
    ck_assert_uint_eq(tree->level_first[0], 0);
    ck_assert_uint_eq(tree->level_first[1], 1);
    for (uint32_t level = 0; level < tree->levels; level++) {
        uint32_t next = tree->level_first[level + 1];
        for (uint32_t n = tree->level_first[level]; n < tree->level_first[level + 1]; n++) {
            const occ_node *node = node_at(n);
            ck_assert_msg(!node->children || node->child == next, "node %u", n);
            next += node->children;
            for (uint32_t c = 0; c < node->children; c++)
                if (node_at(node->child + c)->level <= node->level) ck_abort_msg("node %u", n);
        }
        uint32_t end = level + 1 < tree->levels ? tree->level_first[level + 2] : tree->nodes.count;
        ck_assert_uint_eq(next, end);
    }
    ck_assert_uint_eq(tree->level_first[tree->levels], tree->nodes.count);
    demolish();
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("thesis_octree");
    TCase *octree = tcase_create("octree");
    tcase_add_loop_test(octree, every_object_is_in_exactly_one_node, 0, 5);
    tcase_add_loop_test(octree, every_object_is_inside_the_bounds_of_its_node_and_of_all_above, 0,
                        5);
    tcase_add_loop_test(octree, the_counts_of_the_nodes_sum_up, 0, 5);
    tcase_add_loop_test(octree, the_levels_are_complete_and_ordered, 0, 5);
    suite_add_tcase(suite, octree);
    return test_run_suite(suite);
}
