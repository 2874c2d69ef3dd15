// SPDX-License-Identifier: Apache-2.0
#include "path.h"
#include "soup.h"
#include "support.h"
#include "voxels.h"

static obs_scene walk(const model *m, uint32_t frames, path_report *report)
{
    obs_scene scene = {0};
    ck_assert(path_make(m, frames, 0, &scene, report));
    ck_assert_uint_eq(scene.frame_count, frames);
    for (uint32_t f = 0; f < frames; f++) {
        for (size_t i = 0; i < sizeof scene.frames[f] / sizeof(float); i++) {
            float number;
            memcpy(&number, (const char *)&scene.frames[f] + i * sizeof number, sizeof number);
            ck_assert_msg(isfinite(number), "frame %u, number %zu", f, i);
        }
    }
    ck_assert_double_gt(report->near_z, 0);
    ck_assert_double_gt(report->far_z, report->near_z);
    return scene;
}

static void check_within(const obs_scene *scene, const float low[3], const float high[3])
{
    for (uint32_t f = 0; f < scene->frame_count; f++)
        for (int k = 0; k < 3; k++) {
            ck_assert_float_gt(scene->frames[f].eye[k], low[k]);
            ck_assert_float_lt(scene->frames[f].eye[k], high[k]);
        }
}

START_TEST(room_is_walked_inside_and_off_its_walls)
{
    static const float low[3] = {-10, 0, -20}, high[3] = {10, 6, 20};
    path_report report;
    model m = soup_make(12);
    soup_box(&m, low, high, true);
    obs_scene scene = walk(&m, 60, &report);
    ck_assert_str_eq(report.kind, "walk");
    check_within(&scene, low, high);
    ck_assert_double_gt(report.length, 20);
    // The near plane's corners are 1.55 times as far as its middle.
    ck_assert_double_lt(1.55 * report.near_z, report.clearance);
    obs_free(&scene);
    soup_free(&m);
}
END_TEST

// Two rooms and a corridor between, in one skin each: the way leads through all of it.
START_TEST(way_leads_through_a_corridor)
{
    model m = soup_make(60);
    static const float near_low[3] = {0, 0, 0}, near_high[3] = {10, 4, 10};
    static const float far_low[3] = {30, 0, 0}, far_high[3] = {40, 4, 10};
    soup_box(&m, near_low, near_high, true);
    soup_box(&m, far_low, far_high, true);
    // Of soup_box()'s triangles 0 and 1 are the side of least x, 2 and 3 that of most: the two
    // sides that face each other give way to walls with a doorway.
    for (uint32_t t = 0; t < 2; t++) {
        memmove(m.corners[2 + t], m.corners[0], sizeof *m.corners);
        memmove(m.corners[12 + t], m.corners[0], sizeof *m.corners);
    }
    for (int room = 0; room < 2; room++) {
        float x = room ? 30 : 10;
        const float p[8][3] = {{x, 0, 0}, {x, 4, 0}, {x, 4, 4},  {x, 0, 4},
                               {x, 0, 6}, {x, 4, 6}, {x, 4, 10}, {x, 0, 10}};
        soup_quad(&m, p[room ? 0 : 3], p[room ? 1 : 2], p[room ? 2 : 1], p[room ? 3 : 0]);
        soup_quad(&m, p[room ? 4 : 7], p[room ? 5 : 6], p[room ? 6 : 5], p[room ? 7 : 4]);
    }
    const float a[3] = {10, 0, 4}, b[3] = {30, 0, 4}, c[3] = {30, 4, 4}, d[3] = {10, 4, 4};
    const float e[3] = {10, 0, 6}, f[3] = {30, 0, 6}, g[3] = {30, 4, 6}, h[3] = {10, 4, 6};
    soup_quad(&m, a, b, c, d); // faces +z
    soup_quad(&m, h, g, f, e); // faces -z
    soup_quad(&m, a, e, f, b); // the floor
    soup_quad(&m, d, c, g, h); // the ceiling
    path_report report;
    obs_scene scene = walk(&m, 60, &report);
    static const float low[3] = {0, 0, 0}, high[3] = {40, 4, 10};
    check_within(&scene, low, high);
    uint32_t in_corridor = 0;
    for (uint32_t i = 0; i < scene.frame_count; i++) {
        const float *eye = scene.frames[i].eye;
        if (eye[0] < 10 || eye[0] > 30) continue;
        in_corridor++;
        ck_assert(eye[2] > 4 && eye[2] < 6);
    }
    ck_assert_uint_gt(in_corridor, 15);
    obs_free(&scene);
    soup_free(&m);
}
END_TEST

START_TEST(solid_block_is_seen_from_around)
{
    static const float low[3] = {-1, -1, -1}, high[3] = {1, 1, 1};
    path_report report;
    model m = soup_make(12);
    soup_box(&m, low, high, false);
    obs_scene scene = walk(&m, 16, &report);
    ck_assert_str_eq(report.kind, "orbit");
    for (uint32_t f = 0; f < scene.frame_count; f++) {
        const float *eye = scene.frames[f].eye, *dir = scene.frames[f].dir;
        ck_assert_float_gt(eye[0] * eye[0] + eye[2] * eye[2], 2);
        ck_assert_float_lt(eye[0] * dir[0] + eye[1] * dir[1] + eye[2] * dir[2], 0);
    }
    obs_free(&scene);
    soup_free(&m);
}
END_TEST

START_TEST(odd_models_have_a_path_too)
{
    static const float shapes[][3][3] = {
        {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}},
        {{0, 0, 0}, {0, 1, 0}, {0, 1, 0}},
        {{1e7f, 1e7f, 1e7f}, {1e7f + 1, 1e7f, 1e7f}, {1e7f, 1e7f, 1e7f + 1}},
        {{0, 0, 0}, {1e-30f, 0, 0}, {0, 1e-30f, 0}},
        {{-1e15f, 0, 0}, {1e15f, 0, 0}, {0, 1e15f, 1e15f}}};
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++) {
        path_report report;
        model m = soup_make(1);
        soup_triangle(&m, shapes[i][0], shapes[i][1], shapes[i][2]);
        obs_scene scene = walk(&m, 5, &report);
        obs_free(&scene);
        soup_free(&m);
    }
}
END_TEST

START_TEST(free_cells_are_touched_by_no_triangle)
{
    static const float low[3] = {-3, 0, -5}, high[3] = {4, 6, 7};
    static const float p[3] = {-3, 0, -5}, q[3] = {4, 6, 7}, r[3] = {4, 1, -2};
    voxel_grid grid;
    model m = soup_make(13);
    soup_box(&m, low, high, true);
    soup_triangle(&m, p, q, r);
    ck_assert(voxels_build(&m, 1e5, &grid));
    for (int i = 0; i <= 300; i++)
        for (int j = 0; i + j <= 300; j++) {
            double point[3];
            for (int k = 0; k < 3; k++)
                point[k] = (double)p[k] + ((double)q[k] - (double)p[k]) * i / 300 +
                           ((double)r[k] - (double)p[k]) * j / 300;
            size_t cell = voxels_at(&grid, point);
            ck_assert(cell != SIZE_MAX && grid.solid[cell]);
        }
    voxels_free(&grid);
    soup_free(&m);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("path");
    TCase *ways = tcase_create("ways");
    tcase_add_test(ways, room_is_walked_inside_and_off_its_walls);
    tcase_add_test(ways, way_leads_through_a_corridor);
    tcase_add_test(ways, solid_block_is_seen_from_around);
    tcase_add_test(ways, odd_models_have_a_path_too);
    tcase_add_test(ways, free_cells_are_touched_by_no_triangle);
    suite_add_tcase(suite, ways);
    return test_run_suite(suite);
}
