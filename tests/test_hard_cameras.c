// SPDX-License-Identifier: Apache-2.0
// labels: unit oracle
// timeout: 120
// The cameras that break culling, each by name, as in test_hard_cases.c.
#include "hard.h"

#include "support.h"

// --- the frame of the picture --------------------------------------------------------------------

// 60 degrees of height, 16 : 9: 5.7735 up and 10.264 aside at a distance of 10.
HARD_CASE(objects_at_the_edge_of_the_viewport)
{
    hard_look(h, 0, 0, 0, NULL);
    hard_object(h, hard_brick(11.263f, 0, -10, 1, 1, 0), SEEN);
    hard_object(h, hard_brick(11.266f, 0, -10, 1, 1, 0), OUTSIDE);
    hard_object(h, hard_brick(-11.263f, 0, -10, 1, 1, 0), SEEN);
    hard_object(h, hard_brick(-11.266f, 0, -10, 1, 1, 0), OUTSIDE);
    hard_object(h, hard_brick(0, 6.773f, -10, 1, 1, 0), SEEN);
    hard_object(h, hard_brick(0, 6.775f, -10, 1, 1, 0), OUTSIDE);
    hard_object(h, hard_brick(0, -6.773f, -10, 1, 1, 0), SEEN);
    hard_object(h, hard_brick(0, -6.775f, -10, 1, 1, 0), OUTSIDE);
    hard_object(h, hard_brick(0, 0, 0.1f, 1, 1, 0.25f), SEEN); // reaches the near plane by 0.05
}

// Some of them are hidden only where no picture is: that does not matter, one corner is inside.
HARD_CASE(an_object_half_outside_is_hidden_by_what_hides_all_of_it)
{
    hard_look(h, 0, 0, 0, NULL);
    hard_occluder(h, hard_brick(6, 0, -5, 4, 4, 0.1f), -1);
    hard_object(h, hard_brick(11, 0, -10, 2, 1, 0.5f), HIDDEN);
    hard_object(h, hard_brick(5, 0, -10, 2, 1, 0.5f), SEEN);
}

HARD_CASE(a_camera_with_depth_from_zero_to_one)
{
    const world_lens lens = {.depth = OCC_DEPTH_ZERO_TO_ONE};
    hard_wall(h, 1, &lens);
}

HARD_CASE(a_camera_with_reversed_depth)
{
    const world_lens lens = {.depth = OCC_DEPTH_ONE_TO_ZERO};
    hard_wall(h, 1, &lens);
}

HARD_CASE(a_camera_with_an_infinite_far_plane)
{
    const world_lens lens = {.projection = WORLD_INFINITE};
    hard_wall(h, 1, &lens);
}

HARD_CASE(a_camera_with_reversed_depth_and_an_infinite_far_plane)
{
    const world_lens lens = {.projection = WORLD_INFINITE, .depth = OCC_DEPTH_ONE_TO_ZERO};
    hard_wall(h, 1, &lens);
}

HARD_CASE(an_off_centre_camera)
{
    const world_lens lens = {.projection = WORLD_OFF_CENTRE};
    hard_wall(h, 1, &lens);
}

HARD_CASE(a_jittered_camera)
{
    const world_lens lens = {.projection = WORLD_JITTERED};
    hard_wall(h, 1, &lens);
}

static void orthographic(hard *h, occ_depth depth)
{
    const world_lens lens = {.projection = WORLD_ORTHOGRAPHIC, .depth = depth};
    hard_wall(h, 1, &lens);
    hard_object(h, hard_brick(2.4f, 0, -500, 0.5f, 0.5f, 0.5f),
                HIDDEN); // no perspective makes it smaller
    hard_object(h, hard_brick(2.6f, 0, -11, 0.5f, 0.5f, 0.2f), SEEN);
    hard_object(h, hard_brick(0, 0, 5, 1, 1, 1), OUTSIDE);
}

HARD_CASE(an_orthographic_camera)
{
    orthographic(h, OCC_DEPTH_MINUS_ONE_TO_ONE);
}

HARD_CASE(an_orthographic_camera_with_reversed_depth)
{
    orthographic(h, OCC_DEPTH_ONE_TO_ZERO);
}

// --- all of them ---------------------------------------------------------------------------------

#define CASES(X)                                                                                   \
    X(objects_at_the_edge_of_the_viewport)                                                         \
    X(an_object_half_outside_is_hidden_by_what_hides_all_of_it)                                    \
    X(a_camera_with_depth_from_zero_to_one)                                                        \
    X(a_camera_with_reversed_depth)                                                                \
    X(a_camera_with_an_infinite_far_plane)                                                         \
    X(a_camera_with_reversed_depth_and_an_infinite_far_plane)                                      \
    X(an_off_centre_camera)                                                                        \
    X(a_jittered_camera)                                                                           \
    X(an_orthographic_camera)                                                                      \
    X(an_orthographic_camera_with_reversed_depth)

START_TEST(every_one_of_them_on_an_opencl_device)
{
    static hard_builder *const builders[] = {CASES(HARD_BUILDER)};
    hard_run_on_device(builders, sizeof builders / sizeof *builders);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("hard cameras");
    TCase *host = tcase_create("host");
    CASES(HARD_ADD)
    suite_add_tcase(suite, host);
    TCase *device = tcase_create("device");
    tcase_add_test(device, every_one_of_them_on_an_opencl_device);
    suite_add_tcase(suite, device);
    return test_run_suite(suite);
}
