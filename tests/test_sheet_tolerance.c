// SPDX-License-Identifier: Apache-2.0
// labels: unit property oracle
// What a tolerance makes the shadows of sheets hold.
#include <gmp.h>

#include "sheet_shapes.h"
#include "support.h"
#include "worlds.h"

#include <stdio.h>

// The sine of the angle between a direction and the nearest one in which the outline is seen.
static double sine_to_outline(const occ_sheet *sheet, const double eye[3], const double x[3])
{
    double least = 2.0;
    for (uint32_t i = 0; i < sheet->corner_count; i++) {
        double a[3], b[3], n[3], end[2][3];
        for (int j = 0; j < 3; j++) {
            a[j] = (double)sheet->corner[i][j] - eye[j];
            b[j] = (double)sheet->corner[(i + 1) % sheet->corner_count][j] - eye[j];
        }
        occ_cross(a, b, n);
        occ_cross(n, a, end[0]);
        occ_cross(b, n, end[1]);
        if (occ_dot(end[0], x) >= 0.0 && occ_dot(end[1], x) >= 0.0) {
            least = fmin(least, fabs(occ_dot(n, x)) / sqrt(occ_dot(n, n) * occ_dot(x, x)));
            continue;
        }
        for (int k = 0; k < 2; k++) {
            const double *to = k ? b : a;
            double turn[3];
            occ_cross(to, x, turn);
            if (occ_dot(to, x) <= 0.0) continue;
            least = fmin(least, sqrt(occ_dot(turn, turn) / occ_dot(to, to) / occ_dot(x, x)));
        }
    }
    return least;
}

// A point beyond the sheet in a direction that is off an edge by up to twice the tolerance.
static void point_beside(kit_random *random, const occ_sheet *sheet, const double eye[3],
                         double tolerance, double point[3])
{
    uint32_t n = sheet->corner_count, i = kit_below(random, n);
    double t = world_between(random, -0.1, 1.1), off[3], length = 0.0;
    double by = 2.0 * tolerance * world_between(random, 0, 1);
    double beyond = world_scale(random, 1e-3, 10);
    world_direction(random, off);
    for (int j = 0; j < 3; j++) {
        double a = (double)sheet->corner[i][j], b = (double)sheet->corner[i + 1 < n ? i + 1 : 0][j];
        point[j] = a + t * (b - a) - eye[j];
        length += point[j] * point[j];
    }
    for (int j = 0; j < 3; j++)
        point[j] = eye[j] + (1.0 + beyond) * (point[j] + by * sqrt(length) * off[j]);
}

// What is held although it can be seen is no farther from the outline than the tolerance allows;
// and if the outline is not convex for certain, there is nothing of the kind.
START_TEST(tolerance_holds_no_more_than_it_may)
{
    kit_random random = {(uint64_t)_i + 53};
    unsigned wrong = 0, held = 0;
    double farthest = 0.0;
    for (int trial = 0; trial < WORLD_SHARE(6000); trial++) {
        double size = world_scale(&random, 1e-2, 1e2);
        double tolerance = world_scale(&random, 1e-4, 0.1);
        occ_sheet sheet = any_sheet(&random, (sheet_kind)_i, size);
        sight_from from;
        occ_frame frame = any_view(&random, &sheet, size, &from);
        occ_shadow shadow;
        frame.camera.tolerance = tolerance;
        if (from.direction) continue;
        if (!occ_shadow_of_sheet(&shadow, &frame.camera, &sheet, OCC_NOBODY)) continue;
        for (int k = 0; k < 40; k++) {
            double point[3], x[3];
            occ_box speck = {.center = {0}};
            point_beside(&random, &sheet, from.at, tolerance, point);
            for (int j = 0; j < 3; j++) {
                speck.center[j] = (float)point[j];
                point[j] = (double)speck.center[j];
                x[j] = point[j] - from.at[j];
            }
            occ_relative_box box = occ_frame_relative(&frame, &speck);
            if (!occ_box_in_shadow(&box, shadow.plane[0], shadow.planes)) continue;
            held++;
            if (sight_is_hidden(&from, &sheet, 0, point)) continue;
            wrong++;
            double sine = sine_to_outline(&sheet, from.at, x) / tolerance;
            farthest = fmax(farthest, sine);
            KIT_CHECK(sine <= sqrt(0.5) + 1e-5, "a point off by %g of the tolerance is held", sine);
        }
    }
    printf("%u held, %u of them seen, off by up to %.3f of the tolerance\n", held, wrong, farthest);
    ck_assert_uint_gt(held, WORLD_SHARE(500));
    if (_i == KIND_FLAT) ck_assert(wrong > WORLD_SHARE(3000) && farthest > 0.49);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("sheet_tolerance");
    TCase *tcase = tcase_create("random");
    tcase_add_loop_test(tcase, tolerance_holds_no_more_than_it_may, 0, KINDS);
    suite_add_tcase(suite, tcase);
    return test_run_suite(suite);
}
