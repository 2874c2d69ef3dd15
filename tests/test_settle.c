// SPDX-License-Identifier: Apache-2.0
// What the judge makes of a result and the sampled truth, where the answer is known without either:
// 64 x 64 samples of a view of 90 degrees along -z, the near plane at 1/8.
#include "settle.h"
#include "settle_stage.h"
#include "support.h"

// --- reported visible ----------------------------------------------------------------------------

// 2^-17 at a distance where a sample is 3/32 wide: less than 1e-4 of it.
START_TEST(what_shows_through_a_gap_between_samples_is_not_missed)
{
    stage s = stage_with_gap(0x1p-17f);
    compare_sums sampled = compare_count(&s.truth, &s.result, NULL, NULL);
    ck_assert_uint_eq(sampled.missed, 1);
    outcome found = settle_stage(&s);
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
    outcome found = settle_stage(&s);
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
            int column = i % 36, row = i / 36;
            float x = ((float)column - 17.4375f) / 16, y = ((float)row - 17.4375f) / 16;
            const occ_box tile =
                block(x, y, -3, 0x1p-5f - (has_gap && i == 700 ? 0x1p-17f : 0), 0x1p-5f, 0);
            obs_add_occluder(&s.scene, &tile, other);
        }
        sample(&s, 1);
        ck_assert(!truth_is_visible(&s.truth.verdicts[0]));
        outcome found = settle_stage(&s);
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
    ck_assert_uint_eq(settle_stage(&s).sums.judged_visible, 1);
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
    outcome found = settle_stage(&s);
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
    outcome found = settle_stage(&s);
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
    outcome found = settle_stage(&s);
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
    outcome found = settle_stage(&s);
    ck_assert_uint_eq(found.sums.false_confirmed, 1);
    ck_assert_uint_eq(found.counts.false_hidden, 1);
    const uint32_t shown = 3;
    vis_set_frame(&s.result, 0, &shown);
    s.truth.verdicts[0] = (truth_verdict){.flags = TRUTH_IN_FRUSTUM};
    found = settle_stage(&s);
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

// One of its faces is in the plane of the frustum's right side, and the box beyond.
START_TEST(object_that_only_touches_the_frustum_counts_against_the_result)
{
    const occ_box touching = {{5.5f, 0, -4.5f}, {{1, 0, -1}, {0, 1, 0}, {0.5f, 0, 0.5f}}};
    stage s = stage_with(&touching, 1);
    sample(&s, 0);
    s.truth.verdicts[0] = (truth_verdict){.rays = 1, .flags = TRUTH_IN_FRUSTUM};
    outcome found = settle_stage(&s);
    ck_assert_uint_eq(found.sums.false_confirmed, 1);
    ck_assert_uint_eq(found.counts.false_hidden, 1);
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
    tcase_add_test(hidden, object_that_only_touches_the_frustum_counts_against_the_result);
    suite_add_tcase(suite, hidden);
    return test_run_suite(suite);
}
