// SPDX-License-Identifier: Apache-2.0
// What the calls on triangle soups refuse, skip and count, and what they do without memory.
#include "soups.h"
#include "support.h"

#include <float.h>
#include <math.h>

static kit_log record;
static kit_heap heap;

static occ_soup_work watched(void)
{
    kit_forget(&record);
    heap = (kit_heap){0};
    return (occ_soup_work){.allocator = kit_allocator(&heap), .logger = kit_logger(&record)};
}

static const float square[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
static const uint32_t halves[6] = {0, 1, 2, 0, 2, 3};
static const occ_soup good = {square[0], 4, 0, halves, 2};

// --- refused -------------------------------------------------------------------------------------

// All calls refuse it with this name and reason, and leave their results alone.
static void check_refused(const occ_soup *soup, occ_result want, const char *reason)
{
    occ_soup_counts counts, kept_counts;
    occ_box box, kept_box;
    uint32_t vertex = 77;
    memset(&counts, 0x5a, sizeof counts);
    memset(&box, 0x5a, sizeof box);
    kept_counts = counts;
    kept_box = box;
    const occ_box cube = kit_cube(0, 0, 0, 1);
    for (int call = 0; call < 3; call++) {
        occ_soup_work work = watched();
        occ_result result = call == 0   ? occ_soup_check(soup, &work, &counts)
                            : call == 1 ? occ_bounds_of_soup(soup, &work, &box)
                                        : occ_verify_bounds(soup, &cube, &work, &vertex);
        ck_assert_str_eq(occ_result_name(result), occ_result_name(want));
        ck_assert_msg(kit_logged(&record, reason), "%s", record.text);
        ck_assert_uint_eq(heap.blocks, 0);
    }
    ck_assert(kit_same_bits(&counts, &kept_counts, sizeof counts));
    ck_assert(kit_same_bits(&box, &kept_box, sizeof box));
    ck_assert_uint_eq(vertex, 77);
}

START_TEST(missing_arrays_and_odd_strides_are_refused)
{
    occ_soup soup = good;
    check_refused(NULL, OCC_ERROR_INVALID_ARGUMENT, "the soup is NULL");
    soup.positions = NULL;
    check_refused(&soup, OCC_ERROR_INVALID_ARGUMENT, "no positions");
    soup = good;
    soup.triangle_count = 0;
    check_refused(&soup, OCC_ERROR_INVALID_ARGUMENT, "no triangles");
    soup = good;
    soup.stride = 8;
    check_refused(&soup, OCC_ERROR_INVALID_ARGUMENT, "stride");
    soup.stride = 14;
    check_refused(&soup, OCC_ERROR_INVALID_ARGUMENT, "stride");
}
END_TEST

START_TEST(index_that_names_no_vertex_is_refused)
{
    uint32_t index[6];
    occ_soup soup = good;
    soup.indices = index;
    for (int i = 0; i < 6; i++) {
        memcpy(index, halves, sizeof index);
        index[i] = 4;
        check_refused(&soup, OCC_ERROR_INVALID_ARGUMENT, "names vertex 4 of 4");
        index[i] = UINT32_MAX;
        check_refused(&soup, OCC_ERROR_INVALID_ARGUMENT, "names vertex 4294967295 of 4");
    }
    soup.indices = NULL; // 0 to 5
    check_refused(&soup, OCC_ERROR_INVALID_ARGUMENT, "triangle 1 names vertex 4 of 4");
    soup.triangle_count = UINT32_MAX;
    check_refused(&soup, OCC_ERROR_INVALID_ARGUMENT, "triangle 1 names vertex 4 of 4");
}
END_TEST

static const struct {
    float number;
    occ_result result;
} bad[] = {
    {NAN, OCC_ERROR_NOT_FINITE},          {INFINITY, OCC_ERROR_NOT_FINITE},
    {-INFINITY, OCC_ERROR_NOT_FINITE},    {FLT_MAX, OCC_ERROR_OUT_OF_RANGE},
    {-1.001e15f, OCC_ERROR_OUT_OF_RANGE},
};

START_TEST(bad_number_is_refused_by_name)
{
    float position[5][3] = {{0}};
    occ_soup soup = good;
    occ_box box = kit_cube(0, 0, 0, 1), kept = box;
    soup.positions = position[0];
    soup.vertex_count = 5;
    for (int i = 0; i < 12; i++) {
        memcpy(position, square, sizeof square);
        position[i / 3][i % 3] = bad[_i].number;
        check_refused(&soup, bad[_i].result, "vertex");
        occ_soup_work work = watched();
        ck_assert_int_eq(occ_bounds_of_points(position[0], 5, 0, &work, &box), bad[_i].result);
        ck_assert(kit_logged(&record, "point"));
        ck_assert(kit_same_bits(&box, &kept, sizeof box));
    }
    // A vertex that no triangle names may be anything.
    memcpy(position, square, sizeof square);
    position[4][1] = bad[_i].number;
    ck_assert_int_eq(occ_soup_check(&soup, NULL, NULL), OCC_SUCCESS);
    ck_assert_int_eq(occ_bounds_of_soup(&soup, NULL, &box), OCC_SUCCESS);
}
END_TEST

START_TEST(bounds_at_the_limit_are_refused_rather_than_wrong)
{
    float position[4][3];
    occ_soup soup = {position[0], 4, 0, halves, 2};
    for (int i = 0; i < 12; i++)
        position[i / 3][i % 3] = square[i / 3][i % 3] * 2e15f - OCC_MAX_COORDINATE;
    occ_box box;
    occ_result result = occ_bounds_of_soup(&soup, NULL, &box);
    ck_assert(result == OCC_ERROR_OUT_OF_RANGE || result == OCC_SUCCESS);
    if (!result) ck_assert_int_eq(occ_verify_bounds(&soup, &box, NULL, NULL), OCC_SUCCESS);
}
END_TEST

START_TEST(missing_results_and_bad_boxes_are_refused)
{
    occ_soup_work work = watched();
    ck_assert_int_eq(occ_bounds_of_soup(&good, &work, NULL), OCC_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(occ_bounds_of_points(square[0], 4, 0, &work, NULL),
                     OCC_ERROR_INVALID_ARGUMENT);
    occ_box box = kit_cube(0, 0, 0, 1);
    ck_assert_int_eq(occ_bounds_of_points(NULL, 4, 0, &work, &box), OCC_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(occ_bounds_of_points(square[0], 0, 0, &work, &box),
                     OCC_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(occ_bounds_of_points(square[0], 4, 10, &work, &box),
                     OCC_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(occ_verify_bounds(&good, NULL, &work, NULL), OCC_ERROR_INVALID_ARGUMENT);
    box.axis[1][1] = NAN;
    ck_assert_int_eq(occ_verify_bounds(&good, &box, &work, NULL), OCC_ERROR_NOT_FINITE);
    ck_assert_uint_eq(record.errors, 7);
    work.allocator.free = NULL;
    ck_assert_int_eq(occ_soup_check(&good, &work, NULL), OCC_ERROR_INVALID_ARGUMENT);
}
END_TEST

// --- counted -------------------------------------------------------------------------------------

START_TEST(triangles_without_area_and_twins_are_counted)
{
    const float at[][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0},         {0, 0, 1},
                           {3, 0, 0}, {0, 0, 0}, {-0.0f, 1, -0.0f}, {9, 9, 9}};
    const uint32_t index[] = {
        0, 1, 2, // one
        2, 0, 1, // turned round
        0, 2, 1, // turned over
        5, 1, 6, // of other vertices at the same places
        0, 1, 3, // another
        0, 0, 1, // two corners alike
        0, 5, 2, // alike in place
        1, 0, 4, // in line
        4, 1, 0, // and again
    };
    const occ_soup soup = {at[0], 8, 0, index, 9};
    occ_soup_counts counts;
    ck_assert_int_eq(occ_soup_check(&soup, NULL, &counts), OCC_SUCCESS);
    ck_assert_uint_eq(counts.triangles, 2);
    ck_assert_uint_eq(counts.duplicate, 3);
    ck_assert_uint_eq(counts.degenerate, 4);
    ck_assert_uint_eq(counts.vertices, 7);
}
END_TEST

// Three points of a line that floats cannot all hold: only some of the triangles are flat, and what
// is counted agrees with the products in integers.
START_TEST(area_is_judged_without_rounding)
{
    kit_random random = steady_seed(1, "area");
    uint32_t flat = 0;
    for (int trial = 0; trial < 20000; trial++) {
        int32_t p[3][2];
        float at[3][3];
        for (int k = 0; k < 2; k++) {
            int32_t step = (int32_t)kit_below(&random, 2000), from = 1 << 22;
            p[0][k] = from;
            p[1][k] = from + step;
            p[2][k] = from + 3 * step + (int32_t)(kit_below(&random, 4) == 0);
        }
        for (int c = 0; c < 3; c++) {
            at[c][0] = (float)p[c][0];
            at[c][1] = (float)p[c][1];
            at[c][2] = 0.0f;
        }
        int64_t left = (int64_t)(p[1][0] - p[0][0]) * (p[2][1] - p[0][1]);
        int64_t right = (int64_t)(p[1][1] - p[0][1]) * (p[2][0] - p[0][0]);
        const occ_soup soup = {at[0], 3, 0, NULL, 1};
        occ_soup_counts counts;
        ck_assert_int_eq(occ_soup_check(&soup, NULL, &counts), OCC_SUCCESS);
        KIT_CHECK((counts.degenerate == 1) == (left == right), "trial %d", trial);
        flat += counts.degenerate;
    }
    ck_assert_uint_gt(flat, 1000);
    ck_assert_uint_lt(flat, 19000);
}
END_TEST

// --- stopped, or without memory ------------------------------------------------------------------

typedef struct patience {
    int left;
    float last;
} patience;

static bool wait_for(float done, void *user_data)
{
    patience *p = user_data;
    ck_assert(done >= p->last && done <= 1.0f);
    p->last = done;
    return p->left-- > 0;
}

START_TEST(work_can_be_stopped_at_any_step)
{
    static soups_soup soup;
    kit_random random = steady_seed(2, "stopped");
    soups_make(&random, &soups_shapes[0], 50, true, &soup);
    occ_soup view = soups_view(&soup);
    occ_box want, box;
    ck_assert_int_eq(occ_bounds_of_soup(&view, NULL, &want), OCC_SUCCESS);
    for (int steps = 0;; steps++) {
        occ_soup_work work = watched();
        patience p = {steps, 0.0f};
        work.progress = wait_for;
        work.user_data = &p;
        box = kit_cube(0, 0, 0, 1);
        occ_result result = occ_bounds_of_soup(&view, &work, &box);
        if (!result) {
            ck_assert_int_gt(steps, 1);
            ck_assert_float_eq(p.last, 1.0f);
            break;
        }
        ck_assert_int_eq(result, OCC_ERROR_CANCELLED);
        ck_assert(kit_logged(&record, "OCC_ERROR_CANCELLED"));
        ck_assert_float_eq(box.center[0], 0.0f);
    }
    ck_assert(kit_same_bits(&box, &want, sizeof box));
}
END_TEST

START_TEST(allocation_that_fails_is_an_error_and_leaks_nothing)
{
    static soups_soup soup;
    kit_random random = steady_seed(3, "memory");
    soups_make(&random, &soups_shapes[0], 200, true, &soup);
    occ_soup view = soups_view(&soup);
    occ_soup_counts want, counts;
    ck_assert_int_eq(occ_soup_check(&view, NULL, &want), OCC_SUCCESS);
    for (uint64_t nth = 1;; nth++) {
        occ_soup_work work = watched();
        memset(&counts, 0, sizeof counts);
        heap.fail_at = nth;
        occ_result result = occ_soup_check(&view, &work, &counts);
        ck_assert_uint_eq(heap.blocks, 0);
        if (!heap.failures) {
            ck_assert_int_eq(result, OCC_SUCCESS);
            ck_assert_uint_gt(nth, 2);
            break;
        }
        ck_assert_int_eq(result, OCC_ERROR_OUT_OF_MEMORY);
        ck_assert(kit_logged(&record, "OCC_ERROR_OUT_OF_MEMORY"));
        ck_assert_uint_eq(counts.vertices, 0);
    }
    ck_assert(kit_same_bits(&counts, &want, sizeof counts));
}
END_TEST

START_TEST(bounds_need_no_memory)
{
    occ_soup_work work = watched();
    occ_box box;
    heap.fail_at = 1;
    ck_assert_int_eq(occ_bounds_of_soup(&good, &work, &box), OCC_SUCCESS);
    ck_assert_int_eq(occ_verify_bounds(&good, &box, &work, NULL), OCC_SUCCESS);
    ck_assert_int_eq(occ_soup_check(&good, &work, NULL), OCC_SUCCESS);
    ck_assert_uint_eq(heap.calls, 0);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("soup_input");
    TCase *refused = tcase_create("refused"), *counted = tcase_create("counted");
    TCase *stopped = tcase_create("stopped");
    tcase_add_test(refused, missing_arrays_and_odd_strides_are_refused);
    tcase_add_test(refused, index_that_names_no_vertex_is_refused);
    tcase_add_loop_test(refused, bad_number_is_refused_by_name, 0, (int)(sizeof bad / sizeof *bad));
    tcase_add_test(refused, bounds_at_the_limit_are_refused_rather_than_wrong);
    tcase_add_test(refused, missing_results_and_bad_boxes_are_refused);
    tcase_add_test(counted, triangles_without_area_and_twins_are_counted);
    tcase_add_test(counted, area_is_judged_without_rounding);
    tcase_add_test(stopped, work_can_be_stopped_at_any_step);
    tcase_add_test(stopped, allocation_that_fails_is_an_error_and_leaks_nothing);
    tcase_add_test(stopped, bounds_need_no_memory);
    suite_add_tcase(suite, refused);
    suite_add_tcase(suite, counted);
    suite_add_tcase(suite, stopped);
    return test_run_suite(suite);
}
