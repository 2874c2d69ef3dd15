// SPDX-License-Identifier: Apache-2.0
// labels: unit property oracle
// Walk and test together, against every object times every occluder, one by one.
#include "oracle.h"

#include "support.h"
#include "verdicts.h"
#include "worlds.h"

#include <stdio.h>
#include <stdlib.h>

// --- crowds --------------------------------------------------------------------------------------

enum { OBJECTS = 500, OCCLUDERS = 160, CAMERAS = 6, CROWDS = 3 };

typedef struct crowd {
    occ_box objects[OBJECTS];
    world_occluder occluders[OCCLUDERS];
    uint32_t object_count, occluder_count;
} crowd;

static void place(kit_random *random, double center[3])
{
    for (int j = 0; j < 3; j++)
        center[j] = world_between(random, -50, 50);
    center[1] *= 0.1;
}

// Objects of all shapes and sizes, some of them owners of what is solid in them, sheets that nobody
// owns, and a ground.
static void make_crowd(crowd *c, uint64_t seed)
{
    kit_random random = {seed};
    double center[3];
    *c = (crowd){.object_count = OBJECTS, .occluder_count = OCCLUDERS};
    for (int i = 0; i < OBJECTS; i++) {
        place(&random, center);
        world_shape shape = (world_shape)kit_below(&random, WORLD_SHAPES);
        c->objects[i] = world_box(&random, shape, center, world_scale(&random, 0.02, 5));
    }
    for (int i = 0; i < OCCLUDERS; i++) {
        int owner = kit_below(&random, 3) ? (int)kit_below(&random, OBJECTS) : -1;
        place(&random, center);
        occ_box box = world_box(&random, (world_shape)kit_below(&random, WORLD_SHEET + 1), center,
                                world_scale(&random, 1, 9));
        if (owner >= 0) {
            box = c->objects[owner];
            for (int k = 0; k < 9; k++)
                box.axis[k / 3][k % 3] *= 0.9f;
        }
        c->occluders[i] = (world_occluder){box, owner};
    }
    c->objects[0] = (occ_box){{0, -9, 0}, {{200, 0, 0}, {0, 1, 0}, {0, 0, 200}}};
    c->occluders[0] = (world_occluder){c->objects[0], 0};
}

static occ_scene *scene_of(const crowd *c, uint32_t leaf_objects)
{
    return world_scene(c->objects, c->object_count, c->occluders, c->occluder_count, leaf_objects);
}

static occ_camera_desc camera_of(uint32_t number)
{
    kit_random random = {number + 100};
    static const world_projection projections[] = {WORLD_PERSPECTIVE, WORLD_INFINITE,
                                                   WORLD_OFF_CENTRE, WORLD_ORTHOGRAPHIC};
    world_lens lens = {.projection = projections[number % 4], .depth = (occ_depth)(number % 3)};
    lens.height = lens.projection == WORLD_ORTHOGRAPHIC ? 30.0f : 0.0f;
    float angle = 1.1f * (float)number;
    float eye[3] = {60 * cosf(angle), kit_between(&random, 0, 8), 60 * sinf(angle)};
    float target[3] = {kit_between(&random, -9, 9), 0, kit_between(&random, -9, 9)};
    return world_camera(eye, target, &lens);
}

// --- brute force ---------------------------------------------------------------------------------

typedef struct force {
    bool outside[OBJECTS], hidden[OBJECTS];
} force;

// Every object against each occluder that `used` has, all of them if it is NULL.
static void use_force(const crowd *c, const occ_camera_desc *camera, const bool *used, force *f)
{
    occ_frame frame = verdict_frame(camera);
    occ_shadow shadows[OCCLUDERS];
    bool casts[OCCLUDERS];
    for (uint32_t k = 0; k < c->occluder_count; k++)
        casts[k] =
            (!used || used[k]) &&
            occ_lanes_choose()->shade(&shadows[k], &frame.camera, &c->occluders[k].box, OCC_NOBODY);
    *f = (force){{false}, {false}};
    for (uint32_t i = 0; i < c->object_count; i++) {
        occ_relative_box box = occ_frame_relative(&frame, &c->objects[i]);
        f->outside[i] = verdict_outside(&frame, &c->objects[i]);
        for (uint32_t k = 0; k < c->occluder_count && !f->hidden[i]; k++)
            f->hidden[i] = casts[k] && c->occluders[k].owner != (int)i &&
                           occ_box_in_shadow(&box, shadows[k].plane[0], shadows[k].planes);
    }
}

// Whether the judge lets an object be left out: outside, or hidden by one occluder not its own.
static bool may_be_left_out(const crowd *c, oracle *judge, uint32_t object)
{
    if (oracle_outside(judge, &c->objects[object])) return true;
    for (uint32_t k = 0; k < c->occluder_count; k++) {
        if (c->occluders[k].owner == (int)object) continue;
        if (oracle_box(judge, &c->objects[object], &c->occluders[k].box) == ORACLE_HIDDEN)
            return true;
    }
    return false;
}

static void nothing_is_false(const crowd *c, const occ_camera_desc *camera, const occ_view *view)
{
    oracle *judge = oracle_of_camera(camera);
    for (uint32_t i = 0; i < c->object_count; i++)
        ck_assert_msg(world_sees(view, i) || may_be_left_out(c, judge, i),
                      "object %u can be seen but was left out", i);
    oracle_free(judge);
}

static void read_used(const occ_view *view, bool *used, uint32_t occluders)
{
    occ_occluder handles[OCCLUDERS];
    size_t count;
    ck_assert_int_eq(occ_view_read_occluders(view, handles, OCCLUDERS, &count), OCC_SUCCESS);
    for (uint32_t k = 0; k < occluders; k++)
        used[k] = false;
    for (size_t i = 0; i < count; i++)
        used[handles[i].index - 1] = true;
}

static uint32_t count_seen(const crowd *c, const occ_view *view)
{
    uint32_t seen = 0;
    for (uint32_t i = 0; i < c->object_count; i++)
        seen += world_sees(view, i);
    return seen;
}

// --- identities ----------------------------------------------------------------------------------

START_TEST(pairwise_is_every_object_against_every_occluder)
{
    crowd c;
    make_crowd(&c, (uint64_t)_i + 1);
    occ_scene *scene = scene_of(&c, 0);
    occ_view *view = world_view(OCC_BACKEND_PLAIN, 0);
    occ_cull_desc knobs = world_knobs(OCC_METHOD_PAIRWISE);
    for (uint32_t n = 0; n < CAMERAS; n++) {
        occ_camera_desc camera = camera_of(n);
        force f;
        uint32_t hidden = 0;
        use_force(&c, &camera, NULL, &f);
        kit_cull(view, scene, &camera, &knobs);
        for (uint32_t i = 0; i < c.object_count; i++) {
            ck_assert_msg(world_sees(view, i) == !(f.outside[i] || f.hidden[i]), "object %u", i);
            hidden += f.hidden[i] && !f.outside[i];
        }
        ck_assert_uint_gt(hidden, 20);
        nothing_is_false(&c, &camera, view);
    }
    occ_view_destroy(view);
    occ_scene_destroy(scene);
}
END_TEST

// What a node's test proves of all its objects may lie within the error bound of their own tests,
// and only there may the two differ: the walk leaves out what the judge says is out of sight.
START_TEST(single_is_every_object_against_the_occluders_that_it_chose)
{
    crowd c;
    make_crowd(&c, (uint64_t)_i + 1);
    occ_scene *scene = scene_of(&c, 4);
    occ_view *view = world_view(OCC_BACKEND_PLAIN, 0);
    occ_cull_desc knobs = world_knobs(OCC_METHOD_SINGLE);
    uint32_t at_the_bound = 0, hidden = 0;
    for (uint32_t n = 0; n < CAMERAS; n++) {
        occ_camera_desc camera = camera_of(n);
        bool used[OCCLUDERS];
        force f;
        kit_cull(view, scene, &camera, &knobs);
        read_used(view, used, c.occluder_count);
        use_force(&c, &camera, used, &f);
        for (uint32_t i = 0; i < c.object_count; i++) {
            bool forced = f.outside[i] || f.hidden[i];
            ck_assert_msg(!forced || !world_sees(view, i), "object %u is seen by the walk", i);
            at_the_bound += !forced && !world_sees(view, i);
            hidden += f.hidden[i];
        }
        nothing_is_false(&c, &camera, view);
    }
    ck_assert_uint_gt(hidden, 100);
    ck_assert_uint_le(at_the_bound, 3);
    occ_view_destroy(view);
    occ_scene_destroy(scene);
}
END_TEST

START_TEST(pairwise_hides_all_that_single_hides_and_single_all_that_frustum_leaves_out)
{
    crowd c;
    make_crowd(&c, (uint64_t)_i + 1);
    occ_scene *scene = scene_of(&c, 0);
    occ_view *views[3];
    const occ_method methods[3] = {OCC_METHOD_FRUSTUM, OCC_METHOD_SINGLE, OCC_METHOD_PAIRWISE};
    for (int m = 0; m < 3; m++)
        views[m] = world_view(OCC_BACKEND_PLAIN, 0);
    for (uint32_t n = 0; n < CAMERAS; n++) {
        occ_camera_desc camera = camera_of(n);
        oracle *judge = oracle_of_camera(&camera);
        for (int m = 0; m < 3; m++) {
            occ_cull_desc knobs = world_knobs(methods[m]);
            kit_cull(views[m], scene, &camera, &knobs);
        }
        for (uint32_t i = 0; i < c.object_count; i++) {
            bool seen[3] = {world_sees(views[0], i), world_sees(views[1], i),
                            world_sees(views[2], i)};
            ck_assert_msg(seen[0] || !seen[1], "object %u is outside and seen", i);
            ck_assert_msg(seen[1] || !seen[2] || may_be_left_out(&c, judge, i), "object %u", i);
            if (!seen[0]) ck_assert(oracle_outside(judge, &c.objects[i]));
        }
        uint32_t frustum = count_seen(&c, views[0]), single = count_seen(&c, views[1]);
        ck_assert_uint_gt(frustum, single);
        ck_assert_uint_ge(single + 3, count_seen(&c, views[2]));
        oracle_free(judge);
    }
    for (int m = 0; m < 3; m++)
        occ_view_destroy(views[m]);
    occ_scene_destroy(scene);
}
END_TEST

// --- knobs ---------------------------------------------------------------------------------------

START_TEST(no_knob_hides_what_can_be_seen)
{
    static const occ_cull_desc knobs[] = {{.grain = 1},
                                          {.grain = 100000},
                                          {.min_area = 1e-30f},
                                          {.min_area = 0.1f},
                                          {.max_occluders = 1},
                                          {.max_occluders = 5},
                                          {.min_area = 1e30f},
                                          {.grain = 2},
                                          {.min_area = 1e-30f, .max_occluders = 1000, .grain = 1}};
    static const uint32_t leaves[] = {1, 1024};
    crowd c;
    make_crowd(&c, 7);
    occ_view *view = world_view(OCC_BACKEND_PLAIN, 0);
    for (int l = 0; l < 2; l++) {
        occ_scene *scene = scene_of(&c, leaves[l]);
        for (size_t k = 0; k < sizeof knobs / sizeof *knobs; k++) {
            occ_camera_desc camera = camera_of((uint32_t)k % CAMERAS);
            occ_cull_desc single = knobs[k]; // the oracle knows one occluder at a time
            single.method = OCC_METHOD_SINGLE;
            kit_cull(view, scene, &camera, &single);
            nothing_is_false(&c, &camera, view);
        }
        occ_scene_destroy(scene);
    }
    occ_view_destroy(view);
}
END_TEST

START_TEST(the_knobs_do_what_they_say)
{
    crowd c;
    make_crowd(&c, 8);
    occ_scene *scene = scene_of(&c, 0);
    occ_view *view = world_view(OCC_BACKEND_PLAIN, 0);
    occ_camera_desc camera = camera_of(0);
    occ_view_stats all, stats;
    occ_cull_desc knobs = world_knobs(OCC_METHOD_SINGLE);
    kit_cull(view, scene, &camera, &knobs);
    ck_assert_int_eq(occ_view_get_stats(view, &all), OCC_SUCCESS);
    knobs.max_occluders = 3;
    kit_cull(view, scene, &camera, &knobs);
    ck_assert_int_eq(occ_view_get_stats(view, &stats), OCC_SUCCESS);
    ck_assert_uint_eq(stats.occluders_used, 3);
    ck_assert_uint_gt(all.occluders_used, 3);
    ck_assert_uint_ge(stats.visible, all.visible);
    knobs = world_knobs(OCC_METHOD_SINGLE);
    knobs.min_area = 1e30f;
    kit_cull(view, scene, &camera, &knobs);
    ck_assert_int_eq(occ_view_get_stats(view, &stats), OCC_SUCCESS);
    ck_assert_uint_eq(stats.occluders_used, 0);
    knobs = world_knobs(OCC_METHOD_SINGLE);
    knobs.grain = 100000; // the root is small enough
    kit_cull(view, scene, &camera, &knobs);
    ck_assert_int_eq(occ_view_get_stats(view, &stats), OCC_SUCCESS);
    ck_assert_uint_eq(stats.tested, OBJECTS);
    occ_view_destroy(view);
    occ_scene_destroy(scene);
}
END_TEST

// --- edits of the occluders ----------------------------------------------------------------------

START_TEST(one_occluder_more_shows_nothing_and_one_less_hides_nothing)
{
    static crowd c;
    make_crowd(&c, 9);
    occ_view *more = world_view(OCC_BACKEND_PLAIN, 0), *less = world_view(OCC_BACKEND_PLAIN, 0);
    occ_cull_desc knobs = world_knobs(OCC_METHOD_PAIRWISE);
    occ_camera_desc camera = camera_of(1);
    uint32_t differences = 0;
    for (c.occluder_count = 1; c.occluder_count < OCCLUDERS; c.occluder_count++) {
        occ_scene *scene = scene_of(&c, 0);
        kit_cull(less, scene, &camera, &knobs);
        occ_scene_destroy(scene);
        c.occluder_count++;
        scene = scene_of(&c, 0);
        c.occluder_count--;
        kit_cull(more, scene, &camera, &knobs);
        occ_scene_destroy(scene);
        for (uint32_t i = 0; i < c.object_count; i++) {
            ck_assert_msg(world_sees(less, i) || !world_sees(more, i), "object %u", i);
            differences += world_sees(less, i) && !world_sees(more, i);
        }
    }
    ck_assert_uint_gt(differences, 0);
    occ_view_destroy(more);
    occ_view_destroy(less);
}
END_TEST

// A wall hides a whole node; the object in it that owns the wall stays, its neighbours go.
START_TEST(an_owner_is_never_hidden_by_its_own_not_even_with_its_node)
{
    static const occ_method methods[] = {OCC_METHOD_SINGLE, OCC_METHOD_PAIRWISE};
    occ_box objects[40];
    for (int i = 0; i < 40; i++) {
        int column = i % 7, line = i / 7;
        objects[i] = kit_cube(0.01f * (float)column, 0.01f * (float)line, -50, 0.5f);
    }
    world_occluder wall = {{{0, 0, -20}, {{9, 0, 0}, {0, 9, 0}, {0, 0, 0.1f}}}, 0};
    occ_camera_desc camera = kit_look((float[3]){0, 0, 0}, (float[3]){0, 0, -1});
    occ_view *view = world_view(OCC_BACKEND_PLAIN, 0);
    for (wall.owner = -1; wall.owner < 40; wall.owner++) {
        occ_scene *scene = world_scene(objects, 40, &wall, 1, 1 + (uint32_t)(wall.owner + 1) % 5);
        for (int m = 0; m < 2; m++) {
            occ_cull_desc knobs = world_knobs(methods[m]);
            knobs.grain = 1;
            kit_cull(view, scene, &camera, &knobs);
            for (uint32_t i = 0; i < 40; i++)
                ck_assert_msg(world_sees(view, i) == (wall.owner == (int)i), "object %u of %d", i,
                              wall.owner);
        }
        occ_scene_destroy(scene);
    }
    occ_view_destroy(view);
}
END_TEST

// Two objects stand in each other's shadow and own what casts it on the other.
START_TEST(an_owner_is_hidden_by_what_others_own)
{
    const occ_box objects[2] = {kit_cube(0, 0, -50, 0.5f), kit_cube(0, 0, -51.5f, 0.5f)};
    const world_occluder walls[2] = {{{{0, 0, -20}, {{9, 0, 0}, {0, 9, 0}, {0, 0, 0.1f}}}, 0},
                                     {{{0, 0, -30}, {{9, 0, 0}, {0, 9, 0}, {0, 0, 0.1f}}}, 1}};
    occ_camera_desc camera = kit_look((float[3]){0, 0, 0}, (float[3]){0, 0, -1});
    occ_view *view = world_view(OCC_BACKEND_PLAIN, 0);
    occ_scene *scene = world_scene(objects, 2, walls, 2, 0);
    occ_cull_desc knobs = world_knobs(OCC_METHOD_PAIRWISE);
    kit_cull(view, scene, &camera, &knobs);
    ck_assert(!world_sees(view, 0) && !world_sees(view, 1));
    // The walk does not use the second wall, which the first one hides. It may miss, never lie.
    knobs = world_knobs(OCC_METHOD_SINGLE);
    kit_cull(view, scene, &camera, &knobs);
    ck_assert(world_sees(view, 0) && !world_sees(view, 1));
    occ_scene_destroy(scene);
    occ_view_destroy(view);
}
END_TEST

// --- scale ---------------------------------------------------------------------------------------

static occ_camera_desc scaled_camera(const occ_camera_desc *camera, float factor)
{
    occ_camera_desc scaled = *camera;
    for (int i = 0; i < 12; i++)
        scaled.view_projection[i] /= factor;
    return scaled;
}

START_TEST(a_scene_and_its_camera_times_a_power_of_two_look_the_same)
{
    static crowd c, scaled;
    static const occ_method methods[] = {OCC_METHOD_SINGLE, OCC_METHOD_PAIRWISE,
                                         OCC_METHOD_FRUSTUM};
    make_crowd(&c, 10);
    float factor = ldexpf(1.0f, 6 * _i);
    scaled = c;
    for (int i = 0; i < OBJECTS; i++)
        scaled.objects[i] = world_scaled(&c.objects[i], factor);
    for (int k = 0; k < OCCLUDERS; k++)
        scaled.occluders[k].box = world_scaled(&c.occluders[k].box, factor);
    occ_scene *scenes[2] = {scene_of(&c, 8), scene_of(&scaled, 8)};
    occ_view *views[2] = {world_view(OCC_BACKEND_PLAIN, 0), world_view(OCC_BACKEND_PLAIN, 0)};
    for (uint32_t n = 0; n < CAMERAS * 3; n++) {
        occ_camera_desc camera = camera_of(n % CAMERAS);
        occ_camera_desc other = scaled_camera(&camera, factor);
        occ_cull_desc knobs = world_knobs(methods[n / CAMERAS]);
        knobs.min_area = 1e-4f;
        kit_cull(views[0], scenes[0], &camera, &knobs);
        kit_cull(views[1], scenes[1], &other, &knobs);
        ck_assert_msg(kit_same_masks(views[0], views[1]), "camera %u", n);
    }
    for (int i = 0; i < 2; i++) {
        occ_view_destroy(views[i]);
        occ_scene_destroy(scenes[i]);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("cull");
    TCase *identities = tcase_create("identities");
    tcase_add_loop_test(identities, pairwise_is_every_object_against_every_occluder, 0, CROWDS);
    tcase_add_loop_test(identities, single_is_every_object_against_the_occluders_that_it_chose, 0,
                        CROWDS);
    tcase_add_loop_test(identities,
                        pairwise_hides_all_that_single_hides_and_single_all_that_frustum_leaves_out,
                        0, CROWDS);
    suite_add_tcase(suite, identities);
    TCase *knobs = tcase_create("knobs");
    tcase_add_test(knobs, no_knob_hides_what_can_be_seen);
    tcase_add_test(knobs, the_knobs_do_what_they_say);
    suite_add_tcase(suite, knobs);
    TCase *occluders = tcase_create("occluders");
    tcase_add_test(occluders, one_occluder_more_shows_nothing_and_one_less_hides_nothing);
    tcase_add_test(occluders, an_owner_is_never_hidden_by_its_own_not_even_with_its_node);
    tcase_add_test(occluders, an_owner_is_hidden_by_what_others_own);
    suite_add_tcase(suite, occluders);
    TCase *scale = tcase_create("scale");
    tcase_add_loop_test(scale, a_scene_and_its_camera_times_a_power_of_two_look_the_same, -4, 5);
    suite_add_tcase(suite, scale);
    return test_run_suite(suite);
}
