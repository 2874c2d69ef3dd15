// SPDX-License-Identifier: Apache-2.0
// How much is put to the judge, and what of it.
#include "settle.h"
#include "settle_stage.h"
#include "support.h"

#include <string.h>

// --- hidden for both -----------------------------------------------------------------------------

START_TEST(what_shows_through_a_gap_and_is_reported_hidden_is_false_hidden)
{
    for (int is_open = 0; is_open < 2; is_open++) {
        stage s = stage_with_gap(is_open ? 0x1p-17f : 0);
        const uint32_t shown = 0;
        vis_set_frame(&s.result, 0, &shown);
        compare_sums sampled = compare_count(&s.truth, &s.result, NULL, NULL);
        ck_assert_uint_eq(sampled.false_hidden, 0);
        outcome found = settle_stage(&s);
        ck_assert_uint_eq(found.sums.agreed_judged, 0);
        ck_assert_uint_eq(found.sums.agreed_unjudged, 1);
        found = settle_limited(&s, SETTLE_DEFAULT, 5);
        ck_assert_uint_eq(found.sums.agreed_judged, 1);
        ck_assert_int_eq((int)found.sums.agreed_seen, is_open);
        ck_assert_uint_eq(found.sums.agreed_doubtful + found.sums.agreed_unjudged, 0);
        ck_assert_uint_eq(found.sums.settled + found.sums.unsettled, 0);
        ck_assert_int_eq((int)found.counts.false_hidden, is_open);
        ck_assert_uint_eq(found.counts.largest_px, 0);
        free_stage(&s);
    }
}
END_TEST

START_TEST(decal_that_sampling_could_not_see_is_doubtful)
{
    const occ_box decal = block(0, 0, -2.75f, 0.6875f, 0.6875f, 0);
    const occ_box wall = block(0, 0, -3, 2, 2, 0.25f);
    stage s = stage_with(&decal, 1);
    add_wall(&s, &wall);
    sample(&s, 0);
    s.truth.verdicts[0].samples = 0;
    outcome found = settle_limited(&s, SETTLE_DEFAULT, 5);
    ck_assert_uint_eq(found.sums.agreed_doubtful, 1);
    ck_assert_uint_eq(found.sums.agreed_seen, 0);
    ck_assert_uint_eq(found.counts.false_hidden, 0);
    free_stage(&s);
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
        int column = i % 3 - 1, row = i / 3 - 1;
        const occ_box box =
            block(0.5f * (float)column, 0.5f * (float)row, -5, 0.125f, 0.125f, 0.125f);
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
        const settle_limits limits = {.disagreed = limit};
        outcome found = settle_with(judges, &s, limits);
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
    outcome found = settle_limited(&s, 3, 0);
    ck_assert_uint_eq(found.sums.false_refuted, 3);
    ck_assert_uint_eq(found.sums.settled, 3);
    ck_assert_uint_eq(found.sums.unsettled, 1 + 9 + 4 + 9);
    ck_assert_uint_eq(found.counts.false_hidden, 1);
    found = settle_limited(&s, 10, 0);
    ck_assert_uint_eq(found.sums.false_refuted, 4);
    ck_assert_uint_eq(found.sums.judged_hidden, 10);
    ck_assert_uint_eq(found.counts.false_hidden, 0);
    free_stage(&s);
}
END_TEST

// In frame 1 all are reported hidden.
START_TEST(what_was_asked_before_changes_nothing)
{
    stage s = stage_with_many();
    sample(&s, 0x3ff);
    const uint32_t shown = 0;
    vis_set_frame(&s.result, 1, &shown);
    settle *judges = settle_create(&s.scene, &s.truth);
    ck_assert_ptr_nonnull(judges);
    for (uint64_t limit = 1; limit < 30; limit += 4) {
        const settle_limits limits = {limit, limit};
        outcome first = settle_with(judges, &s, limits), fresh = settle_limited(&s, limit, limit);
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
    const settle_limits limits = {.disagreed = SETTLE_DEFAULT};
    ck_assert_ptr_nonnull(settle_result(judges, &s.result, limits, &settled, &sums));
    ck_assert_ptr_null(settled.verdicts);
    settle_destroy(judges);
    free_stage(&s);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("settle_limits");
    TCase *agreed = tcase_create("agreed");
    tcase_add_test(agreed, what_shows_through_a_gap_and_is_reported_hidden_is_false_hidden);
    tcase_add_test(agreed, decal_that_sampling_could_not_see_is_doubtful);
    suite_add_tcase(suite, agreed);
    TCase *limit = tcase_create("limit");
    tcase_add_test(limit, limit_is_kept_and_shared_among_frames);
    tcase_add_test(limit, objects_reported_hidden_come_first);
    tcase_add_test(limit, what_was_asked_before_changes_nothing);
    tcase_add_test(limit, scene_that_is_not_the_truths_is_refused);
    tcase_add_test(limit, camera_without_an_eye_is_refused);
    suite_add_tcase(suite, limit);
    return test_run_suite(suite);
}
