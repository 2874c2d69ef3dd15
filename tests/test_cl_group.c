// SPDX-License-Identifier: Apache-2.0
// labels: property oracle
// Fusion by a work-group (fuse.cl), compiled for the host, against fusion by one (fusion.h): the
// same answer for every object of crowds that take halving, faces and full stacks to decide.
#include "crowds.h"
#include "flat.h"
#include "kit_group.h"
#include "support.h"

#include <stdio.h>

// --- OpenCL C on the host ------------------------------------------------------------------------

#define __kernel
#define __global
#define __local
#define uint                          uint32_t
#define reqd_work_group_size(x, y, z) unused
#define CLK_LOCAL_MEM_FENCE           0
#define barrier(fence)                kit_group_barrier(__LINE__ + (fence))
#define clz(x)                        ((uint32_t)__builtin_clz(x))
#define popcount(x)                   ((uint32_t)__builtin_popcount(x))
#define atomic_or(place, bits)        ((void)(*(place) |= (bits)))
#define atomic_min(place, x)          ((void)(*(place) = *(place) < (x) ? *(place) : (x)))
#define atomic_inc(place)             ((void)++*(place))
#define get_local_id(dimension)       (dimension)
#define get_group_id(dimension)       (dimension)
#define get_num_groups(dimension)     ((dimension) + 1u)

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunknown-pragmas"
#pragma GCC diagnostic ignored "-Wmissing-prototypes"
#include "fuse.cl"
#pragma GCC diagnostic pop

#undef uint

// --- one object ----------------------------------------------------------------------------------

typedef struct question {
    fuse_group group;
    occ_relative_box box;
    const occ_eye *eye;
    const occ_shadow *shadows;
    uint32_t list[OCC_FLAT_LIST], count, row, planes;
    int answer[KIT_GROUP_ITEMS];
} question;

static void ask(uint32_t item, void *context)
{
    question *q = context;
    q->answer[item] = group_fuses(&q->group, &q->box, q->eye, q->planes, q->shadows, q->list,
                                  q->count, q->row, item);
}

typedef struct tally {
    unsigned hidden, visible, by_faces, halved;
} tally;

// Whether the upper two pieces are halves of one.
static bool are_halves(const occ_fusion *fusion)
{
    if (fusion->depth < 2) return false;
    const occ_piece *a = &fusion->stack[fusion->depth - 2], *b = a + 1;
    uint32_t last = OCC_PIECE_VERTICES / 2;
    return a->count == last + 1 && b->count == last + 1 &&
           kit_same_bits(&a->v[0], &b->v[last], sizeof a->v[0]) &&
           kit_same_bits(&a->v[last], &b->v[0], sizeof a->v[0]);
}

// Whether deciding on an object takes its faces, and whether a piece is halved on the way.
static void look_closer(const question *q, tally *sum)
{
    occ_fusion fusion = {.faces = 0};
    occ_outline outline;
    bool halved = false;
    if (!occ_outline_set(&outline, &q->box, q->eye, 0)) return;
    fusion.depth = occ_outline_pieces(&outline, &q->box, fusion.stack);
    occ_fusion_clip(&fusion, q->eye, q->planes, q->box.e);
    for (uint32_t split = 0; fusion.depth && split < q->eye->splits; split++) {
        uint32_t i = occ_fusion_find(&fusion, &q->box, q->shadows, q->list, q->count, q->row, 0);
        if (i == q->count || !occ_fusion_subtract(&fusion, &q->shadows[q->list[i]], q->box.e))
            break;
        halved = halved || are_halves(&fusion);
    }
    sum->by_faces += fusion.depth && fusion.faces;
    sum->halved += halved;
}

static void compare(question *q, bool backwards, tally *sum)
{
    int expected = occ_box_fused(&q->box, q->eye, q->planes, q->shadows, q->list, q->count, q->row);
    kit_group_run(ask, q, backwards);
    for (uint32_t i = 0; i < KIT_GROUP_ITEMS; i++)
        KIT_CHECK(q->answer[i] == expected, "row %u: item %u says %d, one alone %d", q->row, i,
                  q->answer[i], expected);
    sum->hidden += expected != 0;
    sum->visible += expected == 0;
    look_closer(q, sum);
}

// --- crowds --------------------------------------------------------------------------------------

typedef void make_crowd(kit_random *random, crowd *c, uint32_t objects);

// What a table asks its last kernel: the objects that cheaper answers leave unresolved.
static void ask_all(crowd_frame *f, kit_random *random, tally *sum)
{
    static question q;
    q.eye = &f->frame.camera.constants;
    q.shadows = f->frame.shadows.data;
    q.planes = f->frame.camera.planes;
    q.count = 0;
    for (uint32_t i = 0; i < f->frame.shadows.count; i++)
        if (kit_below(random, 8)) q.list[q.count++] = i;
    for (q.row = 0; q.row < f->scene->boxes.count; q.row++) {
        occ_box box = occ_boxes_get(&f->scene->boxes, q.row);
        q.box = occ_frame_relative(&f->frame, &box);
        if (occ_flat_object(&q.box, q.eye, q.planes, q.shadows, q.list, q.count, q.row, 1) ==
            OCC_UNRESOLVED) {
            compare(&q, kit_below(random, 2), sum);
        }
    }
}

// A box before others of about the same outline, and panels round it: what sticks out behind the
// box is hidden by those, after many of its corners have been cut off.
static void make_ring(kit_random *random, crowd *c, uint32_t objects)
{
    static const float eye[3] = {0.0f, 0.0f, 12.0f}, target[3] = {0.0f, 0.0f, 0.0f};
    world_lens lens = {.near_z = 0.1f, .far_z = 100.0f};
    *c = (crowd){.scale = 1.0f, .camera = world_camera(eye, target, &lens)};
    const double middle[3] = {0.0, 0.0, 3.0};
    double hole = world_between(random, 0.2, 0.6);
    occ_box box = world_box(random, WORLD_TURNED, middle, world_between(random, 0.6, 0.9));
    crowd_put(c, &box, -1);
    for (int side = 0; side < 4; side++) {
        int across = side / 2;
        occ_box panel = {{0.0f, 0.0f, 6.0f}, {{3.0f, 0, 0}, {0, 3.0f, 0}, {0, 0, 0.1f}}};
        panel.center[across] = (float)(side % 2 ? 3.0 + hole : -3.0 - hole);
        crowd_put(c, &panel, -1);
    }
    for (; c->object_count < objects; c->object_count++) {
        const double center[3] = {world_between(random, -0.3, 0.3),
                                  world_between(random, -0.3, 0.3), -6.0};
        c->objects[c->object_count] =
            world_box(random, WORLD_TURNED, center, world_between(random, 1.2, 2.0));
    }
}

static tally compare_crowds(make_crowd *make, uint64_t seed, uint32_t worlds)
{
    static const uint32_t splits[] = {3, 48, 48, 1000};
    kit_random random = {seed};
    tally sum = {0, 0, 0, 0};
    for (uint32_t i = 0; i < worlds; i++) {
        crowd c;
        crowd_frame f;
        make(&random, &c, 17 + kit_below(&random, CROWD_OBJECTS - 16));
        crowd_frame_open(&f, &c, 0.0);
        f.frame.camera.constants.splits = splits[kit_below(&random, 4)];
        ask_all(&f, &random, &sum);
        crowd_frame_close(&f);
    }
    printf("hidden %u, visible %u, by faces %u, halved %u\n", sum.hidden, sum.visible, sum.by_faces,
           sum.halved);
    return sum;
}

START_TEST(a_group_says_of_crowds_what_one_says)
{
    tally sum = compare_crowds(crowd_about, 121, 200 / OCC_TEST_SLOWNESS);
    ck_assert_uint_gt(sum.hidden, 0);
    ck_assert_uint_gt(sum.visible, 0);
    ck_assert_uint_gt(sum.by_faces, 0);
}
END_TEST

START_TEST(a_group_halves_pieces_as_one_does)
{
    tally sum = compare_crowds(make_ring, 124, 10);
    ck_assert_uint_gt(sum.hidden, 0);
    ck_assert_uint_gt(sum.halved, 0);
}
END_TEST

START_TEST(a_group_says_of_panels_what_one_says)
{
    tally sum = compare_crowds(crowd_panels, 122, 40 / OCC_TEST_SLOWNESS);
    ck_assert_uint_gt(sum.hidden, 0);
    ck_assert_uint_gt(sum.visible, 0);
}
END_TEST

START_TEST(a_group_says_of_what_is_around_the_eye_what_one_says)
{
    tally sum = compare_crowds(crowd_around, 123, 12 / OCC_TEST_SLOWNESS);
    ck_assert_uint_gt(sum.hidden, 0);
    ck_assert_uint_gt(sum.visible, 0);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("cl_group");
    TCase *fusion = tcase_create("fusion");
    tcase_add_test(fusion, a_group_says_of_crowds_what_one_says);
    tcase_add_test(fusion, a_group_halves_pieces_as_one_does);
    tcase_add_test(fusion, a_group_says_of_panels_what_one_says);
    tcase_add_test(fusion, a_group_says_of_what_is_around_the_eye_what_one_says);
    suite_add_tcase(suite, fusion);
    return test_run_suite(suite);
}
