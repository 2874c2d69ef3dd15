// SPDX-License-Identifier: Apache-2.0
// The judge of sheets: where the answer is known by hand (see judge_scenes.h), against flat boxes
// with the same corners, and against segments and triangles in whole numbers.
// labels: property oracle
// timeout: 120
#include "judge_scenes.h"
#include "support.h"

#include <string.h>

// --- known by hand -------------------------------------------------------------------------------

// In the plane x = `x`, seen from the eye counterclockwise: y to the right and z up.
static occ_sheet sheet_at(float x, const float (*yz)[2], uint32_t count, occ_sides sides)
{
    occ_sheet sheet = {.corner_count = count, .sides = sides};
    for (uint32_t c = 0; c < count; c++) {
        sheet.corner[c][0] = x;
        sheet.corner[c][1] = yz[c][0];
        sheet.corner[c][2] = yz[c][1];
    }
    return sheet;
}

static occ_sheet pane(float low_y, float high_y, float low_z, float high_z, occ_sides sides)
{
    const float yz[4][2] = {{low_y, low_z}, {high_y, low_z}, {high_y, high_z}, {low_y, high_z}};
    return sheet_at(0, yz, 4, sides);
}

static occ_sheet octagon(occ_sides sides)
{
    static const float yz[8][2] = {{2, -4}, {4, -2}, {4, 2},   {2, 4},
                                   {-2, 4}, {-4, 2}, {-4, -2}, {-2, -4}};
    return sheet_at(0, yz, 8, sides);
}

// The verdict with and without the filter, which must agree.
static bool sees_past(judge *j, const occ_box *object, const occ_sheet *sheets, size_t count)
{
    bool seen[2];
    for (int filter = 0; filter < 2; filter++) {
        judge_filter(j, filter == 1);
        judge_set_occluders(j, NULL, NULL, 0);
        judge_add_sheets(j, sheets, NULL, count);
        seen[filter] = judge_sees(j, object, -1);
        ck_assert_int_eq(judge_share(j, object, -1) > 0.0, seen[filter]);
    }
    ck_assert_int_eq(seen[0], seen[1]);
    return seen[0];
}

static bool seen_from(const double eye[3], const occ_box *object, const occ_sheet *sheets,
                      size_t count)
{
    judge *j = judge_of_eye(eye);
    bool seen = sees_past(j, object, sheets, count);
    judge_free(j);
    return seen;
}

START_TEST(sheet_hides_what_is_behind_all_of_it)
{
    const occ_sheet whole = octagon(OCC_SIDES_BOTH);
    const occ_box inside = panel(-8, -8, 8, -4, 4), corner = panel(-8, 6, 8, 4, 6);
    const occ_box beyond = panel(-8, 6, 8, 4, 6.25f), before = panel(1, -1, 1, -1, 1);
    const occ_box square = panel(-8, -8, 8, -8, 8);
    ck_assert(!seen_from(eye_on_x, &inside, &whole, 1));
    ck_assert(seen_from(eye_on_x, &corner, &whole, 1)); // its corner is where one of 8 is cut off
    ck_assert(seen_from(eye_on_x, &beyond, &whole, 1));
    ck_assert(seen_from(eye_on_x, &before, &whole, 1));
    judge *j = judge_of_eye(eye_on_x);
    judge_add_sheets(j, &whole, NULL, 1);
    ck_assert_double_eq_tol(judge_share(j, &square, -1), 1.0 / 8.0, 1e-12);
    judge_free(j);
}
END_TEST

START_TEST(one_sided_sheet_hides_from_its_front_alone)
{
    static const double behind[3] = {-8, 0, 0}, in_plane[3] = {0, 8, 0};
    const occ_box far_side = panel(-8, -4, 4, -4, 4), near_side = panel(8, -4, 4, -4, 4);
    const occ_box aside = {{0, -8, 0}, {{0, 0, 0}, {0, 0, 0}, {0, 0, 1}}};
    for (int sides = OCC_SIDES_BOTH; sides <= OCC_SIDES_FRONT; sides++) {
        const occ_sheet quad = pane(-4, 4, -4, 4, (occ_sides)sides);
        const occ_sheet eight = octagon((occ_sides)sides);
        ck_assert(!seen_from(eye_on_x, &far_side, &quad, 1));
        ck_assert_int_eq(seen_from(behind, &near_side, &quad, 1), sides == OCC_SIDES_FRONT);
        ck_assert_int_eq(seen_from(behind, &near_side, &eight, 1), sides == OCC_SIDES_FRONT);
        ck_assert_int_eq(seen_from(in_plane, &aside, &quad, 1), sides == OCC_SIDES_FRONT);
    }
}
END_TEST

START_TEST(gap_between_sheets_shows)
{
    const occ_box wall = block(-9, -8, -7, 7, -7, 7);
    occ_sheet halves[2] = {pane(-4, 0, -4, 4, OCC_SIDES_FRONT), pane(0, 4, -4, 4, OCC_SIDES_BOTH)};
    ck_assert(seen_from(eye_on_x, &wall, halves, 1));
    ck_assert(!seen_from(eye_on_x, &wall, halves, 2));
    halves[1].corner[0][1] = 0x1p-149f; // the smallest there is, at one end
    ck_assert(seen_from(eye_on_x, &wall, halves, 2));
    halves[1].corner[0][1] = -0x1p-149f;
    ck_assert(!seen_from(eye_on_x, &wall, halves, 2));
}
END_TEST

// What is between the triangles of a bent sheet is hidden, what is in front of one of them is not.
START_TEST(bent_sheet_is_its_triangles)
{
    occ_sheet bent = pane(-4, 4, -4, 4, OCC_SIDES_BOTH);
    bent.corner[3][0] = -4; // triangle 0 2 3 leans back
    const occ_box upper = {{-0.75f, -1, 1}, {{0}}}, lower = {{-1, 1, -1}, {{0}}};
    const occ_box far_away = panel(-40, -12, 12, -12, 12);
    ck_assert(seen_from(eye_on_x, &upper, &bent, 1));
    ck_assert(!seen_from(eye_on_x, &lower, &bent, 1));
    ck_assert(!seen_from(eye_on_x, &far_away, &bent, 1));
}
END_TEST

START_TEST(sheets_and_boxes_hide_together)
{
    const occ_box wall = panel(-8, -7, 7, -7, 7), left = panel(0, -4, 0, -4, 4);
    const occ_sheet right = pane(0, 4, -4, 4, OCC_SIDES_FRONT);
    const int owner[1] = {3};
    judge *j = judge_of_eye(eye_on_x);
    judge_set_occluders(j, &left, NULL, 1);
    ck_assert(judge_sees(j, &wall, -1));
    judge_add_sheets(j, &right, owner, 1);
    ck_assert(!judge_sees(j, &wall, -1));
    ck_assert(judge_sees(j, &wall, 3)); // the sheet is a part of it
    judge_set_occluders(j, &left, NULL, 1);
    ck_assert(judge_sees(j, &wall, -1)); // the sheet is gone
    judge_free(j);
}
END_TEST

START_TEST(sheet_grows_as_the_box_with_its_corners)
{
    const occ_sheet quad = pane(-4, 4, -4, 4, OCC_SIDES_BOTH);
    const occ_box box = panel(0, -4, 4, -4, 4);
    static const double eye[3] = {8, 0.5, 0.25};
    unsigned counts[2] = {0};
    for (int step = 0; step < 8; step++) {
        const occ_box object = panel(-8, -8, 7.5f + 0.125f * (float)step, -7, 7);
        bool seen[2];
        for (int is_sheet = 0; is_sheet < 2; is_sheet++) {
            judge *j = judge_of_eye(eye);
            judge_set_occluders(j, &box, NULL, is_sheet ? 0 : 1);
            judge_add_sheets(j, &quad, NULL, is_sheet ? 1 : 0);
            ck_assert(judge_grow(j, 0.02));
            seen[is_sheet] = judge_sees(j, &object, -1);
            judge_free(j);
        }
        ck_assert_int_eq(seen[0], seen[1]);
        counts[seen[0]]++;
    }
    ck_assert_uint_gt(counts[0], 2); // more than without growth
    ck_assert_uint_gt(counts[1], 2);
}
END_TEST

// --- against flat boxes --------------------------------------------------------------------------

static float pick_grid(kit_random *random, int reach)
{
    return (float)((int)kit_below(random, 2u * (uint32_t)reach + 1u) - reach);
}

static occ_box grid_box(kit_random *random, int reach, int size, bool is_flat)
{
    occ_box box = {{0}, {{0}}};
    for (int j = 0; j < 3; j++) {
        box.center[j] = pick_grid(random, reach);
        for (int k = 0; k < (is_flat ? 2 : 3); k++)
            box.axis[k][j] = 0.5f * pick_grid(random, size);
    }
    return box;
}

static occ_sheet sheet_of_box(const occ_box *box)
{
    static const float sign[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    occ_sheet sheet = {.corner_count = 4};
    for (int c = 0; c < 4; c++)
        for (int j = 0; j < 3; j++)
            sheet.corner[c][j] =
                box->center[j] + sign[c][0] * box->axis[0][j] + sign[c][1] * box->axis[1][j];
    return sheet;
}

static bool has_area(const occ_box *box)
{
    const float *u = box->axis[0], *v = box->axis[1];
    return u[0] * v[1] != u[1] * v[0] || u[1] * v[2] != u[2] * v[1] || u[2] * v[0] != u[0] * v[2];
}

static judge *any_judge(kit_random *random)
{
    double at[3];
    float eye[3], target[3];
    for (int j = 0; j < 3; j++) {
        at[j] = (double)pick_grid(random, 6) + (j == 0 ? 0.5 : 0.0);
        eye[j] = kit_between(random, -8, 8);
        target[j] = kit_between(random, -2, 2);
    }
    const world_lens lens = {.projection = (world_projection)kit_below(random, WORLD_PROJECTIONS),
                             .near_z = kit_below(random, 2) ? 0.1f : 3.0f,
                             .far_z = kit_below(random, 2) ? 1000.0f : 14.0f};
    uint32_t kind = kit_below(random, 3);
    const occ_camera_desc camera = world_camera(eye, target, &lens);
    return kind == 0   ? judge_of_eye(at)
           : kind == 1 ? judge_of_direction(at)
                       : judge_of_camera(&camera);
}

static void agree_with_boxes(kit_random *random, unsigned counts[2])
{
    enum { MOST = 4 };
    occ_box boxes[MOST];
    occ_sheet sheets[MOST];
    uint32_t count = 1 + kit_below(random, MOST);
    for (uint32_t i = 0; i < count; i++) {
        do {
            boxes[i] = grid_box(random, 3, 6, true);
        } while (!has_area(&boxes[i]));
        sheets[i] = sheet_of_box(&boxes[i]);
    }
    judge *j = any_judge(random);
    ck_assert_ptr_nonnull(j);
    for (int i = 0; i < 6; i++) {
        const occ_box object = grid_box(random, 5, 1, i % 2 == 0);
        judge_filter(j, true);
        judge_set_occluders(j, boxes, NULL, count);
        bool seen = judge_sees(j, &object, -1);
        KIT_CHECK(sees_past(j, &object, sheets, count) == seen, "object %d: not %d", i, (int)seen);
        counts[seen]++;
    }
    judge_free(j);
}

START_TEST(sheet_hides_what_the_box_with_its_corners_hides)
{
    kit_random random = {21};
    unsigned counts[2] = {0};
    for (int i = 0; i < WORLD_SHARE(2000); i++)
        agree_with_boxes(&random, counts);
    ck_assert_uint_gt(counts[0], WORLD_SHARE(1000));
    ck_assert_uint_gt(counts[1], WORLD_SHARE(1000));
}
END_TEST

// --- against whole numbers -----------------------------------------------------------------------

static int sign_of(int64_t value)
{
    return (value > 0) - (value < 0);
}

static void minus(const int64_t a[3], const int64_t b[3], int64_t out[3])
{
    for (int j = 0; j < 3; j++)
        out[j] = a[j] - b[j];
}

static int64_t determinant(const int64_t a[3], const int64_t b[3], const int64_t c[3])
{
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
}

// On which side of the plane of a, b and c a point is: 1 from where they go counterclockwise.
static int side_of(const int64_t a[3], const int64_t b[3], const int64_t c[3], const int64_t p[3])
{
    int64_t u[3], v[3], w[3];
    minus(b, a, u);
    minus(c, a, v);
    minus(p, a, w);
    return sign_of(determinant(u, v, w));
}

// Whether the closed segment from `eye` to `p`, neither in the triangle's plane but perhaps `p`,
// meets the closed triangle.
static bool blocks(int64_t (*corner)[3], bool one_sided, const int64_t eye[3], const int64_t p[3])
{
    int from = side_of(corner[0], corner[1], corner[2], eye);
    int to = side_of(corner[0], corner[1], corner[2], p);
    bool some[3] = {false, false, false};
    if (from == to || from == 0 || (one_sided && from < 0)) return false;
    for (int e = 0; e < 3; e++)
        some[1 + side_of(eye, corner[e], corner[(e + 1) % 3], p)] = true;
    return !(some[0] && some[2]);
}

// Fans of three to eight corners anywhere: bent, folded over, or without an area.
static void agree_with_segments(kit_random *random, unsigned counts[2])
{
    int64_t corner[OCC_SHEET_CORNERS][3], eye[3], p[3];
    double at[3];
    occ_sheet sheet = {.corner_count = 3 + kit_below(random, 6),
                       .sides = (occ_sides)kit_below(random, 2)};
    bool is_flat = kit_below(random, 2) == 0;
    for (uint32_t c = 0; c < sheet.corner_count; c++)
        for (int j = 0; j < 3; j++) {
            sheet.corner[c][j] = is_flat && j == 2 ? 1 : pick_grid(random, 5);
            corner[c][j] = (int64_t)sheet.corner[c][j];
        }
    for (int j = 0; j < 3; j++)
        at[j] = (double)(eye[j] = (int64_t)pick_grid(random, 9));
    judge *j = judge_of_eye(at);
    for (int i = 0; i < 12; i++) {
        occ_box dot = {{0}, {{0}}};
        bool hidden = false, doubtful = false;
        for (int k = 0; k < 3; k++) {
            dot.center[k] = pick_grid(random, 9);
            p[k] = (int64_t)dot.center[k];
        }
        for (uint32_t c = 2; c < sheet.corner_count; c++) {
            int64_t triangle[3][3];
            memcpy(triangle[0], corner[0], sizeof triangle[0]);
            memcpy(triangle[1], corner[c - 1], 2 * sizeof triangle[0]);
            doubtful |= !side_of(triangle[0], triangle[1], triangle[2], eye);
            hidden |= blocks(triangle, sheet.sides == OCC_SIDES_FRONT, eye, p);
        }
        if (doubtful && !hidden) continue; // what is seen edge-on is told by flat boxes
        KIT_CHECK(sees_past(j, &dot, &sheet, 1) != hidden, "point %d: not %d", i, (int)hidden);
        counts[hidden]++;
    }
    judge_free(j);
}

START_TEST(points_are_hidden_where_a_segment_meets_a_triangle)
{
    kit_random random = {22};
    unsigned counts[2] = {0};
    for (int i = 0; i < WORLD_SHARE(8000); i++)
        agree_with_segments(&random, counts);
    ck_assert_uint_gt(counts[0], WORLD_SHARE(4000));
    ck_assert_uint_gt(counts[1], WORLD_SHARE(4000));
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("judge_sheets");
    TCase *known = tcase_create("known");
    tcase_add_test(known, sheet_hides_what_is_behind_all_of_it);
    tcase_add_test(known, one_sided_sheet_hides_from_its_front_alone);
    tcase_add_test(known, gap_between_sheets_shows);
    tcase_add_test(known, bent_sheet_is_its_triangles);
    tcase_add_test(known, sheets_and_boxes_hide_together);
    tcase_add_test(known, sheet_grows_as_the_box_with_its_corners);
    suite_add_tcase(suite, known);
    TCase *random = tcase_create("random");
    tcase_add_test(random, sheet_hides_what_the_box_with_its_corners_hides);
    tcase_add_test(random, points_are_hidden_where_a_segment_meets_a_triangle);
    suite_add_tcase(suite, random);
    return test_run_suite(suite);
}
