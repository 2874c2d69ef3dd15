// SPDX-License-Identifier: Apache-2.0
// timeout: 120
// Sheets of surfaces that are known, and what the calls do with input, memory and time.
#include "kit.h"
#include "shapes.h"
#include "support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 512 };

static shapes *world;
static occ_found_sheet sheets[MOST];
static size_t count;
static occ_sheets_stats stats;
static kit_heap heap;
static kit_log record;

static void set_up(void)
{
    world = calloc(1, sizeof *world);
    ck_assert_ptr_nonnull(world);
    shapes_reset(world);
    heap = (kit_heap){0};
    kit_forget(&record);
}

static void tear_down(void)
{
    free(world);
    ck_assert_uint_eq(heap.blocks, 0);
}

static occ_sheets_desc plain(void)
{
    return (occ_sheets_desc){
        .work = {.allocator = kit_allocator(&heap), .logger = kit_logger(&record)}};
}

static void find(const occ_sheets_desc *desc)
{
    occ_soup soup = shapes_soup(world);
    occ_sheet_fault fault;
    double sum = 0.0;
    ck_assert_int_eq(occ_sheets_find(&soup, desc, sheets, MOST, &count, &stats), OCC_SUCCESS);
    KIT_CHECK(!occ_verify_sheets(&soup, sheets, count, desc, &fault), "sheet %u: reason %d",
              fault.sheet, fault.reason);
    for (size_t i = 0; i < count; i++) {
        ck_assert_float_le(sheets[i].gain, sheets[i].area * 1.0001f);
        ck_assert(i == 0 || sheets[i].gain <= sheets[i - 1].gain);
        sum += (double)sheets[i].gain;
    }
    ck_assert_double_eq_tol(sum, stats.covered, 1e-3 * stats.covered + 1e-30);
    ck_assert_double_le(stats.covered, stats.area * 1.0001);
}

// Two triangles, with the diagonal from the first corner.
static void add_quad(const float *a, const float *b, const float *c, const float *d)
{
    shapes_triangle(world, a, b, c);
    shapes_triangle(world, a, c, d);
}

static void add_rectangle(float x0, float y0, float x1, float y1)
{
    add_quad((float[3]){x0, y0, 0}, (float[3]){x1, y0, 0}, (float[3]){x1, y1, 0},
             (float[3]){x0, y1, 0});
}

// The i-th square of rows of `wide`.
static void add_square(int i, int wide)
{
    int y = i / wide;
    float x0 = (float)(i - y * wide), y0 = (float)y;
    add_rectangle(x0, y0, x0 + 1.0f, y0 + 1.0f);
}

static void turn_world(float angle)
{
    float c = cosf(angle), s = sinf(angle);
    memcpy(world->turn, (float[3][3]){{c, 0, -s}, {0, 1, 0}, {s, 0, c}}, sizeof world->turn);
}

// A slant whose points are floats all the same.
static void slant_world(void)
{
    memcpy(world->turn, (float[3][3]){{1, 0, 0}, {0, 1, 0}, {0.5f, 0.25f, 1}}, sizeof world->turn);
}

// Bounds of the first two coordinates of a sheet.
static void bounds_of(const occ_sheet *sheet, float low[2], float high[2])
{
    for (int k = 0; k < 2; k++) {
        low[k] = INFINITY;
        high[k] = -INFINITY;
        for (uint32_t i = 0; i < sheet->corner_count; i++) {
            low[k] = fminf(low[k], sheet->corner[i][k]);
            high[k] = fmaxf(high[k], sheet->corner[i][k]);
        }
    }
}

// --- surfaces ------------------------------------------------------------------------------------

START_TEST(grid_of_quads_is_one_sheet_however_it_is_turned)
{
    static const float across[3][3][3] = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                          {{3, 0, 1}, {0, 1, 0}, {4, 0, 5}},
                                          {{1, 0, 0}, {0, 1, 0}, {0.5f, 0.25f, 1}}};
    occ_sheets_desc desc = plain();
    for (int kind = 0; kind < 3; kind++) {
        shapes_reset(world);
        memcpy(world->turn, across[kind], sizeof world->turn);
        for (int i = 0; i < 64; i++)
            add_square(i, 8);
        find(&desc);
        ck_assert_uint_eq(count, 1);
        ck_assert_uint_eq(stats.planes, 1);
        ck_assert_uint_eq(sheets[0].sheet.corner_count, 4);
        ck_assert_uint_eq(sheets[0].triangle_count, 128);
        ck_assert_uint_eq(sheets[0].triangle, 0);
        ck_assert_double_eq_tol((double)sheets[0].area, stats.area, 1e-3);
    }
}
END_TEST

START_TEST(no_sheet_reaches_into_a_window)
{
    occ_sheets_desc desc = plain();
    for (int slanted = 0; slanted < 2; slanted++) {
        shapes_reset(world);
        if (slanted) slant_world();
        for (int i = 0; i < 25; i++)
            if (i != 12) add_square(i, 5);
        find(&desc);
        ck_assert_uint_eq(stats.planes, 1);
        ck_assert_uint_eq(count, 4); // along each side of it, from wall to wall
        for (size_t i = 0; i < count; i++) {
            float low[2], high[2];
            bounds_of(&sheets[i].sheet, low, high);
            ck_assert(low[0] >= 3 || high[0] <= 2 || low[1] >= 3 || high[1] <= 2);
        }
        ck_assert_double_eq_tol(stats.covered, stats.area, 1e-4);
    }
}
END_TEST

START_TEST(corners_on_others_edges_do_not_part_a_wall)
{
    occ_sheets_desc desc = plain();
    add_rectangle(0, 0, 3, 1);
    add_rectangle(0, 1, 1, 3);
    add_rectangle(1, 1, 3, 2.5f);
    add_rectangle(1, 2.5f, 3, 3);
    find(&desc);
    ck_assert_uint_eq(count, 1);
    ck_assert_uint_eq(sheets[0].triangle_count, 8);
    ck_assert_float_eq(sheets[0].area, 9.0f);
}
END_TEST

START_TEST(sheets_of_an_angle_overlap_in_its_corner)
{
    occ_sheets_desc desc = plain();
    add_rectangle(0, 0, 4, 1);
    add_rectangle(0, 1, 1, 3);
    find(&desc);
    ck_assert_uint_eq(count, 2);
    ck_assert_float_eq(sheets[0].area, 4.0f);
    ck_assert_float_eq(sheets[1].area, 3.0f);
    ck_assert_float_eq_tol(sheets[1].gain, 2.0f, 1e-5f);
}
END_TEST

START_TEST(octagon_is_one_sheet_and_rounder_shapes_nearly)
{
    occ_sheets_desc desc = plain();
    for (int corners = 8; corners <= 16; corners += 8) {
        shapes_reset(world);
        for (int i = 0; i < corners; i++) {
            float a = 6.2831853f * (float)i / (float)corners,
                  b = 6.2831853f * (float)(i + 1) / (float)corners;
            if (i == corners - 1) b = 0.0f;
            shapes_triangle(world, (float[3]){0, 0, 0}, (float[3]){cosf(a), sinf(a), 0},
                            (float[3]){cosf(b), sinf(b), 0});
        }
        find(&desc);
        ck_assert_uint_eq(sheets[0].sheet.corner_count, 8);
        ck_assert_double_ge((double)sheets[0].area, (corners == 8 ? 0.9999 : 0.9) * stats.area);
        if (corners == 8) ck_assert_uint_eq(count, 1);
    }
}
END_TEST

START_TEST(copies_and_flipped_triangles_do_not_matter_to_two_sides)
{
    occ_sheets_desc desc = plain();
    static const float p[4][3] = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}};
    shapes_triangle(world, p[0], p[1], p[2]);
    shapes_triangle(world, p[0], p[3], p[2]); // flipped
    shapes_triangle(world, p[1], p[2], p[0]); // again
    shapes_triangle(world, p[2], p[1], p[0]); // and turned over
    find(&desc);
    ck_assert_uint_eq(count, 1);
    ck_assert_float_eq(sheets[0].area, 2.0f);
    ck_assert_uint_eq(stats.counts.duplicate, 2);
    desc.sides = OCC_SIDES_FRONT;
    find(&desc);
    ck_assert_uint_eq(count, 2); // which do not hide from the same side
    ck_assert_float_eq(sheets[0].area, 1.0f);
    ck_assert_int_eq(sheets[0].sheet.sides, OCC_SIDES_FRONT);
}
END_TEST

START_TEST(decal_in_a_wall_does_not_part_it)
{
    occ_sheets_desc desc = plain();
    add_rectangle(0, 0, 4, 4);
    add_rectangle(1, 1, 2, 2);
    add_rectangle(0, 0, 1, 0.5f); // in its corner: shares part of its edges
    find(&desc);
    ck_assert_uint_ge(count, 1);
    ck_assert_float_eq(sheets[0].area, 16.0f);
}
END_TEST

START_TEST(surfaces_that_cross_or_meet_in_an_edge_are_sheets_each)
{
    occ_sheets_desc desc = plain();
    static const float p[8][3] = {{0, 0, 0},  {4, 0, 0},  {4, 2, 0}, {0, 2, 0},
                                  {4, 0, -2}, {4, 2, -2}, {4, 0, 2}, {4, 2, 2}};
    add_quad(p[0], p[1], p[2], p[3]);
    add_quad(p[1], p[4], p[5], p[2]);
    add_quad(p[1], p[6], p[7], p[2]);
    add_quad((float[3]){2, -1, -1}, (float[3]){2, 3, -1}, (float[3]){2, 3, 1},
             (float[3]){2, -1, 1});
    find(&desc);
    ck_assert_uint_eq(count, 3); // the two at the edge are one wall from end to end
    ck_assert_float_eq(sheets[0].area, 8.0f);
    ck_assert_float_eq(sheets[1].area, 8.0f);
    ck_assert_float_eq(sheets[2].area, 8.0f);
}
END_TEST

START_TEST(turned_quads_are_sheets_though_no_plane_holds_their_corners)
{
    occ_sheets_desc desc = plain();
    turn_world(0.7f);
    memcpy(world->shift, (float[3]){0.1f, 0.7f, -3.3f}, sizeof world->shift);
    for (int i = 0; i < 3; i++) {
        float x = 1.37f * (float)i;
        world->turn[1][0] = 0.31f;
        world->turn[2][1] = -0.17f;
        add_rectangle(x, 0.2f, x + 1.37f, 2.9f);
    }
    for (int sides = 0; sides < 2; sides++) {
        desc.sides = sides ? OCC_SIDES_FRONT : OCC_SIDES_BOTH;
        find(&desc);
        ck_assert_uint_ge(stats.planes, 2); // else the test tests nothing
        ck_assert_uint_le(count, 2);
        ck_assert_double_eq_tol(stats.covered, stats.area, 1e-4);
    }
}
END_TEST

START_TEST(sharp_bends_are_not_made_flat)
{
    occ_sheets_desc desc = plain();
    shapes_round(world, 8, 0.0f);
    find(&desc);
    ck_assert_uint_ge(count, 100);
    ck_assert_uint_eq(sheets[0].triangle_count, 2);
}
END_TEST

START_TEST(see_through_triangles_are_no_part_of_a_sheet)
{
    occ_sheets_desc desc = plain();
    bool see_through[6] = {false, false, true, true, false, false};
    for (int i = 0; i < 3; i++)
        add_rectangle((float)i, 0, (float)(i + 1), 1);
    desc.see_through = see_through;
    find(&desc);
    ck_assert_uint_eq(count, 2);
    ck_assert_uint_eq(stats.see_through, 2);
    ck_assert_uint_eq(sheets[0].triangle + sheets[1].triangle, 4);
    for (int i = 0; i < 6; i++)
        see_through[i] = true;
    find(&desc);
    ck_assert_uint_eq(count, 0);
}
END_TEST

START_TEST(labels_are_told_and_may_keep_sheets_apart)
{
    occ_sheets_desc desc = plain();
    const uint32_t labels[6] = {7, 7, 7, 7, 9, 9};
    for (int i = 0; i < 3; i++)
        add_rectangle((float)i, 0, (float)(i + 1), 1);
    desc.labels = labels;
    find(&desc);
    ck_assert_uint_eq(count, 1);
    ck_assert_uint_eq(sheets[0].label, OCC_NO_LABEL);
    desc.labels_apart = true;
    find(&desc);
    ck_assert_uint_eq(count, 2);
    ck_assert_uint_eq(sheets[0].label, 7);
    ck_assert_float_eq(sheets[0].area, 2.0f);
    ck_assert_uint_eq(sheets[1].label, 9);
    desc.labels = NULL;
    find(&desc);
    ck_assert_uint_eq(sheets[0].label, 0);
}
END_TEST

START_TEST(small_sheets_are_left_out_and_fewer_are_the_first_of_more)
{
    occ_sheets_desc desc = plain();
    occ_found_sheet all[MOST];
    for (int i = 0; i < 8; i++)
        add_rectangle(10.0f * (float)i, 0, 10.0f * (float)i + 1.0f, (float)(i + 1));
    find(&desc);
    ck_assert_uint_eq(count, 8);
    memcpy(all, sheets, sizeof all);
    desc.min_area = 3.5f;
    find(&desc);
    ck_assert_uint_eq(count, 5);
    desc.min_area = 0.0f;
    occ_soup soup = shapes_soup(world);
    ck_assert_int_eq(occ_sheets_find(&soup, &desc, sheets, 3, &count, &stats), OCC_SUCCESS);
    ck_assert_uint_eq(count, 3);
    ck_assert_uint_eq(stats.found, 8);
    ck_assert(kit_same_bits(sheets, all, 3 * sizeof *all));
    ck_assert_int_eq(occ_sheets_find(&soup, NULL, NULL, 0, &count, NULL), OCC_SUCCESS);
    ck_assert_uint_eq(count, 0);
}
END_TEST

// --- verification --------------------------------------------------------------------------------

static occ_sheet_reason judge(uint32_t corners, const float (*corner)[3], occ_sides sides,
                              occ_sheet_fault *fault)
{
    occ_sheets_desc desc = plain();
    occ_soup soup = shapes_soup(world);
    occ_found_sheet made = {.sheet = {.corner_count = corners, .sides = sides}};
    desc.sides = sides;
    for (uint32_t i = 0; i < corners && i < OCC_SHEET_CORNERS; i++)
        memcpy(made.sheet.corner[i], corner[i], sizeof corner[i]);
    occ_result result = occ_verify_sheets(&soup, &made, 1, &desc, fault);
    ck_assert_int_eq(result, fault->reason ? OCC_ERROR_NOT_INSIDE : OCC_SUCCESS);
    ck_assert_uint_eq(fault->sheet, fault->reason ? 0 : UINT32_MAX);
    return fault->reason;
}

static occ_sheet_reason judge_rectangle(float x0, float y0, float x1, float y1)
{
    occ_sheet_fault fault;
    const float p[4][3] = {{x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0}};
    return judge(4, p, OCC_SIDES_BOTH, &fault);
}

START_TEST(false_sheets_are_named_with_the_reason)
{
    occ_sheet_fault fault;
    for (int i = 0; i < 9; i++)
        if (i != 4) add_square(i, 3);
    ck_assert_int_eq(judge_rectangle(0, 0, 3, 1), OCC_SHEET_SOUND);
    ck_assert_int_eq(judge_rectangle(0.3f, 0.2f, 2.9f, 0.9f), OCC_SHEET_SOUND);
    ck_assert_int_eq(judge_rectangle(3, 1, 0, 0), OCC_SHEET_SOUND); // the other way round
    ck_assert_int_eq(judge_rectangle(0, 0, 3, nextafterf(1, 2)), OCC_SHEET_OPEN);
    ck_assert_int_eq(judge_rectangle(-1e-30f, 0, 3, 1), OCC_SHEET_OPEN);
    ck_assert_int_eq(judge_rectangle(1, 1, 2, 2), OCC_SHEET_OPEN);               // the opening
    ck_assert_int_eq(judge_rectangle(0, 0, 3, 3), OCC_SHEET_OPEN);               // around it
    ck_assert_int_eq(judge_rectangle(1.25f, 1.25f, 1.5f, 1.5f), OCC_SHEET_OPEN); // within it
    ck_assert_int_eq(judge_rectangle(10, 10, 11, 11), OCC_SHEET_OPEN);
    ck_assert_int_eq(judge_rectangle(0, 0, 1, 0), OCC_SHEET_MISMADE); // corners alike
    const float in_line[9][3] = {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}};
    ck_assert_int_eq(judge(3, in_line, OCC_SIDES_BOTH, &fault), OCC_SHEET_FLAT);
    ck_assert_int_eq(judge(2, in_line, OCC_SIDES_BOTH, &fault), OCC_SHEET_MISMADE);
    ck_assert_int_eq(judge(9, in_line, OCC_SIDES_BOTH, &fault), OCC_SHEET_MISMADE);
    const float dented[4][3] = {{0, 0, 0}, {3, 0, 0}, {0.5f, 0.5f, 0}, {0, 1, 0}};
    ck_assert_int_eq(judge(4, dented, OCC_SIDES_BOTH, &fault), OCC_SHEET_BENT);
    const float star[5][3] = {{0, 0, 0}, {1, 1, 0}, {0, 0.9f, 0}, {1, 0, 0}, {0.5f, 1, 0}};
    ck_assert_int_eq(judge(5, star, OCC_SIDES_BOTH, &fault), OCC_SHEET_BENT);
    const float lifted[4][3] = {{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {0, 1, 1e-30f}};
    ck_assert_int_eq(judge(4, lifted, OCC_SIDES_BOTH, &fault), OCC_SHEET_OPEN);
    const float beside[4][3] = {{0, 0, 0}, {3, 0, 0}, {3, 1.5f, 0}, {0, 1.5f, 0}};
    ck_assert_int_eq(judge(4, beside, OCC_SIDES_BOTH, &fault), OCC_SHEET_OPEN);
    ck_assert_uint_ne(fault.triangle, UINT32_MAX); // at the opening
}
END_TEST

START_TEST(one_sided_sheets_hide_from_the_front_alone)
{
    occ_sheet_fault fault;
    add_rectangle(0, 0, 2, 1);
    const float front[4][3] = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}},
                back[4][3] = {{0, 0, 0}, {0, 1, 0}, {2, 1, 0}, {2, 0, 0}},
                part[3][3] = {{0.5f, 0, 0}, {0.5f, 1, 0}, {1, 0.5f, 0}};
    ck_assert_int_eq(judge(4, front, OCC_SIDES_FRONT, &fault), OCC_SHEET_SOUND);
    ck_assert_int_eq(judge(4, back, OCC_SIDES_FRONT, &fault), OCC_SHEET_OPEN);
    ck_assert_int_eq(judge(3, part, OCC_SIDES_FRONT, &fault), OCC_SHEET_OPEN);
    ck_assert_int_eq(judge(4, back, OCC_SIDES_BOTH, &fault), OCC_SHEET_SOUND);
    occ_sheets_desc desc = {.sides = OCC_SIDES_FRONT}; // a sheet that hides from more than is drawn
    occ_soup soup = shapes_soup(world);
    occ_found_sheet both = {.sheet = {.corner_count = 4}};
    memcpy(both.sheet.corner, front, sizeof front);
    ck_assert_int_eq(occ_verify_sheets(&soup, &both, 1, &desc, &fault), OCC_ERROR_NOT_INSIDE);
    ck_assert_int_eq(fault.reason, OCC_SHEET_MISMADE);
}
END_TEST

START_TEST(bent_sheets_are_filled_by_triangles_between_their_corners)
{
    occ_sheet_fault fault;
    static const float p[5][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.25f}, {0, 1, 0}, {0.5f, 0.5f, 0}};
    add_quad(p[0], p[1], p[2], p[3]);
    ck_assert_int_eq(judge(4, p, OCC_SIDES_FRONT, &fault), OCC_SHEET_SOUND);
    const float reversed[4][3] = {{0, 0, 0}, {0, 1, 0}, {1, 1, 0.25f}, {1, 0, 0}};
    ck_assert_int_eq(judge(4, reversed, OCC_SIDES_FRONT, &fault), OCC_SHEET_OPEN);
    ck_assert_int_eq(judge(4, reversed, OCC_SIDES_BOTH, &fault), OCC_SHEET_SOUND);
    world->triangles = 0;
    for (int i = 0; i < 4; i++) // around a point that may stick out
        shapes_triangle(world, p[i], p[(i + 1) % 4], p[4]);
    ck_assert_int_eq(judge(4, p, OCC_SIDES_BOTH, &fault), OCC_SHEET_OPEN);
    world->triangles = 0;
    shapes_triangle(world, p[0], p[1], p[2]); // half of it
    ck_assert_int_eq(judge(4, p, OCC_SIDES_BOTH, &fault), OCC_SHEET_OPEN);
}
END_TEST

// --- calls ---------------------------------------------------------------------------------------

static occ_result call_with(const occ_sheets_desc *desc)
{
    occ_soup soup = shapes_soup(world);
    count = 99;
    occ_result result = occ_sheets_find(&soup, desc, sheets, MOST, &count, &stats);
    ck_assert(result == OCC_SUCCESS || count == 0);
    ck_assert_int_eq(occ_verify_sheets(&soup, sheets, 0, desc, NULL), result);
    return result;
}

START_TEST(bad_input_is_refused_by_name)
{
    occ_sheets_desc good = plain(), d = good;
    add_rectangle(0, 0, 1, 1);
    ck_assert_int_eq(call_with(&good), OCC_SUCCESS);
    d.sides = (occ_sides)7;
    ck_assert_int_eq(call_with(&d), OCC_ERROR_INVALID_ARGUMENT);
    d = good, d.min_area = -1.0f;
    ck_assert_int_eq(call_with(&d), OCC_ERROR_INVALID_ARGUMENT);
    d = good, d.min_area = NAN;
    ck_assert_int_eq(call_with(&d), OCC_ERROR_INVALID_ARGUMENT);
    d = good, d.work.allocator.free = NULL;
    ck_assert_int_eq(call_with(&d), OCC_ERROR_INVALID_ARGUMENT);
    world->at[4][1] = NAN;
    ck_assert_int_eq(call_with(&good), OCC_ERROR_NOT_FINITE);
    world->at[4][1] = 2e15f;
    ck_assert_int_eq(call_with(&good), OCC_ERROR_OUT_OF_RANGE);
    world->at[4][1] = 1.0f;
    occ_soup soup = shapes_soup(world);
    ck_assert_int_eq(occ_sheets_find(&soup, &good, NULL, 3, &count, NULL),
                     OCC_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(occ_sheets_find(&soup, &good, sheets, 3, NULL, NULL),
                     OCC_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(occ_sheets_find(NULL, &good, sheets, 3, &count, NULL),
                     OCC_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(occ_verify_sheets(&soup, NULL, 1, &good, NULL), OCC_ERROR_INVALID_ARGUMENT);
    find(&good);
    sheets[0].sheet.corner[2][0] = INFINITY;
    ck_assert_int_eq(occ_verify_sheets(&soup, sheets, 1, &good, NULL), OCC_ERROR_NOT_FINITE);
    sheets[0].sheet.corner[2][0] = 2e15f;
    ck_assert_int_eq(occ_verify_sheets(&soup, sheets, 1, &good, NULL), OCC_ERROR_OUT_OF_RANGE);
    ck_assert_uint_ge(record.errors, 10);
}
END_TEST

// Something of all that there is.
static void add_some(void)
{
    shapes_round(world, 8, 0.4f);
    for (int i = 0; i < 25; i++)
        if (i != 12) add_square(i, 5);
    turn_world(0.4f);
    shapes_box(world, (float[3]){4, 0, 0}, (float[3]){7, 1, 1});
    add_rectangle(9, 0, 10, 4);
    add_rectangle(10, 0, 12, 4);
}

START_TEST(every_allocation_that_fails_is_reported)
{
    occ_sheets_desc desc = plain();
    static occ_found_sheet expected[MOST];
    static bool see_through[SHAPES_MOST] = {true};
    size_t expected_count;
    desc.see_through = see_through;
    add_some();
    occ_soup soup = shapes_soup(world);
    ck_assert_int_eq(occ_sheets_find(&soup, &desc, expected, MOST, &expected_count, &stats),
                     OCC_SUCCESS);
    ck_assert_uint_ge(expected_count, 20);
    uint64_t calls = heap.calls;
    ck_assert_uint_ge(calls, 20);
    ck_assert_int_eq(occ_verify_sheets(&soup, expected, expected_count, &desc, NULL), OCC_SUCCESS);
    uint64_t all = heap.calls;
    for (uint64_t n = 1; n <= all; n++) {
        heap = (kit_heap){.fail_at = n};
        kit_forget(&record);
        occ_result found = occ_sheets_find(&soup, &desc, sheets, MOST, &count, &stats);
        KIT_CHECK(found == (n <= calls ? OCC_ERROR_OUT_OF_MEMORY : OCC_SUCCESS),
                  "allocation %u: %s", (unsigned)n, occ_result_name(found));
        KIT_CHECK(n > calls || count == 0, "sheets, though the call failed");
        if (!found) found = occ_verify_sheets(&soup, expected, expected_count, &desc, NULL);
        KIT_CHECK(found == OCC_ERROR_OUT_OF_MEMORY, "allocation %u: %s", (unsigned)n,
                  occ_result_name(found));
        KIT_CHECK(record.errors >= 1 && heap.blocks == 0, "allocation %u: silent, or a leak",
                  (unsigned)n);
    }
}
END_TEST

typedef struct watch {
    float last;
    uint32_t calls, stop_at;
} watch;

static bool look(float done, void *user_data)
{
    watch *w = user_data;
    KIT_CHECK(done >= w->last && done <= 1.0f, "progress goes from %g to %g", (double)w->last,
              (double)done);
    w->last = done;
    return ++w->calls != w->stop_at;
}

START_TEST(work_can_be_watched_and_stopped)
{
    occ_sheets_desc desc = plain();
    watch w = {0};
    desc.work.progress = look;
    desc.work.user_data = &w;
    add_some();
    occ_soup soup = shapes_soup(world);
    ck_assert_int_eq(occ_sheets_find(&soup, &desc, sheets, MOST, &count, NULL), OCC_SUCCESS);
    uint32_t calls = w.calls;
    ck_assert_uint_ge(calls, 4);
    size_t found = count;
    for (uint32_t n = 1; n <= calls; n++) {
        w = (watch){.stop_at = n};
        ck_assert_int_eq(occ_sheets_find(&soup, &desc, sheets, MOST, &count, NULL),
                         OCC_ERROR_CANCELLED);
        ck_assert_uint_eq(count, 0);
        ck_assert_uint_eq(heap.blocks, 0);
    }
    w = (watch){0};
    ck_assert_int_eq(occ_sheets_find(&soup, &desc, sheets, MOST, &count, NULL), OCC_SUCCESS);
    w = (watch){.stop_at = 1};
    ck_assert_int_eq(occ_verify_sheets(&soup, sheets, found, &desc, NULL), OCC_ERROR_CANCELLED);
}
END_TEST

START_TEST(same_soup_gives_the_same_sheets)
{
    occ_sheets_desc desc = plain();
    static occ_found_sheet before[MOST];
    add_some();
    find(&desc);
    size_t found = count;
    memcpy(before, sheets, sizeof before);
    find(&desc);
    ck_assert_uint_eq(count, found);
    ck_assert(kit_same_bits(before, sheets, found * sizeof *sheets));
    ck_assert_uint_gt(stats.peak_bytes, 1000);
}
END_TEST

static TCase *add_case(Suite *suite, TCase *group)
{
    tcase_add_checked_fixture(group, set_up, tear_down);
    suite_add_tcase(suite, group);
    return group;
}

int main(void)
{
    Suite *suite = suite_create("sheet_find");
    TCase *surfaces = add_case(suite, tcase_create("surfaces"));
    tcase_add_test(surfaces, grid_of_quads_is_one_sheet_however_it_is_turned);
    tcase_add_test(surfaces, no_sheet_reaches_into_a_window);
    tcase_add_test(surfaces, corners_on_others_edges_do_not_part_a_wall);
    tcase_add_test(surfaces, sheets_of_an_angle_overlap_in_its_corner);
    tcase_add_test(surfaces, octagon_is_one_sheet_and_rounder_shapes_nearly);
    tcase_add_test(surfaces, copies_and_flipped_triangles_do_not_matter_to_two_sides);
    tcase_add_test(surfaces, decal_in_a_wall_does_not_part_it);
    tcase_add_test(surfaces, surfaces_that_cross_or_meet_in_an_edge_are_sheets_each);
    tcase_add_test(surfaces, turned_quads_are_sheets_though_no_plane_holds_their_corners);
    tcase_add_test(surfaces, sharp_bends_are_not_made_flat);
    tcase_add_test(surfaces, see_through_triangles_are_no_part_of_a_sheet);
    tcase_add_test(surfaces, labels_are_told_and_may_keep_sheets_apart);
    tcase_add_test(surfaces, small_sheets_are_left_out_and_fewer_are_the_first_of_more);
    TCase *verify = add_case(suite, tcase_create("verify"));
    tcase_add_test(verify, false_sheets_are_named_with_the_reason);
    tcase_add_test(verify, one_sided_sheets_hide_from_the_front_alone);
    tcase_add_test(verify, bent_sheets_are_filled_by_triangles_between_their_corners);
    TCase *calls = add_case(suite, tcase_create("calls"));
    tcase_add_test(calls, bad_input_is_refused_by_name);
    tcase_add_test(calls, every_allocation_that_fails_is_reported);
    tcase_add_test(calls, work_can_be_watched_and_stopped);
    tcase_add_test(calls, same_soup_gives_the_same_sheets);
    return test_run_suite(suite);
}
