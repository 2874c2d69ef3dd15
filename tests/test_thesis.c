// SPDX-License-Identifier: Apache-2.0
// labels: unit oracle
// The checks of the 2019 thesis (thesis.h), restated over identities: which object is in
// which node, which object is hidden. And what its occlusion test gets wrong, as scenes in which it
// gives the wrong objects while every method of the library gives those of the exact judge.
#include "kit_obs.h"
#include "obs.h"
#include "oracle.h"
#include "scenes.h"
#include "support.h"
#include "thesis.h"
#include "vis.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// --- verdicts ------------------------------------------------------------------------------------

enum { MOST_OBJECTS = 512 };

typedef struct verdicts {
    uint32_t word[OCC_MASK_WORDS(MOST_OBJECTS)];
} verdicts;

static bool sees(const verdicts *v, uint32_t object)
{
    return v->word[object / 32] >> object % 32 & 1u;
}

static bool same(const verdicts *a, const verdicts *b)
{
    return !memcmp(a, b, sizeof *a);
}

static uint32_t count(const verdicts *v)
{
    uint32_t sum = 0;
    for (uint32_t i = 0; i < MOST_OBJECTS; i++)
        sum += sees(v, i);
    return sum;
}

// How many objects the first sees that the second does not.
static uint32_t count_only(const verdicts *a, const verdicts *b)
{
    uint32_t sum = 0;
    for (uint32_t i = 0; i < MOST_OBJECTS; i++)
        sum += sees(a, i) && !sees(b, i);
    return sum;
}

// Visible: not outside of the frustum, and hidden by no single occluder of another object.
static verdicts truth_of(const obs_scene *world, uint32_t frame)
{
    double eye[3];
    occ_camera_desc camera = kit_obs_camera(&world->frames[frame], eye);
    oracle *judge = oracle_of_camera(&camera);
    ck_assert_ptr_nonnull(judge);
    verdicts v = {{0}};
    for (uint32_t i = 0; i < world->object_count; i++) {
        bool visible = !oracle_outside(judge, &world->objects[i]);
        for (uint32_t k = 0; k < world->occluder_count && visible; k++) {
            const obs_occluder *occluder = &world->occluders[k];
            if (occluder->owner == i) continue;
            visible = oracle_box(judge, &world->objects[i], &occluder->box) != ORACLE_HIDDEN;
        }
        v.word[i / 32] |= (uint32_t)visible << i % 32;
    }
    oracle_free(judge);
    return v;
}

// As if every object were larger by a hundred-thousandth.
static verdicts grown_truth(const obs_scene *world, uint32_t frame)
{
    obs_scene grown = *world;
    grown.objects = calloc(world->object_count, sizeof *grown.objects);
    ck_assert_ptr_nonnull(grown.objects);
    for (uint32_t i = 0; i < world->object_count; i++)
        grown.objects[i] = scenes_shrunk(&world->objects[i], 1.00001, 1.00001, 1.00001);
    verdicts v = truth_of(&grown, frame);
    free(grown.objects);
    return v;
}

static verdicts thesis_of(const obs_scene *world, uint32_t frame)
{
    verdicts v = {{0}};
    thesis_cull(world, &world->frames[frame], v.word);
    return v;
}

// What all methods of the library agree on for a frame, one after another in the same view.
static verdicts ours_of(const obs_scene *world, uint32_t frame)
{
    static const occ_view_desc desc = {.backend = OCC_BACKEND_PLAIN};
    occ_scene *built = kit_obs_scene(world, NULL, NULL, NULL);
    occ_view *view = NULL;
    ck_assert_int_eq(occ_view_create(&desc, &view), OCC_SUCCESS);
    verdicts v[2] = {{{0}}, {{0}}};
    for (uint32_t f = 0; f <= frame; f++) { // what it saw before must not matter
        double eye[3];
        occ_camera_desc camera = kit_obs_camera(&world->frames[f], eye);
        for (int i = 0; i < 2; i++) {
            occ_cull_desc knobs = {.method = i ? OCC_METHOD_PAIRWISE : OCC_METHOD_SINGLE,
                                   .min_area = 1e-30f};
            size_t words;
            kit_cull(view, built, &camera, &knobs);
            ck_assert_int_eq(
                occ_view_read_mask(view, v[i].word, OCC_MASK_WORDS(MOST_OBJECTS), &words),
                OCC_SUCCESS);
        }
    }
    ck_assert_msg(same(&v[0], &v[1]), "single and pairwise give different objects");
    occ_view_destroy(view);
    occ_scene_destroy(built);
    return v[0];
}

// --- worlds --------------------------------------------------------------------------------------

// An object that is solid through and through: its bounds are its occluder.
static uint32_t add_solid(obs_scene *world, double x, double y, double z, double half_x,
                          double half_y, double half_z)
{
    occ_box box = scenes_box(x, y, z, half_x, half_y, half_z);
    uint32_t object = obs_add_object(world, &box);
    obs_add_occluder(world, &box, object);
    return object;
}

static void look(obs_scene *world, double x, double y, double z)
{
    const double eye[3] = {0, 0, 0}, direction[3] = {x, y, z};
    obs_frame frame = obs_look(eye, direction, 1.7320508, 16.0 / 9.0, 0.1, 1000);
    obs_add_frame(world, &frame);
}

// The thesis's own scene, its cubes solid, in units of its choice.
static obs_scene crowd(double scale)
{
    obs_scene made, world = {0};
    ck_assert(scenes_make("seedscene", 200, 6, &made));
    for (uint32_t i = 0; i < made.object_count; i++) {
        const occ_box *box = &made.objects[i];
        double half = scale * (double)box->axis[0][0];
        add_solid(&world, scale * (double)box->center[0], scale * (double)box->center[1],
                  scale * (double)box->center[2], half, half, half);
    }
    obs_free(&made);
    const double eye[3] = {-20 * scale, -20 * scale, -20 * scale}, diagonal[3] = {1, 1, 1};
    obs_frame frame = obs_look(eye, diagonal, 1.7320508, 16.0 / 9.0, 0.1 * scale, 400 * scale);
    obs_add_frame(&world, &frame);
    return world;
}

// --- its check of occlusion ----------------------------------------------------------------------

// Up to what lies in the very surface of an occluder, which stays visible.
START_TEST(exactly_the_objects_that_one_other_hides_are_hidden)
{
    obs_scene world;
    ck_assert(scenes_make(scenes_kinds[_i].name, 200, 8, &world));
    ck_assert_uint_le(world.object_count, MOST_OBJECTS);
    verdicts ours = ours_of(&world, 0), truth = truth_of(&world, 0), grown = grown_truth(&world, 0);
    ck_assert_uint_gt(count(&truth), 0);
    ck_assert_uint_lt(count(&grown), world.object_count);
    ck_assert_msg(count_only(&truth, &ours) == 0, "%u hidden wrongly", count_only(&truth, &ours));
    ck_assert_msg(count_only(&ours, &grown) == 0, "%u missed", count_only(&ours, &grown));
    ck_assert_uint_le(count_only(&grown, &truth), world.object_count / 100);
    obs_free(&world);
}
END_TEST

// --- its failures --------------------------------------------------------------------------------

START_TEST(small_units_hide_what_is_visible_in_the_thesis_but_not_here)
{
    obs_scene metres = crowd(1), small = crowd(0.01);
    verdicts truth = truth_of(&metres, 0), thesis = thesis_of(&metres, 0);
    verdicts small_truth = truth_of(&small, 0), small_thesis = thesis_of(&small, 0);
    verdicts ours = ours_of(&metres, 0), small_ours = ours_of(&small, 0);
    ck_assert(same(&truth, &small_truth));
    ck_assert(same(&ours, &truth) && same(&small_ours, &truth));
    ck_assert_uint_gt(count(&truth), 10);
    ck_assert_uint_lt(4 * count_only(&truth, &thesis), count(&truth)); // in metres it mostly works
    ck_assert_uint_gt(10 * count_only(&truth, &small_thesis), 9 * count(&truth));
    obs_free(&metres);
    obs_free(&small);
}
END_TEST

START_TEST(large_units_show_what_is_hidden_in_the_thesis_but_not_here)
{
    obs_scene metres = crowd(1), large = crowd(100);
    verdicts truth = truth_of(&metres, 0), thesis = thesis_of(&metres, 0);
    verdicts large_truth = truth_of(&large, 0), large_thesis = thesis_of(&large, 0);
    verdicts ours = ours_of(&metres, 0), large_ours = ours_of(&large, 0);
    ck_assert(same(&truth, &large_truth));
    ck_assert(same(&ours, &truth) && same(&large_ours, &truth));
    ck_assert_uint_eq(count_only(&thesis, &truth), 0); // in metres it misses nothing
    ck_assert_uint_gt(count_only(&large_thesis, &truth), 20);
    obs_free(&metres);
    obs_free(&large);
}
END_TEST

START_TEST(a_wall_behind_the_camera_hides_in_the_thesis_but_not_here)
{
    obs_scene world = {0};
    uint32_t ahead = add_solid(&world, 0, 0, -10, 0.5, 0.5, 0.5);
    uint32_t wall = add_solid(&world, 0, 0, 5, 3, 3, 0.5);
    look(&world, 0, 0, -1);
    verdicts truth = truth_of(&world, 0), ours = ours_of(&world, 0), thesis = thesis_of(&world, 0);
    ck_assert(sees(&truth, ahead) && !sees(&truth, wall));
    ck_assert(same(&ours, &truth));
    ck_assert_msg(!sees(&thesis, ahead), "the thesis is right");
    obs_free(&world);
}
END_TEST

START_TEST(a_box_that_pokes_out_is_hidden_in_the_thesis_but_not_here)
{
    obs_scene world = {0};
    add_solid(&world, 0, 0, -4, 0.1, 0.1, 0.01);
    uint32_t poking = add_solid(&world, 0.08, 0, -4.1, 0.05, 0.05, 0.05); // by 0.03
    uint32_t within = add_solid(&world, 0.04, 0, -4.3, 0.05, 0.05, 0.05);
    look(&world, 0, 0, -1);
    verdicts truth = truth_of(&world, 0), ours = ours_of(&world, 0), thesis = thesis_of(&world, 0);
    ck_assert(sees(&truth, poking) && !sees(&truth, within));
    ck_assert(same(&ours, &truth));
    ck_assert_msg(!sees(&thesis, poking), "the thesis is right");
    obs_free(&world);
}
END_TEST

START_TEST(the_bounds_of_a_ball_hide_in_the_thesis_but_not_here)
{
    const double inscribed = 1 / sqrt(3.0);
    obs_scene world = {0};
    occ_box bounds = scenes_box(0, 0, -5, 1, 1, 1);
    uint32_t ball = obs_add_object(&world, &bounds);
    occ_box solid = scenes_shrunk(&bounds, inscribed, inscribed, inscribed);
    obs_add_occluder(&world, &solid, ball);
    uint32_t beside = add_solid(&world, 1.26, 1.26, -7, 0.05, 0.05, 0.05);
    uint32_t behind = add_solid(&world, 0, 0, -7, 0.05, 0.05, 0.05);
    look(&world, 0, 0, -1);
    // The line from the eye, the origin, to the middle of `beside` passes the ball of radius 1.
    const double sight = sqrt(2 * 1.26 * 1.26 + 7 * 7), offset = sqrt(2.0) * 1.26 * 5;
    ck_assert(offset / sight > 1.0);
    verdicts truth = truth_of(&world, 0), ours = ours_of(&world, 0), thesis = thesis_of(&world, 0);
    ck_assert(sees(&truth, beside) && !sees(&truth, behind));
    ck_assert(same(&ours, &truth));
    ck_assert_msg(!sees(&thesis, beside), "the thesis is right");
    obs_free(&world);
}
END_TEST

START_TEST(turning_in_place_gives_a_stale_answer_in_the_thesis_but_not_here)
{
    obs_scene world = {0};
    uint32_t ahead = add_solid(&world, 0, 0, -10, 1, 1, 1);
    uint32_t aback = add_solid(&world, 4, 0, 10, 1, 1, 1);
    look(&world, 0, 0, -1);
    look(&world, 0, 0, 1);
    verdicts truth = truth_of(&world, 1), remembered = {{0}}, fresh = {{0}};
    ck_assert(!sees(&truth, ahead) && sees(&truth, aback));
    thesis_memory memory = {.holds = false};
    thesis_cull_remembered(&memory, &world, &world.frames[0], remembered.word);
    thesis_frustum(&world, &world.frames[1], fresh.word);
    ck_assert(sees(&remembered, ahead) && !sees(&remembered, aback));
    thesis_cull_remembered(&memory, &world, &world.frames[1], remembered.word);
    ck_assert_msg(sees(&remembered, ahead) && !sees(&remembered, aback), "the thesis is right");
    ck_assert_msg(same(&fresh, &truth), "so it is not the turned camera that it gets wrong");
    verdicts ours = ours_of(&world, 1);
    ck_assert(same(&ours, &truth));
    obs_free(&world);
}
END_TEST

// The thesis compares numbers of objects. Here it hides one too many and one too few.
START_TEST(equal_counts_of_different_objects_are_told_apart)
{
    obs_scene world = {0};
    uint32_t ahead = add_solid(&world, 0, 0, -10, 0.5, 0.5, 0.5);
    add_solid(&world, 0, 0, 5, 1, 1, 0.5); // behind the camera
    occ_box front = scenes_box(0, 0, -50, 2000, 2000, 1);
    front = scenes_turned(&front, 0.01); // large, and no round numbers
    obs_add_occluder(&world, &front, obs_add_object(&world, &front));
    uint32_t beyond = add_solid(&world, 30, 7, -60, 0.5, 0.5, 0.5);
    look(&world, 0, 0, -1);
    verdicts truth = truth_of(&world, 0), ours = ours_of(&world, 0), thesis = thesis_of(&world, 0);
    ck_assert(sees(&truth, ahead) && !sees(&truth, beyond));
    ck_assert(!sees(&thesis, ahead) && sees(&thesis, beyond));
    ck_assert_uint_eq(count(&thesis), count(&truth));
    vis_result stored;
    ck_assert(vis_create(&stored, world.object_count, 1));
    vis_set_frame(&stored, 0, truth.word);
    ck_assert_uint_eq(vis_differences(&stored, 0, thesis.word), 2);
    ck_assert_uint_eq(vis_differences(&stored, 0, ours.word), 0);
    vis_free(&stored);
    obs_free(&world);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("thesis");
    TCase *occlusion = tcase_create("occlusion");
    tcase_add_loop_test(occlusion, exactly_the_objects_that_one_other_hides_are_hidden, 0, 5);
    suite_add_tcase(suite, occlusion);

    TCase *failures = tcase_create("failures");
    tcase_add_test(failures, small_units_hide_what_is_visible_in_the_thesis_but_not_here);
    tcase_add_test(failures, large_units_show_what_is_hidden_in_the_thesis_but_not_here);
    tcase_add_test(failures, a_wall_behind_the_camera_hides_in_the_thesis_but_not_here);
    tcase_add_test(failures, a_box_that_pokes_out_is_hidden_in_the_thesis_but_not_here);
    tcase_add_test(failures, the_bounds_of_a_ball_hide_in_the_thesis_but_not_here);
    tcase_add_test(failures, turning_in_place_gives_a_stale_answer_in_the_thesis_but_not_here);
    tcase_add_test(failures, equal_counts_of_different_objects_are_told_apart);
    suite_add_tcase(suite, failures);
    return test_run_suite(suite);
}
