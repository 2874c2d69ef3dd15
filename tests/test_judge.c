// SPDX-License-Identifier: Apache-2.0
// The judge of many occluders, where the answer is known by hand: see judge_scenes.h.
#include "judge_scenes.h"

#include "support.h"

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
        int row = i / 4, column = i % 4;
        float y = 2.0f * (float)column - 4.0f, z = 2.0f * (float)row - 4.0f;
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
    return test_run_suite(suite);
}
