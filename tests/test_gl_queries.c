// SPDX-License-Identifier: Apache-2.0
// The occlusion queries themselves, where the answer is known: a view of 90 degrees along -z, so
// that a front of half size h at distance d covers (SIDE h / d)^2 pixels.
#include "gl_queries.h"

#include "support.h"
#include "worlds.h"

enum { SIDE = 64 };

static gl_queries *queries;
static glb_camera view;

static void look(occ_depth depth)
{
    const float eye[3] = {0, 0, 0}, target[3] = {0, 0, -1};
    world_lens lens = {.depth = depth, .height = 1.57079633f, .near_z = 0.125f, .far_z = 100};
    occ_camera_desc camera = world_camera(eye, target, &lens);
    for (int c = 0; c < 4; c++) // as wide as it is high
        camera.view_projection[4 * c] *= 16.0f / 9.0f;
    view = glq_camera(queries, &camera, SIDE, SIDE);
}

static void open_queries(void)
{
    queries = glq_open(SIDE, SIDE);
    look(OCC_DEPTH_MINUS_ONE_TO_ONE);
}

static void close_queries(void)
{
    glq_close(queries);
}

static uint32_t count(const occ_box *object, const occ_box *occluders, size_t number)
{
    glq_rect all = glq_frustum(&view, 0);
    uint32_t samples[2];
    for (int sparing = 0; sparing < 2; sparing++) {
        glb_manner manner = sparing ? GLB_SPARING : GLB_GENEROUS;
        glq_occlude(queries, &view, &all, occluders, NULL, number,
                    sparing ? GLB_GENEROUS : GLB_SPARING);
        glq_count(queries, &view, &all, object, NULL, 1, manner, &samples[sparing]);
    }
    ck_assert_uint_eq(samples[0], samples[1]); // none of these is in doubt
    return samples[0];
}

static occ_box block(float x, float y, float z, float half_x, float half_y, float half_z)
{
    return (occ_box){{x, y, z}, {{half_x, 0, 0}, {0, half_y, 0}, {0, 0, half_z}}};
}

START_TEST(lone_object_covers_the_pixels_of_its_front)
{
    const occ_box middle = block(0, 0, -5.25f, 1.26f, 0.64f, 1);
    for (int depth = 0; depth < 3; depth++) {
        look((occ_depth)depth);
        ck_assert_uint_eq(count(&middle, NULL, 0), 18 * 10);
    }
}
END_TEST

START_TEST(walls_hide_what_is_behind_them)
{
    const occ_box middle = block(0, 0, -5.25f, 1.26f, 0.64f, 1);
    const occ_box walls[] = {block(0, 0, -3, 2, 2, 0.25f), block(0, 0, -9, 2, 2, 0.25f),
                             block(-2, 0, -3, 2, 2, 0.25f)};
    const uint32_t expected[] = {0, 18 * 10, 9 * 10};
    for (int depth = 0; depth < 3; depth++) {
        look((occ_depth)depth);
        for (int i = 0; i < 3; i++)
            ck_assert_uint_eq(count(&middle, &walls[i], 1), expected[i]);
    }
}
END_TEST

START_TEST(what_is_outside_the_frustum_has_no_samples)
{
    const occ_box outside[] = {block(0, 0, 5, 1, 1, 1), block(9, 0, -5, 1, 1, 1),
                               block(0, -9, -5, 1, 1, 1), block(0, 0, -102, 1, 1, 1)};
    for (int i = 0; i < 4; i++)
        ck_assert_uint_eq(count(&outside[i], NULL, 0), 0);
    const occ_box around = block(0, 0, 0, 9, 9, 9), ground = block(0, -1, 0, 90, 0, 90);
    ck_assert_uint_eq(count(&around, NULL, 0), SIDE * SIDE);
    ck_assert_uint_eq(count(&ground, NULL, 0), SIDE * SIDE / 2); // nearly to the horizon
}
END_TEST

// A box as far as a tolerance apart from the center of a pixel may cover it or not; grown it does,
// made smaller it does not.
START_TEST(grown_boxes_cover_what_is_in_doubt)
{
    double pixel = 10.0 / SIDE; // the size of one at a distance of 5
    for (int i = 0; i < 16; i++) {
        double half = (2.5 + (i - 7.5) / 8.0 * view.tolerance) * pixel;
        occ_box box = block(0, 0, -5, (float)half, (float)half, 0), larger, smaller;
        ck_assert(glb_grow(&view, &box, GLB_MARGIN * view.tolerance, &larger));
        ck_assert(glb_grow(&view, &box, -GLB_MARGIN * view.tolerance, &smaller));
        uint32_t most = count(&larger, NULL, 0), least = count(&smaller, NULL, 0);
        ck_assert_uint_eq(most, 6 * 6);
        ck_assert_uint_eq(least, 4 * 4);
        ck_assert_uint_eq(count(&box, &larger, 1), 0);
    }
}
END_TEST

START_TEST(doubt_in_depth_goes_where_it_is_told)
{
    const occ_box front = block(0, 0, -5, 1.25f, 1.25f, 0);
    glq_rect all = glq_frustum(&view, 0);
    uint32_t samples;
    glq_occlude(queries, &view, &all, &front, NULL, 1, GLB_GENEROUS);
    glq_count(queries, &view, &all, &front, NULL, 1, GLB_SPARING, &samples);
    ck_assert_uint_eq(samples, 0);
    glq_occlude(queries, &view, &all, &front, NULL, 1, GLB_SPARING);
    glq_count(queries, &view, &all, &front, NULL, 1, GLB_GENEROUS, &samples);
    ck_assert_uint_eq(samples, 16 * 16);
}
END_TEST

START_TEST(many_boxes_are_counted_one_by_one)
{
    enum { MANY = 3000 };
    static occ_box boxes[MANY];
    static uint32_t samples[MANY];
    for (int i = 0; i < MANY; i++) // their fronts are at 4.5
        boxes[i] = block(0, 0, -5, 0.1422f * (float)(i % 7), 0.3125f, 0.5f);
    glq_rect all = glq_frustum(&view, 0);
    glq_occlude(queries, &view, &all, NULL, NULL, 0, GLB_SPARING);
    glq_count(queries, &view, &all, boxes, NULL, MANY, GLB_GENEROUS, samples);
    for (int i = 0; i < MANY; i++)
        KIT_CHECK(samples[i] == 8u * (uint32_t)(i % 7), "%d: %u", i, samples[i]);
}
END_TEST

START_TEST(own_occluders_hide_others_alone)
{
    const occ_box middle = block(0, 0, -5.25f, 1.26f, 0.64f, 1);
    const occ_box walls[] = {block(0, 0, -3, 2, 2, 0.25f), block(0, 0, -2.5f, 2, 2, 0.25f),
                             block(-2, 0, -3.5f, 2, 2, 0.25f), block(2, 0, -9, 2, 2, 0.25f)};
    const uint32_t owners[] = {7, 7, 3, 3}, asked[] = {7, 3, 0};
    const uint32_t expected[][3] = {{18 * 10, 0, 0}, {9 * 10, 0, 0}, {9 * 10, 0, 0}};
    glq_rect all = glq_frustum(&view, 0);
    for (size_t n = 2; n <= 4; n++) {
        const occ_box objects[] = {middle, middle, middle};
        uint32_t samples[3];
        glq_occlude(queries, &view, &all, walls, owners, n, GLB_GENEROUS);
        glq_count(queries, &view, &all, objects, asked, 3, GLB_SPARING, samples);
        for (int i = 0; i < 3; i++)
            ck_assert_uint_eq(samples[i], expected[n - 2][i]);
    }
    const uint32_t swapped[] = {GLQ_NOBODY, 7, 7, 7}; // the nearest is its own, then nobody's
    uint32_t samples, number = 7;
    glq_occlude(queries, &view, &all, walls, swapped, 4, GLB_GENEROUS);
    glq_count(queries, &view, &all, &middle, &number, 1, GLB_SPARING, &samples);
    ck_assert_uint_eq(samples, 0);
}
END_TEST

START_TEST(boxes_next_to_the_eye_are_open)
{
    const occ_box around = block(0, 0, 0, 9, 9, 9), ahead = block(0, 0, -5, 1, 1, 1),
                  beside = block(3, 0, 0, 1, 9, 9), through = block(0, 3, 0, 9, 3, 9),
                  across = block(0, 0, -1, 1, 1, 0.9f);
    ck_assert(glb_is_open(&view, &around));
    ck_assert(!glb_is_open(&view, &ahead));
    ck_assert(!glb_is_open(&view, &beside));
    ck_assert(glb_is_open(&view, &through));
    ck_assert(!glb_is_cut_by_near(&view, &beside));
    ck_assert(glb_is_cut_by_near(&view, &across));
    ck_assert(!glb_is_cut_by_near(&view, &ahead));
    ck_assert_uint_eq(count(&ahead, &beside, 1), count(&ahead, NULL, 0));
}
END_TEST

int main(void)
{
    int skipped = glq_skip();
    if (skipped) return skipped;
    Suite *suite = suite_create("gl_queries");
    TCase *known = tcase_create("known");
    tcase_add_checked_fixture(known, open_queries, close_queries);
    tcase_add_test(known, lone_object_covers_the_pixels_of_its_front);
    tcase_add_test(known, walls_hide_what_is_behind_them);
    tcase_add_test(known, what_is_outside_the_frustum_has_no_samples);
    tcase_add_test(known, grown_boxes_cover_what_is_in_doubt);
    tcase_add_test(known, doubt_in_depth_goes_where_it_is_told);
    tcase_add_test(known, many_boxes_are_counted_one_by_one);
    tcase_add_test(known, own_occluders_hide_others_alone);
    tcase_add_test(known, boxes_next_to_the_eye_are_open);
    suite_add_tcase(suite, known);
    return test_run_suite(suite);
}
