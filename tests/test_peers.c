// SPDX-License-Identifier: Apache-2.0
// labels: unit
// The peers on Embree (peer.h): they hide what is plainly hidden and show what is plainly
// seen, so that the comparison is fair; and they hide what can be seen in exactly the places where
// such methods do, so that they are not improved in silence.
#include "kit_obs.h"
#include "obs.h"
#include "peer.h"
#include "scenes.h"
#include "support.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const names[] = {"embree-depth", "embree-rays"};
enum { PEERS = 2, TURNS = 4, DEPTH = 0, RAYS = 1 };

// --- what a peer says ----------------------------------------------------------------------------

// All masks of a scene's frames, one after another; memory to free().
static uint32_t *masks_of(const obs_scene *world, int which, const peer_options *options)
{
    static const peer_options usual = {.threads = 1, .rays_width = 85, .rays_height = 48};
    const peer_method *peer = peer_find(names[which]);
    ck_assert(peer && !peer->missing);
    peer_info info = {0};
    void *state = peer->open(world, options ? options : &usual, &info);
    ck_assert_ptr_nonnull(state);
    ck_assert(strncmp(info.driver, "Embree 3.", 9) == 0 && info.bytes > 0);
    size_t words = OCC_MASK_WORDS(world->object_count);
    uint32_t *masks = calloc(words * world->frame_count + 1, sizeof *masks);
    ck_assert_ptr_nonnull(masks);
    for (uint32_t f = 0; f < world->frame_count; f++) {
        occ_view_stats stats = {0};
        peer->cull(state, &world->frames[f], masks + f * words, &stats);
        ck_assert_uint_le(stats.tested, world->object_count);
    }
    peer->close(state);
    return masks;
}

// Bit i: object i of up to 32 is shown in the only frame.
static uint32_t shown(const obs_scene *world, int which, const peer_options *options)
{
    ck_assert(world->object_count <= 32 && world->frame_count == 1);
    uint32_t *masks = masks_of(world, which, options), mask = masks[0];
    free(masks);
    return mask;
}

static uint32_t bit(uint32_t object)
{
    return UINT32_C(1) << object;
}

// --- small worlds --------------------------------------------------------------------------------

// The eye is somewhere and looks in one of four directions. Boxes are given as seen from it: x to
// the right, y up, z ahead.
typedef struct sight {
    obs_scene world;
    int turn;
} sight;

static const double eye[3] = {10, -3, 7};

static occ_box box_of(const sight *s, double x, double y, double z, double half_x, double half_y,
                      double half_z)
{
    double cosine[] = {1, 0, -1, 0}, sine[] = {0, 1, 0, -1}, c = cosine[s->turn], d = sine[s->turn];
    return scenes_box(eye[0] + c * x + d * z, eye[1] + y, eye[2] + d * x - c * z,
                      fabs(c * half_x + d * half_z), half_y, fabs(d * half_x + c * half_z));
}

static uint32_t add_object(sight *s, double x, double y, double z, double half)
{
    occ_box box = box_of(s, x, y, z, half, half, half);
    return obs_add_object(&s->world, &box);
}

// A thin upright wall, part of an object of its own.
static uint32_t add_wall(sight *s, double left, double right, double z, double half_height)
{
    occ_box box = box_of(s, (left + right) / 2, 0, z, (right - left) / 2, half_height, 0.01);
    uint32_t object = obs_add_object(&s->world, &box);
    obs_add_occluder(&s->world, &box, object);
    return object;
}

static sight look(int turn)
{
    const double directions[TURNS][3] = {{0, 0, -1}, {1, 0, 0}, {0, 0, 1}, {-1, 0, 0}};
    sight s = {.turn = turn};
    obs_frame frame = obs_look(eye, directions[turn], 1.7320508, 16.0 / 9.0, 0.1, 1000);
    obs_add_frame(&s.world, &frame);
    return s;
}

// Every test of a peer runs so many times.
enum { VIEWS = PEERS * TURNS };

START_TEST(a_wall_hides_what_is_behind_it_and_nothing_else)
{
    sight s = look(_i % TURNS);
    uint32_t wall = add_wall(&s, -2, 2, 5, 2), behind = add_object(&s, 0, 0, 10, 0.5);
    uint32_t far_behind = add_object(&s, 1, 1, 100, 2), beside = add_object(&s, 6, 0, 10, 0.5);
    uint32_t above = add_object(&s, 0, 4.8, 10, 0.4), before = add_object(&s, 0, 0, 3, 0.3);
    uint32_t aback = add_object(&s, 0, 0, -10, 0.5), poking = add_object(&s, 4, 0, 10, 0.6);
    uint32_t mask = shown(&s.world, _i / TURNS, NULL);
    ck_assert_msg(!(mask & bit(behind)) && !(mask & bit(far_behind)), "the wall does not hide");
    ck_assert_msg(!(mask & bit(aback)), "behind the camera is in the frustum");
    ck_assert_uint_eq(mask, bit(wall) | bit(beside) | bit(above) | bit(before) | bit(poking));
    obs_free(&s.world);
}
END_TEST

// A window of six corners as seen from the eye, counterclockwise or clockwise.
static void add_window(sight *s, occ_sides sides, bool is_turned, uint32_t owner)
{
    static const double xy[6][2] = {{2, 0}, {1, 2}, {-1, 2}, {-2, 0}, {-1, -2}, {1, -2}};
    occ_sheet sheet = {.corner_count = 6, .sides = sides};
    for (int c = 0; c < 6; c++) {
        const double *at = xy[is_turned ? 5 - c : c];
        occ_box point = box_of(s, at[0], at[1], 5, 0, 0, 0);
        memcpy(sheet.corner[c], point.center, sizeof sheet.corner[c]);
    }
    obs_add_sheet(&s->world, &sheet, owner);
}

START_TEST(a_sheet_hides_from_the_sides_that_it_has)
{
    for (int is_turned = 0; is_turned < 2; is_turned++)
        for (int sides = OCC_SIDES_BOTH; sides <= OCC_SIDES_FRONT; sides++) {
            sight s = look(_i % TURNS);
            uint32_t owner = add_object(&s, 0, 0, -20, 0.5), behind = add_object(&s, 0, 0, 10, 0.5);
            uint32_t corner = add_object(&s, 3.5, 3.5, 10, 0.4); // beside one of six edges
            add_window(&s, (occ_sides)sides, is_turned, owner);
            uint32_t mask = shown(&s.world, _i / TURNS, NULL);
            bool is_seen = sides == OCC_SIDES_FRONT && is_turned;
            ck_assert_uint_eq(mask, bit(corner) | (is_seen ? bit(behind) : 0));
            obs_free(&s.world);
        }
}
END_TEST

START_TEST(up_is_up)
{
    sight s = look(_i % TURNS);
    occ_box box = box_of(&s, 0, 1, 5, 2, 2, 0.01); // at z = 10 from -2 to 6
    uint32_t wall = obs_add_object(&s.world, &box);
    obs_add_occluder(&s.world, &box, wall);
    uint32_t high = add_object(&s, 0, 4.5, 10, 0.5), low = add_object(&s, 0, -4.5, 10, 0.5);
    uint32_t mask = shown(&s.world, _i / TURNS, NULL);
    ck_assert_msg(!(mask & bit(high)), "the wall does not hide");
    ck_assert_uint_eq(mask, bit(wall) | bit(low));
    obs_free(&s.world);
}
END_TEST

START_TEST(what_lies_in_a_surface_is_shown)
{
    sight s = look(_i % TURNS);
    uint32_t wall = add_wall(&s, -2, 2, 5, 2);
    occ_box flat = box_of(&s, 0.3, 0.2, 4.99, 0.5, 0.5, 0);
    uint32_t decal = obs_add_object(&s.world, &flat);
    ck_assert_uint_eq(shown(&s.world, _i / TURNS, NULL), bit(wall) | bit(decal));
    obs_free(&s.world);
}
END_TEST

// It passes below the eye. Walls stand before its far corners and, behind the camera, before the
// others.
START_TEST(an_object_that_reaches_behind_the_camera_is_shown)
{
    sight s = look(_i % TURNS);
    occ_box floor = box_of(&s, 0, -2, 7.5, 2, 1, 12.5);
    uint32_t object = obs_add_object(&s.world, &floor);
    add_wall(&s, -3, 3, 6, 3);
    add_wall(&s, -5, 5, -2, 5);
    ck_assert_msg(shown(&s.world, _i / TURNS, NULL) & bit(object), "the floor is hidden");
    obs_free(&s.world);
}
END_TEST

START_TEST(an_object_is_not_hidden_by_its_own_occluder)
{
    sight s = look(_i % TURNS);
    occ_box bounds = box_of(&s, 0.3, 0.2, 8, 1, 1, 1);
    uint32_t solid = obs_add_object(&s.world, &bounds);
    obs_add_occluder(&s.world, &bounds, solid); // flush with its bounds
    uint32_t behind = add_object(&s, 0.3, 0.2, 11, 0.5);
    uint32_t mask = shown(&s.world, _i / TURNS, NULL);
    ck_assert_msg(mask & bit(solid), "an occluder flush with its object hides it");
    ck_assert_msg(!(mask & bit(behind)), "it hides nothing else either");
    obs_free(&s.world);
}
END_TEST

// From 0.31 at z = 5 on, the walls stand before the corners of its front. Those of its back are
// seen at 0.21 between the walls, where only its own occluder is before them.
START_TEST(an_own_occluder_does_not_help_the_others)
{
    for (int owned = 0; owned < 2; owned++) {
        sight s = look(_i % TURNS);
        occ_box bounds = box_of(&s, 0, 0, 10, 0.5, 0.5, 2),
                inner = box_of(&s, 0, 0, 10, 0.4, 0.4, 1);
        uint32_t object = obs_add_object(&s.world, &bounds), other = add_object(&s, 0, 0, 10, 1);
        obs_add_occluder(&s.world, &inner, owned ? object : other);
        add_wall(&s, -3, -0.26, 5, 3);
        add_wall(&s, 0.26, 3, 5, 3);
        bool is_shown = shown(&s.world, _i / TURNS, NULL) & bit(object);
        // The depth buffer has no owners, but nothing that is before the bounds either.
        ck_assert_msg(is_shown == (owned || _i / TURNS == DEPTH), "owned %d: shown %d", owned,
                      is_shown);
        obs_free(&s.world);
    }
}
END_TEST

START_TEST(two_walls_hide_together_what_neither_hides_alone)
{
    for (int parts = 1; parts <= 3; parts++) {
        sight s = look(_i % TURNS);
        uint32_t behind = add_object(&s, 0, 0, 10, 1);
        if (parts & 1) add_wall(&s, -3, 0.2, 5, 3);
        if (parts & 2) add_wall(&s, -0.2, 3, 6, 3);
        bool is_shown = shown(&s.world, _i / TURNS, NULL) & bit(behind);
        ck_assert_msg(is_shown == (parts != 3), "walls %d: shown %d", parts, is_shown);
        obs_free(&s.world);
    }
}
END_TEST

START_TEST(sheets_hide_and_boxes_without_area_do_not)
{
    for (int zero = 0; zero < 4; zero++) { // a sheet seen from the front, from its edge, a segment
        sight s = look(_i % TURNS);
        const double half[4][3] = {{2, 2, 0}, {0, 2, 2}, {2, 0, 0}, {0, 0, 0}};
        occ_box box = box_of(&s, 0, 0, 5, half[zero][0], half[zero][1], half[zero][2]);
        obs_add_occluder(&s.world, &box, obs_add_object(&s.world, &box));
        uint32_t behind = add_object(&s, 0, 0, 10, 0.5);
        bool is_shown = shown(&s.world, _i / TURNS, NULL) & bit(behind);
        ck_assert_msg(is_shown == (zero != 0), "case %d: shown %d", zero, is_shown);
        obs_free(&s.world);
    }
}
END_TEST

START_TEST(what_is_around_the_eye_is_shown_and_a_wall_behind_it_hides_nothing)
{
    sight s = look(_i % TURNS);
    uint32_t around = add_object(&s, 0, 0, 0, 20), ahead = add_object(&s, 0, 0, 10, 0.5);
    add_wall(&s, -5, 5, -2, 5);
    add_wall(&s, -5, 5, 0.05, 5); // before the near plane: cut away
    uint32_t mask = shown(&s.world, _i / TURNS, NULL);
    ck_assert_uint_eq(mask, bit(around) | bit(ahead));
    obs_free(&s.world);
}
END_TEST

START_TEST(a_projection_off_its_center_is_followed)
{
    sight s = look(_i % TURNS);
    s.world.frames[0].proj[8] = 0.5f;  // the axis of view lies left of the middle,
    s.world.frames[0].proj[9] = -0.4f; // and above it
    uint32_t wall = add_wall(&s, -1, 1, 5, 1), behind = add_object(&s, 0, 0, 10, 0.5);
    uint32_t right = add_object(&s, 3.3, 0, 10, 0.5), left = add_object(&s, -3.3, 0, 10, 0.5);
    uint32_t above = add_object(&s, 0, 3.3, 10, 0.5), below = add_object(&s, 0, -3.3, 10, 0.5);
    uint32_t mask = shown(&s.world, _i / TURNS, NULL);
    ck_assert_uint_eq(mask, bit(wall) | bit(right) | bit(left) | bit(above) | bit(below));
    ck_assert_msg(!(mask & bit(behind)), "the wall does not hide");
    obs_free(&s.world);
}
END_TEST

START_TEST(without_perspective_only_the_frustum_decides)
{
    sight s = look(_i % TURNS);
    float *proj = s.world.frames[0].proj;
    memset(proj, 0, 16 * sizeof *proj);
    proj[0] = proj[5] = 0.2f;
    proj[10] = -0.01f;
    proj[15] = 1;
    uint32_t wall = add_wall(&s, -2, 2, 5, 2), behind = add_object(&s, 0, 0, 10, 0.5);
    uint32_t outside = add_object(&s, 8, 0, 10, 0.5);
    uint32_t mask = shown(&s.world, _i / TURNS, NULL);
    ck_assert_uint_eq(mask, bit(wall) | bit(behind));
    ck_assert_uint_eq(mask & bit(outside), 0);
    obs_free(&s.world);
}
END_TEST

START_TEST(denormal_boxes_do_no_harm)
{
    obs_scene world;
    ck_assert(scenes_make("city", 200, 13, &world));
    for (uint32_t i = 0; i < world.occluder_count; i++)
        for (int k = 0; k < 12; k++) {
            float *number = k < 3 ? &world.occluders[i].box.center[k]
                                  : &world.occluders[i].box.axis[k / 3 - 1][k % 3];
            *number *= 1e-40f;
        }
    free(masks_of(&world, _i, NULL));
    obs_free(&world);
}
END_TEST

START_TEST(denormal_numbers_are_numbers_again_afterwards)
{
    volatile float tiny = FLT_MIN;
    ck_assert(tiny / 2 > 0);
    sight s = look(0);
    add_wall(&s, -2, 2, 5, 2);
    shown(&s.world, _i, NULL);
    ck_assert_msg(tiny / 2 > 0, "they are flushed to zero");
    obs_free(&s.world);
}
END_TEST

// --- whole scenes --------------------------------------------------------------------------------

START_TEST(without_occluders_the_answer_is_that_of_method_frustum)
{
    obs_scene world;
    ck_assert(scenes_make(scenes_kinds[_i / PEERS].name, 1500, 11, &world));
    world.occluder_count = 0;
    uint32_t *masks = masks_of(&world, _i % PEERS, NULL);
    size_t words = OCC_MASK_WORDS(world.object_count), count;
    occ_scene *built = kit_obs_scene(&world, NULL, NULL, NULL);
    occ_view *view = NULL;
    ck_assert_int_eq(occ_view_create(&(occ_view_desc){.backend = OCC_BACKEND_PLAIN}, &view),
                     OCC_SUCCESS);
    uint32_t *expected = calloc(words, sizeof *expected);
    ck_assert_ptr_nonnull(expected);
    for (uint32_t f = 0; f < world.frame_count; f++) {
        double at[3];
        occ_camera_desc camera = kit_obs_camera(&world.frames[f], at);
        kit_cull(view, built, &camera, &(occ_cull_desc){.method = OCC_METHOD_FRUSTUM});
        ck_assert_int_eq(occ_view_read_mask(view, expected, words, &count), OCC_SUCCESS);
        ck_assert_msg(memcmp(expected, masks + f * words, words * sizeof *expected) == 0,
                      "%s, frame %u: another frustum", scenes_kinds[_i / PEERS].name, f);
    }
    free(expected);
    free(masks);
    occ_view_destroy(view);
    occ_scene_destroy(built);
    obs_free(&world);
}
END_TEST

START_TEST(masks_are_the_same_again_and_on_two_threads)
{
    obs_scene world;
    ck_assert(scenes_make(_i / PEERS ? "city" : "soup", 3000, 12, &world));
    world.frame_count = 10;
    const peer_options two = {.threads = 2, .rays_width = 85, .rays_height = 48};
    uint32_t *first = masks_of(&world, _i % PEERS, NULL),
             *again = masks_of(&world, _i % PEERS, NULL);
    uint32_t *threads = masks_of(&world, _i % PEERS, &two), left = 0;
    size_t words = OCC_MASK_WORDS(world.object_count) * world.frame_count;
    for (size_t i = 0; i < words; i++)
        left |= first[i];
    ck_assert_msg(left != 0, "nothing is shown");
    ck_assert_int_eq(memcmp(first, again, words * sizeof *first), 0);
    ck_assert_int_eq(memcmp(first, threads, words * sizeof *first), 0);
    free(first);
    free(again);
    free(threads);
    obs_free(&world);
}
END_TEST

// --- what they get wrong -------------------------------------------------------------------------

// At z = 5 the buffer's columns are 0.1208 apart, one of them at 0: none falls into this gap.
static const double gap[2] = {0.02, 0.10};

static void add_gapped_wall(sight *s, double left, double right)
{
    add_wall(s, -3, left, 5, 3);
    add_wall(s, right, 3, 5, 3);
}

START_TEST(the_depth_buffer_hides_what_is_seen_between_its_rays)
{
    sight s = look(_i);
    add_gapped_wall(&s, gap[0], gap[1]);
    // All of it is seen: from 0.105 to 0.145 at z = 9.98 is from 0.0526 to 0.0727 at z = 5.
    uint32_t seen = add_object(&s, 0.125, 0, 10, 0.02);
    const peer_options fine = {.threads = 1, .rays_width = 2720, .rays_height = 1536};
    ck_assert_msg(!(shown(&s.world, DEPTH, NULL) & bit(seen)), "embree-depth is right");
    ck_assert_msg(shown(&s.world, DEPTH, &fine) & bit(seen), "a fine buffer hides it too");
    ck_assert_msg(shown(&s.world, RAYS, NULL) & bit(seen), "its corners are hidden");
    obs_free(&s.world);
}
END_TEST

START_TEST(corner_rays_hide_what_is_seen_between_the_corners)
{
    sight s = look(_i);
    add_gapped_wall(&s, -0.2, 0.2);
    uint32_t seen = add_object(&s, 0, 0, 10, 0.5); // its corners are at 0.24 and more, at z = 5
    ck_assert_msg(!(shown(&s.world, RAYS, NULL) & bit(seen)), "embree-rays is right");
    ck_assert_msg(shown(&s.world, DEPTH, NULL) & bit(seen), "no ray finds a gap of three pixels");
    obs_free(&s.world);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("peers");
    TCase *small = tcase_create("small");
    tcase_add_loop_test(small, a_wall_hides_what_is_behind_it_and_nothing_else, 0, VIEWS);
    tcase_add_loop_test(small, an_object_is_not_hidden_by_its_own_occluder, 0, VIEWS);
    tcase_add_loop_test(small, an_own_occluder_does_not_help_the_others, 0, VIEWS);
    tcase_add_loop_test(small, two_walls_hide_together_what_neither_hides_alone, 0, VIEWS);
    tcase_add_loop_test(small, sheets_hide_and_boxes_without_area_do_not, 0, VIEWS);
    tcase_add_loop_test(small, what_is_around_the_eye_is_shown_and_a_wall_behind_it_hides_nothing,
                        0, VIEWS);
    tcase_add_loop_test(small, a_projection_off_its_center_is_followed, 0, VIEWS);
    tcase_add_loop_test(small, without_perspective_only_the_frustum_decides, 0, VIEWS);
    tcase_add_loop_test(small, denormal_boxes_do_no_harm, 0, PEERS);
    tcase_add_loop_test(small, denormal_numbers_are_numbers_again_afterwards, 0, PEERS);
    tcase_add_loop_test(small, a_sheet_hides_from_the_sides_that_it_has, 0, VIEWS);
    tcase_add_loop_test(small, up_is_up, 0, VIEWS);
    tcase_add_loop_test(small, what_lies_in_a_surface_is_shown, 0, VIEWS);
    tcase_add_loop_test(small, an_object_that_reaches_behind_the_camera_is_shown, 0, VIEWS);
    suite_add_tcase(suite, small);

    TCase *scenes = tcase_create("scenes");
    tcase_add_loop_test(scenes, without_occluders_the_answer_is_that_of_method_frustum, 0,
                        5 * PEERS);
    tcase_add_loop_test(scenes, masks_are_the_same_again_and_on_two_threads, 0, 2 * PEERS);
    suite_add_tcase(suite, scenes);

    TCase *failures = tcase_create("failures");
    tcase_add_loop_test(failures, the_depth_buffer_hides_what_is_seen_between_its_rays, 0, TURNS);
    tcase_add_loop_test(failures, corner_rays_hide_what_is_seen_between_the_corners, 0, TURNS);
    suite_add_tcase(suite, failures);
    return test_run_suite(suite);
}
