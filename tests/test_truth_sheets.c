// SPDX-License-Identifier: Apache-2.0
// The sampling oracle and sheets, where the answer is known without it, and what becomes of wrong
// results: 64 x 64 samples of a view of 90 degrees along -z, as in settle_stage.h.
#include "settle.h"
#include "settle_stage.h"
#include "support.h"

#include <math.h>
#include <string.h>

// At z = -3, counterclockwise for the eye at the origin: between corners in x and y.
static occ_sheet pane(const float (*xy)[2], uint32_t count, occ_sides sides)
{
    occ_sheet sheet = {.corner_count = count, .sides = sides};
    for (uint32_t c = 0; c < count; c++) {
        sheet.corner[c][0] = xy[c][0];
        sheet.corner[c][1] = xy[c][1];
        sheet.corner[c][2] = -3;
    }
    return sheet;
}

static occ_sheet square(float low_x, float high_x, occ_sides sides)
{
    const float xy[4][2] = {{low_x, -2}, {high_x, -2}, {high_x, 2}, {low_x, 2}};
    return pane(xy, 4, sides);
}

static occ_sheet turned_round(const occ_sheet *sheet)
{
    occ_sheet turned = *sheet;
    for (uint32_t c = 0; c < sheet->corner_count; c++)
        memcpy(turned.corner[c], sheet->corner[sheet->corner_count - 1 - c],
               sizeof turned.corner[c]);
    return turned;
}

// With an owner of its own, behind the camera.
static void add_pane(stage *s, const occ_sheet *sheet)
{
    const occ_box owner = block(0, 0, 90, 1, 1, 1);
    obs_add_sheet(&s->scene, sheet, obs_add_object(&s->scene, &owner));
}

static uint32_t samples_of(stage *s)
{
    sample(s, 0);
    uint32_t samples = s->truth.verdicts[0].samples;
    ck_assert(samples > 0 || s->truth.verdicts[0].rays == 0);
    free_stage(s);
    return samples;
}

static uint32_t samples_past(const occ_sheet *sheet)
{
    stage s = stage_with(NULL, 1);
    add_pane(&s, sheet);
    return samples_of(&s);
}

// --- samples and rays ----------------------------------------------------------------------------

// Object 0 covers 16 x 16 samples, half of them to the left of the middle.
START_TEST(sheet_hides_the_samples_that_it_covers)
{
    const occ_sheet whole = square(-2, 2, OCC_SIDES_BOTH), left = square(-2, 0, OCC_SIDES_BOTH);
    ck_assert_uint_eq(samples_past(&whole), 0);
    ck_assert_uint_eq(samples_past(&left), 8 * 16);
    // An octagon with half sizes 3/4 and corners cut off at 3/8: at depth 4 of the front, it covers
    // 16 x 16 samples but for four triangles with 4 samples along either side.
    static const float eight[8][2] = {{-0.375f, -0.75f}, {0.375f, -0.75f}, {0.75f, -0.375f},
                                      {0.75f, 0.375f},   {0.375f, 0.75f},  {-0.375f, 0.75f},
                                      {-0.75f, 0.375f},  {-0.75f, -0.375f}};
    const occ_sheet octagon = pane(eight, 8, OCC_SIDES_FRONT);
    uint32_t seen = samples_past(&octagon);
    ck_assert_uint_ge(seen, 4 * 6);
    ck_assert_uint_le(seen, 4 * 10);
}
END_TEST

START_TEST(one_sided_sheet_hides_from_its_front_alone)
{
    const occ_sheet front = square(-2, 2, OCC_SIDES_FRONT), both = square(-2, 2, OCC_SIDES_BOTH);
    const occ_sheet back = turned_round(&front), other = turned_round(&both);
    ck_assert_uint_eq(samples_past(&front), 0);
    ck_assert_uint_eq(samples_past(&back), 16 * 16);
    ck_assert_uint_eq(samples_past(&other), 0);
}
END_TEST

START_TEST(sheet_without_area_or_edge_on_hides_nothing)
{
    occ_sheet line = square(-2, 2, OCC_SIDES_BOTH), floor = line;
    for (int c = 0; c < 4; c++) {
        line.corner[c][0] = line.corner[c][1];
        floor.corner[c][2] = -3 + floor.corner[c][1];
        floor.corner[c][1] = 0;
    }
    ck_assert_uint_eq(samples_past(&line), 16 * 16);
    ck_assert_uint_eq(samples_past(&floor), 16 * 16);
}
END_TEST

START_TEST(bent_sheet_hides_behind_its_triangles)
{
    occ_sheet bent = square(-4, 4, OCC_SIDES_BOTH); // over the diagonal from below left
    bent.corner[1][2] = -9;
    bent.corner[3][2] = -9;
    uint32_t seen = samples_past(&bent); // the fold is before the object, what leans back behind it
    ck_assert_uint_gt(seen, 0);
    ck_assert_uint_lt(seen, 16 * 16 / 2);
}
END_TEST

START_TEST(sheet_hides_no_object_that_owns_it)
{
    stage s = stage_with(NULL, 1);
    const occ_sheet whole = square(-2, 2, OCC_SIDES_BOTH);
    obs_add_sheet(&s.scene, &whole, 0);
    ck_assert_uint_eq(samples_of(&s), 16 * 16);
}
END_TEST

enum { CELLS = 16 };

// A wall of triangles, corners and diagonals on the rays of samples: at x and y in multiples of
// 1/32 at z = -2. Some corners are moved about, so that the wall is bent.
static void add_wall_of_triangles(stage *s, kit_random *random, const float eye[3])
{
    float corner[CELLS + 1][CELLS + 1][3];
    const occ_box owner = block(eye[0], eye[1], eye[2] + 90, 1, 1, 1);
    uint32_t other = obs_add_object(&s->scene, &owner);
    for (int i = 0; i <= CELLS; i++)
        for (int k = 0; k <= CELLS; k++) {
            float part = kit_below(random, 2) ? 1.0f : kit_between(random, 0.75f, 1);
            corner[i][k][0] = eye[0] + part * (float)(4 * i - 2 * CELLS + 1) / 32;
            corner[i][k][1] = eye[1] + part * (float)(4 * k - 2 * CELLS + 1) / 32;
            corner[i][k][2] = eye[2] - part * 2;
        }
    for (int i = 0; i < 2 * CELLS * CELLS; i++) {
        int x = i / 2 % CELLS, y = i / 2 / CELLS, upper = i % 2;
        occ_sheet sheet = {.corner_count = 3, .sides = OCC_SIDES_FRONT};
        memcpy(sheet.corner[0], corner[x][y], sizeof sheet.corner[0]);
        memcpy(sheet.corner[1], corner[x + 1][y + !!upper], sizeof sheet.corner[0]);
        memcpy(sheet.corner[2], corner[x + !upper][y + 1], sizeof sheet.corner[0]);
        obs_add_sheet(&s->scene, &sheet, other);
    }
}

static void look_orthographic(obs_frame *frame)
{
    memset(frame->proj, 0, sizeof frame->proj);
    frame->proj[0] = frame->proj[5] = frame->proj[15] = 1.0f;
    frame->proj[10] = -0.0625f;
    frame->proj[14] = -1.0f;
}

START_TEST(no_ray_slips_through_a_seam)
{
    kit_random random = {5};
    for (int i = 0; i < 40; i++) {
        float eye[3] = {0, 0, 0};
        for (int j = 0; i % 2 && j < 3; j++)
            eye[j] = kit_between(&random, -9, 9);
        const occ_box behind = block(eye[0], eye[1], eye[2] - 5, 1, 1, 1);
        stage s = stage_with(&behind, 1);
        const double from[3] = {(double)eye[0], (double)eye[1], (double)eye[2]};
        s.scene.frames[0] = obs_look(from, along_z, 1, 1, 0.125, 100);
        if (i % 4 > 1) look_orthographic(&s.scene.frames[0]);
        add_wall_of_triangles(&s, &random, eye);
        if (i % 4 > 1) s.scene.objects[0] = block(eye[0], eye[1], eye[2] - 5, 0.5f, 0.5f, 1);
        uint32_t seen = samples_of(&s);
        ck_assert_msg(seen == 0, "wall %d: %u samples", i, seen);
    }
}
END_TEST

// --- wrong results -------------------------------------------------------------------------------

// Object 0 before or behind sheets; `shown` is the result's word on it.
static outcome judged(const occ_sheet *sheets, int count, bool shown, uint32_t samples)
{
    stage s = stage_with(NULL, 1);
    for (int i = 0; i < count; i++)
        add_pane(&s, &sheets[i]);
    sample(&s, shown);
    s.truth.verdicts[0].samples = samples; // as if sampling had seen so much
    s.truth.verdicts[0].rays = 0;
    const settle_limits limits = {SETTLE_DEFAULT, SETTLE_DEFAULT};
    settle *judges = settle_create(&s.scene, &s.truth);
    outcome found = settle_with(judges, &s, limits);
    settle_destroy(judges);
    free_stage(&s);
    return found;
}

START_TEST(what_a_sheet_hides_is_settled)
{
    const occ_sheet whole = square(-2, 2, OCC_SIDES_FRONT), back = turned_round(&whole);
    outcome found = judged(&whole, 1, false, 3);
    ck_assert_uint_eq(found.sums.false_refuted, 1);
    ck_assert_uint_eq(found.counts.false_hidden, 0);
    found = judged(&whole, 1, true, 0);
    ck_assert_uint_eq(found.counts.missed, 1);
    found = judged(&back, 1, true, 0);
    ck_assert_uint_eq(found.counts.missed, 0);
    ck_assert_uint_eq(found.sums.judged_visible, 1);
}
END_TEST

START_TEST(wrong_verdicts_past_sheets_are_named)
{
    const occ_sheet whole = square(-2, 2, OCC_SIDES_FRONT), back = turned_round(&whole);
    occ_sheet halves[2] = {square(-2, 0.5f, OCC_SIDES_BOTH), square(0.5f, 2, OCC_SIDES_FRONT)};
    ck_assert_uint_eq(judged(&back, 1, false, 0).sums.agreed_seen, 1);
    ck_assert_uint_eq(judged(&back, 1, false, 9).sums.false_confirmed, 1);
    ck_assert_uint_eq(judged(halves, 1, false, 0).sums.agreed_seen, 1);
    ck_assert_uint_eq(judged(halves, 2, false, 0).sums.agreed_seen, 0);
    ck_assert_uint_eq(judged(halves, 2, false, 0).sums.agreed_doubtful, 0);
    halves[1].corner[3][0] = nextafterf(0.5f, 1); // a gap of one step, on top
    ck_assert_uint_eq(judged(halves, 2, false, 0).sums.agreed_seen, 1);
}
END_TEST

// By the judge's reading the sheet hides the object whose front is in it.
START_TEST(doubt_past_sheets_counts_against_the_result)
{
    occ_sheet touched = square(-3, 3, OCC_SIDES_FRONT);
    for (int c = 0; c < 4; c++)
        touched.corner[c][2] = -4;
    outcome found = judged(&touched, 1, false, 5);
    ck_assert_uint_eq(found.sums.false_confirmed, 1);
    found = judged(&touched, 1, false, 0);
    ck_assert_uint_eq(found.sums.agreed_doubtful, 1);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("truth_sheets");
    TCase *samples = tcase_create("samples");
    tcase_add_test(samples, sheet_hides_the_samples_that_it_covers);
    tcase_add_test(samples, one_sided_sheet_hides_from_its_front_alone);
    tcase_add_test(samples, sheet_without_area_or_edge_on_hides_nothing);
    tcase_add_test(samples, bent_sheet_hides_behind_its_triangles);
    tcase_add_test(samples, sheet_hides_no_object_that_owns_it);
    tcase_add_test(samples, no_ray_slips_through_a_seam);
    suite_add_tcase(suite, samples);
    TCase *settled = tcase_create("settled");
    tcase_add_test(settled, what_a_sheet_hides_is_settled);
    tcase_add_test(settled, wrong_verdicts_past_sheets_are_named);
    tcase_add_test(settled, doubt_past_sheets_counts_against_the_result);
    suite_add_tcase(suite, settled);
    return test_run_suite(suite);
}
