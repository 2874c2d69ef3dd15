// SPDX-License-Identifier: Apache-2.0
#include "kit_crew.h"

#include "box.h"
#include "scene_data.h"

#include <check.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *name;
    occ_view_desc desc;
} members[KIT_CREW_MOST] = {{"plain C", {.backend = OCC_BACKEND_PLAIN}},
                            {"OpenMP, 1 thread", {.backend = OCC_BACKEND_OPENMP, .threads = 1}},
                            {"OpenMP, 2 threads", {.backend = OCC_BACKEND_OPENMP, .threads = 2}},
                            {"OpenMP, 3 threads", {.backend = OCC_BACKEND_OPENMP, .threads = 3}},
                            {"OpenMP, 8 threads", {.backend = OCC_BACKEND_OPENMP, .threads = 8}},
                            {"OpenCL", {.backend = OCC_BACKEND_OPENCL}}};

static bool may_be_absent(const occ_view_desc *desc, occ_result result)
{
    if (desc->backend != OCC_BACKEND_OPENCL) return false;
    if (result == OCC_ERROR_UNSUPPORTED) return true; // a build without OpenCL
    return result == OCC_ERROR_NO_DEVICE && !getenv("CI") && !getenv("OCC_REQUIRE_OPENCL");
}

void kit_crew_gather(kit_crew *crew)
{
    for (crew->size = 0; crew->size < KIT_CREW_MOST; crew->size++) {
        const occ_view_desc *desc = &members[crew->size].desc;
        crew->name[crew->size] = members[crew->size].name;
        occ_result result = occ_view_create(desc, &crew->view[crew->size]);
        if (may_be_absent(desc, result)) return;
        ck_assert_msg(result == OCC_SUCCESS, "%s: %s", crew->name[crew->size],
                      occ_result_name(result));
    }
}

void kit_crew_dismiss(kit_crew *crew)
{
    for (unsigned i = 0; i < crew->size; i++)
        occ_view_destroy(crew->view[i]);
    crew->size = 0;
}

occ_view_stats kit_stats(const occ_view *view)
{
    occ_view_stats stats;
    ck_assert_int_eq(occ_view_get_stats(view, &stats), OCC_SUCCESS);
    return stats;
}

// Everything but times and bytes.
static bool same_counts(const occ_view_stats *a, const occ_view_stats *b)
{
    return a->objects == b->objects && a->walk_outside == b->walk_outside &&
           a->walk_hidden == b->walk_hidden && a->tested == b->tested &&
           a->test_outside == b->test_outside && a->test_hidden == b->test_hidden &&
           a->visible == b->visible && a->nodes_tested == b->nodes_tested &&
           a->occluders_tested == b->occluders_tested && a->occluders_used == b->occluders_used &&
           a->ranges == b->ranges;
}

void kit_same_answers(const occ_view *a, const occ_view *b, const char *who)
{
    occ_view_stats counts[2] = {kit_stats(a), kit_stats(b)};
    ck_assert_msg(kit_same_masks(a, b), "%s: another mask", who);
    ck_assert_msg(same_counts(&counts[0], &counts[1]), "%s: other counts", who);
}

uint32_t *kit_crew_cull(kit_crew *crew, const occ_scene *scene, const occ_camera_desc *camera,
                        const occ_cull_desc *knobs)
{
    for (unsigned i = 0; i < crew->size; i++) {
        kit_cull(crew->view[i], scene, camera, knobs);
        kit_same_answers(crew->view[0], crew->view[i], crew->name[i]);
    }
    return kit_mask(crew->view[0], NULL);
}

bool kit_same_words(const uint32_t *a, const uint32_t *b, uint32_t slots)
{
    return !memcmp(a, b, OCC_MASK_WORDS(slots) * sizeof *a);
}

// --- moves ---------------------------------------------------------------------------------------

static occ_box box_of(const occ_scene *scene, occ_object object)
{
    occ_box box;
    ck_assert_int_eq(occ_scene_box(scene, object, &box), OCC_SUCCESS);
    return box;
}

static uint64_t key_of(const occ_scene *scene, const occ_box *box)
{
    float min[3], max[3];
    occ_box_bounds(box, min, max);
    return occ_octree_key(&scene->object_tree.root, min, max);
}

typedef struct extent {
    float low[3], high[3];
} extent;

static extent extent_of(const occ_scene *scene, const occ_object *objects, uint32_t count)
{
    extent e = {{0}, {0}};
    for (uint32_t i = 0; i < count; i++) {
        occ_box box = box_of(scene, objects[i]);
        for (int j = 0; j < 3; j++) {
            if (!i || box.center[j] < e.low[j]) e.low[j] = box.center[j];
            if (!i || box.center[j] > e.high[j]) e.high[j] = box.center[j];
        }
    }
    return e;
}

// The outermost objects stay where they are, and with them the octree's root.
static bool is_inner(const extent *e, const occ_box *box)
{
    for (int j = 0; j < 3; j++)
        if (box->center[j] <= e->low[j] || box->center[j] >= e->high[j]) return false;
    return true;
}

// Moves a box as far as it can easily go and still keep its key. False: nowhere was found.
static bool move_box(const occ_scene *scene, const extent *all, occ_box *box, kit_random *random)
{
    for (int power = 3; power > 0; power--) {
        float reach = ldexpf(1, power);
        occ_box moved = *box;
        for (int j = 0; j < 3; j++)
            moved.center[j] += kit_between(random, -reach, reach);
        if (!is_inner(all, box) || !is_inner(all, &moved)) continue;
        if (key_of(scene, &moved) != key_of(scene, box)) continue;
        *box = moved;
        return true;
    }
    return false;
}

uint32_t kit_move_within_cells(occ_scene *scene, const occ_object *objects, uint32_t count,
                               kit_random *random)
{
    extent all = extent_of(scene, objects, count);
    uint32_t moved = 0;
    for (uint32_t i = 0; i < count; i += 3) {
        occ_box box = box_of(scene, objects[i]);
        if (!move_box(scene, &all, &box, random)) continue;
        ck_assert_int_eq(occ_scene_move(scene, objects[i], &box), OCC_SUCCESS);
        moved++;
    }
    return moved;
}
