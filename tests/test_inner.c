// SPDX-License-Identifier: Apache-2.0
// timeout: 120
// Inner boxes of solids that are known, and what the calls do with input, memory, time and threads.
#include "kit.h"
#include "shapes.h"
#include "support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST = 32 };

static shapes *world;
static occ_inner_box boxes[MOST];
static size_t count;
static occ_inner_stats stats;
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

static occ_inner_desc quick(void)
{
    return (occ_inner_desc){
        .work = {.allocator = kit_allocator(&heap), .logger = kit_logger(&record)},
        .max_cells = 40000,
        .threads = 1};
}

static void find(const occ_inner_desc *desc)
{
    occ_soup soup = shapes_soup(world);
    occ_inner_fault fault;
    ck_assert_int_eq(occ_inner_find(&soup, desc, boxes, MOST, &count, &stats), OCC_SUCCESS);
    KIT_CHECK(!occ_verify_inner(&soup, boxes, count, desc, &fault), "box %u: reason %d", fault.box,
              fault.reason);
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) {
        ck_assert(boxes[i].gain > 0.0f);
        sum += (double)boxes[i].gain;
    }
    ck_assert_double_eq_tol(sum, (double)stats.coverage, 1e-5);
    ck_assert(stats.coverage <= 1.0001f);
}

static bool same_boxes(const occ_inner_box *a, const occ_inner_box *b, size_t n)
{
    for (size_t i = 0; i < n; i++)
        if (!kit_same_bits(&a[i].box, &b[i].box, sizeof a->box) || a[i].gain != b[i].gain ||
            a[i].closed != b[i].closed || !kit_same_bits(&a[i].grid, &b[i].grid, sizeof a->grid))
            return false;
    return true;
}

static void add_box(float x0, float y0, float z0, float x1, float y1, float z1)
{
    shapes_box(world, (float[3]){x0, y0, z0}, (float[3]){x1, y1, z1});
}

static void turn_world(float angle)
{
    float c = cosf(angle), s = sinf(angle);
    memcpy(world->turn, (float[3][3]){{c, -s, 0}, {s, c, 0}, {0, 0, 1}}, sizeof world->turn);
}

// --- solids --------------------------------------------------------------------------------------

START_TEST(box_is_found_whole)
{
    occ_inner_desc desc = quick();
    add_box(0, 0, 0, 3, 2, 1);
    find(&desc);
    ck_assert_uint_eq(count, 1);
    ck_assert(boxes[0].closed);
    ck_assert_float_ge(stats.coverage, 0.999f);
    const float expected[12] = {1.5f, 1, 0.5f, 1.5f, 0, 0, 0, 1, 0, 0, 0, 0.5f};
    const float *found = boxes[0].box.center;
    for (int i = 0; i < 12; i++)
        ck_assert_float_eq_tol(found[i], expected[i], 1e-6f);
}
END_TEST

START_TEST(turned_box_is_found_whole_unless_boxes_are_to_be_aligned)
{
    occ_inner_desc desc = quick();
    turn_world(0.6f);
    add_box(0, 0, 0, 6, 2, 1);
    find(&desc);
    ck_assert_float_ge(boxes[0].gain, 0.98f);
    ck_assert_float_ne(boxes[0].box.axis[0][0] * boxes[0].box.axis[0][1] +
                           boxes[0].box.axis[1][0] * boxes[0].box.axis[1][1] +
                           boxes[0].box.axis[2][0] * boxes[0].box.axis[2][1],
                       0.0f);
    desc.aligned_only = true;
    find(&desc);
    ck_assert_float_le(boxes[0].gain, 0.8f);
    for (size_t i = 0; i < count; i++)
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                ck_assert(j == k || boxes[i].box.axis[j][k] == 0.0f);
}
END_TEST

START_TEST(two_arms_take_two_boxes)
{
    occ_inner_desc desc = quick();
    // One closed surface: an L as a prism.
    static const float outline[6][2] = {{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4}};
    static const int cover[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
    float p[2][6][3];
    for (int i = 0; i < 12; i++)
        memcpy(p[i / 6][i % 6], (float[3]){outline[i % 6][0], outline[i % 6][1], i < 6 ? 0 : 2},
               12);
    for (int i = 0; i < 4; i++) {
        shapes_triangle(world, p[0][cover[i][0]], p[0][cover[i][2]], p[0][cover[i][1]]);
        shapes_triangle(world, p[1][cover[i][0]], p[1][cover[i][1]], p[1][cover[i][2]]);
    }
    for (int i = 0; i < 6; i++) {
        int n = (i + 1) % 6;
        shapes_triangle(world, p[0][i], p[0][n], p[1][n]);
        shapes_triangle(world, p[0][i], p[1][n], p[1][i]);
    }
    find(&desc);
    ck_assert_uint_ge(count, 2);
    ck_assert_float_ge(boxes[0].gain + boxes[1].gain, 0.99f);
}
END_TEST

START_TEST(round_solids_are_covered_by_more_and_more)
{
    occ_inner_desc desc = quick();
    shapes_round(world, 16, 0.0f);
    find(&desc);
    ck_assert_uint_ge(count, 10);
    ck_assert_float_ge(boxes[0].gain, 0.5f);
    ck_assert_float_ge(stats.coverage, 0.9f);
    shapes_reset(world);
    shapes_round(world, 16, 0.4f);
    find(&desc);
    ck_assert_float_ge(stats.coverage, 0.75f);
    for (size_t i = 0; i < count; i++) { // none bridges the hole
        float x = boxes[i].box.center[0], y = boxes[i].box.center[1];
        ck_assert_float_ge(x * x + y * y, 0.36f);
    }
}
END_TEST

START_TEST(solids_that_touch_overlap_or_stand_apart_are_found)
{
    occ_inner_desc desc = quick();
    add_box(0, 0, 0, 1, 1, 1);
    add_box(1, 0, 0, 2, 1, 1); // shares a face
    find(&desc);
    ck_assert_uint_eq(count, 2);
    ck_assert_float_ge(stats.coverage, 0.999f);
    add_box(0.5f, 0.25f, 0.25f, 3, 0.75f, 0.75f);
    find(&desc);
    ck_assert_float_ge(stats.coverage, 0.999f);
    shapes_reset(world);
    for (int i = 0; i < 12; i++)
        add_box(4.0f * (float)i, 0, 0, 4.0f * (float)i + 2, 3, 1);
    find(&desc);
    ck_assert_uint_eq(count, 12);
    ck_assert_uint_eq(stats.parts, 12);
    ck_assert_float_ge(stats.coverage, 0.999f);
}
END_TEST

START_TEST(small_solids_in_a_large_hall_get_grids_of_their_own)
{
    occ_inner_desc desc = quick();
    desc.max_cells = 4096; // one is a tenth of a cell wide
    add_box(0, 0, 0, 1000, 1000, 100);
    world->triangles -= 2; // the hall is open
    for (int i = 0; i < 5; i++)
        add_box(100.0f * (float)i + 50, 300, 0, 100.0f * (float)i + 56, 306, 40);
    find(&desc);
    ck_assert_uint_eq(stats.parts, 1);
    ck_assert_uint_eq(count, 5);
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            ck_assert_float_eq_tol(boxes[i].box.axis[k][k], k == 2 ? 20.0f : 3.0f, 1e-3f);
}
END_TEST

START_TEST(thin_walls_get_cells_of_their_own_shape)
{
    occ_inner_desc desc = quick();
    turn_world(0.3f);
    add_box(0, 0, 0, 10, 3, 0.001f);
    find(&desc);
    ck_assert_uint_ge(count, 1);
    ck_assert_float_ge(boxes[0].gain, 0.98f);
}
END_TEST

START_TEST(open_mesh_yields_nothing_unless_holes_are_allowed)
{
    occ_inner_desc desc = quick();
    add_box(0, 0, 0, 4, 4, 4);
    add_box(10, 0, 0, 14, 4, 4);
    // A hole: the corner of one face, a quarter of a unit wide.
    world->triangles--;
    static const float p[4][3] = {{14, 0, 0}, {14, 4, 4}, {14, 0, 4}, {14, 0.25f, 3.75f}};
    shapes_triangle(world, p[0], p[1], p[3]);
    shapes_triangle(world, p[0], p[3], p[2]);
    find(&desc);
    ck_assert_uint_eq(count, 1); // the one that is whole
    ck_assert_uint_eq(stats.open_triangles, 13);
    desc.max_hole = 0.01f; // finer than the grid
    find(&desc);
    ck_assert_uint_eq(count, 1);
    desc.max_hole = 2.0f;
    find(&desc);
    ck_assert_uint_ge(count, 2);
    bool dry = false;
    for (size_t i = 0; i < count; i++) {
        if (boxes[i].closed) continue;
        dry = true;
        ck_assert_float_gt(boxes[i].box.center[0], 10.0f);
        ck_assert_float_le(boxes[i].grid.hole, 2.0f);
    }
    ck_assert(dry);
}
END_TEST

// A room with walls of thickness 1: outer and inner surface.
static void add_room(bool inside_out)
{
    add_box(0, 0, 0, 12, 12, 12);
    uint32_t first = world->triangles;
    add_box(1, 1, 1, 11, 11, 11);
    for (uint32_t t = first; inside_out && t < world->triangles; t++) {
        float held[3];
        memcpy(held, world->at[3 * t], sizeof held);
        memcpy(world->at[3 * t], world->at[3 * t + 1], sizeof held);
        memcpy(world->at[3 * t + 1], held, sizeof held);
    }
}

static bool room_is_filled(void)
{
    bool filled = false;
    for (size_t i = 0; i < count; i++) {
        bool within = true;
        for (int k = 0; k < 3; k++)
            within = within && fabsf(boxes[i].box.center[k] - 6.0f) < 5.0f;
        filled |= within;
    }
    return filled;
}

START_TEST(room_is_left_free_if_a_point_or_the_winding_says_so)
{
    occ_inner_desc desc = quick();
    const float points[6] = {6, 6, 6, 100, 0, 0};
    add_room(true);
    find(&desc);
    ck_assert(room_is_filled());
    desc.free_points = points;
    desc.free_count = 2;
    find(&desc);
    ck_assert_uint_ge(count, 3); // a wall covers the one across from it
    ck_assert(!room_is_filled());
    ck_assert_float_ge(stats.coverage, 0.999f);
    desc.free_points = NULL;
    desc.free_count = 0;
    desc.facing = OCC_FACING_OUT;
    find(&desc);
    ck_assert_uint_ge(count, 3); // a wall covers the one across from it
    ck_assert(!room_is_filled());
    desc.facing = OCC_FACING_ANY;
    desc.max_hole = 1.0f;
    desc.free_points = points;
    desc.free_count = 1;
    find(&desc);
    ck_assert_uint_ge(count, 3); // a wall covers the one across from it
}
END_TEST

START_TEST(space_between_rooms_is_solid_if_the_eye_never_leaves_them)
{
    occ_inner_desc desc = quick();
    const float points[6] = {5, 5, 5, 17, 5, 5};
    add_box(0, 0, 0, 10, 10, 10);
    add_box(12, 0, 0, 22, 10, 10);
    add_box(4, 4, 0, 6, 6, 2); // a pillar in one of them
    desc.outside_solid = true;
    ck_assert_int_eq(occ_inner_find(&(occ_soup){0}, &desc, boxes, MOST, &count, NULL),
                     OCC_ERROR_INVALID_ARGUMENT); // and where is the eye?
    desc.free_points = points;
    desc.free_count = 2;
    for (int holes = 0; holes < 2; holes++) {
        if (holes) { // a crack, and a room that is open if any hole counts
            world->at[0][0] += 0.001f;
            desc.max_hole = 2.5f;
            desc.max_cells = 200000;
        }
        bool between = false, pillar = false;
        find(&desc);
        for (size_t i = 0; i < count; i++) {
            const float *c = boxes[i].box.center;
            bool low = c[1] > 0 && c[1] < 10 && c[2] > 0 && c[2] < 10;
            between |= low && c[0] > 10 && c[0] < 12;
            pillar |= low && c[0] > 4 && c[0] < 6;
            KIT_CHECK(!(low && c[0] > 12 && c[0] < 22), "box %zu fills the second room", i);
            KIT_CHECK(!(low && c[0] > 0 && c[0] < 4), "box %zu fills the first room", i);
        }
        ck_assert(between && pillar);
    }
    const float inside[3] = {11, 5, 5};
    desc.free_points = inside;
    desc.free_count = 1;
    occ_soup soup = shapes_soup(world);
    ck_assert_int_eq(occ_verify_inner(&soup, boxes, count, &desc, NULL), OCC_ERROR_NOT_INSIDE);
}
END_TEST

START_TEST(box_in_a_room_is_told_from_one_in_a_wall)
{
    occ_inner_desc desc = quick();
    const float point[3] = {3, 3, 3};
    add_room(false);
    occ_soup soup = shapes_soup(world);
    occ_inner_box made[2] = {{.box = kit_cube(6, 0.5f, 6, 0.5f)}, {.box = kit_cube(6, 6, 6, 2)}};
    occ_inner_fault fault;
    ck_assert_int_eq(occ_verify_inner(&soup, made, 2, &desc, &fault), OCC_SUCCESS);
    desc.free_points = point;
    desc.free_count = 1;
    ck_assert_int_eq(occ_verify_inner(&soup, made, 2, &desc, &fault), OCC_ERROR_NOT_INSIDE);
    ck_assert_int_eq(fault.reason, OCC_INNER_ROOM);
    ck_assert_uint_eq(fault.box, 1);
    ck_assert_uint_eq(fault.point, 0);
    ck_assert_int_eq(occ_verify_inner(&soup, made, 1, &desc, &fault), OCC_SUCCESS);
}
END_TEST

START_TEST(choice_stops_at_the_coverage_or_the_number_asked_for)
{
    occ_inner_desc desc = quick();
    shapes_round(world, 16, 0.0f);
    find(&desc);
    occ_inner_box all[MOST];
    memcpy(all, boxes, sizeof all);
    desc.coverage = 0.7f;
    find(&desc);
    ck_assert_float_ge(stats.coverage, 0.7f);
    ck_assert_float_lt(stats.coverage - boxes[count - 1].gain, 0.7f);
    ck_assert(same_boxes(all, boxes, count)); // the first of a longer choice
    occ_soup soup = shapes_soup(world);
    desc.coverage = 0.0f;
    ck_assert_int_eq(occ_inner_find(&soup, &desc, boxes, 3, &count, NULL), OCC_SUCCESS);
    ck_assert_uint_eq(count, 3);
    ck_assert(same_boxes(all, boxes, 3));
    ck_assert_int_eq(occ_inner_find(&soup, &desc, NULL, 0, &count, NULL), OCC_SUCCESS);
    ck_assert_uint_eq(count, 0);
}
END_TEST

START_TEST(what_has_no_inside_yields_nothing)
{
    occ_inner_desc desc = quick();
    static const float a[3] = {0, 0, 0}, b[3] = {1, 0, 0}, c[3] = {0, 1, 0}, d[3] = {1, 1, 0};
    shapes_triangle(world, a, a, a);
    find(&desc);
    ck_assert_uint_eq(count, 0);
    shapes_triangle(world, a, b, c);
    shapes_triangle(world, b, c, a);
    shapes_triangle(world, b, d, c);
    find(&desc);
    ck_assert_uint_eq(count, 0);
    ck_assert_uint_eq(stats.counts.duplicate, 1);
    ck_assert_uint_eq(stats.counts.degenerate, 1);
    world->triangles = 0;
    for (int i = 0; i < 2; i++) { // a pillow without filling
        shapes_triangle(world, a, b, c);
        shapes_triangle(world, b, d, c);
    }
    desc.max_hole = 10.0f;
    find(&desc);
    ck_assert_uint_eq(count, 0);
}
END_TEST

// --- verification --------------------------------------------------------------------------------

static occ_inner_reason judge(const occ_box *box, occ_inner_fault *fault)
{
    occ_inner_desc desc = quick();
    occ_soup soup = shapes_soup(world);
    occ_inner_box one = {.box = *box};
    occ_result result = occ_verify_inner(&soup, &one, 1, &desc, fault);
    ck_assert_int_eq(result, fault->reason ? OCC_ERROR_NOT_INSIDE : OCC_SUCCESS);
    return fault->reason;
}

START_TEST(false_boxes_are_named_with_the_reason)
{
    occ_inner_fault fault;
    add_box(0, 0, 0, 2, 2, 2);
    occ_box box = kit_cube(1, 1, 1, 1); // just fits
    ck_assert_int_eq(judge(&box, &fault), OCC_INNER_SOUND);
    box.axis[0][0] = nextafterf(1, 2);
    ck_assert_int_eq(judge(&box, &fault), OCC_INNER_ENTERED);
    const float *corner[3];
    shapes_corner(world, fault.triangle, corner);
    for (int i = 1; i < 3; i++) // of the faces across x
        ck_assert(corner[i][0] == corner[0][0]);
    box = kit_cube(5, 1, 1, 1);
    ck_assert_int_eq(judge(&box, &fault), OCC_INNER_OPEN);
    box = kit_cube(1, 1, 1, 3); // all triangles are inside it
    ck_assert_int_eq(judge(&box, &fault), OCC_INNER_ENTERED);
    ck_assert_uint_eq(fault.triangle, 0);
    box = kit_cube(1, 1, 1, 0.5f);
    memset(box.axis[1], 0, sizeof box.axis[1]);
    ck_assert_int_eq(judge(&box, &fault), OCC_INNER_FLAT);
    box = kit_cube(1, 1, 1, 1e-20f);
    ck_assert_int_eq(judge(&box, &fault), OCC_INNER_SOUND);
}
END_TEST

START_TEST(grid_of_a_dry_box_is_not_taken_on_trust)
{
    occ_inner_desc desc = quick();
    occ_inner_fault fault;
    desc.max_hole = 3.0f;
    add_box(0, 0, 0, 8, 8, 8);
    world->triangles -= 2; // a whole face: 8 units wide
    static const float p[4][3] = {{8, 0, 0}, {8, 8, 0}, {8, 8, 8}, {8, 0, 8}}, hole[3] = {8, 1, 1};
    shapes_triangle(world, p[0], p[1], hole);
    shapes_triangle(world, p[1], p[2], hole);
    shapes_triangle(world, p[2], p[3], hole); // p[3], p[0], hole is missing: up to 1 wide
    find(&desc);
    ck_assert_uint_ge(count, 1);
    ck_assert(!boxes[0].closed);
    occ_soup soup = shapes_soup(world);
    occ_inner_box box = boxes[0];
    desc.max_hole = box.grid.hole * 0.99f;
    ck_assert_int_eq(occ_verify_inner(&soup, &box, 1, &desc, &fault), OCC_ERROR_NOT_INSIDE);
    ck_assert_int_eq(fault.reason, OCC_INNER_OPEN);
    desc.max_hole = 3.0f;
    box.grid.hole = 0.0f; // is worked out anew
    ck_assert_int_eq(occ_verify_inner(&soup, &box, 1, &desc, &fault), OCC_SUCCESS);
    box.grid.closing = 1000;
    ck_assert_int_eq(occ_verify_inner(&soup, &box, 1, &desc, &fault), OCC_ERROR_NOT_INSIDE);
    box = boxes[0];
    box.grid.closing = 0;
    for (int k = 0; k < 3; k++) {
        box.grid.cell[k] = 0.125f; // the hole is wider than such cells
        box.grid.origin[k] = -16;
        box.grid.size[k] = 104;
    }
    desc.max_cells = 2000000;
    ck_assert_int_eq(occ_verify_inner(&soup, &box, 1, &desc, &fault), OCC_ERROR_NOT_INSIDE);
    const float bad[] = {0.0f, -1.0f, NAN, INFINITY, 1e-30f};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        box = boxes[0];
        box.grid.cell[1] = bad[i];
        ck_assert_int_eq(occ_verify_inner(&soup, &box, 1, &desc, &fault), OCC_ERROR_NOT_INSIDE);
        box = boxes[0];
        if (bad[i] <= 0.0f) continue;
        box.grid.axis[1][1] = bad[i];
        ck_assert_int_eq(occ_verify_inner(&soup, &box, 1, &desc, &fault), OCC_ERROR_NOT_INSIDE);
    }
    box = boxes[0];
    box.grid.size[2] = 1u << 30;
    ck_assert_int_eq(occ_verify_inner(&soup, &box, 1, &desc, &fault), OCC_ERROR_NOT_INSIDE);
}
END_TEST

// --- input, memory, time, threads ----------------------------------------------------------------

static occ_result call_with(const occ_inner_desc *desc)
{
    occ_soup soup = shapes_soup(world);
    occ_result result = occ_inner_find(&soup, desc, boxes, MOST, &count, &stats);
    occ_inner_fault fault;
    occ_inner_box one = {.box = kit_cube(0.5f, 0.5f, 0.5f, 0.1f)};
    ck_assert_int_eq(occ_verify_inner(&soup, &one, 1, desc, &fault), result);
    return result;
}

START_TEST(bad_input_is_refused_by_name)
{
    occ_inner_desc good = quick(), d;
    const float nan_point[3] = {0, NAN, 0}, far_point[3] = {0, 0, 2e15f};
    add_box(0, 0, 0, 1, 1, 1);
    ck_assert_int_eq(call_with(&good), OCC_SUCCESS);
    ck_assert_int_eq(call_with(NULL), OCC_SUCCESS);
    d = good, d.max_cells = 100;
    ck_assert_int_eq(call_with(&d), OCC_ERROR_INVALID_ARGUMENT);
    d = good, d.max_cells = UINT32_MAX;
    ck_assert_int_eq(call_with(&d), OCC_ERROR_INVALID_ARGUMENT);
    d = good, d.threads = 5000;
    ck_assert_int_eq(call_with(&d), OCC_ERROR_INVALID_ARGUMENT);
    d = good, d.coverage = NAN;
    ck_assert_int_eq(call_with(&d), OCC_ERROR_INVALID_ARGUMENT);
    d = good, d.max_hole = -1.0f;
    ck_assert_int_eq(call_with(&d), OCC_ERROR_INVALID_ARGUMENT);
    d = good, d.facing = (occ_facing)9;
    ck_assert_int_eq(call_with(&d), OCC_ERROR_INVALID_ARGUMENT);
    d = good, d.free_count = 1;
    ck_assert_int_eq(call_with(&d), OCC_ERROR_INVALID_ARGUMENT);
    d = good, d.free_count = 1, d.free_points = nan_point;
    ck_assert_int_eq(call_with(&d), OCC_ERROR_NOT_FINITE);
    d = good, d.free_count = 1, d.free_points = far_point;
    ck_assert_int_eq(call_with(&d), OCC_ERROR_OUT_OF_RANGE);
    ck_assert_uint_ge(record.errors, 8);
    world->at[7][1] = INFINITY;
    ck_assert_int_eq(call_with(&good), OCC_ERROR_NOT_FINITE);
    occ_soup soup = shapes_soup(world);
    ck_assert_int_eq(occ_inner_find(&soup, &good, NULL, 3, &count, NULL),
                     OCC_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(occ_inner_find(&soup, &good, boxes, 3, NULL, NULL),
                     OCC_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(occ_inner_find(NULL, &good, boxes, 3, &count, NULL),
                     OCC_ERROR_INVALID_ARGUMENT);
    world->at[7][1] = 0.0f;
    ck_assert_int_eq(occ_verify_inner(&soup, NULL, 1, &good, NULL), OCC_ERROR_INVALID_ARGUMENT);
}
END_TEST

// Two solids, one open, so that every step has something to do.
static void add_some(void)
{
    shapes_round(world, 8, 0.4f);
    turn_world(0.4f);
    add_box(4, 0, 0, 7, 1, 1);
    add_box(7, 0, 0, 8, 1, 1);
    add_box(20, 0, 0, 22, 2, 2);
    world->triangles--;
}

START_TEST(every_allocation_that_fails_is_reported)
{
    occ_inner_desc desc = quick();
    const float point[3] = {50, 0, 0};
    desc.max_cells = 4096;
    desc.max_hole = 4.0f;
    desc.free_points = point;
    desc.free_count = 1;
    add_some();
    occ_soup soup = shapes_soup(world);
    occ_inner_box expected[MOST];
    size_t expected_count;
    ck_assert_int_eq(occ_inner_find(&soup, &desc, expected, MOST, &expected_count, &stats),
                     OCC_SUCCESS);
    ck_assert_uint_ge(expected_count, 4);
    uint64_t calls = heap.calls;
    ck_assert_uint_ge(stats.peak_bytes, 5 * 4096 / 2);
    ck_assert_int_eq(occ_verify_inner(&soup, expected, expected_count, &desc, NULL), OCC_SUCCESS);
    uint64_t all = heap.calls;
    for (uint64_t n = 1; n <= all; n++) {
        heap = (kit_heap){.fail_at = n};
        kit_forget(&record);
        occ_result found = occ_inner_find(&soup, &desc, boxes, MOST, &count, &stats);
        KIT_CHECK(found == (n <= calls ? OCC_ERROR_OUT_OF_MEMORY : OCC_SUCCESS),
                  "allocation %u: %s", (unsigned)n, occ_result_name(found));
        if (!found) found = occ_verify_inner(&soup, expected, expected_count, &desc, NULL);
        KIT_CHECK(found == OCC_ERROR_OUT_OF_MEMORY, "allocation %u: %s", (unsigned)n,
                  occ_result_name(found));
        KIT_CHECK(record.errors >= 1 && heap.blocks == 0, "allocation %u: silent, or a leak",
                  (unsigned)n);
        KIT_CHECK(n > calls || count == 0, "boxes, though the call failed");
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
    occ_inner_desc desc = quick();
    watch w = {0};
    desc.max_cells = 4096;
    desc.work.progress = look;
    desc.work.user_data = &w;
    add_some();
    occ_soup soup = shapes_soup(world);
    ck_assert_int_eq(occ_inner_find(&soup, &desc, boxes, MOST, &count, NULL), OCC_SUCCESS);
    uint32_t calls = w.calls;
    ck_assert_uint_ge(calls, 6);
    size_t found = count;
    for (uint32_t n = 1; n <= calls; n++) {
        w = (watch){.stop_at = n};
        ck_assert_int_eq(occ_inner_find(&soup, &desc, boxes, MOST, &count, NULL),
                         OCC_ERROR_CANCELLED);
        ck_assert_uint_eq(count, 0);
        ck_assert_uint_eq(heap.blocks, 0);
    }
    w = (watch){0};
    ck_assert_int_eq(occ_inner_find(&soup, &desc, boxes, MOST, &count, NULL), OCC_SUCCESS);
    w = (watch){.stop_at = 1};
    ck_assert_int_eq(occ_verify_inner(&soup, boxes, found, &desc, NULL), OCC_ERROR_CANCELLED);
}
END_TEST

START_TEST(threads_change_nothing)
{
    occ_inner_desc desc = quick();
    add_some();
    find(&desc);
    occ_inner_box alone[MOST];
    occ_inner_stats before = stats;
    size_t found = count;
    memcpy(alone, boxes, sizeof alone);
    for (uint32_t threads = 2; threads < 6; threads++) {
        desc.threads = threads;
        find(&desc);
        ck_assert_uint_eq(count, found);
        ck_assert(same_boxes(alone, boxes, found));
        ck_assert_uint_eq(stats.candidates, before.candidates);
        ck_assert_uint_eq(stats.peak_bytes, before.peak_bytes);
    }
}
END_TEST

START_TEST(memory_is_bounded_by_the_cells_allowed)
{
    occ_inner_desc desc = quick();
    add_box(0, 0, 0, 1, 1, 1);
    for (uint32_t cells = 1u << 16; cells <= 1u << 22; cells *= 4) {
        desc.max_cells = cells;
        find(&desc);
        ck_assert_uint_ge(stats.cells, cells / 2);
        ck_assert_uint_le(stats.cells, cells);
        ck_assert_uint_le(stats.peak_bytes, 5 * (uint64_t)cells + 2000000);
    }
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
    Suite *suite = suite_create("inner");
    TCase *solids = add_case(suite, tcase_create("solids"));
    tcase_add_test(solids, box_is_found_whole);
    tcase_add_test(solids, turned_box_is_found_whole_unless_boxes_are_to_be_aligned);
    tcase_add_test(solids, two_arms_take_two_boxes);
    tcase_add_test(solids, round_solids_are_covered_by_more_and_more);
    tcase_add_test(solids, solids_that_touch_overlap_or_stand_apart_are_found);
    tcase_add_test(solids, small_solids_in_a_large_hall_get_grids_of_their_own);
    tcase_add_test(solids, thin_walls_get_cells_of_their_own_shape);
    tcase_add_test(solids, open_mesh_yields_nothing_unless_holes_are_allowed);
    tcase_add_test(solids, room_is_left_free_if_a_point_or_the_winding_says_so);
    tcase_add_test(solids, space_between_rooms_is_solid_if_the_eye_never_leaves_them);
    tcase_add_test(solids, choice_stops_at_the_coverage_or_the_number_asked_for);
    tcase_add_test(solids, what_has_no_inside_yields_nothing);
    TCase *verify = add_case(suite, tcase_create("verify"));
    tcase_add_test(verify, box_in_a_room_is_told_from_one_in_a_wall);
    tcase_add_test(verify, false_boxes_are_named_with_the_reason);
    tcase_add_test(verify, grid_of_a_dry_box_is_not_taken_on_trust);
    TCase *calls = add_case(suite, tcase_create("calls"));
    tcase_add_test(calls, bad_input_is_refused_by_name);
    tcase_add_test(calls, every_allocation_that_fails_is_reported);
    tcase_add_test(calls, work_can_be_watched_and_stopped);
    tcase_add_test(calls, threads_change_nothing);
    tcase_add_test(calls, memory_is_bounded_by_the_cells_allowed);
    return test_run_suite(suite);
}
