// SPDX-License-Identifier: Apache-2.0
#include "hard.h"

#include "oracle.h"

#include <math.h>
#include <string.h>

void hard_object(hard *h, occ_box box, hard_fate expected)
{
    ck_assert_uint_lt(h->object_count, HARD_OBJECTS);
    h->objects[h->object_count] = box;
    h->fates[h->object_count++] = expected;
}

void hard_occluder(hard *h, occ_box box, int owner)
{
    ck_assert_uint_lt(h->occluder_count, HARD_OCCLUDERS);
    h->occluders[h->occluder_count++] = (world_occluder){box, owner};
}

// From the eye along -z.
void hard_look(hard *h, float x, float y, float z, const world_lens *lens)
{
    const float eye[3] = {x, y, z}, target[3] = {x, y, z - 1};
    h->camera = world_camera(eye, target, lens);
    const double exact[3] = {(double)x, (double)y, (double)z};
    memcpy(h->eye, exact, sizeof exact);
    h->camera.eye = h->eye;
}

occ_box hard_brick(float x, float y, float z, float a, float b, float c)
{
    return (occ_box){{x, y, z}, {{a, 0, 0}, {0, b, 0}, {0, 0, c}}};
}

// A wall and what is behind, beside and before it, all times `s`.
void hard_wall(hard *h, float s, const world_lens *lens)
{
    world_lens scaled = lens ? *lens : (world_lens){.projection = WORLD_PERSPECTIVE};
    scaled.near_z = 0.1f * s;
    scaled.far_z = 1000 * s;
    scaled.height = scaled.projection == WORLD_ORTHOGRAPHIC ? 20 * s : 0.0f;
    hard_look(h, 0, 0, 0, &scaled);
    hard_occluder(h, hard_brick(0, 0, -10 * s, 3 * s, 3 * s, 0.5f * s), -1);
    hard_object(h, hard_brick(0, 0, -20 * s, 1 * s, 1 * s, 1 * s), HIDDEN);
    hard_object(h, hard_brick(0, 0, -10.6f * s, 2.5f * s, 2.5f * s, 0.05f * s), HIDDEN);
    hard_object(h, hard_brick(4.8f * s, 0, -15 * s, 1 * s, 1 * s, 1 * s), SEEN);
    hard_object(h, hard_brick(0, 0, -5 * s, 0.2f * s, 0.2f * s, 0.2f * s), SEEN);
    hard_object(h, hard_brick(0, 0, -9.4f * s, 1 * s, 1 * s, 0.05f * s), SEEN);
    hard_object(h, hard_brick(0, 200 * s, -15 * s, 1 * s, 1 * s, 1 * s), OUTSIDE);
    hard_object(h, hard_brick(0, 0, -2000 * s, 1 * s, 1 * s, 1 * s),
                scaled.projection == WORLD_INFINITE ? HIDDEN : OUTSIDE);
}

// --- the judgement -------------------------------------------------------------------------------

static bool may_be_left_out(const hard *h, oracle *judge, uint32_t i)
{
    if (oracle_outside(judge, &h->objects[i])) return true;
    for (uint32_t k = 0; k < h->occluder_count; k++)
        if (h->occluders[k].owner != (int)i &&
            oracle_box(judge, &h->objects[i], &h->occluders[k].box) == ORACLE_HIDDEN)
            return true;
    return false;
}

static void check_mask(const hard *h, const occ_view *view, oracle *judge, occ_method method)
{
    for (uint32_t i = 0; i < h->object_count; i++) {
        bool seen = world_sees(view, i), frustum = method == OCC_METHOD_FRUSTUM;
        const char *how = frustum ? "frustum" : method == OCC_METHOD_SINGLE ? "single" : "pairwise";
        ck_assert_msg(seen || may_be_left_out(h, judge, i), "%s left out object %u, which is seen",
                      how, i);
        if (h->fates[i] == DOUBTFUL) continue;
        bool expected = h->fates[i] == SEEN || (frustum && h->fates[i] == HIDDEN);
        ck_assert_msg(seen == expected, "%s: object %u is %s", how, i, seen ? "seen" : "left out");
    }
}

// Fates that the judge does not share are mistakes of the test.
static void check_fates(const hard *h, oracle *judge)
{
    for (uint32_t i = 0; i < h->object_count; i++) {
        bool outside = oracle_outside(judge, &h->objects[i]);
        if (h->fates[i] == OUTSIDE) ck_assert_msg(outside, "object %u is inside", i);
        if (h->fates[i] == HIDDEN)
            ck_assert_msg(!outside && may_be_left_out(h, judge, i), "object %u is not hidden", i);
    }
}

static void run_on(const hard *h, occ_view *view, oracle *judge)
{
    static const occ_method methods[] = {OCC_METHOD_SINGLE, OCC_METHOD_PAIRWISE,
                                         OCC_METHOD_FRUSTUM};
    for (uint32_t leaf = 1; leaf <= 64; leaf *= 8) {
        occ_scene *scene =
            world_scene(h->objects, h->object_count, h->occluders, h->occluder_count, leaf);
        for (int m = 0; m < 3; m++) {
            occ_cull_desc knobs = world_knobs(methods[m]);
            knobs.grain = leaf;
            kit_cull(view, scene, &h->camera, &knobs);
            check_mask(h, view, judge, methods[m]);
        }
        occ_scene_destroy(scene);
    }
}

static hard built(hard_builder *build)
{
    hard h = {.camera = {.depth = OCC_DEPTH_MINUS_ONE_TO_ONE}};
    build(&h);
    return h;
}

// The descriptor points into the scene itself.
static void aim(hard *h)
{
    if (h->camera.eye) h->camera.eye = h->eye;
    if (h->camera.origin) h->camera.origin = h->origin;
}

void hard_run(hard_builder *build)
{
    hard h = built(build);
    aim(&h);
    oracle *judge = oracle_of_camera(&h.camera);
    check_fates(&h, judge);
    for (uint32_t threads = 0; threads < 3; threads++) {
        occ_view *view = world_view(threads ? OCC_BACKEND_OPENMP : OCC_BACKEND_PLAIN, threads);
        run_on(&h, view, judge);
        occ_view_destroy(view);
    }
    oracle_free(judge);
}

void hard_run_on_device(hard_builder *const *builders, size_t count)
{
    occ_view *view = world_view(OCC_BACKEND_OPENCL, 0);
    for (size_t i = 0; view && i < count; i++) {
        hard h = built(builders[i]);
        aim(&h);
        oracle *judge = oracle_of_camera(&h.camera);
        run_on(&h, view, judge);
        oracle_free(judge);
    }
    occ_view_destroy(view);
}
