// SPDX-License-Identifier: Apache-2.0
#include "kit_faults.h"

#include "kit_sheets.h"
#include "kit_tree.h"

#include <stdlib.h>
#include <string.h>

enum { OBJECTS = 150, MASK_WORDS = 16, CULLS = 3, FRAMES = 60 };

// One run of the script.
typedef struct run {
    kit_heap heap;
    kit_log record;
    occ_scene *scene;
    occ_view *view;
    occ_backend backend;
    occ_object objects[OBJECTS];
    occ_occluder occluders[OBJECTS], nobodys[OBJECTS];
    uint32_t masks[CULLS][MASK_WORDS];
    uint32_t culls;
    unsigned refusals;
} run;

// What to do with a call's result: 1 if it must be made again.
static int again(run *r, occ_result result, uint64_t failures, const char *call)
{
    if (result == OCC_SUCCESS) return 0; // what failed was dispensable
    KIT_CHECK(result == OCC_ERROR_OUT_OF_MEMORY, "%s: %s", call, occ_result_name(result));
    KIT_CHECK(r->heap.failures > failures, "%s fails, though no allocation did", call);
    KIT_CHECK(r->record.errors && kit_logged(&r->record, "OCC_ERROR_OUT_OF_MEMORY"),
              "%s fails in silence: %s", call, r->record.text);
    if (r->scene) (void)occ_scene_slot_count(r->scene);
    kit_forget(&r->record);
    r->heap.fail_at = 0; // the shortage is over
    r->refusals++;
    return 1;
}

// Makes a call until it succeeds: the second time it must.
#define TRY(r, call)                                                                               \
    do {                                                                                           \
        uint64_t failures_before = (r)->heap.failures;                                             \
        if (!again((r), (call), failures_before, #call)) break;                                    \
        occ_result retried = (call);                                                               \
        KIT_CHECK(retried == OCC_SUCCESS, "%s, made again: %s", #call, occ_result_name(retried));  \
    } while (0)

static void create_scene(run *r)
{
    occ_scene_desc desc = {.allocator = kit_allocator(&r->heap),
                           .logger = kit_logger(&r->record),
                           .object_count = 10,
                           .occluder_count = 5,
                           .leaf_objects = 4};
    uint64_t blocks = r->heap.blocks;
    occ_result result = occ_scene_create(&desc, &r->scene);
    if (result) KIT_CHECK(!r->scene && r->heap.blocks == blocks, "a scene half made is left");
    if (again(r, result, 0, "occ_scene_create")) TRY(r, occ_scene_create(&desc, &r->scene));
}

static void create_view(run *r)
{
    occ_view_desc desc = {.allocator = kit_allocator(&r->heap),
                          .logger = kit_logger(&r->record),
                          .backend = r->backend,
                          .threads = 2};
    uint64_t blocks = r->heap.blocks, failures = r->heap.failures;
    occ_result result = occ_view_create(&desc, &r->view);
    if (result) KIT_CHECK(!r->view && r->heap.blocks == blocks, "a view half made is left");
    if (again(r, result, failures, "occ_view_create")) TRY(r, occ_view_create(&desc, &r->view));
}

static void commit(run *r)
{
    TRY(r, occ_scene_commit(r->scene));
    kit_check_trees(r->scene);
}

static void cull(run *r)
{
    occ_camera_desc camera = kit_path(r->culls);
    occ_cull_desc knobs = {.min_area = 1e-30f, .grain = 4};
    TRY(r, occ_cull(r->view, r->scene, &camera, &knobs));
    size_t count;
    KIT_CHECK(!occ_view_read_mask(r->view, r->masks[r->culls++], MASK_WORDS, &count), "no mask");
}

static void move_some(run *r, float by, uint32_t step)
{
    occ_box boxes[OBJECTS];
    occ_object moved[OBJECTS];
    uint32_t count = 0;
    for (uint32_t i = 0; i < OBJECTS; i += step) {
        if (occ_scene_box(r->scene, r->objects[i], &boxes[count])) continue;
        boxes[count].center[0] += by;
        moved[count++] = r->objects[i];
    }
    TRY(r, occ_scene_move_many(r->scene, moved, boxes, count));
}

static void add_sheets(run *r, const occ_box *boxes)
{
    occ_sheet sheets[30];
    for (int i = 0; i < 30; i++)
        sheets[i] = kit_sheet_of_box(&boxes[i]);
    TRY(r, occ_scene_add_sheets(r->scene, sheets, r->objects, 30, NULL));
}

static void run_script(run *r)
{
    kit_random random = {5};
    occ_box boxes[OBJECTS];
    for (int i = 0; i < OBJECTS; i++)
        boxes[i] = kit_box(&random, 40, 4);
    create_scene(r);
    for (int i = 0; i < 20; i++)
        TRY(r, occ_scene_add(r->scene, &boxes[i], &r->objects[i]));
    TRY(r, occ_scene_add_occluders(r->scene, boxes, r->objects, 20, r->occluders));
    commit(r);
    TRY(r, occ_scene_add_many(r->scene, boxes + 20, OBJECTS - 20, r->objects + 20));
    create_view(r);
    commit(r);
    cull(r);
    move_some(r, 0.0005f, 3); // within their cells
    TRY(r, occ_scene_add_occluders(r->scene, boxes, NULL, 80, r->nobodys));
    add_sheets(r, boxes);
    commit(r);
    cull(r);
    TRY(r, occ_scene_remove(r->scene, r->objects[3]));
    TRY(r, occ_scene_remove(r->scene, r->objects[77]));
    TRY(r, occ_scene_move_occluder(r->scene, r->occluders[5], &boxes[99]));
    TRY(r, occ_scene_remove_occluder(r->scene, r->occluders[6]));
    TRY(r, occ_scene_add_occluder(r->scene, &boxes[4], r->objects[4], NULL)); // its second
    TRY(r, occ_scene_move_occluder(r->scene, r->nobodys[1], &boxes[98]));
    TRY(r, occ_scene_remove_occluder(r->scene, r->nobodys[2]));
    occ_sheet sheet = kit_sheet_of_box(&boxes[7]);
    TRY(r, occ_scene_move_sheet(r->scene, r->nobodys[3], &sheet)); // a box until now
    move_some(r, 11.0f, 7);
    commit(r);
    cull(r);
}

static void end_run(run *r)
{
    occ_view_destroy(r->view);
    occ_scene_destroy(r->scene);
    KIT_CHECK(r->heap.blocks == 0 && r->heap.bytes == 0, "%llu blocks are lost",
              (unsigned long long)r->heap.blocks);
}

// Runs the script with one more allocation going well each time, until all do.
void kit_fail_every_allocation(occ_backend backend, bool keeps_failing, uint64_t step)
{
    run *expected = calloc(1, sizeof *expected), *r = calloc(1, sizeof *r);
    ck_assert(expected && r);
    r->backend = backend;
    run_script(r);
    ck_assert_uint_eq(r->refusals, 0);
    uint64_t calls = r->heap.calls;
    ck_assert_uint_gt(calls, 40);
    end_run(r);
    expected->backend = OCC_BACKEND_PLAIN;
    run_script(expected);
    end_run(expected);
    ck_assert_mem_eq(r->masks, expected->masks, sizeof r->masks);
    unsigned refusals = 0;
    for (uint64_t n = 1; n <= calls; n += step) {
        memset(r, 0, sizeof *r);
        r->backend = backend;
        r->heap.fail_at = n;
        r->heap.keeps_failing = keeps_failing;
        run_script(r);
        KIT_CHECK(r->heap.failures > 0, "allocation %llu was not made", (unsigned long long)n);
        KIT_CHECK(!memcmp(r->masks, expected->masks, sizeof r->masks),
                  "another mask after allocation %llu failed", (unsigned long long)n);
        end_run(r);
        refusals += r->refusals;
    }
    ck_assert_uint_gt(refusals, calls / step / 2);
    free(expected);
    free(r);
}

// --- frames after the first ----------------------------------------------------------------------

static uint64_t scene_bytes(const run *r)
{
    occ_scene_stats stats;
    ck_assert_int_eq(occ_scene_get_stats(r->scene, &stats), OCC_SUCCESS);
    return stats.bytes;
}

void kit_frames_allocate_nothing(occ_backend backend)
{
    static const occ_method methods[] = {OCC_METHOD_SINGLE, OCC_METHOD_FRUSTUM,
                                         OCC_METHOD_PAIRWISE};
    run *r = calloc(1, sizeof *r);
    ck_assert_ptr_nonnull(r);
    r->backend = backend;
    create_scene(r);
    create_view(r);
    kit_fill(r->scene, 3000, 10, 8, NULL, NULL);
    ck_assert_int_eq(occ_scene_commit(r->scene), OCC_SUCCESS);
    for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
        occ_cull_desc knobs = {.method = methods[m]};
        uint64_t calls = 0;
        for (uint32_t f = 0; f < 2 * FRAMES; f++) {
            if (f == FRAMES) calls = r->heap.calls;
            occ_camera_desc camera = kit_path(f % FRAMES);
            kit_cull(r->view, r->scene, &camera, &knobs);
        }
        KIT_CHECK(r->heap.calls == calls, "%llu allocations",
                  (unsigned long long)(r->heap.calls - calls));
        occ_view_stats stats;
        ck_assert_int_eq(occ_view_get_stats(r->view, &stats), OCC_SUCCESS);
        ck_assert_uint_gt(stats.visible, 0);
        ck_assert_uint_eq(stats.bytes + scene_bytes(r), r->heap.bytes);
    }
    end_run(r);
    free(r);
}
