// SPDX-License-Identifier: Apache-2.0
// timeout: 120
// A commit on any number of threads gives the same trees, orders and boxes, bit for bit: at first,
// after edits, and after an allocation that failed.
#include "box.h"
#include "kit_tree.h"
#include "support.h"

#include <math.h>
#include <stdlib.h>

enum {
    OBJECTS = OCC_TEST_SLOWNESS > 1 ? 30000 : 70000, // enough for several parts
    OCCLUDERS = OBJECTS / 2,
    SCENES = 4
};

static const uint32_t threads_of[SCENES] = {1, 2, 3, 8};

// The same scene, committed on as many threads.
static struct {
    kit_heap heap;
    occ_scene *scene;
    occ_object *objects;
    occ_occluder *occluders;
} made[SCENES];
static occ_box *boxes;

// Some cells are full of boxes that coincide, some boxes are huge, most are scattered.
static occ_box random_box(kit_random *random)
{
    switch (kit_below(random, 6)) {
    case 0:
        return kit_cube((float)kit_below(random, 4) * 9, 1, 2, 0.25f);
    case 1:
        return kit_box(random, 1000, ldexpf(1, (int)kit_below(random, 12) - 2));
    case 2:
        return kit_cube(500, kit_between(random, 0, 1), 500, 0.01f);
    default:
        return kit_box(random, 1000, 1);
    }
}

// Some occluders are nobody's, some objects own several.
static void add_all(int s)
{
    static occ_object owners[OCCLUDERS];
    KIT_CHECK(!occ_scene_add_many(made[s].scene, boxes, OBJECTS, made[s].objects), "refused");
    for (uint32_t i = 0; i < OCCLUDERS; i++) {
        owners[i] = made[s].objects[i % 5 ? i : OBJECTS - 1 - i / 100];
        if (i % 3 == 2) owners[i] = (occ_object){0, 0};
    }
    KIT_CHECK(!occ_scene_add_occluders(made[s].scene, boxes, owners, OCCLUDERS, made[s].occluders),
              "refused");
}

static void set_up(void)
{
    boxes = calloc(OBJECTS, sizeof *boxes);
    ck_assert_ptr_nonnull(boxes);
    kit_random random = {42};
    for (uint32_t i = 0; i < OBJECTS; i++)
        boxes[i] = random_box(&random);
    boxes[OBJECTS - 1] = kit_cube(1100, -1150, 1200, 1); // the farthest, in the last part
    for (int s = 0; s < SCENES; s++) {
        made[s].objects = calloc(OBJECTS, sizeof(occ_object));
        made[s].occluders = calloc(OCCLUDERS, sizeof(occ_occluder));
        ck_assert(made[s].objects && made[s].occluders);
        occ_scene_desc desc = {
            .allocator = kit_allocator(&made[s].heap), .threads = threads_of[s], .leaf_objects = 8};
        ck_assert_int_eq(occ_scene_create(&desc, &made[s].scene), OCC_SUCCESS);
        add_all(s);
    }
}

static void tear_down(void)
{
    for (int s = 0; s < SCENES; s++) {
        occ_scene_destroy(made[s].scene);
        ck_assert_uint_eq(made[s].heap.blocks, 0);
        free(made[s].objects);
        free(made[s].occluders);
    }
    free(boxes);
}

static void commit_and_compare(void)
{
    for (int s = 0; s < SCENES; s++)
        ck_assert_int_eq(occ_scene_commit(made[s].scene), OCC_SUCCESS);
    for (int s = 1; s < SCENES; s++)
        kit_check_same_scene(made[0].scene, made[s].scene);
}

// Moves every so-manieth object and occluder by `distance`.
static void move_some(uint32_t every, float distance)
{
    for (int s = 0; s < SCENES; s++)
        for (uint32_t i = 0; i < OCCLUDERS; i += every) {
            occ_box box = boxes[i];
            box.center[0] += distance;
            KIT_CHECK(!occ_scene_move(made[s].scene, made[s].objects[i], &box), "refused");
            KIT_CHECK(!occ_scene_move_occluder(made[s].scene, made[s].occluders[i], &box),
                      "refused");
        }
}

// Removes every so-manieth object, with what it owns, and lets another take its place.
static void replace_some(uint32_t every, bool with_another)
{
    for (int s = 0; s < SCENES; s++)
        for (uint32_t i = 1; i < OBJECTS; i += every) {
            occ_box box = boxes[OBJECTS - i];
            KIT_CHECK(!occ_scene_remove(made[s].scene, made[s].objects[i]), "refused");
            if (with_another) {
                KIT_CHECK(!occ_scene_add(made[s].scene, &box, &made[s].objects[i]), "refused");
            }
        }
}

START_TEST(thread_count_does_not_show)
{
    commit_and_compare();
    ck_assert_uint_gt(made[0].scene->object_tree.nodes.count, 1000);
    ck_assert_uint_gt(made[0].scene->attached_count, OCCLUDERS / 2);
    ck_assert_uint_gt(made[0].scene->occluder_tree.nodes.count, 1000);
    kit_check_trees(made[3].scene);
    move_some(2000, 2e-3f); // within the cells: no sorting
    ck_assert(!made[1].scene->objects_reordered);
    commit_and_compare();
    kit_check_trees(made[3].scene);
    move_some(100, 300.0f);
    commit_and_compare();
    replace_some(1000, true);
    commit_and_compare();
    kit_check_trees(made[1].scene);
    replace_some(3, false);
    commit_and_compare();
    kit_check_trees(made[2].scene);
}
END_TEST

// The root cube is the least that its rules allow: worked out here from all boxes in one go.
START_TEST(root_cube_holds_the_middle_of_every_object)
{
    ck_assert_int_eq(occ_scene_commit(made[_i].scene), OCC_SUCCESS);
    const occ_root *root = &made[_i].scene->object_tree.root;
    double extent = 0.0;
    for (int j = 0; j < 3; j++) {
        double low = INFINITY, high = -INFINITY, step = root->size / 8.0;
        for (uint32_t i = 0; i < OBJECTS; i++) {
            float min[3], max[3];
            occ_box_bounds(&boxes[i], min, max);
            low = fmin(low, 0.5 * ((double)min[j] + (double)max[j]));
            high = fmax(high, 0.5 * ((double)min[j] + (double)max[j]));
        }
        ck_assert(root->origin[j] <= low && low < root->origin[j] + step);
        ck_assert(high <= root->origin[j] + root->size);
        extent = fmax(extent, high - low);
    }
    ck_assert(root->size / 2.0 <= extent * 8.0 / 7.0 && extent * 8.0 / 7.0 < root->size);
}
END_TEST

START_TEST(failed_commit_on_threads_can_be_tried_again)
{
    ck_assert_int_eq(occ_scene_commit(made[0].scene), OCC_SUCCESS);
    kit_heap *heap = &made[1].heap;
    occ_result result = OCC_ERROR_OUT_OF_MEMORY;
    uint32_t failures = 0;
    for (uint64_t n = 1; result; n += n) { // each try gets further
        heap->fail_at = heap->calls + n;
        result = occ_scene_commit(made[1].scene);
        if (!result) break;
        ck_assert_int_eq(result, OCC_ERROR_OUT_OF_MEMORY);
        ck_assert_int_eq(occ_scene_validate(made[1].scene), OCC_ERROR_NOT_COMMITTED);
        failures++;
    }
    ck_assert_uint_gt(failures, 3);
    kit_check_same_scene(made[0].scene, made[1].scene);
    kit_check_trees(made[1].scene);
    ck_assert_uint_eq(made[0].heap.bytes, made[1].heap.bytes);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("commit_threads");
    TCase *threads = tcase_create("threads");
    tcase_add_checked_fixture(threads, set_up, tear_down);
    tcase_add_test(threads, thread_count_does_not_show);
    tcase_add_loop_test(threads, root_cube_holds_the_middle_of_every_object, 0, SCENES);
    tcase_add_test(threads, failed_commit_on_threads_can_be_tried_again);
    suite_add_tcase(suite, threads);
    return test_run_suite(suite);
}
