// SPDX-License-Identifier: Apache-2.0
// labels: opencl
// What travels to the device: all boxes once, then only the rows that commits have changed; and the
// mask is OpenMP's all the while.
#include "kit_cl.h"
#include "kit_tree.h"
#include "support.h"

#include <stdlib.h>
#include <string.h>

enum { OBJECTS = 4000 };

static occ_scene *scene;
static occ_view *device, *host;
static occ_object objects[OBJECTS];
static occ_occluder occluders[OBJECTS];

static void set_up(void)
{
    kit_cl_reset();
    ck_assert_int_eq(occ_scene_create(NULL, &scene), OCC_SUCCESS);
    kit_fill(scene, OBJECTS, 8, 5, objects, occluders);
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
    occ_view_desc desc = {.backend = OCC_BACKEND_OPENCL};
    ck_assert_int_eq(occ_view_create(&desc, &device), OCC_SUCCESS);
    desc.backend = OCC_BACKEND_OPENMP;
    ck_assert_int_eq(occ_view_create(&desc, &host), OCC_SUCCESS);
}

static void tear_down(void)
{
    occ_view_destroy(device);
    occ_view_destroy(host);
    occ_scene_destroy(scene);
    ck_assert_int_eq(kit_cl_state.live, 0);
}

// One frame; kit_cl_state tells what it sent.
static void frame(uint32_t i)
{
    occ_camera_desc camera = kit_path(i);
    kit_cl_reset();
    kit_cull(device, scene, &camera, NULL);
    kit_cull(host, scene, &camera, NULL);
    KIT_CHECK(kit_same_masks(device, host), "the device's mask is another");
    KIT_CHECK(kit_cl_state.in_flight == 0, "%u commands are under way", kit_cl_state.in_flight);
}

static uint64_t table_bytes(const occ_scene *of)
{
    return (uint64_t)of->boxes.stride * OCC_BOX_COLUMNS * sizeof(float);
}

// Whether the frame has sent the whole table: nothing else is as large.
static bool sent_all(void)
{
    return kit_cl_state.whole_bytes >= table_bytes(scene);
}

static void commit(void)
{
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
}

// Moves an object within its cell, as small edits mostly do.
static void nudge(uint32_t i)
{
    occ_box box;
    ck_assert_int_eq(occ_scene_box(scene, objects[i], &box), OCC_SUCCESS);
    box.axis[1][1] *= 0.999f;
    ck_assert_int_eq(occ_scene_move(scene, objects[i], &box), OCC_SUCCESS);
}

static uint32_t row_of(uint32_t i)
{
    return scene->objects.value[occ_object_slot(objects[i])];
}

// How many runs of 1 there are.
static unsigned runs_of(const unsigned char *rows)
{
    unsigned runs = 0;
    for (uint32_t row = 0; row < OBJECTS; row++)
        runs += rows[row] && (row == 0 || !rows[row - 1]);
    return runs;
}

// Which rows the frame has sent, as 0 or 1 each.
static void rows_sent(unsigned char *sent)
{
    memset(sent, 0, OBJECTS);
    KIT_CHECK(kit_cl_state.rows < KIT_CL_SENDS, "too many sends to note");
    for (unsigned s = 0; s < kit_cl_state.rows; s++) {
        const kit_cl_send *send = &kit_cl_state.row[s];
        KIT_CHECK(send->region[1] == OCC_BOX_COLUMNS && send->region[2] == 1, "not all columns");
        size_t first = send->origin[0] / sizeof(float), count = send->region[0] / sizeof(float);
        KIT_CHECK(first + count <= OBJECTS && count > 0, "rows beyond the table");
        for (size_t row = first; row < first + count; row++) {
            KIT_CHECK(!sent[row], "row %zu travels twice", row);
            sent[row] = 1;
        }
    }
}

START_TEST(small_moves_send_only_the_rows_around_them)
{
    unsigned char sent[OBJECTS], wanted[OBJECTS];
    kit_random random = {9};
    frame(0);
    ck_assert(sent_all());
    for (uint32_t round = 1; round < 12; round++) {
        memset(wanted, 0, sizeof wanted);
        for (uint32_t k = 0; k < round; k++) {
            uint32_t i = kit_below(&random, OBJECTS), block;
            nudge(i);
            block = row_of(i) / OCC_CHANGE_ROWS * OCC_CHANGE_ROWS;
            for (uint32_t row = block; row < block + OCC_CHANGE_ROWS && row < OBJECTS; row++)
                wanted[row] = 1;
        }
        ck_assert(!scene->objects_reordered); // else the test has moved too far
        if (round % 2) {                      // the occluders' order is no matter of the rows
            ck_assert_int_eq(occ_scene_remove_occluder(scene, occluders[round]), OCC_SUCCESS);
        }
        commit();
        frame(round);
        rows_sent(sent);
        ck_assert_mem_eq(sent, wanted, sizeof sent);
        ck_assert_uint_eq(kit_cl_state.rows, runs_of(wanted)); // neighbours travel together
        ck_assert_uint_lt(kit_cl_state.whole_bytes, table_bytes(scene));
    }
}
END_TEST

START_TEST(frame_without_edits_sends_no_boxes)
{
    frame(0);
    frame(1);
    ck_assert_uint_eq(kit_cl_state.rows, 0);
    ck_assert(!sent_all());
}
END_TEST

START_TEST(moved_occluders_send_no_boxes)
{
    frame(0);
    for (uint32_t i = 0; i < 20; i++) {
        occ_box box = kit_cube((float)i, 2, -3, 1.5f);
        ck_assert_int_eq(occ_scene_move_occluder(scene, occluders[i], &box), OCC_SUCCESS);
    }
    commit();
    frame(0);
    ck_assert_uint_eq(kit_cl_state.rows, 0);
    ck_assert(!sent_all());
}
END_TEST

START_TEST(another_order_sends_the_table)
{
    frame(0);
    ck_assert_int_eq(occ_scene_remove(scene, objects[17]), OCC_SUCCESS);
    commit();
    frame(1);
    ck_assert(sent_all());
    ck_assert_uint_eq(kit_cl_state.rows, 0);
    frame(2);
    ck_assert(!sent_all());
}
END_TEST

START_TEST(view_that_missed_a_commit_catches_up)
{
    frame(0);
    nudge(100);
    commit();
    nudge(3000);
    commit(); // what the first one changed is forgotten by now
    frame(1);
    nudge(200);
    commit();
    frame(2);
    ck_assert(!sent_all());
    ck_assert_uint_eq(kit_cl_state.rows, 1);
}
END_TEST

START_TEST(every_view_gets_every_change)
{
    occ_view *other;
    occ_view_desc desc = {.backend = OCC_BACKEND_OPENCL};
    ck_assert_int_eq(occ_view_create(&desc, &other), OCC_SUCCESS);
    for (uint32_t round = 0; round < 9; round++) {
        for (uint32_t i = round; i < OBJECTS; i += 500) {
            occ_box box;
            ck_assert_int_eq(occ_scene_box(scene, objects[i], &box), OCC_SUCCESS);
            box.center[1] += round % 3 == 2 ? 30.0f : 0.0f;
            box.axis[1][1] *= 0.999f;
            ck_assert_int_eq(occ_scene_move(scene, objects[i], &box), OCC_SUCCESS);
        }
        commit();
        frame(round);
        if (round % 4 == 1) continue; // the other view misses one now and then
        occ_camera_desc camera = kit_path(round);
        kit_cull(other, scene, &camera, NULL);
        ck_assert(kit_same_masks(other, host));
    }
    occ_view_destroy(other);
}
END_TEST

START_TEST(frame_after_warm_up_makes_no_buffer)
{
    occ_view_stats before, after;
    for (uint32_t i = 0; i < 12; i++)
        frame(i);
    ck_assert_int_eq(occ_view_get_stats(device, &before), OCC_SUCCESS);
    ck_assert_uint_ge(before.device_bytes, table_bytes(scene));
    for (uint32_t i = 0; i < 12; i++) {
        frame(i);
        ck_assert_uint_eq(kit_cl_state.created, 0);
    }
    ck_assert_int_eq(occ_view_get_stats(device, &after), OCC_SUCCESS);
    ck_assert_uint_eq(after.device_bytes, before.device_bytes);
}
END_TEST

START_TEST(device_bytes_are_those_of_the_buffers)
{
    occ_scene *mine = scene;
    for (uint32_t count = 50; count < 12000; count *= 3) { // the buffers grow
        ck_assert_int_eq(occ_scene_create(NULL, &scene), OCC_SUCCESS);
        kit_fill(scene, count, 4, count, NULL, NULL);
        commit();
        for (uint32_t i = 0; i < 4; i++) {
            occ_view_stats stats;
            frame(i);
            ck_assert_int_eq(occ_view_get_stats(device, &stats), OCC_SUCCESS);
            ck_assert_uint_gt(stats.device_bytes, table_bytes(scene));
            ck_assert_uint_eq(stats.device_bytes, kit_cl_state.buffer_bytes);
        }
        occ_scene_destroy(scene);
    }
    scene = mine;
}
END_TEST

START_TEST(nothing_is_under_way_after_a_frame_that_looks_away)
{
    // The first frame sends the table, but no object is left to test.
    static const float eye[3] = {0, 500, 0}, up[3] = {1, 900, 0};
    occ_camera_desc camera = kit_look(eye, up);
    kit_cl_reset();
    kit_cull(device, scene, &camera, NULL);
    occ_view_stats stats;
    ck_assert_int_eq(occ_view_get_stats(device, &stats), OCC_SUCCESS);
    ck_assert_uint_eq(stats.ranges, 0);
    ck_assert_uint_eq(kit_cl_state.in_flight, 0);
    frame(0);
}
END_TEST

START_TEST(empty_scene_is_no_trouble)
{
    occ_scene *full = scene;
    ck_assert_int_eq(occ_scene_create(NULL, &scene), OCC_SUCCESS);
    commit();
    frame(0);
    ck_assert_int_eq(occ_scene_add(scene, &(occ_box){{0, 1, 0}, {{1, 0, 0}}}, objects),
                     OCC_SUCCESS);
    commit();
    frame(0);
    frame(1);
    occ_scene_destroy(scene);
    scene = full;
    frame(2);
}
END_TEST

// --- scenes that come and go ---------------------------------------------------------------------

START_TEST(views_of_two_scenes_in_turn_see_each)
{
    occ_scene *first = scene, *second;
    ck_assert_int_eq(occ_scene_create(NULL, &second), OCC_SUCCESS);
    kit_fill(second, OBJECTS, 8, 77, NULL, NULL);
    ck_assert_int_eq(occ_scene_commit(second), OCC_SUCCESS);
    for (uint32_t i = 0; i < 6; i++) {
        scene = i % 2 ? second : first;
        frame(i);
        ck_assert(sent_all());
    }
    scene = first;
    occ_scene_destroy(second);
}
END_TEST

// Gives out the same addresses for the same sequence of sizes.
typedef struct arena {
    char *memory;
    size_t used, size;
} arena;

static void *arena_alloc(size_t size, size_t alignment, void *user_data)
{
    arena *a = user_data;
    size_t begin = (a->used + alignment - 1) / alignment * alignment;
    if (size > a->size - begin) return NULL;
    a->used = begin + size;
    return a->memory + begin;
}

static void arena_free(void *pointer, size_t size, void *user_data)
{
    (void)pointer;
    (void)size;
    (void)user_data;
}

START_TEST(scene_at_the_address_of_a_dead_one_is_another_scene)
{
    occ_scene *mine = scene, *dead = NULL;
    arena a = {aligned_alloc(64, (size_t)1 << 24), 0, (size_t)1 << 24};
    ck_assert_ptr_nonnull(a.memory);
    occ_scene_desc desc = {.allocator = {arena_alloc, arena_free, &a}, .object_count = OBJECTS};
    for (uint64_t seed = 1; seed < 5; seed++) {
        a.used = 0;
        ck_assert_int_eq(occ_scene_create(&desc, &scene), OCC_SUCCESS);
        ck_assert(!dead || dead == scene);
        kit_fill(scene, OBJECTS, 8, seed, NULL, NULL);
        commit();
        frame(0);
        dead = scene;
        occ_scene_destroy(scene);
    }
    free(a.memory);
    scene = mine;
}
END_TEST

int main(void)
{
    int skipped = test_skip_without_device();
    if (skipped) return skipped;
    Suite *suite = suite_create("cl_upload");
    TCase *rows = tcase_create("rows");
    tcase_add_checked_fixture(rows, set_up, tear_down);
    tcase_add_test(rows, small_moves_send_only_the_rows_around_them);
    tcase_add_test(rows, frame_without_edits_sends_no_boxes);
    tcase_add_test(rows, moved_occluders_send_no_boxes);
    tcase_add_test(rows, another_order_sends_the_table);
    tcase_add_test(rows, view_that_missed_a_commit_catches_up);
    tcase_add_test(rows, every_view_gets_every_change);
    suite_add_tcase(suite, rows);
    TCase *frames = tcase_create("frames");
    tcase_add_checked_fixture(frames, set_up, tear_down);
    tcase_add_test(frames, frame_after_warm_up_makes_no_buffer);
    tcase_add_test(frames, device_bytes_are_those_of_the_buffers);
    tcase_add_test(frames, nothing_is_under_way_after_a_frame_that_looks_away);
    tcase_add_test(frames, empty_scene_is_no_trouble);
    suite_add_tcase(suite, frames);
    TCase *scenes = tcase_create("scenes");
    tcase_add_checked_fixture(scenes, set_up, tear_down);
    tcase_add_test(scenes, views_of_two_scenes_in_turn_see_each);
    tcase_add_test(scenes, scene_at_the_address_of_a_dead_one_is_another_scene);
    suite_add_tcase(suite, scenes);
    return test_run_suite(suite);
}
