// SPDX-License-Identifier: Apache-2.0
// labels: property oracle
// Bounds of soups: they hold every vertex as rational numbers say, and are nearly as small as can
// be.
#include "contact_oracle.h"
#include "smallest_box.h"
#include "soups.h"
#include "support.h"

#include <math.h>
#include <stdio.h>

static double volume_of(const occ_box *box)
{
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        const float *a = box->axis[1], *b = box->axis[2];
        int i = (k + 1) % 3, j = (k + 2) % 3;
        double minor = (double)a[i] * (double)b[j] - (double)a[j] * (double)b[i];
        sum += (double)box->axis[0][k] * minor;
    }
    return 8.0 * fabs(sum);
}

static occ_box bound(const soups_soup *soup, const char *name, int trial)
{
    occ_box box;
    occ_soup view = soups_view(soup);
    occ_result result = occ_bounds_of_soup(&view, NULL, &box);
    KIT_CHECK(!result, "%s %d: %s", name, trial, occ_result_name(result));
    return box;
}

// --- every vertex is inside ----------------------------------------------------------------------

enum { SOUPS = 1200, JUDGED = 25, MOST_VERTICES = 60 };

static soups_soup soup;

START_TEST(every_vertex_is_inside)
{
    const soups_shape *shape = &soups_shapes[_i];
    kit_random random = steady_seed(1, shape->name);
    for (int trial = 0; trial < SOUPS; trial++) {
        soups_make(&random, shape, 1 + kit_below(&random, MOST_VERTICES), trial % 4 == 0, &soup);
        occ_box box = bound(&soup, shape->name, trial);
        occ_soup view = soups_view(&soup);
        uint32_t vertex = 0;
        KIT_CHECK(!occ_verify_bounds(&view, &box, NULL, &vertex), "%s %d: vertex %u", shape->name,
                  trial, (unsigned)vertex);
        for (uint32_t v = 0; trial < JUDGED && v < soup.vertices; v++) {
            float corner[3][3];
            for (int c = 0; c < 3; c++)
                memcpy(corner[c], soup.position[v], sizeof corner[c]);
            KIT_CHECK(contact_oracle_meet(&box, corner, false), "%s %d: vertex %u, judged",
                      shape->name, trial, (unsigned)v);
        }
    }
}
END_TEST

// One coordinate after the other is moved until the vertex is outside by rational numbers; the
// verifier must name it, and it alone.
START_TEST(vertex_that_is_moved_out_is_named)
{
    const soups_shape *shape = &soups_shapes[_i];
    kit_random random = steady_seed(2, shape->name);
    for (int trial = 0; trial < 40; trial++) {
        uint32_t vertices = 1 + kit_below(&random, 20), found = UINT32_MAX;
        soups_make(&random, shape, vertices, trial % 2 == 0, &soup);
        occ_box box = bound(&soup, shape->name, trial);
        uint32_t v = kit_below(&random, vertices);
        float *x = &soup.position[v][kit_below(&random, 3)];
        float corner[3][3];
        // Doubling steps end far outside.
        for (float step = fmaxf(fabsf(*x) * 0x1p-23f, 0x1p-149f);; step *= 2.0f) {
            *x += step;
            for (int c = 0; c < 3; c++)
                memcpy(corner[c], soup.position[v], sizeof corner[c]);
            if (!contact_oracle_meet(&box, corner, false)) break;
        }
        occ_soup view = soups_view(&soup);
        ck_assert_int_eq(occ_verify_bounds(&view, &box, NULL, &found), OCC_ERROR_NOT_INSIDE);
        ck_assert_uint_eq(found, v);
    }
}
END_TEST

// --- they are small ------------------------------------------------------------------------------

enum { COMPARED = 8, MOST_COMPARED = 32 };

// Where floats end is not asked here: their grain would be part of the answer.
START_TEST(volume_is_close_to_the_smallest)
{
    double sum = 0.0, worst = 0.0, upright = 0.0;
    int boxes = 0;
    for (uint32_t s = 0; s < soups_shape_count; s++) {
        const soups_shape *shape = &soups_shapes[s];
        kit_random random = steady_seed(3, shape->name);
        for (int trial = 0; shape->solid && trial < COMPARED; trial++, boxes++) {
            occ_box aligned;
            uint32_t vertices = 8 + kit_below(&random, MOST_COMPARED - 7);
            soups_make(&random, shape, vertices, true, &soup);
            occ_box box = bound(&soup, shape->name, trial);
            double best = smallest_box_volume((const float(*)[3])soup.position, vertices);
            double ratio = volume_of(&box) / best;
            KIT_CHECK(ratio > 0.999, "%s %d: the reference is beaten: %g", shape->name, trial,
                      ratio);
            ck_assert_int_eq(occ_box_from_points(soup.position[0], vertices, 0, &aligned), 0);
            upright += volume_of(&aligned) / best;
            sum += ratio;
            worst = fmax(worst, ratio);
        }
    }
    printf("volume over the smallest box's: %.4f on average of %d, %.4f at worst; upright %.2f\n",
           sum / boxes, boxes, worst, upright / boxes);
    ck_assert_double_le(sum / boxes, 1.02);
    ck_assert_double_le(worst, 1.2);
}
END_TEST

START_TEST(box_of_a_turned_box_is_that_box)
{
    kit_random random = steady_seed(4, "turned");
    for (int trial = 0; trial < 200; trial++) {
        soups_make(&random, &soups_shapes[3], 64, true, &soup);
        occ_box box = bound(&soup, "box", trial), aligned;
        if (soup.vertices < 8) continue;
        double best = smallest_box_volume((const float(*)[3])soup.position, 64);
        ck_assert_double_le(volume_of(&box), best * 1.001);
        ck_assert_int_eq(occ_box_from_points(soup.position[0], 64, 0, &aligned), 0);
        ck_assert_double_le(volume_of(&box), volume_of(&aligned));
    }
}
END_TEST

// A model that lies along the axes gets the very box that holds it.
START_TEST(upright_box_is_kept_as_it_is)
{
    const float corner[8][3] = {{1, 2, 3}, {9, 2, 3}, {1, 5, 3}, {9, 5, 3},
                                {1, 2, 4}, {9, 2, 4}, {1, 5, 4}, {9, 5, 4}};
    const occ_box want = {{5, 3.5f, 3.5f}, {{4, 0, 0}, {0, 1.5f, 0}, {0, 0, 0.5f}}};
    occ_box box;
    ck_assert_int_eq(occ_bounds_of_points(corner[0], 8, 0, NULL, &box), OCC_SUCCESS);
    ck_assert(kit_same_bits(&box, &want, sizeof box));
    ck_assert_int_eq(occ_bounds_of_points(corner[0], 4, 0, NULL, &box), OCC_SUCCESS);
    ck_assert_float_eq(box.axis[2][2], 0.0f); // flat
    ck_assert_int_eq(occ_bounds_of_points(corner[5], 1, 0, NULL, &box), OCC_SUCCESS);
    ck_assert_float_eq(box.center[0], 9.0f);
    ck_assert_double_eq(volume_of(&box), 0.0);
}
END_TEST

START_TEST(flat_and_straight_soups_get_thin_boxes)
{
    kit_random random = steady_seed(5, "thin");
    for (int trial = 0; trial < 200; trial++) {
        soups_make(&random, &soups_shapes[trial % 2 ? 6 : 7], 30, true, &soup);
        occ_box box = bound(&soup, "thin", trial);
        double side[3], least = INFINITY, most = 0.0;
        for (int k = 0; k < 3; k++) {
            const float *a = box.axis[k];
            side[k] = sqrt((double)a[0] * (double)a[0] + (double)a[1] * (double)a[1] +
                           (double)a[2] * (double)a[2]);
            least = fmin(least, side[k]);
            most = fmax(most, side[k]);
        }
        // Positions are rounded to floats at up to 12 units from the origin.
        KIT_CHECK(least < 1e-5 && most > 10.0 * least, "%d: %g", trial, least);
    }
}
END_TEST

// --- the same however it is told -----------------------------------------------------------------

START_TEST(stride_and_indices_change_nothing)
{
    static float wide[3 * SOUPS_MOST_TRIANGLES][5];
    kit_random random = steady_seed(6, "told");
    for (int trial = 0; trial < 100; trial++) {
        occ_box box, again;
        soups_make(&random, &soups_shapes[trial % 6], 40, true, &soup);
        occ_soup view = soups_view(&soup),
                 plain = {wide[0], 3 * soup.triangles, sizeof wide[0], NULL, soup.triangles};
        for (uint32_t i = 0; i < 3 * soup.triangles; i++)
            memcpy(wide[i], soup.position[soup.index[i]], 3 * sizeof(float));
        ck_assert_int_eq(occ_bounds_of_soup(&view, NULL, &box), OCC_SUCCESS);
        ck_assert_int_eq(occ_bounds_of_soup(&plain, NULL, &again), OCC_SUCCESS);
        ck_assert(kit_same_bits(&box, &again, sizeof box));
        ck_assert_int_eq(
            occ_bounds_of_points(wide[0], 3 * soup.triangles, sizeof wide[0], NULL, &again),
            OCC_SUCCESS);
        ck_assert(kit_same_bits(&box, &again, sizeof box));
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("soup_bounds");
    TCase *inside = tcase_create("inside"), *small = tcase_create("small");
    tcase_add_loop_test(inside, every_vertex_is_inside, 0, (int)soups_shape_count);
    tcase_add_loop_test(inside, vertex_that_is_moved_out_is_named, 0, (int)soups_shape_count);
    tcase_add_test(small, volume_is_close_to_the_smallest);
    tcase_add_test(small, box_of_a_turned_box_is_that_box);
    tcase_add_test(small, upright_box_is_kept_as_it_is);
    tcase_add_test(small, flat_and_straight_soups_get_thin_boxes);
    tcase_add_test(small, stride_and_indices_change_nothing);
    suite_add_tcase(suite, inside);
    suite_add_tcase(suite, small);
    return test_run_suite(suite);
}
