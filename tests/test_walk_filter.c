// SPDX-License-Identifier: Apache-2.0
// labels: unit property
// What the walk decides about nodes agrees with what the test would say of the objects in them, in
// every instruction set; and whole frames are the same in all of them.
#include "kit_crew.h"
#include "kit_edge.h"
#include "kit_obs.h"
#include "kit_set.h"
#include "obs.h"
#include "scenes.h"
#include "support.h"
#include "view_data.h"

#include <stdlib.h>
#include <string.h>

// --- nodes and the objects in them ---------------------------------------------------------------

typedef struct grove {
    occ_scene *scene;
    occ_frame frame; // for its camera
    float size;
    kit_random random;
    unsigned dropped, cleared, hidden, outside, in_shadow; // how often each was seen
} grove;

static occ_relative_box object_at(const grove *g, uint32_t row)
{
    occ_box box = occ_boxes_get(&g->scene->boxes, row);
    return occ_frame_relative(&g->frame, &box);
}

static bool is_outside(const occ_relative_box *box, const float plane[4])
{
    return occ_box_outside(box, plane, 1u);
}

static bool is_inside(const occ_relative_box *box, const float plane[4])
{
    return occ_box_in_shadow(box, plane, 1u);
}

// Aligned boxes beside others, so that many a node's bounds are an object's own; far from the
// origin and far apart compared with their size, so that rounding has its say.
static occ_box rough_box(kit_random *random, float size)
{
    occ_box box = kit_box(random, size, 0.05f * size);
    uint32_t what = kit_below(random, 6);
    for (int k = 0; k < 3; k++) {
        for (int j = 0; j < 3; j++) {
            if (what < 3 && j != k) box.axis[k][j] = 0.0f;
            if (what == 1) box.axis[k][j] *= 1e-5f;
        }
    }
    if (what == 5) memset(box.axis[kit_below(random, 3)], 0, sizeof box.axis[0]);
    return box;
}

static void plant(grove *g, float size)
{
    static const occ_scene_desc desc = {.leaf_objects = 3};
    g->size = size;
    ck_assert_int_eq(occ_scene_create(&desc, &g->scene), OCC_SUCCESS);
    for (int i = 0; i < 400; i++) {
        occ_box box = rough_box(&g->random, size);
        ck_assert_int_eq(occ_scene_add_many(g->scene, &box, 1, NULL), OCC_SUCCESS);
    }
    ck_assert_int_eq(occ_scene_commit(g->scene), OCC_SUCCESS);
}

// An eye in or around the scene, and planes through the edges of what is there.
static void take_stand(grove *g)
{
    occ_eye *eye = &g->frame.camera.constants;
    *eye = (occ_eye){.slack_floor = 0x1p-80f};
    for (int j = 0; j < 3; j++) {
        eye->high[j] = kit_between(&g->random, -g->size, g->size);
        eye->low[j] = eye->high[j] * kit_between(&g->random, -0x1p-25f, 0x1p-25f);
        eye->slack_floor += 0x1p-46f * eye->high[j] * (eye->high[j] < 0.0f ? -1.0f : 1.0f);
    }
    for (int p = 0; p < OCC_FRUSTUM_PLANES; p++) {
        occ_relative_box box = object_at(g, kit_below(&g->random, g->scene->boxes.count));
        edge_plane(&g->random, &box, g->size, eye->plane[p]);
    }
}

// No object of the node contradicts what was said of it and a frustum plane.
static void check_cut(grove *g, const occ_siblings *s, uint32_t c)
{
    const occ_eye *eye = &g->frame.camera.constants;
    const occ_node *node = &s->nodes[c];
    uint32_t may_be_outside = s->frustum;
    for (uint32_t row = node->first; row < node->first + node->count; row++) {
        occ_relative_box box = object_at(g, row);
        for (uint32_t p = 0; p < OCC_FRUSTUM_PLANES; p++) {
            if (!(s->frustum >> p & 1u)) continue;
            bool cleared = !(s->frustum_of[c] >> p & 1u);
            if (cleared && is_outside(&box, eye->plane[p]))
                ck_abort_msg("an object is outside of a plane that its node is inside of");
            if (is_inside(&box, eye->plane[p])) may_be_outside &= ~(1u << p);
        }
    }
    g->cleared += s->frustum_of[c] != s->frustum;
    if (!(s->outside >> c & 1u)) return;
    g->outside++;
    if (!may_be_outside) ck_abort_msg("a node outside has objects inside of each plane");
}

// Nor what was said of it and a shadow, that hides it or that is left out.
static void check_shadow(grove *g, const occ_node *node, const occ_shadow *shadow, bool hidden,
                         bool listed)
{
    g->hidden += hidden;
    g->dropped += !hidden && !listed;
    for (uint32_t row = node->first; row < node->first + node->count; row++) {
        occ_relative_box box = object_at(g, row);
        bool held = occ_box_in_shadow(&box, shadow->plane[0], shadow->planes);
        g->in_shadow += held;
        if (held && !hidden && !listed)
            ck_abort_msg("an occluder is left out that hides an object");
        if (hidden && shadow->owner == row) ck_abort_msg("an object is hidden by what it owns");
        for (uint32_t p = 0; hidden && p < shadow->planes; p++)
            if (is_outside(&box, shadow->plane[p]))
                ck_abort_msg("an object is outside of the shadow that hides its node");
    }
}

static void ask_node(grove *g, const occ_lanes *lanes, const occ_node *node, const kit_set *one)
{
    static const occ_screen nowhere;
    occ_relative_box box = occ_frame_relative_node(&g->frame, node);
    occ_projection seen;
    uint32_t hint = 0, list[2], count = 0;
    occ_shadow_set set = kit_set_view(one);
    occ_question question = {.box = &box,
                             .seen = &seen,
                             .first = node->first,
                             .rows = node->count,
                             .key = INFINITY,
                             .upright = true,
                             .hint = &hint};
    const occ_eye *eye = &g->frame.camera.constants;
    bool hidden = lanes->hide(&question, &set, eye, &nowhere);
    lanes->project(&nowhere, &box, &seen);
    if (lanes->gather(&question, &set, list, &count) != hidden)
        ck_abort_msg("what hides a node alone hides it, or does not");
    check_shadow(g, node, &one->shadows[0], hidden, count > 0);
}

static void check_family(grove *g, const occ_lanes *lanes, const occ_node *parent)
{
    enum { SHADOWS = 4 };
    const occ_node *nodes = occ_octree_nodes(&g->scene->object_tree);
    occ_siblings cut = {.nodes = nodes + parent->child, .count = parent->children};
    cut.frustum = kit_below(&g->random, 1u << OCC_FRUSTUM_PLANES);
    lanes->cut(&cut, &g->frame.camera.constants);
    for (uint32_t c = 0; c < cut.count; c++)
        check_cut(g, &cut, c);
    for (int i = 0; i < SHADOWS; i++) {
        static kit_set one;
        occ_shadow shadow;
        occ_relative_box edge = object_at(g, parent->first + kit_below(&g->random, parent->count));
        edge_shadow(&g->random, &edge, g->size, g->scene->boxes.count, &shadow);
        one.count = 0;
        kit_set_add(&one, &shadow);
        for (uint32_t c = 0; c < cut.count; c++)
            if (!(cut.outside >> c & 1u)) ask_node(g, lanes, &cut.nodes[c], &one);
    }
}

static const float sizes[] = {1.0f, 1e14f, 1e-30f, 1e-39f, 1e5f};

START_TEST(no_node_is_decided_against_an_object_in_it)
{
    grove g = {.random = {(uint64_t)_i + 21}};
    plant(&g, sizes[_i]);
    const occ_octree *tree = &g.scene->object_tree;
    for (int stand = 0; stand < 200 / OCC_TEST_SLOWNESS; stand++) {
        take_stand(&g);
        for (uint32_t n = 0; n < tree->nodes.count; n++) {
            const occ_node *node = &occ_octree_nodes(tree)[n];
            for (uint32_t v = 0; node->children && occ_lanes_get(v); v++)
                check_family(&g, occ_lanes_get(v), node);
        }
    }
    ck_assert_uint_gt(g.dropped, 100);
    if (sizes[_i] > 1e-20f) { // smaller than the bound everything is in doubt
        ck_assert_uint_gt(g.hidden, 100);
        ck_assert_uint_gt(g.cleared, 100);
        ck_assert_uint_gt(g.outside, 100);
        ck_assert_uint_gt(g.in_shadow, 100);
    }
    occ_scene_destroy(g.scene);
}
END_TEST

// --- whole frames --------------------------------------------------------------------------------

// A view that uses these lanes for everything.
static occ_view *view_with(const occ_lanes *lanes)
{
    occ_view *view = NULL;
    occ_view_desc desc = {.backend = OCC_BACKEND_OPENMP, .threads = 2};
    ck_assert_int_eq(occ_view_create(&desc, &view), OCC_SUCCESS);
    view->frame.lanes = lanes;
    view->backend->ops->destroy(view->backend);
    ck_assert_int_eq(occ_backend_openmp_create(&view->hooks, 2, lanes, &view->backend),
                     OCC_SUCCESS);
    return view;
}

START_TEST(whole_frames_are_the_same_in_every_instruction_set)
{
    static const occ_cull_desc knobs[] = {{.method = OCC_METHOD_SINGLE},
                                          {.method = OCC_METHOD_SINGLE, .grain = 1},
                                          {.method = OCC_METHOD_SINGLE, .min_area = 1e-30f},
                                          {.method = OCC_METHOD_FUSED},
                                          {.method = OCC_METHOD_FUSED, .min_area = 1e-30f},
                                          {.method = OCC_METHOD_FUSED, .tolerance = 0.01f},
                                          {.method = OCC_METHOD_FRUSTUM},
                                          {.method = OCC_METHOD_PAIRWISE}};
    static const occ_scene_desc desc = {.leaf_objects = 8};
    obs_scene file;
    ck_assert(scenes_make(scenes_kinds[_i].name, 3000 / OCC_TEST_SLOWNESS, 3, &file));
    occ_scene *scene = kit_obs_scene(&file, &desc, NULL, NULL);
    occ_view *plain = NULL;
    occ_view_desc plain_desc = {.backend = OCC_BACKEND_PLAIN};
    ck_assert_int_eq(occ_view_create(&plain_desc, &plain), OCC_SUCCESS);
    for (uint32_t v = 0; occ_lanes_get(v); v++) {
        occ_view *view = view_with(occ_lanes_get(v));
        for (uint32_t f = 0; f < file.frame_count; f += 13) {
            double eye[3];
            occ_camera_desc camera = kit_obs_camera(&file.frames[f], eye);
            for (unsigned k = 0; k < sizeof knobs / sizeof *knobs; k++) {
                kit_cull(plain, scene, &camera, &knobs[k]);
                kit_cull(view, scene, &camera, &knobs[k]);
                kit_same_answers(plain, view, occ_lanes_get(v)->name);
            }
        }
        occ_view_destroy(view);
    }
    occ_view_destroy(plain);
    occ_scene_destroy(scene);
    obs_free(&file);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("walk_filter");
    TCase *nodes = tcase_create("nodes");
    tcase_add_loop_test(nodes, no_node_is_decided_against_an_object_in_it, 0,
                        sizeof sizes / sizeof *sizes);
    suite_add_tcase(suite, nodes);
    TCase *frames = tcase_create("frames");
    tcase_add_loop_test(frames, whole_frames_are_the_same_in_every_instruction_set, 0, 5);
    suite_add_tcase(suite, frames);
    return test_run_suite(suite);
}
