// SPDX-License-Identifier: Apache-2.0
// labels: property oracle
// The fused test of objects on the shadows of real occluders: in every instruction set the same as
// scalar C, which knows nothing of where things are on the screen.
#include "crowds.h"
#include "fusion.h"
#include "support.h"

#include <stdio.h>

enum { WORLDS = 3000 / OCC_TEST_SLOWNESS };

typedef void make_crowd(kit_random *random, crowd *c, uint32_t objects);

typedef struct tally {
    unsigned outside, hidden, alone, visible;
} tally;

static occ_verdict test_plainly(const crowd_frame *f, const occ_range *range, const uint32_t *list,
                                tally *sum)
{
    const occ_eye *eye = &f->frame.camera.constants;
    const occ_shadow *shadows = f->frame.shadows.data;
    occ_verdict verdict = {{0, 0}, {0, 0}};
    for (uint32_t i = 0; i < range->count; i++) {
        uint32_t row = range->first + i, bit = 1u << i % 32;
        occ_box box = occ_boxes_get(&f->scene->boxes, row);
        occ_relative_box object = occ_frame_relative(&f->frame, &box);
        if (occ_box_outside(&object, eye->plane[0], range->frustum)) {
            verdict.outside[i / 32] |= bit;
            sum->outside++;
        } else if (occ_box_fused(&object, eye, range->frustum, shadows, list,
                                 range->candidate_count, row)) {
            bool alone = false;
            for (uint32_t k = 0; k < range->candidate_count && !alone; k++) {
                const occ_shadow *shadow = &shadows[list[k]];
                alone = shadow->owner != row &&
                        occ_box_in_shadow(&object, shadow->plane[0], shadow->planes);
            }
            sum->hidden++;
            sum->alone += alone;
        } else {
            verdict.visible[i / 32] |= bit;
            sum->visible++;
        }
    }
    return verdict;
}

// All objects and most of the shadows, in an order of their own.
static occ_range any_range(kit_random *random, const crowd_frame *f, uint32_t *list)
{
    uint32_t count = 0, shadows = f->frame.shadows.count;
    for (uint32_t i = 0; i < shadows; i++)
        if (kit_below(random, 8)) list[count++] = i;
    for (uint32_t i = count; kit_below(random, 2) && i > 1; i--) {
        uint32_t other = kit_below(random, i), moved = list[other];
        list[other] = list[i - 1];
        list[i - 1] = moved;
    }
    uint32_t planes = f->frame.camera.planes;
    if (kit_below(random, 4) == 0) planes &= kit_below(random, 64);
    return (occ_range){
        .count = f->scene->boxes.count, .candidate_count = count, .frustum = planes, .fused = 1};
}

static void same_in_all(make_crowd *make, uint64_t seed, double tolerance, tally *sum)
{
    static const uint32_t splits[] = {0, 1, 8, 48, 1000};
    kit_random random = {seed};
    for (int i = 0; i < WORLDS; i++) {
        crowd c;
        crowd_frame f;
        uint32_t list[CROWD_OCCLUDERS] = {0};
        make(&random, &c, 17 + kit_below(&random, CROWD_OBJECTS - 16));
        crowd_frame_open(&f, &c, tolerance);
        f.frame.camera.constants.splits = splits[kit_below(&random, 5)];
        occ_range range = any_range(&random, &f, list);
        occ_verdict expected = test_plainly(&f, &range, list, sum);
        occ_shadow_set set = occ_occluders_so_far(&f.frame);
        occ_candidates candidates = {&set, list, range.candidate_count};
        for (uint32_t v = 0; occ_lanes_get(v); v++) {
            const occ_lanes *lanes = occ_lanes_get(v);
            occ_verdict said = lanes->test(&f.scene->boxes, &range, &f.frame.camera.constants,
                                           &f.frame.camera.screen, &candidates);
            KIT_CHECK(kit_same_bits(&said, &expected, sizeof said), "%s in world %d", lanes->name,
                      i);
        }
        crowd_frame_close(&f);
    }
    printf("outside %u, hidden %u, by one %u, visible %u\n", sum->outside, sum->hidden, sum->alone,
           sum->visible);
}

START_TEST(a_crowd_is_fused_alike)
{
    tally sum = {0, 0, 0, 0};
    same_in_all(crowd_about, 81, 0.0, &sum);
    ck_assert_uint_gt(sum.hidden - sum.alone, WORLDS / 10);
    ck_assert_uint_gt(sum.visible, 2 * WORLDS);
}
END_TEST

START_TEST(a_wall_of_panels_is_fused_alike)
{
    tally sum = {0, 0, 0, 0};
    same_in_all(crowd_panels, 82, 0.0, &sum);
    ck_assert_uint_gt(sum.hidden - sum.alone, WORLDS);
    ck_assert_uint_gt(sum.visible, 2 * WORLDS);
}
END_TEST

START_TEST(what_is_around_the_eye_is_fused_alike)
{
    tally sum = {0, 0, 0, 0};
    same_in_all(crowd_around, 83, 0.0, &sum);
    ck_assert_uint_gt(sum.hidden - sum.alone, WORLDS);
    ck_assert_uint_gt(sum.visible, 2 * WORLDS);
    ck_assert_uint_gt(sum.outside, 2 * WORLDS);
}
END_TEST

// Then occluders reach farther than they are on the screen.
START_TEST(so_is_what_a_tolerance_hides)
{
    static const double tolerances[] = {1e-4, 1e-2, (double)OCC_MAX_TOLERANCE};
    tally sum = {0, 0, 0, 0};
    same_in_all(crowd_about, (uint64_t)_i + 84, tolerances[_i], &sum);
    same_in_all(crowd_panels, (uint64_t)_i + 94, tolerances[_i], &sum);
    same_in_all(crowd_around, (uint64_t)_i + 104, tolerances[_i], &sum);
    ck_assert_uint_gt(sum.hidden - sum.alone, 3 * WORLDS);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("lanes_fusion");
    TCase *worlds = tcase_create("worlds");
    tcase_add_test(worlds, a_crowd_is_fused_alike);
    tcase_add_test(worlds, a_wall_of_panels_is_fused_alike);
    tcase_add_test(worlds, what_is_around_the_eye_is_fused_alike);
    suite_add_tcase(suite, worlds);
    TCase *tolerance = tcase_create("tolerance");
    tcase_add_loop_test(tolerance, so_is_what_a_tolerance_hides, 0, 3);
    suite_add_tcase(suite, tolerance);
    return test_run_suite(suite);
}
