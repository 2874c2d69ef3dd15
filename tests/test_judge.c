// SPDX-License-Identifier: Apache-2.0
// The judge of many occluders, where the answer is known by hand. The eye is at (8, 0, 0), panels
// stand in the plane x = 0, and what is to be hidden at x = -8, where shadows are twice as large.
#include "judge.h"

#include "support.h"
#include "worlds.h"

#include <math.h>

static const double eye_on_x[3] = {8, 0, 0};

static occ_box panel(float x, float low_y, float high_y, float low_z, float high_z)
{
    return (occ_box){{x, 0.5f * (low_y + high_y), 0.5f * (low_z + high_z)},
                     {{0, 0, 0}, {0, 0.5f * (high_y - low_y), 0}, {0, 0, 0.5f * (high_z - low_z)}}};
}

static occ_box block(float low_x, float high_x, float low_y, float high_y, float low_z,
                     float high_z)
{
    occ_box box = panel(0.5f * (low_x + high_x), low_y, high_y, low_z, high_z);
    box.axis[0][0] = 0.5f * (high_x - low_x);
    return box;
}

// The verdict with and without the filter, which must agree.
static bool ask(judge *j, const occ_box *object, const occ_box *occluders, size_t count)
{
    bool seen[2];
    for (int filter = 0; filter < 2; filter++) {
        judge_filter(j, filter == 1);
        judge_set_occluders(j, occluders, NULL, count);
        seen[filter] = judge_sees(j, object, -1);
        ck_assert_int_eq(judge_share(j, object, -1) > 0.0, seen[filter]);
    }
    ck_assert_int_eq(seen[0], seen[1]);
    return seen[0];
}

static bool sees_from(const double eye[3], const occ_box *object, const occ_box *occluders,
                      size_t count)
{
    judge *j = judge_of_eye(eye);
    bool seen = ask(j, object, occluders, count);
    judge_free(j);
    return seen;
}

static bool sees(const occ_box *object, const occ_box *occluders, size_t count)
{
    return sees_from(eye_on_x, object, occluders, count);
}

// --- panels --------------------------------------------------------------------------------------

START_TEST(without_occluders_everything_is_seen)
{
    occ_box wall = panel(-8, -7, 7, -7, 7), room = kit_cube(8, 0, 0, 1), dot = {{-8, 0, 0}, {{0}}};
    ck_assert(sees(&wall, NULL, 0));
    ck_assert(sees(&room, NULL, 0)); // around the eye
    ck_assert(sees(&dot, NULL, 0));
}
END_TEST

START_TEST(two_abutting_panels_hide_what_neither_hides)
{
    occ_box wall = block(-9, -8, -7, 7, -7, 7);
    occ_box panels[2] = {panel(0, -4, 0, -4, 4), panel(0, 0, 4, -4, 4)};
    ck_assert(sees(&wall, panels, 1));
    ck_assert(sees(&wall, panels + 1, 1));
    ck_assert(!sees(&wall, panels, 2));
    panels[0].center[1] = nextafterf(-2.0f, -3.0f); // a gap of 2^-22
    ck_assert(sees(&wall, panels, 2));
    panels[0].center[1] = nextafterf(-2.0f, 0.0f); // now they overlap
    ck_assert(!sees(&wall, panels, 2));
}
END_TEST

START_TEST(the_shadows_rim_belongs_to_the_shadow)
{
    occ_box panels[2] = {panel(0, -4, 0, -4, 4), panel(0, 0, 4, -4, 4)};
    occ_box full = panel(-8, -8, 8, -8, 8), more = panel(-8, -8, nextafterf(8, 9), -8, 8);
    ck_assert(!sees(&full, panels, 2));
    more.center[1] = nextafterf(0, 1);
    more.axis[1][1] = 8;
    ck_assert(sees(&more, panels, 2));
}
END_TEST

START_TEST(the_gap_is_seen_where_it_is)
{
    occ_box panels[2] = {panel(0, -4, -0.25f, -4, 4), panel(0, 0.25f, 4, -4, 4)};
    occ_box above = panel(-8, 0.5f, 7, -7, 7), across = panel(-8, 0.25f, 7, -7, 7);
    ck_assert(!sees(&above, panels, 2));
    ck_assert(sees(&across, panels, 2));
    judge *j = judge_of_eye(eye_on_x);
    occ_box wall = panel(-8, -4, 4, -7, 7);
    judge_set_occluders(j, panels, NULL, 2);
    ck_assert_double_eq_tol(judge_share(j, &wall, -1), 1.0 / 8.0, 1e-12);
    judge_free(j);
}
END_TEST

START_TEST(panels_may_stand_one_behind_the_other)
{
    occ_box wall = panel(-8, -7, 7, -7, 7);
    occ_box panels[3] = {panel(0, -4, -1, -4, 4), panel(4, -0.5f, 0.5f, -2, 2),
                         panel(-4, 1.5f, 6, -6, 6)};
    ck_assert(!sees(&wall, panels, 3)); // they meet on the lines of sight to y = -2 and y = 2
    for (int i = 0; i < 3; i++) {
        occ_box two[2] = {panels[(i + 1) % 3], panels[(i + 2) % 3]};
        ck_assert(sees(&wall, two, 2));
    }
    panels[2].center[1] = nextafterf(panels[2].center[1], 10);
    ck_assert(sees(&wall, panels, 3));
}
END_TEST

START_TEST(three_sectors_meet_in_one_point)
{
    occ_box wall = panel(-8, -2, 2, -2, 2);
    occ_box sectors[3] = {
        panel(0, -4, 4, -8, 0),
        {{0, 2, 2}, {{0, 0, 0}, {0, 2, 0}, {0, 0, 2}}},
        {{0, -2, 2}, {{0, 0, 0}, {0, -2, 0}, {0, 1, 2}}}, // sheared: its edge leans over the second
    };
    ck_assert(sees(&wall, sectors, 3)); // and away from it at the bottom
    sectors[2].axis[2][1] = 0;
    ck_assert(!sees(&wall, sectors, 3));
    for (int i = 0; i < 3; i++) {
        occ_box two[2] = {sectors[(i + 1) % 3], sectors[(i + 2) % 3]};
        ck_assert(sees(&wall, two, 2));
    }
}
END_TEST

START_TEST(a_wall_of_sixteen_panels_needs_each_of_them)
{
    occ_box wall = block(-10, -8, -8, 8, -8, 8), panels[16];
    for (int i = 0; i < 16; i++) {
        float y = 2.0f * (float)(i % 4) - 4.0f, z = 2.0f * (float)(i / 4) - 4.0f;
        panels[i] = panel(0, y, y + 2, z, z + 2);
    }
    ck_assert(!sees(&wall, panels, 16));
    for (int i = 0; i < 16; i++) {
        occ_box gone = panels[i];
        panels[i] = panels[15];
        ck_assert(sees(&wall, panels, 15));
        occ_box behind = block(-10, -8, 2 * gone.center[1] - 2, 2 * gone.center[1] + 2,
                               2 * gone.center[2] - 2, 2 * gone.center[2] + 2);
        ck_assert(sees(&behind, panels, 15));
        panels[i] = gone;
    }
}
END_TEST

START_TEST(solid_blocks_abut_as_panels_do)
{
    occ_box wall = block(-9, -8, -7, 7, -7, 7);
    occ_box blocks[2] = {block(-1, 0, -4, 0, -4, 4), block(-2, 0, 0, 4, -4, 4)};
    ck_assert(!sees(&wall, blocks, 2));
    blocks[1] = block(-2, 0, 0x1p-20f, 4, -4, 4);
    ck_assert(sees(&wall, blocks, 2));
}
END_TEST

// --- owners, touching and intersecting -----------------------------------------------------------

START_TEST(an_owner_is_not_hidden_by_its_own)
{
    occ_box wall = panel(-8, -7, 7, -7, 7);
    occ_box panels[2] = {panel(0, -4, 0, -4, 4), panel(0, 0, 4, -4, 4)};
    int owners[2] = {-1, 7};
    judge *j = judge_of_eye(eye_on_x);
    judge_set_occluders(j, panels, owners, 2);
    ck_assert(judge_sees(j, &wall, 7));
    ck_assert(!judge_sees(j, &wall, 6));
    ck_assert(!judge_sees(j, &wall, -1));
    ck_assert_double_eq_tol(judge_share(j, &wall, 7), 0.5, 1e-12);
    judge_free(j);
}
END_TEST

START_TEST(what_an_occluder_holds_is_hidden_and_what_sticks_out_is_not)
{
    occ_box solid = kit_cube(0, 0, 0, 2), inside = kit_cube(0, 0, 0, 1);
    occ_box flush = kit_cube(0, 0, 0, 2), through = kit_cube(0.5f, 0, 0, 2);
    ck_assert(!sees(&inside, &solid, 1));
    ck_assert(!sees(&flush, &solid, 1)); // closed: its faces are in the shadow
    ck_assert(sees(&through, &solid, 1));
    occ_box needle = block(-5, 2.0001f, 0, 0.001f, 0, 0.001f);
    ck_assert(sees(&needle, &solid, 1));
    occ_box slabs[2] = {solid, panel(3, -1, 1, -1, 1)};
    ck_assert(!sees(&needle, slabs, 2)); // its end is behind the second
}
END_TEST

START_TEST(a_sheet_through_an_object_hides_only_what_is_behind_it)
{
    occ_box cube = kit_cube(0, 0, 0, 1), sheet = panel(0, -3, 3, -3, 3);
    ck_assert(sees(&cube, &sheet, 1));
    occ_box flush = panel(1, -3, 3, -3, 3), before = panel(0.999f, -3, 3, -3, 3);
    ck_assert(!sees(&cube, &flush, 1)); // in the plane of its front face
    ck_assert(sees(&cube, &before, 1));
}
END_TEST

// --- eyes in planes ------------------------------------------------------------------------------

START_TEST(eyes_in_the_plane_of_an_occluders_face)
{
    occ_box solid = block(-1, 1, -2, 0, -4, 4), twin = block(-1, 1, 0, 2, -4, 4);
    occ_box below = block(-9, -8, -2, 0, -4, 4), above = block(-9, -8, 0, 2, -4, 4);
    ck_assert(!sees(&below, &solid, 1)); // y = 0 is the plane of its face, and of the eye
    ck_assert(sees(&above, &solid, 1));
    occ_box both[2] = {solid, twin}, across = block(-9, -8, -2, 2, -4, 4);
    ck_assert(!sees(&across, both, 2));
    occ_box edge_on = block(-1, 1, 0, 0, -4, 4); // a sheet seen from its edge
    ck_assert(sees(&across, &edge_on, 1));
    occ_box in_plane = block(-9, -8, 0, 0, -1, 1);
    ck_assert(!sees(&in_plane, &edge_on, 1));
}
END_TEST

START_TEST(eyes_in_the_plane_of_an_objects_face)
{
    occ_box object = block(-9, -8, 0, 2, -1, 1), wide = panel(0, 0, 4, -4, 4);
    ck_assert(!sees(&object, &wide, 1));
    occ_box less = panel(0, 0x1p-20f, 4, -4, 4);
    ck_assert(sees(&object, &less, 1));
    occ_box sheet = block(-9, -8, 0, 0, -1, 1); // seen edge-on, its area counts none the less
    ck_assert(sees(&sheet, &less, 1));
    ck_assert(!sees(&sheet, &wide, 1));
}
END_TEST

START_TEST(eyes_inside_of_occluders_and_objects)
{
    static const double corner[3] = {1, 1, 1}, center[3] = {0, 0, 0};
    occ_box solid = kit_cube(0, 0, 0, 1), far_off = kit_cube(-5, 0, 0, 1);
    ck_assert(sees_from(center, &far_off, &solid, 1));
    ck_assert(sees_from(corner, &far_off, &solid, 1));
    occ_box shield = kit_cube(0.5f, 0.5f, 0.5f, 0.25f);
    ck_assert(sees_from(center, &solid, &shield, 1));
    ck_assert(sees_from(corner, &solid, &shield, 1));
    occ_box behind_us = kit_cube(5, 0, 0, 1);
    ck_assert(sees_from(center, &far_off, &behind_us, 1));
}
END_TEST

// --- segments and points -------------------------------------------------------------------------

START_TEST(segments_and_points_are_seen_by_length_and_by_themselves)
{
    occ_box panels[2] = {panel(0, -4, 0, -4, 4), panel(0, 0, 4, -4, 4)};
    occ_box segment = {{-8, 0, 0}, {{0}, {0, 4, 0}, {0, -2, 0}}}; // to y = ±6
    occ_box longer = {{-8, 0, 0}, {{0}, {0, 4, 0}, {0, -4.0001f, 0}}};
    occ_box dot = {{-8, 0, 0}, {{0}}}, beside = {{-8, 8.0001f, 0}, {{0}}},
            rim = {{-8, 8, 0}, {{0}}};
    ck_assert(sees(&segment, panels, 1));
    ck_assert(!sees(&segment, panels, 2));
    ck_assert(sees(&longer, panels, 2));
    ck_assert(!sees(&dot, panels, 1));
    ck_assert(!sees(&rim, panels, 2));
    ck_assert(sees(&beside, panels, 2));
}
END_TEST

START_TEST(occluders_without_area_hide_what_lies_along_them)
{
    occ_box line = {{0, 0, 0}, {{0, 0, 0}, {0, 2, 0}, {0, 1, 0}}};
    occ_box behind = {{-8, 0, 0}, {{0, 0, 0}, {0, 6, 0}, {0, 0, 0}}},
            wall = panel(-8, -1, 1, -1, 1);
    ck_assert(!sees(&behind, &line, 1));
    behind.axis[1][1] = 6.5f;
    ck_assert(sees(&behind, &line, 1));
    ck_assert(sees(&wall, &line, 1));
}
END_TEST

START_TEST(three_axes_in_one_plane_are_a_hexagon)
{
    occ_box hexagon = {{-8, 0, 0}, {{0, 1, 0}, {0, 0, 1}, {0, 1, 1}}};
    occ_box same = {{0, 0, 0}, {{0, 0.5f, 0}, {0, 0, 0.5f}, {0, 0.5f, 0.5f}}};
    ck_assert(!sees(&hexagon, &same, 1));
    same.axis[2][1] = 0.4999f;
    ck_assert(sees(&hexagon, &same, 1));
    occ_box square = panel(0, -1, 1, -1, 1);
    ck_assert(!sees(&hexagon, &square, 1));
    square = panel(0, -1, 1, -1, 0.999f);
    ck_assert(sees(&hexagon, &square, 1));
}
END_TEST

// --- directions ----------------------------------------------------------------------------------

START_TEST(a_direction_casts_parallel_shadows)
{
    static const double toward[3] = {1, 0, 0};
    occ_box panels[2] = {panel(0, -4, 0, -4, 4), panel(1e6f, 0, 4, -4, 4)};
    occ_box wall = block(-1e6f, -8, -4, 4, -4, 4), before = block(1e6f, 2e6f, -4, 4, -4, 4);
    judge *j = judge_of_direction(toward);
    ck_assert(!ask(j, &wall, panels, 2));
    ck_assert(ask(j, &before, panels, 2));
    wall.axis[1][1] = nextafterf(4, 5);
    ck_assert(ask(j, &wall, panels, 2));
    judge_free(j);
}
END_TEST

// --- boxes of eyes -------------------------------------------------------------------------------

static judge_sight from_box(const occ_box *eyes, const occ_box *object, const occ_box *occluder)
{
    judge_sight exact = judge_single_from(eyes, object, occluder, false);
    ck_assert_int_eq(judge_single_from(eyes, object, occluder, true), exact);
    return exact;
}

START_TEST(hidden_from_every_eye_in_a_box)
{
    occ_box eyes = kit_cube(8, 0, 0, 1), wall = panel(0, -4, 4, -4, 4);
    // The narrowest shadow: from (9, 1) past (0, 4), on a line with slope -1 / 3.
    occ_box small = panel(-8, -6.5f, 6.5f, -6.5f, 6.5f), exact = panel(-9, -7, 7, -7, 7);
    occ_box more = panel(-9, -7, nextafterf(7, 8), -7, 7);
    more.center[1] = nextafterf(0, 1);
    more.axis[1][1] = 7;
    ck_assert_int_eq(from_box(&eyes, &small, &wall), JUDGE_HIDDEN);
    ck_assert_int_eq(from_box(&eyes, &exact, &wall), JUDGE_GRAZED);
    ck_assert_int_eq(from_box(&eyes, &more, &wall), JUDGE_SEEN);
    occ_box flush = kit_cube(-7, 0, 0, 7);
    ck_assert_int_eq(from_box(&eyes, &flush, &wall), JUDGE_SEEN);
    flush = block(-9, 0, -4, 4, -4, 4); // its face is the sheet
    ck_assert_int_eq(from_box(&eyes, &flush, &wall), JUDGE_GRAZED);
    occ_box within = kit_cube(0, 0, 0, 8.0f);
    ck_assert_int_eq(from_box(&within, &small, &wall),
                     JUDGE_SEEN); // the occluder is among the eyes
}
END_TEST

// A corner of the occluder reaches into the box of eyes, though all 64 segments meet it.
START_TEST(an_occluder_among_the_eyes_hides_nothing)
{
    occ_box eyes = kit_cube(0, 0, 0, 1), object = {{-9, 0, 0}, {{0}}};
    occ_box wedge = {{-4.5f, 0, 0}, {{2, 2, 0}, {2, -2, 0}, {0, 0, 4}}}; // an edge at x = -0.5
    ck_assert_int_eq(from_box(&eyes, &object, &wedge), JUDGE_SEEN);
    wedge.center[0] = -5; // touches
    ck_assert_int_eq(from_box(&eyes, &object, &wedge), JUDGE_SEEN);
    wedge.center[0] = -5.0001f;
    object.center[0] = -10;
    ck_assert_int_eq(from_box(&eyes, &object, &wedge), JUDGE_HIDDEN);
}
END_TEST

// --- clip planes ---------------------------------------------------------------------------------

// From (8, 0, 0) along -x, 90 degrees, near plane at x = 7, far plane at infinity: w = 8 - x, clip
// x = z, clip y = y, clip z = w - 1, from 0.
static judge *quarter_view(const double *eye)
{
    occ_camera_desc camera = {
        .view_projection = {0, 0, -1, -1, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 7, 8},
        .depth = OCC_DEPTH_ZERO_TO_ONE,
        .eye = eye,
    };
    judge *j = judge_of_camera(&camera);
    ck_assert_ptr_nonnull(j);
    return j;
}

START_TEST(inside_crossing_and_outside)
{
    judge *j = quarter_view(NULL);
    occ_box inside = kit_cube(0, 0, 0, 1), crossing = kit_cube(0, 8, 0, 1);
    occ_box touching = kit_cube(-1, 11, 0, 1), beyond = kit_cube(20, 0, 0, 1);
    occ_box corner = kit_cube(7.5f, 0, 0, 0.5f), rim = kit_cube(7.5f, 0, 0, 0.75f);
    occ_box all = kit_cube(0, 0, 0, 100), beside = kit_cube(7, 3, 3, 1.5f);
    ck_assert_int_eq(judge_frustum(j, &inside), JUDGE_INSIDE);
    ck_assert_int_eq(judge_frustum(j, &crossing), JUDGE_CROSSING);
    ck_assert_int_eq(judge_frustum(j, &touching), JUDGE_OUTSIDE); // (-2, 10, z) is on a plane
    ck_assert_int_eq(judge_frustum(j, &beyond), JUDGE_OUTSIDE);
    ck_assert_int_eq(judge_frustum(j, &corner), JUDGE_OUTSIDE); // its face is in the near plane
    ck_assert_int_eq(judge_frustum(j, &rim), JUDGE_CROSSING);
    ck_assert_int_eq(judge_frustum(j, &all), JUDGE_CROSSING);
    ck_assert_int_eq(judge_frustum(j, &beside), JUDGE_CROSSING); // (5.5, 1.5, 1.5) is in
    occ_box dot = {{7, 1, 1}, {{0}}}, line = {{7, 2, 0}, {{0, 1, 0}, {0}, {0}}};
    ck_assert_int_eq(judge_frustum(j, &dot), JUDGE_INSIDE);
    ck_assert_int_eq(judge_frustum(j, &line), JUDGE_OUTSIDE); // its end is on a plane
    judge_free(j);
}
END_TEST

// Outside of no single plane, and yet outside: it passes the near corner of the frustum.
START_TEST(outside_though_no_plane_tells)
{
    judge *j = quarter_view(NULL);
    occ_box beam = {{7.125f, 1.125f, 0}, {{0.5f, -1, 0}, {0.03125f, 0.015625f, 0}, {0, 0, 0.5f}}};
    ck_assert_int_eq(judge_frustum(j, &beam), JUDGE_OUTSIDE);
    ck_assert(!ask(j, &beam, NULL, 0));
    beam.center[0] = 6.9375f;
    ck_assert_int_eq(judge_frustum(j, &beam), JUDGE_CROSSING);
    ck_assert(ask(j, &beam, NULL, 0));
    judge_free(j);
}
END_TEST

START_TEST(what_is_seen_must_be_inside)
{
    judge *j = quarter_view(NULL);
    occ_box wall = panel(-8, 0, 32, -4, 4), below = panel(0, 0, 8, -2, 2);
    ck_assert(
        !ask(j, &wall, &below, 1)); // at x = -8 the view ends at y = 16, and so does the shadow
    occ_box less = panel(0, 0, nextafterf(8, 0), -2, 2);
    less.center[1] = nextafterf(4, 0);
    less.axis[1][1] = 4;
    ck_assert(ask(j, &wall, &less, 1));
    occ_box outside = panel(-8, 16, 32, -4, 4);
    ck_assert(!ask(j, &outside, NULL, 0));
    outside.center[1] = nextafterf(24, 0);
    ck_assert(ask(j, &outside, NULL, 0));
    judge_free(j);
}
END_TEST

START_TEST(the_near_plane_opens_objects_and_occluders)
{
    judge *j = quarter_view(NULL);
    occ_box object = block(-8, 7.5f, -0.5f, 0.5f, -0.5f, 0.5f), shield = panel(6.5f, -4, 4, -4, 4);
    ck_assert(ask(j, &object, &shield, 1)); // its cut at x = 7 is before the shield
    occ_box at_near = panel(7, -4, 4, -4, 4), before = panel(7.25f, -4, 4, -4, 4);
    ck_assert(!ask(j, &object, &at_near, 1));
    ck_assert(ask(j, &object, &before, 1)); // it is not drawn
    // A ramp from (7.5, -1) to (6.5, 1): the near plane leaves what is above y = 0.
    occ_box ramp = {{7, 0, 0}, {{-0.5f, 1, 0}, {0, 0, 4}, {0, 0, 0}}};
    occ_box above = panel(-8, 0, 8, -8, 8), across = panel(-8, -0.125f, 8, -8, 8);
    ck_assert(!ask(j, &above, &ramp, 1));
    ck_assert(ask(j, &across, &ramp, 1));
    judge_free(j);
}
END_TEST

START_TEST(planes_are_carried_to_a_given_eye)
{
    static const double elsewhere[3] = {1e6 + 0x1p-30, 0, 0};
    judge *j = quarter_view(elsewhere);
    occ_box inside = kit_cube(1e6f - 8, 0, 0, 1), outside = kit_cube(0, 2e6f, 0, 1);
    occ_box ahead = kit_cube(1e6f + 1, 0, 0, 1), away = kit_cube(1e6f + 8, 0, 0, 1);
    ck_assert_int_eq(judge_frustum(j, &inside), JUDGE_INSIDE);
    ck_assert_int_eq(judge_frustum(j, &outside), JUDGE_OUTSIDE);
    ck_assert_int_eq(judge_frustum(j, &ahead), JUDGE_OUTSIDE);
    ck_assert_int_eq(judge_frustum(j, &away), JUDGE_OUTSIDE);
    judge_free(j);
    occ_camera_desc singular = {
        .view_projection = {0, 0, -1, -1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 7, 8}};
    ck_assert_ptr_null(judge_of_camera(&singular));
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("judge");
    TCase *panels = tcase_create("panels");
    tcase_add_test(panels, without_occluders_everything_is_seen);
    tcase_add_test(panels, two_abutting_panels_hide_what_neither_hides);
    tcase_add_test(panels, the_shadows_rim_belongs_to_the_shadow);
    tcase_add_test(panels, the_gap_is_seen_where_it_is);
    tcase_add_test(panels, panels_may_stand_one_behind_the_other);
    tcase_add_test(panels, three_sectors_meet_in_one_point);
    tcase_add_test(panels, a_wall_of_sixteen_panels_needs_each_of_them);
    tcase_add_test(panels, solid_blocks_abut_as_panels_do);
    suite_add_tcase(suite, panels);
    TCase *touching = tcase_create("touching");
    tcase_add_test(touching, an_owner_is_not_hidden_by_its_own);
    tcase_add_test(touching, what_an_occluder_holds_is_hidden_and_what_sticks_out_is_not);
    tcase_add_test(touching, a_sheet_through_an_object_hides_only_what_is_behind_it);
    tcase_add_test(touching, eyes_in_the_plane_of_an_occluders_face);
    tcase_add_test(touching, eyes_in_the_plane_of_an_objects_face);
    tcase_add_test(touching, eyes_inside_of_occluders_and_objects);
    tcase_add_test(touching, segments_and_points_are_seen_by_length_and_by_themselves);
    tcase_add_test(touching, occluders_without_area_hide_what_lies_along_them);
    tcase_add_test(touching, three_axes_in_one_plane_are_a_hexagon);
    suite_add_tcase(suite, touching);
    TCase *cameras = tcase_create("cameras");
    tcase_add_test(cameras, a_direction_casts_parallel_shadows);
    tcase_add_test(cameras, hidden_from_every_eye_in_a_box);
    tcase_add_test(cameras, an_occluder_among_the_eyes_hides_nothing);
    tcase_add_test(cameras, inside_crossing_and_outside);
    tcase_add_test(cameras, outside_though_no_plane_tells);
    tcase_add_test(cameras, what_is_seen_must_be_inside);
    tcase_add_test(cameras, the_near_plane_opens_objects_and_occluders);
    tcase_add_test(cameras, planes_are_carried_to_a_given_eye);
    suite_add_tcase(suite, cameras);
    return test_run_suite(suite);
}
