// SPDX-License-Identifier: Apache-2.0
// What the judge makes of a result and the sampled truth, where the answer is known without either:
// 64 x 64 samples of a view of 90 degrees along -z, the near plane at 1/8.
#include "compare_count.h"
#include "kit.h"
#include "settle.h"
#include "support.h"
#include "truth_sample.h"

#include <string.h>

enum { SIDE = 64, MOST_OBJECTS = 32, MOST_FRAMES = 4 };

// A scene of frames that are all alike, and what is reported of it.
typedef struct stage {
    obs_scene scene;
    truth_result truth;
    vis_result result;
} stage;

typedef struct outcome {
    settle_sums sums;
    compare_sums counts;
} outcome;

static const double at_origin[3] = {0, 0, 0}, along_z[3] = {0, 0, -1};

static occ_box block(float x, float y, float z, float half_x, float half_y, float half_z)
{
    return (occ_box){{x, y, z}, {{half_x, 0, 0}, {0, half_y, 0}, {0, 0, half_z}}};
}

static stage stage_with(const occ_box *box, int frames)
{
    stage s = {0};
    const occ_box middle = block(0, 0, -5, 1, 1, 1);
    obs_frame frame = obs_look(at_origin, along_z, 1, 1, 0.125, 100);
    for (int i = 0; i < frames; i++)
        obs_add_frame(&s.scene, &frame);
    obs_add_object(&s.scene, box ? box : &middle);
    return s;
}

// An occluder with an owner of its own, behind the camera.
static void add_wall(stage *s, const occ_box *box)
{
    const occ_box owner = block(0, 0, 90, 1, 1, 1);
    obs_add_occluder(&s->scene, box, obs_add_object(&s->scene, &owner));
}

// Samples all frames; the bits of `shown` are the objects that the result shows in each.
static void sample(stage *s, uint32_t shown)
{
    uint32_t objects = s->scene.object_count, frames = s->scene.frame_count;
    ck_assert(!s->scene.out_of_memory && objects <= MOST_OBJECTS && frames <= MOST_FRAMES);
    ck_assert(truth_create(&s->truth, objects, frames));
    ck_assert(vis_create(&s->result, objects, frames));
    s->truth.width = s->truth.height = SIDE;
    for (uint32_t i = 0; i < frames; i++) {
        s->truth.frames[i] = i;
        const char *complaint =
            truth_sample(&s->scene, i, SIDE, SIDE, s->truth.verdicts + (size_t)i * objects);
        ck_assert_msg(!complaint, "%s", complaint);
        vis_set_frame(&s->result, i, &shown);
    }
}

static outcome settle_with(settle *judges, stage *s, uint64_t limit)
{
    outcome found;
    truth_result settled;
    const char *complaint = settle_result(judges, &s->result, limit, &settled, &found.sums);
    ck_assert_msg(!complaint, "%s", complaint);
    found.counts = compare_count(&settled, &s->result, NULL, NULL);
    truth_free(&settled);
    const settle_sums *sums = &found.sums;
    ck_assert_uint_eq(sums->settled, sums->judged_visible + sums->judged_hidden);
    ck_assert_uint_le(sums->settled, limit);
    return found;
}

static outcome settle_stage(stage *s, uint64_t limit)
{
    ck_assert_ptr_null(settle_check(&s->scene, &s->truth));
    settle *judges = settle_create(&s->scene, &s->truth);
    ck_assert_ptr_nonnull(judges);
    outcome found = settle_with(judges, s, limit);
    settle_destroy(judges);
    return found;
}

static void free_stage(stage *s)
{
    obs_free(&s->scene);
    truth_free(&s->truth);
    vis_free(&s->result);
}

// --- reported visible ----------------------------------------------------------------------------

// Two sheets before object 0, and between them a gap of that width.
static stage stage_with_gap(float gap)
{
    stage s = stage_with(NULL, 1);
    const occ_box left = block(-1.6875f, 0, -3, 2, 4, 0),
                  right = block(2.3125f + gap, 0, -3, 2, 4, 0);
    add_wall(&s, &left);
    add_wall(&s, &right);
    sample(&s, 1);
    ck_assert_uint_eq(s.truth.verdicts[0].flags, TRUTH_IN_FRUSTUM);
    ck_assert(!truth_is_visible(&s.truth.verdicts[0]));
    return s;
}

// 2^-17 at a distance where a sample is 3/32 wide: less than 1e-4 of it.
START_TEST(what_shows_through_a_gap_between_samples_is_not_missed)
{
    stage s = stage_with_gap(0x1p-17f);
    compare_sums sampled = compare_count(&s.truth, &s.result, NULL, NULL);
    ck_assert_uint_eq(sampled.missed, 1);
    outcome found = settle_stage(&s, SETTLE_DEFAULT);
    ck_assert_uint_eq(found.sums.judged_visible, 1);
    ck_assert_uint_eq(found.sums.judged_hidden + found.sums.unsettled, 0);
    ck_assert_uint_eq(found.counts.missed, 0);
    ck_assert_uint_eq(found.counts.in_frustum, sampled.in_frustum);
    ck_assert_uint_eq(found.counts.visible, sampled.visible + 1);
    free_stage(&s);
}
END_TEST

START_TEST(what_is_behind_a_closed_seam_is_missed)
{
    stage s = stage_with_gap(0);
    outcome found = settle_stage(&s, SETTLE_DEFAULT);
    ck_assert_uint_eq(found.sums.judged_visible, 0);
    ck_assert_uint_eq(found.sums.judged_hidden, 1);
    ck_assert_uint_eq(found.counts.missed, 1);
    free_stage(&s);
}
END_TEST

// A wall of 36 x 36 tiles, no seam of which is on a sample or on a line to a corner: far more
// candidates than are tried at first. One of them may be a little narrower than its place.
START_TEST(one_of_many_occluders_decides)
{
    for (unsigned has_gap = 0; has_gap < 2; has_gap++) {
        stage s = stage_with(NULL, 1);
        const occ_box owner = block(0, 0, 90, 1, 1, 1);
        uint32_t other = obs_add_object(&s.scene, &owner);
        for (int i = 0; i < 36 * 36; i++) {
            float x = ((float)(i % 36) - 17.4375f) / 16, y = ((float)(i / 36) - 17.4375f) / 16;
            const occ_box tile =
                block(x, y, -3, 0x1p-5f - (has_gap && i == 700 ? 0x1p-17f : 0), 0x1p-5f, 0);
            obs_add_occluder(&s.scene, &tile, other);
        }
        sample(&s, 1);
        ck_assert(!truth_is_visible(&s.truth.verdicts[0]));
        outcome found = settle_stage(&s, SETTLE_DEFAULT);
        ck_assert_uint_eq(found.sums.judged_visible, has_gap);
        ck_assert_uint_eq(found.counts.missed, 1 - has_gap);
        free_stage(&s);
    }
}
END_TEST

START_TEST(own_occluder_does_not_hide_the_object)
{
    stage s = stage_with(NULL, 1);
    const occ_box wall = block(0, 0, -3, 2, 2, 0.25f);
    obs_add_occluder(&s.scene, &wall, 0);
    sample(&s, 1);
    s.truth.verdicts[0].samples = 0; // as if sampling had been blind
    ck_assert_uint_eq(settle_stage(&s, SETTLE_DEFAULT).sums.judged_visible, 1);
    free_stage(&s);
}
END_TEST

START_TEST(agreement_and_what_is_outside_are_not_settled)
{
    stage s = stage_with(NULL, 1);
    const occ_box wall = block(0, 0, -3, 2, 2, 0.25f), beside = block(50, 0, -5, 1, 1, 1),
                  clear = block(3, 0, -5, 0.25f, 1, 1);
    add_wall(&s, &wall);
    uint32_t outside = obs_add_object(&s.scene, &beside), seen = obs_add_object(&s.scene, &clear);
    sample(&s, 1u << outside | 1u << seen);
    outcome found = settle_stage(&s, SETTLE_DEFAULT);
    ck_assert_uint_eq(found.sums.settled + found.sums.unsettled, 0);
    ck_assert_uint_eq(found.counts.missed + found.counts.false_hidden, 0);
    free_stage(&s);
}
END_TEST

// --- reported hidden -----------------------------------------------------------------------------

START_TEST(visible_object_reported_hidden_is_confirmed)
{
    stage s = stage_with(NULL, 1);
    const occ_box wall = block(-2, 0, -3, 2, 2, 0.25f);
    add_wall(&s, &wall);
    sample(&s, 0);
    outcome found = settle_stage(&s, SETTLE_DEFAULT);
    ck_assert_uint_ge(found.sums.false_confirmed, 1);
    ck_assert_uint_eq(found.sums.false_refuted, 0);
    ck_assert_uint_eq(found.counts.false_hidden, found.sums.false_confirmed);
    ck_assert_uint_eq(found.counts.largest_px, 8 * 16);
    free_stage(&s);
}
END_TEST

// Whether the object, hidden behind the wall, is found so though the truth was made to see it.
static bool is_refuted(const occ_box *object, const occ_box *wall)
{
    stage s = stage_with(object, 1);
    add_wall(&s, wall);
    sample(&s, 2);
    ck_assert_uint_eq(s.truth.verdicts[0].flags, TRUTH_IN_FRUSTUM);
    ck_assert(!truth_is_visible(&s.truth.verdicts[0]));
    s.truth.verdicts[0].samples = 3;
    compare_sums sampled = compare_count(&s.truth, &s.result, NULL, NULL);
    ck_assert_uint_eq(sampled.false_hidden, 1);
    outcome found = settle_stage(&s, SETTLE_DEFAULT);
    uint64_t refuted = found.sums.false_refuted;
    ck_assert_uint_eq(refuted + found.sums.false_confirmed, 1);
    ck_assert_uint_eq(found.counts.false_hidden, 1 - refuted);
    ck_assert_uint_eq(found.counts.largest_px, refuted ? 0 : 3);
    ck_assert_uint_eq(found.counts.visible, sampled.visible - refuted);
    ck_assert_uint_eq(found.counts.missed, 0);
    free_stage(&s);
    return refuted;
}

// Walls apart from the object, touching it from before, holding it, and beside the camera, where
// the near plane cuts the wall outside of the frustum.
START_TEST(hidden_object_that_sampling_saw_is_refuted)
{
    const occ_box object = block(0, 0, -5, 1, 1, 1), aside = block(8, 0, -10, 0.5f, 0.5f, 0.5f);
    const occ_box walls[] = {block(0, 0, -3, 2, 2, 0.25f), block(0, 0, -3, 2, 2, 1),
                             block(0, 0, -5, 3, 3, 2)},
                  along = block(1.5f, 0, -8, 0.5f, 6, 13);
    for (int i = 0; i < 3; i++)
        ck_assert_msg(is_refuted(&object, &walls[i]), "wall %d", i);
    ck_assert(is_refuted(&aside, &along));
}
END_TEST

// Object 0 is seen by sampling's reading, and not by the judge's: reported hidden it is
// false-hidden, and would sampling not see it, then reported visible it would be missed.
static void check_doubt(const occ_box *object, const occ_box *wall)
{
    stage s = stage_with(object, 1);
    add_wall(&s, wall);
    sample(&s, 2);
    ck_assert(truth_is_visible(&s.truth.verdicts[0]));
    outcome found = settle_stage(&s, SETTLE_DEFAULT);
    ck_assert_uint_eq(found.sums.false_confirmed, 1);
    ck_assert_uint_eq(found.counts.false_hidden, 1);
    const uint32_t shown = 3;
    vis_set_frame(&s.result, 0, &shown);
    s.truth.verdicts[0] = (truth_verdict){.flags = TRUTH_IN_FRUSTUM};
    found = settle_stage(&s, SETTLE_DEFAULT);
    ck_assert_uint_eq(found.sums.judged_hidden, 1);
    ck_assert_uint_eq(found.counts.missed, 1);
    free_stage(&s);
}

START_TEST(what_is_in_an_occluders_surface_counts_against_the_result)
{
    const occ_box wall = block(0, 0, -3, 2, 2, 0.25f);
    const occ_box objects[] = {block(0, 0, -2.75f, 0.6875f, 0.6875f, 0),
                               block(0.5f, 0, -2.875f, 0.25f, 0.25f, 0.125f)};
    for (int i = 0; i < 2; i++)
        check_doubt(&objects[i], &wall);
}
END_TEST

START_TEST(occluder_cut_open_by_the_near_plane_counts_against_the_result)
{
    const occ_box object = block(0, 0, -5, 1, 1, 1);
    const occ_box wall = block(0, 0, -1, 9, 9, 0.9375f);
    check_doubt(&object, &wall);
}
END_TEST

// The eye is in the plane of both.
START_TEST(sheet_edge_on_counts_against_the_result)
{
    const occ_box object = block(0, 0, -5, 0.5f, 0, 0.5f), floor = block(0, 0, -3, 2, 0, 1);
    check_doubt(&object, &floor);
}
END_TEST

// --- the limit -----------------------------------------------------------------------------------

enum { SMALL = 9, FRAMES = 3 };

// A wall with nine objects behind it, in three frames.
static stage stage_with_many(void)
{
    const occ_box first = block(-0.5f, -0.5f, -5, 0.125f, 0.125f, 0.125f);
    stage s = stage_with(&first, FRAMES);
    for (int i = 1; i < SMALL; i++) {
        const occ_box box =
            block(0.5f * (float)(i % 3 - 1), 0.5f * (float)(i / 3 - 1), -5, 0.125f, 0.125f, 0.125f);
        obs_add_object(&s.scene, &box);
    }
    const occ_box wall = block(0, 0, -3, 2, 2, 0.25f);
    add_wall(&s, &wall);
    return s;
}

static uint32_t asked_in(const settle *judges, uint32_t frame)
{
    uint32_t asked = 0;
    for (uint32_t i = 0; i < SMALL; i++)
        asked += settle_look_up(judges, frame, i) != SETTLE_UNASKED;
    return asked;
}

START_TEST(limit_is_kept_and_shared_among_frames)
{
    stage s = stage_with_many();
    sample(&s, 0x3ff);
    for (uint32_t limit = 1; limit <= FRAMES * SMALL + 1; limit++) {
        uint32_t most = limit < FRAMES * SMALL ? limit : FRAMES * SMALL;
        settle *judges = settle_create(&s.scene, &s.truth);
        outcome found = settle_with(judges, &s, limit);
        ck_assert_uint_eq(found.sums.settled, most);
        ck_assert_uint_eq(found.sums.unsettled, FRAMES * SMALL - most);
        ck_assert_uint_eq(found.counts.missed, FRAMES * SMALL);
        for (uint32_t frame = 0; frame < FRAMES; frame++) {
            ck_assert_uint_ge(asked_in(judges, frame), most / FRAMES);
            ck_assert_uint_le(asked_in(judges, frame), (most + FRAMES - 1) / FRAMES);
        }
        settle_destroy(judges);
    }
    free_stage(&s);
}
END_TEST

// In frame 1 the truth was made to see four objects.
START_TEST(objects_reported_hidden_come_first)
{
    stage s = stage_with_many();
    sample(&s, 0x3ff);
    const uint32_t shown = 0xf;
    vis_set_frame(&s.result, 1, &shown);
    for (int i = 5; i < SMALL; i++)
        s.truth.verdicts[s.scene.object_count + (uint32_t)i].rays = 1;
    outcome found = settle_stage(&s, 3);
    ck_assert_uint_eq(found.sums.false_refuted, 3);
    ck_assert_uint_eq(found.sums.settled, 3);
    ck_assert_uint_eq(found.sums.unsettled, 1 + 9 + 4 + 9);
    ck_assert_uint_eq(found.counts.false_hidden, 1);
    found = settle_stage(&s, 10);
    ck_assert_uint_eq(found.sums.false_refuted, 4);
    ck_assert_uint_eq(found.sums.judged_hidden, 10);
    ck_assert_uint_eq(found.counts.false_hidden, 0);
    free_stage(&s);
}
END_TEST

START_TEST(what_was_asked_before_changes_nothing)
{
    stage s = stage_with_many();
    sample(&s, 0x3ff);
    settle *judges = settle_create(&s.scene, &s.truth);
    ck_assert_ptr_nonnull(judges);
    for (uint64_t limit = 1; limit < 30; limit += 4) {
        outcome first = settle_with(judges, &s, limit), fresh = settle_stage(&s, limit);
        ck_assert_mem_eq(&first.sums, &fresh.sums, sizeof first.sums);
        ck_assert_uint_eq(first.counts.missed, fresh.counts.missed);
        ck_assert_uint_eq(first.counts.visible, fresh.counts.visible);
    }
    settle_destroy(judges);
    free_stage(&s);
}
END_TEST

START_TEST(scene_that_is_not_the_truths_is_refused)
{
    stage s = stage_with_many();
    sample(&s, 0);
    s.scene.frame_count--;
    ck_assert_ptr_nonnull(settle_check(&s.scene, &s.truth));
    s.scene.frame_count++;
    s.scene.object_count--;
    ck_assert_ptr_nonnull(settle_check(&s.scene, &s.truth));
    s.scene.object_count++;
    s.truth.frame_count = 0;
    ck_assert_ptr_nonnull(settle_check(&s.scene, &s.truth));
    free_stage(&s);
}
END_TEST

START_TEST(camera_without_an_eye_is_refused)
{
    stage s = stage_with_many();
    sample(&s, 0x3ff);
    memset(s.scene.frames[1].proj, 0, sizeof s.scene.frames[1].proj);
    settle *judges = settle_create(&s.scene, &s.truth);
    truth_result settled;
    settle_sums sums;
    ck_assert_ptr_nonnull(settle_result(judges, &s.result, SETTLE_DEFAULT, &settled, &sums));
    ck_assert_ptr_null(settled.verdicts);
    settle_destroy(judges);
    free_stage(&s);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("settle");
    TCase *shown = tcase_create("shown");
    tcase_add_test(shown, what_shows_through_a_gap_between_samples_is_not_missed);
    tcase_add_test(shown, what_is_behind_a_closed_seam_is_missed);
    tcase_add_test(shown, one_of_many_occluders_decides);
    tcase_add_test(shown, own_occluder_does_not_hide_the_object);
    tcase_add_test(shown, agreement_and_what_is_outside_are_not_settled);
    suite_add_tcase(suite, shown);
    TCase *hidden = tcase_create("hidden");
    tcase_add_test(hidden, visible_object_reported_hidden_is_confirmed);
    tcase_add_test(hidden, hidden_object_that_sampling_saw_is_refuted);
    tcase_add_test(hidden, what_is_in_an_occluders_surface_counts_against_the_result);
    tcase_add_test(hidden, occluder_cut_open_by_the_near_plane_counts_against_the_result);
    tcase_add_test(hidden, sheet_edge_on_counts_against_the_result);
    suite_add_tcase(suite, hidden);
    TCase *limit = tcase_create("limit");
    tcase_add_test(limit, limit_is_kept_and_shared_among_frames);
    tcase_add_test(limit, objects_reported_hidden_come_first);
    tcase_add_test(limit, what_was_asked_before_changes_nothing);
    tcase_add_test(limit, scene_that_is_not_the_truths_is_refused);
    tcase_add_test(limit, camera_without_an_eye_is_refused);
    suite_add_tcase(suite, limit);
    return test_run_suite(suite);
}
