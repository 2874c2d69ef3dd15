// SPDX-License-Identifier: Apache-2.0
#include "image_compare.h"
#include "support.h"

#include <stdlib.h>
#include <string.h>

enum { WIDTH = 4, HEIGHT = 3, PIXELS = WIDTH * HEIGHT };

// Object 0 has the opaque places 0 and 1, object 1 the opaque 2 and the see-through 3, object 2 the
// see-through 4. Place i is the model's triangle 10 + i.
static uint32_t first[] = {0, 2, 4, 5}, see_through[] = {2, 3, 4},
                triangles[] = {10, 11, 12, 13, 14};
static const image_parts parts = {.object_count = 3,
                                  .triangle_count = 5,
                                  .triangles = triangles,
                                  .first = first,
                                  .see_through = see_through,
                                  .see_through_count = 2};

static image_pixels full, culled;
static bool is_drawn[3];
static uint32_t veils[3][PIXELS]; // what the see-through triangles of each object give alone

static void set_up(void)
{
    ck_assert(image_pixels_create(&full, WIDTH, HEIGHT));
    ck_assert(image_pixels_create(&culled, WIDTH, HEIGHT));
    for (int i = 0; i < 3; i++)
        is_drawn[i] = true;
    memset(veils, 0, sizeof veils);
}

static void tear_down(void)
{
    image_pixels_free(&full);
    image_pixels_free(&culled);
}

static bool probe(void *state, uint32_t object, uint32_t *veil)
{
    ck_assert_ptr_eq(state, veils);
    memcpy(veil, veils[object], sizeof veils[object]);
    return true;
}

static image_difference compare(void)
{
    image_difference d;
    ck_assert(image_compare(&full, &culled, &parts, is_drawn, probe, veils, &d));
    return d;
}

START_TEST(equal_pictures_do_not_differ)
{
    for (uint32_t i = 0; i < PIXELS; i++)
        full.front[i] = culled.front[i] = i % 4;
    is_drawn[0] = false;
    image_difference d = compare();
    ck_assert_uint_eq(d.pixels, 0);
    ck_assert_uint_eq(d.count, 0);
    ck_assert_uint_eq(d.unnamed, 0);
    image_difference_free(&d);
}
END_TEST

START_TEST(missing_object_is_named_with_its_first_pixel_and_triangle)
{
    is_drawn[0] = false;
    full.front[1 * WIDTH + 3] = 1; // the middle row
    full.front[2 * WIDTH + 2] = 2; // the upper one, which is the last
    culled.front[2 * WIDTH + 2] = 3;
    full.front[5] = culled.front[5] = 3;
    image_difference d = compare();
    ck_assert_uint_eq(d.pixels, 2);
    ck_assert_uint_eq(d.unnamed, 0);
    ck_assert_uint_eq(d.count, 1);
    ck_assert_uint_eq(d.missing[0].object, 0);
    ck_assert_uint_eq(d.missing[0].pixels, 2);
    ck_assert_uint_eq(d.missing[0].x, 2);
    ck_assert_uint_eq(d.missing[0].y, 0);
    ck_assert_uint_eq(d.missing[0].triangle, 11);
    image_difference_free(&d);
}
END_TEST

START_TEST(difference_without_a_missing_object_is_counted)
{
    full.front[0] = 1; // one drawn object for another,
    culled.front[0] = 3;
    culled.front[7] = 3; // or where there was nothing
    culled.veil[8] = 99;
    image_difference d = compare();
    ck_assert_uint_eq(d.pixels, 3);
    ck_assert_uint_eq(d.unnamed, 3);
    ck_assert_uint_eq(d.count, 0);
    image_difference_free(&d);
}
END_TEST

START_TEST(missing_see_through_objects_are_named)
{
    is_drawn[1] = is_drawn[2] = false;
    full.veil[2] = 5; // of both
    veils[1][2] = 6;
    veils[2][2] = 3;
    full.veil[9] = 7; // of one
    veils[2][9] = 7;
    veils[2][10] = 7; // where the pictures are equal
    image_difference d = compare();
    ck_assert_uint_eq(d.pixels, 2);
    ck_assert_uint_eq(d.unnamed, 0);
    ck_assert_uint_eq(d.count, 2);
    ck_assert_uint_eq(d.missing[0].object, 1);
    ck_assert_uint_eq(d.missing[0].pixels, 1);
    ck_assert_uint_eq(d.missing[1].object, 2);
    ck_assert_uint_eq(d.missing[1].pixels, 2);
    ck_assert_uint_eq(d.missing[1].x, 1);
    ck_assert_uint_eq(d.missing[1].y, 0);
    ck_assert_uint_eq(d.missing[1].triangle, UINT32_MAX);
    image_difference_free(&d);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("image_compare");
    TCase *pixels = tcase_create("pixels");
    tcase_add_checked_fixture(pixels, set_up, tear_down);
    tcase_add_test(pixels, equal_pictures_do_not_differ);
    tcase_add_test(pixels, missing_object_is_named_with_its_first_pixel_and_triangle);
    tcase_add_test(pixels, difference_without_a_missing_object_is_counted);
    tcase_add_test(pixels, missing_see_through_objects_are_named);
    suite_add_tcase(suite, pixels);
    return test_run_suite(suite);
}
