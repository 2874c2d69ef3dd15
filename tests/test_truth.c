// SPDX-License-Identifier: Apache-2.0
// The sampling oracle where the answer is known without it: 64 x 64 samples of a view of 90 degrees
// along -z, so that a front of half size h at distance d covers (64 h / d)^2 of them.
#include "kit.h"
#include "support.h"
#include "truth_sample.h"

enum { SIDE = 64, MOST_OBJECTS = 8 };

typedef struct stage {
    obs_scene scene;
    truth_verdict verdicts[MOST_OBJECTS];
} stage;

static const double at_origin[3] = {0, 0, 0}, along_z[3] = {0, 0, -1};

static occ_box block(float x, float y, float z, float half_x, float half_y, float half_z)
{
    return (occ_box){{x, y, z}, {{half_x, 0, 0}, {0, half_y, 0}, {0, 0, half_z}}};
}

// A stage with object 0: its front covers 16 x 16 samples in the middle.
static stage stage_with(const occ_box *box)
{
    stage s = {0};
    const occ_box middle = block(0, 0, -5, 1, 1, 1);
    obs_frame frame = obs_look(at_origin, along_z, 1, 1, 0.125, 100);
    obs_add_frame(&s.scene, &frame);
    obs_add_object(&s.scene, box ? box : &middle);
    return s;
}

// An occluder with an owner of its own, far behind all else.
static void add_wall(stage *s, const occ_box *box)
{
    const occ_box owner = block(0, 0, -90, 1, 1, 1);
    obs_add_occluder(&s->scene, box, obs_add_object(&s->scene, &owner));
}

static const truth_verdict *look(stage *s)
{
    ck_assert(!s->scene.out_of_memory && s->scene.object_count <= MOST_OBJECTS);
    const char *complaint = truth_sample(&s->scene, 0, SIDE, SIDE, s->verdicts);
    ck_assert_msg(!complaint, "%s", complaint);
    obs_free(&s->scene);
    return s->verdicts;
}

static void check_samples(stage *s, uint32_t samples)
{
    const truth_verdict *verdict = look(s);
    ck_assert_uint_eq(verdict->flags, TRUTH_IN_FRUSTUM);
    ck_assert_uint_eq(verdict->samples, samples);
    ck_assert_uint_eq(verdict->rays, 0);
}

START_TEST(lone_object_covers_the_samples_of_its_front)
{
    stage s = stage_with(NULL);
    check_samples(&s, 16 * 16);
}
END_TEST

START_TEST(wall_hides_a_box)
{
    stage s = stage_with(NULL);
    const occ_box wall = block(0, 0, -3, 2, 2, 0.25f);
    add_wall(&s, &wall);
    check_samples(&s, 0);
}
END_TEST

START_TEST(wall_behind_a_box_hides_nothing)
{
    stage s = stage_with(NULL);
    const occ_box wall = block(0, 0, -8, 9, 9, 1);
    add_wall(&s, &wall);
    check_samples(&s, 16 * 16);
}
END_TEST

START_TEST(half_a_wall_hides_half_a_box)
{
    stage s = stage_with(NULL);
    const occ_box wall = block(-2, 0, -3, 2, 2, 0.25f);
    add_wall(&s, &wall);
    check_samples(&s, 8 * 16);
}
END_TEST

START_TEST(two_halves_hide_a_box_together)
{
    stage s = stage_with(NULL);
    const occ_box left = block(-2, 0, -3, 2.0625f, 2, 0.25f), right = block(2, 0, -2, 2, 2, 0.25f);
    add_wall(&s, &left);
    add_wall(&s, &right);
    check_samples(&s, 0);
}
END_TEST

START_TEST(own_occluder_hides_others_alone)
{
    stage s = stage_with(NULL);
    const occ_box behind = block(0, 0, -9, 1, 1, 1), wall = block(0, 0, -3, 2, 2, 0.25f);
    uint32_t other = obs_add_object(&s.scene, &behind);
    obs_add_occluder(&s.scene, &wall, 0);
    const truth_verdict *verdicts = look(&s);
    ck_assert_uint_eq(verdicts[0].samples, 16 * 16);
    ck_assert_uint_eq(verdicts[other].samples + verdicts[other].rays, 0);
}
END_TEST

// Of the occluders on a ray the second, third and fourth may be the first that counts.
START_TEST(foreign_occluder_behind_many_own_ones_hides)
{
    for (int is_there = 0; is_there < 2; is_there++) {
        stage s = stage_with(NULL);
        for (int i = 0; i < 3; i++) {
            const occ_box own = block(0, 0, -1 - 0.5f * (float)i, 2, 2, 0.125f);
            obs_add_occluder(&s.scene, &own, 0);
        }
        const occ_box foreign = block(0, 0, -3, 2, 2, 0.25f);
        if (is_there) add_wall(&s, &foreign);
        check_samples(&s, is_there ? 0 : 16 * 16);
    }
}
END_TEST

START_TEST(objects_behind_beside_and_beyond_are_outside)
{
    static const float centers[][3] = {{0, 0, 5}, {9, 0, -5}, {0, -9, -5}, {0, 0, -102}};
    for (int i = 0; i < 4; i++) {
        const float *c = centers[i];
        const occ_box box = block(c[0], c[1], c[2], 1, 1, 1);
        stage s = stage_with(&box);
        const truth_verdict *verdict = look(&s);
        ck_assert_uint_eq(verdict->flags, 0);
        ck_assert_uint_eq(verdict->samples + verdict->rays, 0);
    }
}
END_TEST

// Each of these has corners on the inner side of every plane. The first passes by the edge where
// the left and the near plane meet, the second runs through the frustum.
START_TEST(slanted_box_is_outside_though_no_plane_parts_it)
{
    const occ_box beside = {{-1.5f, 0, -0.75f}, {{2.5f, 0, 1.25f}, {0, 0.0625f, 0}, {0, 0, 0}}};
    const occ_box across = {{-0.5f, 0, -0.75f}, {{2.5f, 0, 1.25f}, {0, 0.0625f, 0}, {0, 0, 0}}};
    stage s = stage_with(&beside);
    ck_assert_uint_eq(look(&s)->flags, 0);
    s = stage_with(&across);
    ck_assert_uint_eq(look(&s)->flags, TRUTH_IN_FRUSTUM);
}
END_TEST

START_TEST(object_around_the_eye_covers_all_samples)
{
    const occ_box room = block(0, 0, 0, 200, 200, 200);
    stage s = stage_with(&room);
    const occ_box wall = block(0, 0, -3, 9, 9, 0.25f);
    add_wall(&s, &wall);
    check_samples(&s, SIDE * SIDE);
}
END_TEST

START_TEST(occluder_around_or_behind_the_eye_hides_nothing)
{
    const occ_box walls[] = {block(0, 0, 0, 2, 2, 2), block(0, 0, 3, 9, 9, 1)};
    for (int i = 0; i < 2; i++) {
        stage s = stage_with(NULL);
        add_wall(&s, &walls[i]);
        check_samples(&s, 16 * 16);
    }
}
END_TEST

START_TEST(occluder_cut_by_the_near_plane_hides_nothing_where_it_is_cut)
{
    const occ_box walls[] = {block(0, 0, -0.0625f, 9, 9, 0.03125f), block(0, 0, -1, 9, 9, 0.9375f)};
    for (int i = 0; i < 2; i++) {
        stage s = stage_with(NULL);
        add_wall(&s, &walls[i]);
        check_samples(&s, 16 * 16);
    }
}
END_TEST

START_TEST(object_between_samples_is_found_by_rays)
{
    const occ_box tiny = block(0.001f, 0.001f, -5, 0.0005f, 0.0005f, 0.0005f);
    for (int is_hidden = 0; is_hidden < 2; is_hidden++) {
        stage s = stage_with(&tiny);
        const occ_box wall = block(0, 0, -3, 2, 2, 0.25f);
        if (is_hidden) add_wall(&s, &wall);
        const truth_verdict *verdict = look(&s);
        ck_assert_uint_eq(verdict->flags, TRUTH_IN_FRUSTUM);
        ck_assert_uint_eq(verdict->samples, 0);
        ck_assert(is_hidden ? verdict->rays == 0 : verdict->rays > 0);
    }
}
END_TEST

// A needle and a point have no area, a sheet seen edge-on neither: only rays can reach them.
START_TEST(object_without_area_is_found_by_rays)
{
    const occ_box boxes[] = {block(0, 0, -5, 1, 0, 0), block(0.5f, 0.25f, -5, 0, 0, 0),
                             block(0, 0, -5, 1, 0, 1)};
    for (int i = 0; i < 3; i++) {
        stage s = stage_with(&boxes[i]);
        const truth_verdict *verdict = look(&s);
        ck_assert_uint_eq(verdict->samples, 0);
        ck_assert_uint_gt(verdict->rays, 0);
    }
}
END_TEST

// The wall ends 1/1000 of the view's width short of the box's edge.
START_TEST(sliver_thinner_than_a_sample_is_found_by_rays)
{
    stage s = stage_with(NULL);
    const occ_box wall = block(0.00025f, 0, -1, 0.25f, 0.5f, 0);
    add_wall(&s, &wall);
    const truth_verdict *verdict = look(&s);
    ck_assert_uint_eq(verdict->samples, 0);
    ck_assert_uint_gt(verdict->rays, 0);
}
END_TEST

START_TEST(sheet_hides_from_both_sides_but_not_edge_on)
{
    const float signs[2] = {1, -1};
    for (int i = 0; i < 2; i++) {
        stage s = stage_with(NULL);
        const occ_box sheet = block(0, 0, -3, 2 * signs[i], 2, 0);
        add_wall(&s, &sheet);
        check_samples(&s, 0);
    }
    stage s = stage_with(NULL);
    const occ_box floor = block(0, 0, -3, 2, 0, 1);
    add_wall(&s, &floor);
    check_samples(&s, 16 * 16);
}
END_TEST

// Axes x, y and x + y: of the square |x|, |y| < 2 all but two corners, triangles of 1/8 each.
START_TEST(three_axes_in_one_plane_make_a_hexagon)
{
    const occ_box hexagon = {{0, 0, -4}, {{0.5f, 0, 0}, {0, 0.5f, 0}, {0.5f, 0.5f, 0}}};
    stage s = stage_with(&hexagon);
    check_samples(&s, 16 * 16 - 2 * 8 * 7 / 2 - 8);
    s = stage_with(NULL);
    const occ_box wall = {{0, 0, -2}, {{0.25f, 0, 0}, {0, 0.25f, 0}, {0.25f, 0.25f, 0}}};
    add_wall(&s, &wall);
    ck_assert_uint_gt(look(&s)->samples, 2 * 8 * 7 / 2 - 1);
}
END_TEST

START_TEST(what_lies_in_an_occluders_surface_is_visible)
{
    const occ_box decal = block(0, 0, -2.75f, 0.6875f, 0.6875f, 0);
    stage s = stage_with(&decal);
    const occ_box wall = block(0, 0, -3, 2, 2, 0.25f);
    add_wall(&s, &wall);
    check_samples(&s, 16 * 16);
}
END_TEST

// x and y from -1 to 1, depth from 1 to 9.
START_TEST(orthographic_camera_sees_along_its_direction)
{
    const occ_box box = block(0.5f, 0, -5, 0.25f, 0.5f, 1), wall = block(0.5f, 1, -3, 1, 1, 1);
    for (int has_wall = 0; has_wall < 2; has_wall++) {
        stage s = stage_with(&box);
        obs_frame *frame = &s.scene.frames[0];
        for (int i = 0; i < 16; i++)
            frame->proj[i] = i % 5 == 0 ? 1.0f : 0.0f;
        frame->proj[10] = -0.25f;
        frame->proj[14] = -1.25f;
        if (has_wall) add_wall(&s, &wall);
        check_samples(&s, has_wall ? 16 * 16 : 16 * 32);
    }
}
END_TEST

START_TEST(infinite_far_plane_is_none)
{
    const occ_box far_away = block(0, 0, -5000, 1000, 1000, 1000);
    stage s = stage_with(&far_away);
    s.scene.frames[0].proj[10] = -1;
    s.scene.frames[0].proj[14] = -0.25f;
    check_samples(&s, 16 * 16);
}
END_TEST

START_TEST(camera_without_an_eye_is_refused)
{
    stage s = stage_with(NULL);
    for (int i = 0; i < 16; i++)
        s.scene.frames[0].proj[i] = 0;
    ck_assert_ptr_nonnull(truth_sample(&s.scene, 0, SIDE, SIDE, s.verdicts));
    obs_free(&s.scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("truth");
    TCase *hiding = tcase_create("hiding");
    tcase_add_test(hiding, lone_object_covers_the_samples_of_its_front);
    tcase_add_test(hiding, wall_hides_a_box);
    tcase_add_test(hiding, wall_behind_a_box_hides_nothing);
    tcase_add_test(hiding, half_a_wall_hides_half_a_box);
    tcase_add_test(hiding, two_halves_hide_a_box_together);
    tcase_add_test(hiding, own_occluder_hides_others_alone);
    tcase_add_test(hiding, foreign_occluder_behind_many_own_ones_hides);
    tcase_add_test(hiding, occluder_around_or_behind_the_eye_hides_nothing);
    tcase_add_test(hiding, occluder_cut_by_the_near_plane_hides_nothing_where_it_is_cut);
    tcase_add_test(hiding, sheet_hides_from_both_sides_but_not_edge_on);
    tcase_add_test(hiding, three_axes_in_one_plane_make_a_hexagon);
    tcase_add_test(hiding, what_lies_in_an_occluders_surface_is_visible);
    suite_add_tcase(suite, hiding);
    TCase *frustum = tcase_create("frustum");
    tcase_add_test(frustum, objects_behind_beside_and_beyond_are_outside);
    tcase_add_test(frustum, slanted_box_is_outside_though_no_plane_parts_it);
    tcase_add_test(frustum, object_around_the_eye_covers_all_samples);
    tcase_add_test(frustum, orthographic_camera_sees_along_its_direction);
    tcase_add_test(frustum, infinite_far_plane_is_none);
    tcase_add_test(frustum, camera_without_an_eye_is_refused);
    suite_add_tcase(suite, frustum);
    TCase *rays = tcase_create("rays");
    tcase_add_test(rays, object_between_samples_is_found_by_rays);
    tcase_add_test(rays, object_without_area_is_found_by_rays);
    tcase_add_test(rays, sliver_thinner_than_a_sample_is_found_by_rays);
    suite_add_tcase(suite, rays);
    return test_run_suite(suite);
}
