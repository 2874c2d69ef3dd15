// SPDX-License-Identifier: Apache-2.0
// labels: unit property oracle
// timeout: 120
// What several occluders hide together, against the exact judge.
#include "crowds.h"
#include "judge.h"
#include "support.h"

#include <stdio.h>

enum { MOST = 24 };

// Of the objects in the frustum: what is hidden, what of it was found by fused and by single.
typedef struct tally {
    unsigned hidden, found, by_one;
} tally;

static occ_scene *scene_of(const crowd *t)
{
    return world_scene(t->objects, t->object_count, t->occluders, t->occluder_count, 8);
}

static void cull_into(bool seen[MOST], const crowd *t, const occ_scene *scene, occ_view *view,
                      occ_method method)
{
    occ_cull_desc knobs = world_knobs(method);
    kit_cull(view, scene, &t->camera, &knobs);
    for (uint32_t i = 0; i < t->object_count; i++)
        seen[i] = world_sees(view, i);
}

static void set_occluders(judge *j, const crowd *t)
{
    occ_box boxes[CROWD_OCCLUDERS];
    int owners[CROWD_OCCLUDERS];
    for (uint32_t i = 0; i < t->occluder_count; i++) {
        boxes[i] = t->occluders[i].box;
        owners[i] = t->occluders[i].owner;
    }
    judge_set_occluders(j, boxes, owners, t->occluder_count);
}

static void judge_crowd(const crowd *t, int number, occ_view *view, tally *sum)
{
    bool fused[MOST], single[MOST];
    occ_scene *scene = scene_of(t);
    cull_into(fused, t, scene, view, OCC_METHOD_FUSED);
    cull_into(single, t, scene, view, OCC_METHOD_SINGLE);
    judge *j = judge_of_camera(&t->camera);
    ck_assert_ptr_nonnull(j);
    set_occluders(j, t);
    for (uint32_t i = 0; i < t->object_count; i++) {
        KIT_CHECK(t->strange || single[i] || !fused[i], "world %d: one alone hides object %u",
                  number, i);
        bool inside = judge_frustum(j, &t->objects[i]) != JUDGE_OUTSIDE;
        if (!inside) continue;
        bool seen = judge_sees(j, &t->objects[i], (int)i);
        KIT_CHECK(!seen || fused[i], "world %d: object %u is hidden, but it can be seen", number,
                  i);
        if (t->strange) continue; // what is hidden may keep the occluders that it owns from use
        sum->hidden += !seen;
        sum->found += !seen && !fused[i];
        sum->by_one += !seen && !single[i];
    }
    judge_free(j);
    occ_scene_destroy(scene);
}

// --- by hand -------------------------------------------------------------------------------------

static occ_box brick(float x, float y, float z, float a, float b, float c)
{
    return (occ_box){{x, y, z}, {{a, 0, 0}, {0, b, 0}, {0, 0, c}}};
}

static void wall(crowd *t, occ_box box)
{
    crowd_put(t, &box, -1);
}

// An eye at the origin that looks along -z.
static void look_ahead(crowd *t)
{
    static const float eye[3] = {0, 0, 0}, target[3] = {0, 0, -1};
    *t = (crowd){.camera = world_camera(eye, target, NULL)};
    t->camera.eye = t->eye;
}

static void fuse_plainly(bool seen[MOST], const crowd *t)
{
    occ_view *view = world_view(OCC_BACKEND_PLAIN, 0);
    occ_scene *scene = scene_of(t);
    cull_into(seen, t, scene, view, OCC_METHOD_FUSED);
    occ_scene_destroy(scene);
    occ_view_destroy(view);
}

// Its face goes through the eye, and a wall inside hides its far end.
START_TEST(an_object_around_the_eye_is_seen)
{
    for (int i = 0; i < 5; i++) {
        static const float ahead[5] = {10, 9.99999f, 10.00001f, 9, 9.999f};
        crowd t;
        bool seen[MOST];
        look_ahead(&t);
        t.objects[t.object_count++] = brick(0, 0, -ahead[i], 10, 10, 10);
        wall(&t, brick(0, 0, -15, 9, 9, 0.5f));
        wall(&t, brick(0, 0, -16, 9, 9, 0.5f));
        fuse_plainly(seen, &t);
        KIT_CHECK(seen[0] || i == 2, "the object around the eye is hidden");
    }
}
END_TEST

// Two sheets that overlap, or leave a gap of a tenth or a thousandth of a pixel; objects behind
// them, right behind, before, and right through.
START_TEST(two_walls_hide_between_them_what_neither_hides)
{
    static const float gaps[] = {-0.01f, -1e-3f, 1e-3f, 1e-5f};
    for (int i = 0; i < 4; i++) {
        crowd t;
        bool seen[MOST];
        look_ahead(&t);
        wall(&t, brick(-5 - 0.5f * gaps[i], 0, -10, 5, 5, 0));
        wall(&t, brick(5 + 0.5f * gaps[i], 0, -10, 5, 5, 0));
        t.objects[t.object_count++] = brick(0, 0, -20, 1, 1, 1);
        t.objects[t.object_count++] = brick(0, 0, -11, 1, 1, 0.5f);
        t.objects[t.object_count++] = brick(0, 0, -9, 1, 1, 0.5f);
        t.objects[t.object_count++] = brick(0, 0, -10, 1, 1, 0.5f);
        fuse_plainly(seen, &t);
        ck_assert_int_eq(seen[0], gaps[i] > 0.0f);
        ck_assert_int_eq(seen[1], gaps[i] > 0.0f);
        ck_assert(seen[2] && seen[3]);
    }
}
END_TEST

// The part of it that is in the picture is behind the wall.
START_TEST(what_is_beyond_the_edge_of_the_picture_needs_no_hiding)
{
    crowd t;
    bool seen[MOST];
    look_ahead(&t);
    wall(&t, brick(8, 0, -10, 4, 4, 0.1f)); // the picture ends at 10.26
    t.objects[t.object_count++] = brick(40, 0, -20, 25, 1, 1);
    t.objects[t.object_count++] = brick(10, 0, -20, 6, 1, 1);
    fuse_plainly(seen, &t);
    ck_assert(!seen[0]);
    ck_assert(seen[1]);
}
END_TEST

// --- at random -----------------------------------------------------------------------------------

typedef void make_crowd(kit_random *random, crowd *c, uint32_t objects);

static tally judge_many(make_crowd *make, uint64_t seed, int count)
{
    occ_view *view = world_view(OCC_BACKEND_PLAIN, 0);
    kit_random random = {seed};
    tally sum = {0, 0, 0};
    for (int i = 0; i < count; i++) {
        crowd t;
        make(&random, &t, MOST);
        judge_crowd(&t, i, view, &sum);
    }
    occ_view_destroy(view);
    printf("hidden %u, by several %u, by one %u\n", sum.hidden, sum.found, sum.by_one);
    return sum;
}

// Nothing is missed but what is next to being seen.
START_TEST(a_crowd_hides_what_the_judge_has_hidden)
{
    tally sum = judge_many(crowd_about, 71, WORLD_SHARE(4000));
    ck_assert_uint_gt(sum.found, sum.hidden - sum.hidden / 200);
    ck_assert_uint_lt(sum.by_one, sum.hidden - sum.hidden / 50);
}
END_TEST

// A third of the walls have seams that abut exactly, or by less than the bounds: these stay open.
START_TEST(a_wall_of_panels_hides_what_the_judge_has_hidden)
{
    tally sum = judge_many(crowd_panels, 72, WORLD_SHARE(4000));
    ck_assert_uint_gt(sum.found, sum.hidden - sum.hidden / 10);
    ck_assert_uint_lt(sum.by_one, sum.hidden - sum.hidden / 8);
}
END_TEST

static void same_on(occ_view *other, make_crowd *make, uint64_t seed, int count)
{
    occ_view *plain = world_view(OCC_BACKEND_PLAIN, 0);
    kit_random random = {seed};
    for (int i = 0; other && i < count; i++) {
        crowd t;
        bool seen[2][MOST] = {{false}};
        make(&random, &t, MOST);
        occ_scene *scene = scene_of(&t);
        cull_into(seen[0], &t, scene, plain, OCC_METHOD_FUSED);
        cull_into(seen[1], &t, scene, other, OCC_METHOD_FUSED);
        KIT_CHECK(kit_same_bits(seen[0], seen[1], sizeof seen[0]), "world %d differs", i);
        occ_scene_destroy(scene);
    }
    occ_view_destroy(plain);
}

START_TEST(openmp_fuses_as_plain_does)
{
    occ_view *view = world_view(OCC_BACKEND_OPENMP, 2);
    same_on(view, crowd_about, 73, WORLD_SHARE(2000));
    same_on(view, crowd_panels, 74, WORLD_SHARE(2000));
    occ_view_destroy(view);
}
END_TEST

START_TEST(a_device_fuses_as_plain_does)
{
    occ_view *view = world_view(OCC_BACKEND_OPENCL, 0);
    same_on(view, crowd_about, 75, WORLD_SHARE(600));
    same_on(view, crowd_panels, 76, WORLD_SHARE(600));
    occ_view_destroy(view);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("fusion");
    TCase *by_hand = tcase_create("by hand");
    tcase_add_test(by_hand, an_object_around_the_eye_is_seen);
    tcase_add_test(by_hand, two_walls_hide_between_them_what_neither_hides);
    tcase_add_test(by_hand, what_is_beyond_the_edge_of_the_picture_needs_no_hiding);
    suite_add_tcase(suite, by_hand);
    TCase *random = tcase_create("random");
    tcase_add_test(random, a_crowd_hides_what_the_judge_has_hidden);
    tcase_add_test(random, a_wall_of_panels_hides_what_the_judge_has_hidden);
    suite_add_tcase(suite, random);
    TCase *backends = tcase_create("backends");
    tcase_add_test(backends, openmp_fuses_as_plain_does);
    tcase_add_test(backends, a_device_fuses_as_plain_does);
    suite_add_tcase(suite, backends);
    return test_run_suite(suite);
}
