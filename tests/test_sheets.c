// SPDX-License-Identifier: Apache-2.0
// labels: property oracle
// Sheets must lie in the surface exactly: GMP's rationals say whether they do.
#include "parallelogram.h"
#include "sheets.h"
#include "soup.h"
#include "steady.h"
#include "support.h"

#include <gmp.h>

typedef mpq_t rational_vector[3];

static void make_vector(rational_vector v)
{
    for (int k = 0; k < 3; k++)
        mpq_init(v[k]);
}

static void drop_vector(rational_vector v)
{
    for (int k = 0; k < 3; k++)
        mpq_clear(v[k]);
}

// out = a - b, from floats.
static void difference(rational_vector out, rational_vector a, const float *b)
{
    mpq_t rational;
    mpq_init(rational);
    for (int k = 0; k < 3; k++) {
        mpq_set_d(rational, (double)b[k]);
        mpq_sub(out[k], a[k], rational);
    }
    mpq_clear(rational);
}

static void cross(rational_vector out, rational_vector a, rational_vector b)
{
    mpq_t right;
    mpq_init(right);
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        mpq_mul(out[k], a[i], b[j]);
        mpq_mul(right, a[j], b[i]);
        mpq_sub(out[k], out[k], right);
    }
    mpq_clear(right);
}

static int sign_of_dot(rational_vector a, rational_vector b)
{
    mpq_t sum, term;
    mpq_inits(sum, term, NULL);
    for (int k = 0; k < 3; k++) {
        mpq_mul(term, a[k], b[k]);
        mpq_add(sum, sum, term);
    }
    int sign = mpq_sgn(sum);
    mpq_clears(sum, term, NULL);
    return sign;
}

// The corner number `i` of a sheet's box.
static void sheet_corner(rational_vector out, const occ_box *box, int i)
{
    mpq_t axis;
    mpq_init(axis);
    for (int k = 0; k < 3; k++) {
        mpq_set_d(out[k], (double)box->center[k]);
        for (int n = 0; n < 2; n++) {
            mpq_set_d(axis, (double)box->axis[n][k]);
            if (i >> n & 1)
                mpq_add(out[k], out[k], axis);
            else
                mpq_sub(out[k], out[k], axis);
        }
    }
    mpq_clear(axis);
}

// Whether a point is in a convex polygon's plane and within it.
static bool inside(rational_vector p, const float *const *corner, int count)
{
    rational_vector a, b, normal, edge, toward, turn;
    make_vector(a), make_vector(b), make_vector(normal);
    make_vector(edge), make_vector(toward), make_vector(turn);
    bool good = true;
    for (int k = 0; k < 3; k++) {
        mpq_set_d(a[k], (double)corner[1][k]);
        mpq_set_d(b[k], (double)corner[2][k]);
    }
    difference(edge, a, corner[0]);
    difference(toward, b, corner[0]);
    cross(normal, edge, toward);
    difference(toward, p, corner[0]);
    if (sign_of_dot(normal, toward) != 0) good = false;
    for (int i = 0; good && i < count; i++) {
        for (int k = 0; k < 3; k++)
            mpq_set_d(a[k], (double)corner[(i + 1) % count][k]);
        difference(edge, a, corner[i]);
        difference(toward, p, corner[i]);
        cross(turn, edge, toward);
        if (sign_of_dot(turn, normal) < 0) good = false;
    }
    drop_vector(a), drop_vector(b), drop_vector(normal);
    drop_vector(edge), drop_vector(toward), drop_vector(turn);
    return good;
}

static void check_inside(const occ_box *box, const float *const *corner, int count)
{
    rational_vector p;
    make_vector(p);
    for (int i = 0; i < 4; i++) {
        sheet_corner(p, box, i);
        ck_assert_msg(inside(p, corner, count), "corner %d is outside", i);
    }
    for (int k = 0; k < 3; k++)
        ck_assert_float_eq(box->axis[2][k], 0.0f);
    drop_vector(p);
}

static sheet_list find(const model *m)
{
    sheet_list list;
    ck_assert(sheets_find(m, &list));
    return list;
}

START_TEST(rectangle_becomes_a_sheet_of_its_whole_area)
{
    static const float a[3] = {1, 2, 3}, b[3] = {5, 2, 3}, c[3] = {5, 9, 3}, d[3] = {1, 9, 3};
    model m = soup_make(2);
    soup_quad(&m, a, b, c, d);
    sheet_list list = find(&m);
    ck_assert_uint_eq(list.count, 1);
    ck_assert_double_eq(list.at[0].area, 28.0);
    const float *const quad[4] = {a, b, c, d};
    check_inside(&list.at[0].box, quad, 4);
    sheets_free(&list);
    soup_free(&m);
}
END_TEST

// Coordinates with all their bits: the middle of two floats mostly is none.
START_TEST(upright_rectangle_of_any_floats_keeps_nearly_all_its_area)
{
    steady_random random = steady_seed(3, "sheets");
    for (int trial = 0; trial < 3000; trial++) {
        int axis = (int)steady_below(&random, 3), u = (axis + 1) % 3, v = (axis + 2) % 3;
        double scale = ldexp(1.0, (int)steady_below(&random, 40) - 20);
        float low[2], high[2], quad[4][3];
        float level = (float)(scale * steady_between(&random, -100, 100));
        for (int k = 0; k < 2; k++) {
            low[k] = (float)(scale * steady_between(&random, -100, 100));
            high[k] = low[k] + (float)(scale * steady_between(&random, 0.1, 50));
        }
        for (int i = 0; i < 4; i++) {
            quad[i][axis] = level;
            quad[i][u] = i == 1 || i == 2 ? high[0] : low[0];
            quad[i][v] = i >= 2 ? high[1] : low[1];
        }
        const float *const corner[4] = {quad[0], quad[1], quad[2], quad[3]};
        double whole = ((double)high[0] - (double)low[0]) * ((double)high[1] - (double)low[1]);
        occ_box box;
        ck_assert(quad_is_flat_and_convex(corner));
        double area = quad_fit_parallelogram(corner, &box);
        ck_assert_double_gt(area, whole * 0.999);
        ck_assert_double_le(area, whole * (1 + 1e-12));
        check_inside(&box, corner, 4);
    }
}
END_TEST

// Slanted quads on a grid of whole numbers, as in maps: whatever is given out is inside.
START_TEST(slanted_quad_on_a_grid_gives_a_sheet_inside_it)
{
    steady_random random = steady_seed(4, "sheets");
    int flat = 0, found = 0;
    for (int trial = 0; trial < 20000; trial++) {
        float quad[4][3];
        int e[3], f[3];
        for (int k = 0; k < 3; k++) {
            e[k] = (int)steady_below(&random, 9) - 4;
            f[k] = (int)steady_below(&random, 9) - 4;
        }
        int s = 1 + (int)steady_below(&random, 6), t = 1 + (int)steady_below(&random, 6);
        int p = (int)steady_below(&random, 8), q = (int)steady_below(&random, 8);
        for (int k = 0; k < 3; k++) {
            int from = (int)steady_below(&random, 2000) - 1000;
            quad[0][k] = (float)from;
            quad[1][k] = (float)(from + s * e[k]);
            quad[2][k] = (float)(from + p * e[k] + q * f[k]);
            quad[3][k] = (float)(from + t * f[k]);
        }
        const float *const corner[4] = {quad[0], quad[1], quad[2], quad[3]};
        occ_box box;
        if (!quad_is_flat_and_convex(corner)) continue;
        flat++;
        if (quad_fit_parallelogram(corner, &box) == 0) continue;
        found++;
        check_inside(&box, corner, 4);
    }
    ck_assert_int_gt(flat, 5000);
    ck_assert_int_gt(found, flat * 95 / 100);
}
END_TEST

START_TEST(trapezoid_gives_its_inner_parallelogram)
{
    static const float a[3] = {0, 0, 0}, b[3] = {8, 0, 0}, c[3] = {4, 4, 4}, d[3] = {0, 4, 4};
    const float *const quad[4] = {a, b, c, d};
    occ_box box;
    ck_assert(quad_is_flat_and_convex(quad));
    ck_assert_double_ge(quad_fit_parallelogram(quad, &box), 16 * sqrt(2.0) - 1e-9);
    check_inside(&box, quad, 4);
}
END_TEST

static uint32_t sheets_of(const float *a, const float *b, const float *c, const float *d)
{
    model m = soup_make(2);
    soup_quad(&m, a, b, c, d);
    sheet_list list = find(&m);
    uint32_t count = list.count;
    sheets_free(&list);
    soup_free(&m);
    return count;
}

START_TEST(pair_that_is_bent_by_one_ulp_gives_none)
{
    static const float a[3] = {0, 0, 3}, b[3] = {5, 0, 3}, c[3] = {5, 9, 3}, d[3] = {0, 9, 3};
    const float bent[3] = {0, 9, nextafterf(3.0f, 4.0f)};
    ck_assert_uint_eq(sheets_of(a, b, c, d), 1);
    ck_assert_uint_eq(sheets_of(a, b, c, bent), 0);
}
END_TEST

START_TEST(pair_with_a_notch_gives_none)
{
    static const float a[3] = {0, 0, 0}, b[3] = {9, 1, 0}, c[3] = {2, 2, 0}, d[3] = {1, 9, 0};
    ck_assert_uint_eq(sheets_of(a, b, c, d), 0);
}
END_TEST

START_TEST(pair_folded_on_itself_gives_none)
{
    static const float a[3] = {0, 0, 0}, b[3] = {4, 1, 0}, c[3] = {4, 4, 0}, d[3] = {3, 1, 0};
    ck_assert_uint_eq(sheets_of(a, b, c, d), 0);
}
END_TEST

START_TEST(triangles_that_face_apart_give_none)
{
    static const float a[3] = {0, 0, 0}, b[3] = {4, 0, 0}, c[3] = {4, 4, 0}, d[3] = {0, 4, 0};
    model m = soup_make(2);
    soup_triangle(&m, a, b, c);
    soup_triangle(&m, a, d, c);
    sheet_list list = find(&m);
    ck_assert_uint_eq(list.count, 0);
    sheets_free(&list);
    soup_free(&m);
}
END_TEST

START_TEST(see_through_triangle_gives_none)
{
    static const float a[3] = {0, 0, 0}, b[3] = {4, 0, 0}, c[3] = {4, 4, 0}, d[3] = {0, 4, 0};
    model m = soup_make(2);
    soup_quad(&m, a, b, c, d);
    m.see_through[1] = true;
    sheet_list list = find(&m);
    ck_assert_uint_eq(list.count, 0);
    sheets_free(&list);
    soup_free(&m);
}
END_TEST

START_TEST(degenerate_triangles_give_none)
{
    static const float a[3] = {0, 0, 0}, b[3] = {4, 0, 0}, c[3] = {8, 0, 0}, d[3] = {0, 4, 0};
    ck_assert_uint_eq(sheets_of(a, b, c, a), 0);
    ck_assert_uint_eq(sheets_of(a, a, a, a), 0);
    ck_assert_uint_eq(sheets_of(a, b, c, d), 0);
}
END_TEST

START_TEST(no_triangle_is_in_two_sheets)
{
    enum { SIDE = 12 };
    model m = soup_make(2 * SIDE * SIDE);
    for (int i = 0; i < SIDE; i++)
        for (int j = 0; j < SIDE; j++) {
            const float x = (float)i, z = (float)j;
            const float a[3] = {x, 0, z}, b[3] = {x, 0, z + 1}, c[3] = {x + 1, 0, z + 1},
                        d[3] = {x + 1, 0, z};
            soup_quad(&m, a, b, c, d);
        }
    bool seen[2 * SIDE * SIDE] = {false};
    sheet_list list = find(&m);
    ck_assert_uint_eq(list.count, SIDE * SIDE);
    for (uint32_t i = 0; i < list.count; i++)
        for (int k = 0; k < 2; k++) {
            ck_assert(!seen[list.at[i].triangles[k]]);
            seen[list.at[i].triangles[k]] = true;
        }
    sheets_free(&list);
    soup_free(&m);
}
END_TEST

START_TEST(thousands_of_copies_of_an_edge_are_no_trouble)
{
    static const float a[3] = {0, 0, 0}, b[3] = {4, 0, 0}, c[3] = {4, 4, 0}, d[3] = {0, 4, 0};
    model m = soup_make(20000);
    for (int i = 0; i < 10000; i++)
        soup_quad(&m, a, b, c, d);
    sheet_list list = find(&m);
    ck_assert_uint_ge(list.count, 1);
    sheets_free(&list);
    soup_free(&m);
}
END_TEST

static TCase *exactness(void)
{
    TCase *tcase = tcase_create("exactness");
    tcase_add_test(tcase, rectangle_becomes_a_sheet_of_its_whole_area);
    tcase_add_test(tcase, upright_rectangle_of_any_floats_keeps_nearly_all_its_area);
    tcase_add_test(tcase, slanted_quad_on_a_grid_gives_a_sheet_inside_it);
    tcase_add_test(tcase, trapezoid_gives_its_inner_parallelogram);
    return tcase;
}

static TCase *refusals(void)
{
    TCase *tcase = tcase_create("refusals");
    tcase_add_test(tcase, pair_that_is_bent_by_one_ulp_gives_none);
    tcase_add_test(tcase, pair_with_a_notch_gives_none);
    tcase_add_test(tcase, pair_folded_on_itself_gives_none);
    tcase_add_test(tcase, triangles_that_face_apart_give_none);
    tcase_add_test(tcase, see_through_triangle_gives_none);
    tcase_add_test(tcase, degenerate_triangles_give_none);
    return tcase;
}

static TCase *choice(void)
{
    TCase *tcase = tcase_create("choice");
    tcase_add_test(tcase, no_triangle_is_in_two_sheets);
    tcase_add_test(tcase, thousands_of_copies_of_an_edge_are_no_trouble);
    return tcase;
}

int main(void)
{
    Suite *suite = suite_create("sheets");
    suite_add_tcase(suite, exactness());
    suite_add_tcase(suite, refusals());
    suite_add_tcase(suite, choice());
    return test_run_suite(suite);
}
