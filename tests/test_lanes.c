// SPDX-License-Identifier: Apache-2.0
// labels: unit property
// Every instruction set's lanes against scalar C straight from verdict.h, on numbers chosen to sit
// on the edge of a verdict.
#include "frame.h"
#include "kit_edge.h"
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

// --- one box, many shadows -----------------------------------------------------------------------

// Each lane's shadow holds the box in most planes, so that the last may decide.
static void fill_block(kit_random *random, const occ_relative_box *box, float size,
                       occ_shadow_block *block)
{
    for (uint32_t l = 0; l < OCC_SHADOW_LANES; l++) {
        uint32_t planes = 1 + kit_below(random, OCC_SHADOW_PLANES);
        float plane[4] = {0};
        for (uint32_t p = 0; p < OCC_SHADOW_PLANES; p++) {
            if (p < planes) edge_plane(random, box, size, plane);
            for (int j = 0; j < 4; j++)
                block->plane[p][j][l] = plane[j];
        }
    }
}

static bool block_hides(const occ_shadow_block *block, const occ_relative_box *box)
{
    for (uint32_t l = 0; l < OCC_SHADOW_LANES; l++) {
        float planes[OCC_SHADOW_PLANES][4];
        for (uint32_t p = 0; p < OCC_SHADOW_PLANES; p++)
            for (int j = 0; j < 4; j++)
                planes[p][j] = block->plane[p][j][l];
        if (occ_box_in_shadow(box, planes[0], OCC_SHADOW_PLANES)) return true;
    }
    return false;
}

START_TEST(every_instruction_set_finds_the_same_boxes_hidden)
{
    enum { MOST_BLOCKS = 3 };
    kit_random random = {11};
    unsigned held = 0;
    occ_shadow_block blocks[MOST_BLOCKS];
    for (unsigned i = 0; i < ROUNDS / 4; i++) {
        float size = edge_size(&random);
        occ_relative_box box = edge_box(&random, size, 0x1p-80f);
        uint32_t count = kit_below(&random, MOST_BLOCKS + 1);
        bool expected = false;
        for (uint32_t b = 0; b < count; b++) {
            fill_block(&random, &box, size, &blocks[b]);
            expected |= block_hides(&blocks[b], &box);
        }
        held += expected;
        for (unsigned v = 0; v < lane_count; v++)
            if (lanes[v]->any_hides(blocks, count, &box) != expected)
                ck_abort_msg("%s in round %u, where C says %d", lanes[v]->name, i, expected);
    }
    ck_assert_uint_gt(held, ROUNDS / 40);
    ck_assert_uint_lt(held, ROUNDS / 4 - ROUNDS / 40);
}
END_TEST

// --- siblings ------------------------------------------------------------------------------------

typedef struct family {
    occ_node nodes[OCC_NODE_LANES];
    occ_relative_box boxes[OCC_NODE_LANES]; // the nodes' bounds, as the lanes are to see them
    occ_siblings siblings;
    occ_eye eye;
    float size;
} family;

// As load_nodes() in lanes.c promises.
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
    out->outside = out->hidden = 0;
    for (uint32_t c = 0; c < out->count; c++) {
        out->frustum_of[c] = out->frustum;
        for (uint32_t p = 0; p < OCC_FRUSTUM_PLANES; p++) {
            if (!(out->frustum >> p & 1u)) continue;
            if (node_outside(&f->boxes[c], f->eye.plane[p])) out->outside |= 1u << c;
            if (node_inside(&f->boxes[c], f->eye.plane[p])) out->frustum_of[c] &= ~(1u << p);
        }
    }
}

// A child's candidates are those that touch it, up to the one that hides it.
static void shade_plainly(const family *f, const occ_candidates *candidates, occ_siblings *out,
                          uint8_t *touched)
{
    for (uint32_t i = 0; i < candidates->count; i++) {
        const occ_shadow *shadow = &candidates->shadows[candidates->list[i]];
        uint32_t decided = out->outside | out->hidden;
        if (i && decided == (1u << out->count) - 1u) return; // nobody asks for the rest
        touched[i] = 0;
        for (uint32_t c = 0; c < out->count; c++) {
            bool outside = false, inside = true;
            for (uint32_t p = 0; p < shadow->planes; p++) {
                outside |= node_outside(&f->boxes[c], shadow->plane[p]);
                inside &= node_inside(&f->boxes[c], shadow->plane[p]);
            }
            if (decided >> c & 1u || outside) continue;
            touched[i] |= (uint8_t)(1u << c);
            bool owns = shadow->owner >= f->nodes[c].first &&
                        shadow->owner < f->nodes[c].first + f->nodes[c].count;
            if (inside && !owns) out->hidden |= 1u << c;
        }
    }
}

static bool same_siblings(const occ_siblings *a, const occ_siblings *b)
{
    return a->outside == b->outside && a->hidden == b->hidden &&
           !memcmp(a->frustum_of, b->frustum_of, a->count * sizeof *a->frustum_of);
}

START_TEST(every_instruction_set_decides_siblings_alike)
{
    enum { MOST = 12 };
    kit_random random = {12};
    unsigned outside = 0, hidden = 0;
    occ_shadow shadows[MOST];
    uint32_t list[MOST];
    for (unsigned i = 0; i < ROUNDS; i++) {
        family f;
        make_family(&random, &f);
        occ_candidates candidates = {
            .shadows = shadows, .list = list, .count = kit_below(&random, MOST + 1)};
        for (uint32_t k = 0; k < candidates.count; k++) {
            list[k] = candidates.count - 1 - k;
            edge_shadow(&random, &f.boxes[kit_below(&random, f.siblings.count)], f.size, 1400,
                        &shadows[k]);
        }
        occ_siblings expected;
        uint8_t expected_touched[MOST] = {0}, touched[MOST];
        cut_plainly(&f, &expected);
        shade_plainly(&f, &candidates, &expected, expected_touched);
        outside += expected.outside != 0;
        hidden += expected.hidden != 0;
        for (unsigned v = 0; v < lane_count; v++) {
            occ_siblings siblings = f.siblings;
            memset(touched, 0, sizeof touched);
            lanes[v]->cut(&siblings, &f.eye);
            lanes[v]->shade(&siblings, &f.eye, &candidates, touched);
            if (!same_siblings(&siblings, &expected) ||
                memcmp(touched, expected_touched, MOST) != 0)
                ck_abort_msg("%s in round %u", lanes[v]->name, i);
        }
    }
    ck_assert_uint_gt(outside, ROUNDS / 20);
    ck_assert_uint_gt(hidden, ROUNDS / 20);
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

static occ_verdict test_plainly(const crowd *c, const occ_range *range,
                                const occ_candidates *candidates)
{
    occ_verdict verdict = {{0, 0}, {0, 0}};
    for (uint32_t i = 0; i < range->count; i++) {
        occ_relative_box box = row_of(c, range->first + i);
        uint32_t bit = 1u << i % 32;
        if (occ_box_outside(&box, c->eye.plane[0], range->frustum)) {
            verdict.outside[i / 32] |= bit;
            continue;
        }
        bool hidden = false;
        for (uint32_t k = 0; k < candidates->count; k++) {
            const occ_shadow *shadow = &candidates->shadows[candidates->list[k]];
            hidden |= shadow->owner != range->first + i &&
                      occ_box_in_shadow(&box, shadow->plane[0], shadow->planes);
        }
        if (!hidden) verdict.visible[i / 32] |= bit;
    }
    return verdict;
}

START_TEST(every_instruction_set_decides_objects_alike)
{
    kit_random random = {13};
    crowd c = {.size = 0.0f};
    static const occ_allocator heap;
    static const occ_logger silence;
    ck_assert_int_eq(occ_hooks_init(&c.hooks, &heap, &silence), OCC_SUCCESS);
    ck_assert_int_eq(occ_boxes_reserve(&c.hooks, &c.boxes, ROWS), OCC_SUCCESS);
    occ_shadow shadows[MOST_CANDIDATES];
    uint32_t list[MOST_CANDIDATES];
    unsigned outside = 0, hidden = 0, visible = 0;
    for (unsigned i = 0; i < ROUNDS / 8; i++) {
        if (i % 4 == 0) make_crowd(&random, &c);
        occ_range range = {.first = kit_below(&random, ROWS - OCC_RANGE_OBJECTS + 1)};
        range.count = 1 + kit_below(&random, OCC_RANGE_OBJECTS);
        range.frustum = kit_below(&random, 1u << OCC_FRUSTUM_PLANES);
        for (int p = 0; p < OCC_FRUSTUM_PLANES; p++) {
            occ_relative_box edge = row_of(&c, range.first + kit_below(&random, range.count));
            edge_plane(&random, &edge, c.size, c.eye.plane[p]);
        }
        occ_candidates candidates = {
            .shadows = shadows, .list = list, .count = kit_below(&random, MOST_CANDIDATES + 1)};
        for (uint32_t k = 0; k < candidates.count; k++) {
            occ_relative_box edge = row_of(&c, range.first + kit_below(&random, range.count));
            list[k] = candidates.count - 1 - k;
            edge_shadow(&random, &edge, c.size, ROWS, &shadows[k]);
        }
        occ_verdict expected = test_plainly(&c, &range, &candidates);
        for (unsigned v = 0; v < lane_count; v++) {
            occ_verdict said = lanes[v]->test(&c.boxes, &range, &c.eye, &candidates);
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
END_TEST

int main(void)
{
    Suite *suite = suite_create("lanes");
    TCase *tcase = tcase_create("variants");
    tcase_add_checked_fixture(tcase, list_lanes, NULL);
    tcase_add_test(tcase, every_instruction_set_finds_the_same_boxes_hidden);
    tcase_add_test(tcase, every_instruction_set_decides_siblings_alike);
    tcase_add_test(tcase, every_instruction_set_decides_objects_alike);
    suite_add_tcase(suite, tcase);
    return test_run_suite(suite);
}
