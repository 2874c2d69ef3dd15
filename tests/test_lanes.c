// SPDX-License-Identifier: Apache-2.0
// labels: unit property
// Every instruction set's lanes against scalar C straight from verdict.h, on numbers chosen to sit
// on the edge of a verdict.
#include "frame.h"
#include "kit_edge.h"
#include "kit_set.h"
#include "support.h"

#include <string.h>

enum { MOST_LANES = 8, ROUNDS = 30000 / OCC_TEST_SLOWNESS };

static const occ_lanes *lanes[MOST_LANES];
static unsigned lane_count;

static void list_lanes(void)
{
    for (lane_count = 0; lane_count < MOST_LANES && occ_lanes_get(lane_count); lane_count++)
        lanes[lane_count] = occ_lanes_get(lane_count);
    ck_assert_uint_gt(lane_count, 0);
    ck_assert_str_eq(lanes[lane_count - 1]->name, "plain");
}

// --- siblings ------------------------------------------------------------------------------------

typedef struct family {
    occ_node nodes[OCC_NODE_LANES];
    occ_relative_box boxes[OCC_NODE_LANES]; // the nodes' bounds, as the lanes are to see them
    occ_siblings siblings;
    occ_eye eye;
    float size;
} family;

// As load_nodes() in lanes_walk.h promises.
static occ_relative_box bounds_of(const occ_node *node, const occ_eye *eye)
{
    occ_relative_box box = {.a = {0}};
    for (int j = 0; j < 3; j++) {
        float min = OCC_RELATIVE(node->min[j], eye->high[j], eye->low[j]);
        float max = OCC_RELATIVE(node->max[j], eye->high[j], eye->low[j]);
        box.t[j] = OCC_MIDDLE(min, max);
        box.a[4 * j] = OCC_HALF(min, max);
    }
    float size = OCC_NORM1(box.t[0], box.t[1], box.t[2]);
    size += OCC_NORM1(box.a[0], box.a[4], box.a[8]);
    box.e = OCC_BOUND(size, eye->slack_floor);
    return box;
}

static float node_reach(const occ_relative_box *box, const float plane[4])
{
    return OCC_REACH_OF_AABB(plane[0], plane[1], plane[2], box->a[0], box->a[4], box->a[8]);
}

static bool node_inside(const occ_relative_box *box, const float plane[4])
{
    float s = OCC_PLANE_AT(plane[0], plane[1], plane[2], plane[3], box->t[0], box->t[1], box->t[2]);
    return OCC_IS_INSIDE(s, node_reach(box, plane), box->e);
}

static bool node_outside(const occ_relative_box *box, const float plane[4])
{
    float s = OCC_PLANE_AT(plane[0], plane[1], plane[2], plane[3], box->t[0], box->t[1], box->t[2]);
    return OCC_IS_OUTSIDE(s, node_reach(box, plane), box->e);
}

static void make_family(kit_random *random, family *f)
{
    f->size = edge_size(random);
    f->eye = edge_eye(random, f->size);
    uint32_t count = 1 + kit_below(random, OCC_NODE_LANES), row = kit_below(random, 1000);
    f->siblings = (occ_siblings){.nodes = f->nodes, .count = count};
    f->siblings.frustum = kit_below(random, 1u << OCC_FRUSTUM_PLANES);
    for (uint32_t c = 0; c < count; c++) {
        occ_node *node = &f->nodes[c];
        for (int j = 0; j < 3; j++) {
            node->min[j] = edge_number(random, f->size);
            node->max[j] = node->min[j] + fabsf(edge_number(random, 0.5f * f->size));
        }
        node->first = row;
        node->count = 1 + kit_below(random, 50);
        row += node->count;
        f->boxes[c] = bounds_of(node, &f->eye);
    }
    for (int p = 0; p < OCC_FRUSTUM_PLANES; p++)
        edge_plane(random, &f->boxes[kit_below(random, count)], f->size, f->eye.plane[p]);
}

static void cut_plainly(const family *f, occ_siblings *out)
{
    *out = f->siblings;
    out->outside = 0;
    for (uint32_t c = 0; c < out->count; c++) {
        out->frustum_of[c] = out->frustum;
        for (uint32_t p = 0; p < OCC_FRUSTUM_PLANES; p++) {
            if (!(out->frustum >> p & 1u)) continue;
            if (node_outside(&f->boxes[c], f->eye.plane[p])) out->outside |= 1u << c;
            if (node_inside(&f->boxes[c], f->eye.plane[p])) out->frustum_of[c] &= ~(1u << p);
        }
    }
}

static bool same_siblings(const occ_siblings *a, const occ_siblings *b)
{
    return a->outside == b->outside &&
           !memcmp(a->frustum_of, b->frustum_of, a->count * sizeof *a->frustum_of);
}

START_TEST(every_instruction_set_decides_siblings_alike)
{
    kit_random random = {12};
    unsigned outside = 0, cleared = 0;
    for (unsigned i = 0; i < ROUNDS; i++) {
        family f;
        occ_siblings expected;
        make_family(&random, &f);
        cut_plainly(&f, &expected);
        outside += expected.outside != 0;
        cleared += expected.frustum_of[0] != expected.frustum;
        for (unsigned v = 0; v < lane_count; v++) {
            occ_siblings siblings = f.siblings;
            lanes[v]->cut(&siblings, &f.eye);
            if (!same_siblings(&siblings, &expected))
                ck_abort_msg("%s in round %u", lanes[v]->name, i);
        }
    }
    ck_assert_uint_gt(outside, ROUNDS / 20);
    ck_assert_uint_gt(cleared, ROUNDS / 20);
}
END_TEST

// --- objects -------------------------------------------------------------------------------------

typedef struct crowd {
    occ_hooks hooks;
    occ_boxes boxes;
    occ_eye eye;
    float size;
} crowd;

enum { ROWS = 150, MOST_CANDIDATES = 10 };

static void make_crowd(kit_random *random, crowd *c)
{
    c->size = edge_size(random);
    c->eye = edge_eye(random, c->size);
    c->boxes.count = ROWS;
    for (uint32_t row = 0; row < ROWS; row++) {
        occ_relative_box from = edge_box(random, c->size, 0.0f);
        occ_box box;
        memcpy(box.center, from.t, sizeof box.center);
        memcpy(box.axis, from.a, sizeof box.axis);
        occ_boxes_set(&c->boxes, row, &box);
    }
}

static occ_relative_box row_of(const crowd *c, uint32_t row)
{
    occ_frame frame;
    frame.camera.constants = c->eye;
    occ_box box = occ_boxes_get(&c->boxes, row);
    return occ_frame_relative(&frame, &box);
}

static bool hides_row(const crowd *c, const occ_range *range, const occ_candidates *candidates,
                      const occ_relative_box *box, uint32_t row)
{
    const occ_shadow *shadows = candidates->set->shadows;
    if (range->fused) {
        return occ_box_fused(box, &c->eye, range->frustum, shadows, candidates->list,
                             candidates->count, row);
    }
    for (uint32_t k = 0; k < candidates->count; k++) {
        const occ_shadow *shadow = &shadows[candidates->list[k]];
        if (shadow->owner != row && occ_box_in_shadow(box, shadow->plane[0], shadow->planes))
            return true;
    }
    return false;
}

static occ_verdict test_plainly(const crowd *c, const occ_range *range,
                                const occ_candidates *candidates)
{
    occ_verdict verdict = {{0, 0}, {0, 0}};
    for (uint32_t i = 0; i < range->count; i++) {
        occ_relative_box box = row_of(c, range->first + i);
        uint32_t bit = 1u << i % 32;
        if (occ_box_outside(&box, c->eye.plane[0], range->frustum)) {
            verdict.outside[i / 32] |= bit;
        } else if (!hides_row(c, range, candidates, &box, range->first + i)) {
            verdict.visible[i / 32] |= bit;
        }
    }
    return verdict;
}

// A range, planes of the frustum on the edges of its objects, and how far fusion may go.
static occ_range any_range(kit_random *random, crowd *c, bool fused)
{
    occ_range range = {.first = kit_below(random, ROWS - OCC_RANGE_OBJECTS + 1), .fused = fused};
    range.count = 1 + kit_below(random, OCC_RANGE_OBJECTS);
    range.frustum = kit_below(random, 1u << OCC_FRUSTUM_PLANES);
    for (int p = 0; p < OCC_FRUSTUM_PLANES; p++) {
        occ_relative_box edge = row_of(c, range.first + kit_below(random, range.count));
        edge_plane(random, &edge, c->size, c->eye.plane[p]);
    }
    c->eye.splits = kit_below(random, 50);
    c->eye.toward[2] = c->eye.toward[3] = kit_below(random, 4) ? 0.0f : 1.0f;
    return range;
}

static void any_candidates(kit_random *random, const crowd *c, const occ_range *range, kit_set *set,
                           uint32_t *list)
{
    uint32_t count = kit_below(random, MOST_CANDIDATES + 1);
    for (set->count = 0; set->count < count;) {
        occ_relative_box edge = row_of(c, range->first + kit_below(random, range->count));
        occ_shadow shadow;
        list[set->count] = count - 1 - set->count;
        edge_shadow(random, &edge, c->size, ROWS, &shadow);
        kit_set_add(set, &shadow);
    }
}

static const occ_screen nowhere;

static void test_objects(bool fused)
{
    kit_random random = {13};
    crowd c = {.size = 0.0f};
    static const occ_allocator heap;
    static const occ_logger silence;
    ck_assert_int_eq(occ_hooks_init(&c.hooks, &heap, &silence), OCC_SUCCESS);
    ck_assert_int_eq(occ_boxes_reserve(&c.hooks, &c.boxes, ROWS), OCC_SUCCESS);
    kit_set set;
    uint32_t list[MOST_CANDIDATES] = {0};
    unsigned outside = 0, hidden = 0, visible = 0;
    for (unsigned i = 0; i < ROUNDS / 8; i++) {
        if (i % 4 == 0) make_crowd(&random, &c);
        occ_range range = any_range(&random, &c, fused);
        any_candidates(&random, &c, &range, &set, list);
        const occ_shadow_set view = kit_set_view(&set);
        occ_candidates candidates = {&view, list, view.count};
        occ_verdict expected = test_plainly(&c, &range, &candidates);
        for (unsigned v = 0; v < lane_count; v++) {
            occ_verdict said = lanes[v]->test(&c.boxes, &range, &c.eye, &nowhere, &candidates);
            if (memcmp(&said, &expected, sizeof said) != 0)
                ck_abort_msg("%s in round %u", lanes[v]->name, i);
        }
        outside += (expected.outside[0] | expected.outside[1]) != 0;
        visible += (expected.visible[0] | expected.visible[1]) != 0;
        hidden += (unsigned)__builtin_popcount(expected.outside[0] | expected.visible[0]) <
                  (range.count < 32 ? range.count : 32);
    }
    ck_assert_uint_gt(outside, ROUNDS / 100);
    ck_assert_uint_gt(visible, ROUNDS / 100);
    ck_assert_uint_gt(hidden, ROUNDS / 100);
    occ_boxes_free(&c.hooks, &c.boxes);
}

START_TEST(every_instruction_set_decides_objects_alike)
{
    test_objects(false);
}
END_TEST

START_TEST(every_instruction_set_fuses_alike)
{
    test_objects(true);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("lanes");
    TCase *tcase = tcase_create("variants");
    tcase_add_checked_fixture(tcase, list_lanes, NULL);
    tcase_add_test(tcase, every_instruction_set_decides_siblings_alike);
    tcase_add_test(tcase, every_instruction_set_decides_objects_alike);
    tcase_add_test(tcase, every_instruction_set_fuses_alike);
    suite_add_tcase(suite, tcase);
    return test_run_suite(suite);
}
