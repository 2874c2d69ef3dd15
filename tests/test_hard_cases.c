// SPDX-License-Identifier: Apache-2.0
// labels: unit oracle
// timeout: 120
// The cases that break culling, each by name: what must be seen is seen, what must go goes, by
// every method on every backend, and the judge agrees with all that went.
#include "hard.h"

#include "support.h"

#include <string.h>

// --- where the eye is ----------------------------------------------------------------------------

HARD_CASE(an_eye_level_with_a_face_is_not_past_it)
{
    hard_look(h, 0, 1, 0, NULL);
    hard_occluder(h, hard_brick(0, 0, -10, 1, 1, 1), -1);
    hard_object(h, hard_brick(0, -0.5f, -20, 0.5f, 0.5f, 0.5f), HIDDEN);
    hard_object(h, hard_brick(0, 1, -20, 0.5f, 0.5f, 0.5f), SEEN);    // astride the plane
    hard_object(h, hard_brick(0, 1, -20, 0.5f, 0, 0.5f), SEEN);       // in it
    hard_object(h, hard_brick(0, 0.5f, -20, 0.5f, 0.5f, 0.5f), SEEN); // under it, and touching it
}

HARD_CASE(an_eye_in_line_with_an_edge_sees_along_it)
{
    hard_look(h, 1, 1, 0, NULL);
    hard_occluder(h, hard_brick(0, 0, -10, 1, 1, 1), -1);
    hard_object(h, hard_brick(0, 0, -20, 0.5f, 0.5f, 0.5f), HIDDEN);
    hard_object(h, hard_brick(1, 1, -20, 0, 0, 0.5f), SEEN); // on the line
    hard_object(h, hard_brick(1, 0, -20, 0, 0.5f, 0.5f), SEEN);
}

HARD_CASE(an_eye_in_a_corner_of_an_occluder_is_not_hidden_by_it)
{
    hard_look(h, 1, 1, 1, NULL);
    hard_occluder(h, hard_brick(0, 0, 0, 1, 1, 1), -1);
    hard_occluder(h, hard_brick(1, 1, -20, 1, 1, 1), -1);
    hard_object(h, hard_brick(-1, -1, -5, 0.5f, 0.5f, 0.5f), SEEN);
    hard_object(h, hard_brick(1, 1, -40, 0.5f, 0.5f, 0.5f), HIDDEN);
}

HARD_CASE(an_eye_inside_an_occluder_is_not_hidden_by_it)
{
    hard_look(h, 0, 0, 0, NULL);
    hard_occluder(h, hard_brick(0.25f, 0, 0, 1, 1, 1), -1);
    hard_occluder(h, hard_brick(5, 0, -20, 1, 1, 1), -1);
    hard_object(h, hard_brick(0, 0, -0.5f, 0.1f, 0.1f, 0.1f), SEEN);
    hard_object(h, hard_brick(0, 0, -10, 1, 1, 1), SEEN);
    hard_object(h, hard_brick(10, 0, -40, 1, 1, 1), HIDDEN);
}

HARD_CASE(an_eye_inside_an_object_sees_it)
{
    hard_look(h, 0, 0, 0, NULL);
    hard_occluder(h, hard_brick(0, 0, -5, 9, 9, 0.5f), 2);
    hard_object(h, hard_brick(0, 0, 0, 1, 1, 1), SEEN);
    hard_object(h, hard_brick(0, 0, 0, 500, 500, 500), SEEN);
    hard_object(h, hard_brick(0, 0, -5, 9, 9, 1), SEEN);
    hard_object(h, hard_brick(0, 0, -10, 1, 1, 1), HIDDEN);
}

HARD_CASE(an_occluder_behind_the_eye_hides_nothing_before_it)
{
    hard_look(h, 0, 0, 0, NULL);
    hard_occluder(h, hard_brick(0, 0, 5, 9, 9, 1), -1);
    hard_occluder(h, hard_brick(0, 0, 5, 9, 9, 0), -1);
    hard_object(h, hard_brick(0, 0, -5, 1, 1, 1), SEEN);
    hard_object(h, hard_brick(0, 0, 20, 1, 1, 1), OUTSIDE);
}

HARD_CASE(objects_behind_around_and_touching_the_eye_and_the_near_plane)
{
    const world_lens lens = {.near_z = 1};
    hard_look(h, 0, 0, 0, &lens);
    hard_occluder(h, hard_brick(0, 0, -20, 99, 99, 1), -1);
    hard_object(h, hard_brick(0, 0, 3, 1, 1, 1), OUTSIDE);
    hard_object(h, hard_brick(0, 0, 1, 1, 1, 1), OUTSIDE); // touches the eye
    hard_object(h, hard_brick(0, 0, -0.5f, 1, 1, 0.25f), OUTSIDE);
    hard_object(h, hard_brick(0, 0, -1, 1, 1, 1), SEEN); // from the eye through the near plane
    hard_object(h, hard_brick(0, 0, -1, 0.1f, 0.1f, 0), DOUBTFUL); // in it, as floats have it
    hard_object(h, hard_brick(0, 0, -1.001f, 0.1f, 0.1f, 0), SEEN);
    hard_object(h, hard_brick(0, 0, -30, 1, 1, 5), HIDDEN);
}

// --- surfaces that meet --------------------------------------------------------------------------

HARD_CASE(coplanar_touching_and_identical_boxes_stay)
{
    hard_look(h, 0, 0, 0, NULL);
    hard_occluder(h, hard_brick(0, 0, -10, 3, 3, 0), -1);
    hard_occluder(h, hard_brick(9, 0, -19, 3, 3, 1), -1);
    hard_object(h, hard_brick(0, 0, -10, 1, 1, 0), SEEN);        // in the sheet
    hard_object(h, hard_brick(0, 0, -10, 3, 3, 0), SEEN);        // the sheet
    hard_object(h, hard_brick(0, 0, -11, 1, 1, 1), SEEN);        // touches it from behind
    hard_object(h, hard_brick(0, 0, -9, 1, 1, 1), SEEN);         // and from before
    hard_object(h, hard_brick(0, 0, -11.001f, 1, 1, 1), HIDDEN); // a millimetre behind it
    hard_object(h, hard_brick(9, 0, -19, 3, 3, 1), SEEN);        // the brick
    hard_object(h, hard_brick(9, 0, -18, 1, 1, 0), SEEN);        // on its face
    hard_object(h, hard_brick(9, 0, -19, 1, 1, 1), SEEN);        // inside, flush with its face
    hard_object(h, hard_brick(9, 0, -19, 1, 1, 0.5f), HIDDEN);   // inside
    hard_object(h, hard_brick(9, 0, -20, 1, 1, 0), HIDDEN);      // on its back
}

HARD_CASE(boxes_without_thickness_area_or_volume)
{
    hard_look(h, 0, 0, 0, NULL);
    hard_occluder(h, hard_brick(0, 0, -10, 2, 2, 0), -1);
    hard_occluder(h, hard_brick(8, 0, -10, 2, 0, 0), -1);  // a segment
    hard_occluder(h, hard_brick(-8, 0, -10, 0, 0, 0), -1); // a point
    hard_object(h, hard_brick(0, 0, -12, 1, 1, 0), HIDDEN);
    hard_object(h, hard_brick(0, 0, -12, 1, 0, 0), HIDDEN);
    hard_object(h, hard_brick(0, 0, -12, 0, 0, 0), HIDDEN);
    hard_object(h, hard_brick(0, 0, -8, 0, 0, 0), SEEN);
    hard_object(h, hard_brick(2.5f, 0, -12, 0, 1, 0), SEEN);
    hard_object(h, hard_brick(9.6f, 0, -12, 0.1f, 0, 0), SEEN);
    hard_object(h, hard_brick(-9.6f, 0, -12, 0, 0, 0), SEEN);
}

HARD_CASE(needles_of_one_to_a_million)
{
    hard_look(h, 0, 0, 0, NULL);
    hard_occluder(h, hard_brick(0, 0, -100, 10, 1e-2f, 1e-2f), -1);
    hard_occluder(h, hard_brick(0, 30, -100, 20, 20, 1e-5f), -1);
    hard_object(h, hard_brick(0, 0, -110, 5, 5e-6f, 5e-6f), HIDDEN);
    hard_object(h, hard_brick(0, 0, -110, 20, 2e-5f, 2e-5f),
                SEEN); // longer than the needle before it
    hard_object(h, hard_brick(0, 0, -110, 5e-6f, 5, 5e-6f), SEEN); // across it
    hard_object(h, hard_brick(0, 36, -120, 10, 1e-5f, 1e-5f), HIDDEN);
    hard_object(h, hard_brick(0, 36, -120, 1e-5f, 1e-5f, 10), HIDDEN);
    hard_object(h, hard_brick(0, 36, -120, 1e-5f, 30, 1e-5f), SEEN); // comes out of it on both ends
}

HARD_CASE(interpenetrating_boxes_show_what_sticks_out)
{
    hard_look(h, 0, 0, 0, NULL);
    hard_occluder(h, hard_brick(0, 0, -20, 5, 5, 5), -1);
    hard_object(h, hard_brick(0, 0, -16, 1, 1, 2), SEEN);             // out of the front
    hard_object(h, hard_brick(5, 0, -16, 2, 1, 0.5f), SEEN);          // out of the side
    hard_object(h, hard_brick(0, 0, -24, 1, 1, 3), HIDDEN);           // out of the back
    hard_object(h, hard_brick(0, 0, -20, 1, 1, 1), HIDDEN);           // not at all
    hard_object(h, hard_brick(0, 0, -15.05f, 5.03f, 1, 0.01f), SEEN); // by a hand's breadth
    hard_object(h, hard_brick(0, 0, -20, 9, 9, 9), SEEN);             // holds the occluder
}

HARD_CASE(a_gap_narrower_than_a_pixel_is_a_gap)
{
    hard_look(h, 0, 0, 0, NULL);
    hard_occluder(h, hard_brick(-5.00005f, 0, -10, 5, 5, 0), -1);
    hard_occluder(h, hard_brick(5.00005f, 0, -10, 5, 5, 0), -1);
    hard_object(h, hard_brick(0, 0, -20, 1, 1, 1), SEEN);
    hard_object(h, hard_brick(0, 0, -20, 1e-5f, 1e-5f, 1e-5f), SEEN);
    hard_object(h, hard_brick(2, 0, -20, 1, 1, 1), HIDDEN);
    hard_object(h, hard_brick(-2, 0, -20, 1, 1, 1), HIDDEN);
}

// --- shapes and sizes ----------------------------------------------------------------------------

HARD_CASE(a_scale_of_one_millionth)
{
    hard_wall(h, 1e-6f, NULL);
}

HARD_CASE(a_scale_of_one_thousandth)
{
    hard_wall(h, 1e-3f, NULL);
}

HARD_CASE(a_scale_of_a_thousand)
{
    hard_wall(h, 1e3f, NULL);
}

HARD_CASE(a_scale_of_a_million)
{
    hard_wall(h, 1e6f, NULL);
}

HARD_CASE(a_scale_next_to_the_largest)
{
    hard_wall(h, 4e11f, NULL); // OCC_MAX_COORDINATE is 1e15
}

HARD_CASE(a_huge_occluder_and_a_tiny_object_and_the_reverse)
{
    hard_look(h, 0, 0, 0, NULL);
    hard_occluder(h, hard_brick(0, 0, -5e5f - 20, 1e6f, 1e6f, 5e5f), -1);
    hard_occluder(h, hard_brick(0, 0, -10, 1e-3f, 1e-3f, 1e-3f), -1);
    hard_object(h, hard_brick(0, 0, -30, 1e-3f, 1e-3f, 1e-3f), HIDDEN);
    hard_object(h, hard_brick(1, 1, -19, 1e-3f, 1e-3f, 1e-3f), SEEN);
    hard_object(h, hard_brick(0, 0, -15, 1e-4f, 1e-4f, 1e-4f), HIDDEN); // behind the crumb
    hard_object(h, hard_brick(0, 0, -15, 1e-2f, 1e-2f, 1e-2f), SEEN);
    hard_object(h, hard_brick(0, 0, -600, 1e5f, 1e5f, 500), HIDDEN);
    hard_object(h, hard_brick(0, 0, 0, 1e6f, 1e6f, 1e6f), SEEN);
}

HARD_CASE(mirrored_and_sheared_boxes)
{
    hard_look(h, 0, 0, 0, NULL);
    occ_box mirrored = {{-6, 0, -20}, {{-3, 0, 0}, {0, 3, 0}, {0, 0, 3}}};
    occ_box sheared = {{6, 0, -20}, {{3, 0, 0}, {0, 3, 0}, {6, 0, 3}}}; // leans by two to one
    hard_occluder(h, mirrored, -1);
    hard_occluder(h, sheared, -1);
    hard_object(h, hard_brick(-11, 0, -40, 1, 1, 1), HIDDEN);
    hard_object(h, hard_brick(11, 0, -40, 1, 1, 1), HIDDEN);
    hard_object(h, hard_brick(0.9f, 0, -22, 0.1f, 0.1f, 0.1f), HIDDEN); // behind its left end
    hard_object(h, hard_brick(3.5f, 0, -18.5f, 0.1f, 0.1f, 0.1f),
                SEEN); // in its bounds, before its face
    occ_box leaning = {{-11, 0, -40}, {{-1, 0, 0}, {1, 1, 0}, {0, 1, -1}}};
    hard_object(h, leaning, HIDDEN);
}

// The floats there are a whole unit apart; the detail is in the axes, and the camera counts from
// its own place.
HARD_CASE(millimetres_ten_million_units_from_the_origin)
{
    hard_look(h, 0, 0, 0, NULL);
    const double there[3] = {1e7, -1e7, 1e7};
    memcpy(h->eye, there, sizeof there);
    memcpy(h->origin, there, sizeof there);
    h->camera.origin = h->origin;
    const float x = 1e7f, y = -1e7f, z = 1e7f;
    hard_occluder(h, hard_brick(x, y, z - 10, 3, 3, 0), -1);
    hard_object(h, hard_brick(x, y, z - 20, 5.999f, 1, 0), HIDDEN); // the wall's edge is at 6 here
    hard_object(h, hard_brick(x, y, z - 20, 6.001f, 1, 0), SEEN);
    hard_object(h, hard_brick(x, y, z - 11, 1, 1, 0.999f), HIDDEN);
    hard_object(h, hard_brick(x, y, z - 11, 1, 1, 1.001f), SEEN);
    hard_object(h, hard_brick(x, y, z - 9, 1, 1, 0.001f), SEEN);
    hard_object(h, hard_brick(x, y, z + 1, 1, 1, 0.999f), OUTSIDE);
}

HARD_CASE(an_eye_between_the_floats_far_from_the_origin)
{
    hard_look(h, 0, 0, 0, NULL);
    const double there[3] = {1e7 + 0.25, -1e7, 1e7 + 0.125};
    memcpy(h->eye, there, sizeof there);
    memcpy(h->origin, there, sizeof there);
    h->camera.origin = h->origin;
    const float x = 1e7f, y = -1e7f, z = 1e7f;
    hard_occluder(h, hard_brick(x, y, z - 1, 0.75f, 0.75f, 0), -1); // from -1 to 0.5, 1.125 away
    hard_object(h, hard_brick(x - 1, y, z - 2, 0.6f, 0.1f, 0),
                HIDDEN); // to -1.85; the wall's edge is at -1.889
    hard_object(h, hard_brick(x - 1, y, z - 2, 0.7f, 0.1f, 0), SEEN); // to -1.95
    hard_object(h, hard_brick(x + 1, y, z - 2, 0.1f, 0.1f, 0),
                HIDDEN); // to 0.85; there it is at 0.944
    hard_object(h, hard_brick(x + 1, y, z - 2, 0.2f, 0.1f, 0), SEEN);
}

HARD_CASE(denormal_boxes_are_boxes)
{
    hard_look(h, 0, 0, 0, NULL);
    hard_occluder(h, hard_brick(0, 0, -10, 3, 3, 1e-44f), -1);
    hard_occluder(h, hard_brick(0, 1e-40f, -5, 1e-40f, 1e-42f, 0), -1);
    hard_object(h, hard_brick(0, 0, -20, 1e-45f, 1e-42f, 1e-39f), HIDDEN);
    hard_object(h, hard_brick(1e-40f, 1e-45f, -5, 1e-45f, 0, 0), SEEN);
    hard_object(h, hard_brick(0, 1e-40f, -6, 1e-45f, 0, 0), SEEN);
}

// --- sheets --------------------------------------------------------------------------------------

HARD_CASE(sheets_edge_on_hide_nothing_and_from_both_sides_the_same)
{
    hard_look(h, 0, 0, 0, NULL);
    hard_occluder(h, (occ_box){{0, 0, -20}, {{0, 0, 0}, {0, 5, 0}, {0, 0, 5}}}, -1); // edge-on
    hard_occluder(h, (occ_box){{9, 0, -20}, {{2, 0, 0}, {0, 2, 0}, {0, 0, 0}}}, -1);
    hard_occluder(h, (occ_box){{-9, 0, -20}, {{2, 0, 0}, {0, -2, 0}, {0, 0, 0}}}, -1); // its back
    hard_object(h, hard_brick(0, 0, -30, 0, 1, 1), SEEN);
    hard_object(h, hard_brick(0, 0, -30, 0, 0, 0), SEEN);
    hard_object(h, hard_brick(13.5f, 0, -30, 1, 1, 1), HIDDEN);
    hard_object(h, hard_brick(-13.5f, 0, -30, 1, 1, 1), HIDDEN);
}

HARD_CASE(a_sheet_flush_with_the_bound_of_its_own_object)
{
    hard_look(h, 0, 0, 0, NULL);
    hard_occluder(h, hard_brick(0, 0, -10, 2, 2, 0), 0);  // the front of the first
    hard_occluder(h, hard_brick(6, 0, -10, 2, 2, 0), -1); // that of the second, and nobody's
    hard_object(h, hard_brick(0, 0, -11, 2, 2, 1), SEEN);
    hard_object(h, hard_brick(6, 0, -11, 2, 2, 1), SEEN);
    hard_object(h, hard_brick(0, 0, -13, 1, 1, 0.5f), HIDDEN);
    hard_object(h, hard_brick(7.8f, 0, -13, 1, 1, 0.5f), HIDDEN);
}

// --- how many ------------------------------------------------------------------------------------

HARD_CASE(no_objects_and_no_occluders)
{
    hard_look(h, 0, 0, 0, NULL);
}

HARD_CASE(occluders_and_no_objects)
{
    hard_look(h, 0, 0, 0, NULL);
    hard_occluder(h, hard_brick(0, 0, -10, 3, 3, 1), -1);
}

HARD_CASE(one_object_and_no_occluders)
{
    hard_look(h, 0, 0, 0, NULL);
    hard_object(h, hard_brick(0, 0, -10, 3, 3, 1), SEEN);
}

HARD_CASE(one_object_and_its_own_occluder)
{
    hard_look(h, 0, 0, 0, NULL);
    hard_object(h, hard_brick(0, 0, -10, 3, 3, 1), SEEN);
    hard_occluder(h, hard_brick(0, 0, -5, 9, 9, 1), 0); // even before it
}

// --- all of them ---------------------------------------------------------------------------------

#define CASES(X)                                                                                   \
    X(an_eye_level_with_a_face_is_not_past_it)                                                     \
    X(an_eye_in_line_with_an_edge_sees_along_it)                                                   \
    X(an_eye_in_a_corner_of_an_occluder_is_not_hidden_by_it)                                       \
    X(an_eye_inside_an_occluder_is_not_hidden_by_it)                                               \
    X(an_eye_inside_an_object_sees_it)                                                             \
    X(an_occluder_behind_the_eye_hides_nothing_before_it)                                          \
    X(objects_behind_around_and_touching_the_eye_and_the_near_plane)                               \
    X(coplanar_touching_and_identical_boxes_stay)                                                  \
    X(boxes_without_thickness_area_or_volume)                                                      \
    X(needles_of_one_to_a_million)                                                                 \
    X(interpenetrating_boxes_show_what_sticks_out)                                                 \
    X(a_gap_narrower_than_a_pixel_is_a_gap)                                                        \
    X(a_scale_of_one_millionth)                                                                    \
    X(a_scale_of_one_thousandth)                                                                   \
    X(a_scale_of_a_thousand)                                                                       \
    X(a_scale_of_a_million)                                                                        \
    X(a_scale_next_to_the_largest)                                                                 \
    X(a_huge_occluder_and_a_tiny_object_and_the_reverse)                                           \
    X(mirrored_and_sheared_boxes)                                                                  \
    X(millimetres_ten_million_units_from_the_origin)                                               \
    X(an_eye_between_the_floats_far_from_the_origin)                                               \
    X(denormal_boxes_are_boxes)                                                                    \
    X(sheets_edge_on_hide_nothing_and_from_both_sides_the_same)                                    \
    X(a_sheet_flush_with_the_bound_of_its_own_object)                                              \
    X(no_objects_and_no_occluders)                                                                 \
    X(occluders_and_no_objects)                                                                    \
    X(one_object_and_no_occluders)                                                                 \
    X(one_object_and_its_own_occluder)

START_TEST(every_one_of_them_on_an_opencl_device)
{
    static hard_builder *const builders[] = {CASES(HARD_BUILDER)};
    hard_run_on_device(builders, sizeof builders / sizeof *builders);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("hard cases");
    TCase *host = tcase_create("host");
    CASES(HARD_ADD)
    suite_add_tcase(suite, host);
    TCase *device = tcase_create("device");
    tcase_add_test(device, every_one_of_them_on_an_opencl_device);
    suite_add_tcase(suite, device);
    return test_run_suite(suite);
}
