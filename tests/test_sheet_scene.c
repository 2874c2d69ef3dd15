// SPDX-License-Identifier: Apache-2.0
// Sheets in a scene: what is refused, what is given back, and what commits make of them.
#include "box.h"
#include "kit_model.h"
#include "kit_sheets.h"
#include "sheet.h"
#include "support.h"

#include <float.h>
#include <math.h>

enum { OBJECTS = 40 };

static const occ_object nobody = {0, 0};
static kit_heap heap;
static kit_log record;
static occ_scene *scene;
static occ_object objects[OBJECTS];
static occ_occluder a_box, a_sheet;
static occ_sheet sheet; // that which it is

static occ_sheet triangle(float x)
{
    return (occ_sheet){.corner_count = 3, .corner = {{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}}};
}

static void set_up(void)
{
    heap = (kit_heap){0};
    kit_forget(&record);
    occ_scene_desc desc = {.allocator = kit_allocator(&heap), .logger = kit_logger(&record)};
    ck_assert_int_eq(occ_scene_create(&desc, &scene), OCC_SUCCESS);
    kit_fill(scene, OBJECTS, 2, 3, objects, NULL);
    occ_box box = kit_cube(1, 2, 3, 4);
    sheet = triangle(5);
    ck_assert_int_eq(occ_scene_add_occluder(scene, &box, nobody, &a_box), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_add_sheet(scene, &sheet, objects[3], &a_sheet), OCC_SUCCESS);
}

static void tear_down(void)
{
    occ_scene_destroy(scene);
    ck_assert_uint_eq(heap.blocks, 0);
}

static void commit(void)
{
    ck_assert_int_eq(occ_scene_commit(scene), OCC_SUCCESS);
    kit_check_trees(scene);
}

static occ_scene_stats stats_of(void)
{
    occ_scene_stats stats;
    ck_assert_int_eq(occ_scene_get_stats(scene, &stats), OCC_SUCCESS);
    return stats;
}

// The sheet and the box are as they were, and nothing was added.
static void check_untouched(uint32_t occluders)
{
    occ_sheet known;
    occ_box box, cube = kit_cube(1, 2, 3, 4);
    occ_object owner;
    ck_assert_int_eq(occ_scene_occluder_sheet(scene, a_sheet, &known, &owner), OCC_SUCCESS);
    ck_assert(kit_same_sheets(&known, &sheet) && kit_same_bits(&owner, &objects[3], sizeof owner));
    ck_assert_int_eq(occ_scene_occluder_box(scene, a_box, &box, &owner), OCC_SUCCESS);
    ck_assert(kit_same_bits(&box, &cube, sizeof box) && !owner.index);
    ck_assert_uint_eq(stats_of().occluders, occluders);
}

#define CHECK_REFUSED(call, expected)                                                              \
    do {                                                                                           \
        uint32_t occluders_before = stats_of().occluders;                                          \
        kit_forget(&record);                                                                       \
        ck_assert_int_eq((call), (expected));                                                      \
        ck_assert_uint_eq(record.errors, 1);                                                       \
        ck_assert(kit_logged(&record, occ_result_name(expected)));                                 \
        check_untouched(occluders_before);                                                         \
    } while (0)

// --- what is refused -----------------------------------------------------------------------------

static void check_bad_sheet(const occ_sheet *bad, occ_result expected)
{
    occ_sheet three[3] = {triangle(0), *bad, triangle(1)};
    occ_occluder handles[3] = {{7, 8}};
    CHECK_REFUSED(occ_scene_add_sheet(scene, bad, nobody, handles), expected);
    CHECK_REFUSED(occ_scene_add_sheet(scene, bad, objects[1], handles), expected);
    CHECK_REFUSED(occ_scene_add_sheets(scene, three, NULL, 3, handles), expected);
    ck_assert(kit_logged(&record, "sheet 1 of 3"));
    CHECK_REFUSED(occ_scene_move_sheet(scene, a_sheet, bad), expected);
    CHECK_REFUSED(occ_scene_move_sheet(scene, a_box, bad), expected);
    ck_assert(handles[0].index == 7 && handles[0].generation == 8);
}

START_TEST(number_of_corners_out_of_range_is_refused)
{
    static const uint32_t counts[] = {0, 1, 2, 9, 10, UINT32_MAX};
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++) {
        occ_sheet bad = triangle(2);
        bad.corner_count = counts[i];
        check_bad_sheet(&bad, OCC_ERROR_INVALID_ARGUMENT);
        ck_assert(kit_logged(&record, "3 to 8 corners"));
    }
}
END_TEST

START_TEST(unknown_sides_are_refused)
{
    occ_sheet bad = triangle(2);
    const unsigned unknown = 2;
    memcpy(&bad.sides, &unknown, sizeof bad.sides);
    check_bad_sheet(&bad, OCC_ERROR_INVALID_ARGUMENT);
    ck_assert(kit_logged(&record, "sides"));
}
END_TEST

START_TEST(bad_number_in_a_corner_is_refused)
{
    static const struct {
        float number;
        occ_result result;
    } bad[] = {{NAN, OCC_ERROR_NOT_FINITE},
               {-INFINITY, OCC_ERROR_NOT_FINITE},
               {FLT_MAX, OCC_ERROR_OUT_OF_RANGE},
               {-1.1e15f, OCC_ERROR_OUT_OF_RANGE},
               {INFINITY, OCC_ERROR_NOT_FINITE}};
    for (size_t b = 0; b < sizeof bad / sizeof *bad; b++)
        for (int k = 0; k < 24; k++) {
            kit_random random = {9};
            static const float center[3] = {1, 2, 3};
            occ_sheet one = kit_round_sheet(&random, 8, center, 2);
            one.corner[k / 3][k % 3] = bad[b].number;
            check_bad_sheet(&one, bad[b].result);
        }
}
END_TEST

START_TEST(what_is_beyond_the_corners_is_not_read)
{
    occ_sheet one = triangle(2), back;
    occ_occluder handle;
    for (int i = 3; i < OCC_SHEET_CORNERS; i++)
        one.corner[i][0] = NAN;
    ck_assert_int_eq(occ_scene_add_sheet(scene, &one, nobody, &handle), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_occluder_sheet(scene, handle, &back, NULL), OCC_SUCCESS);
    occ_sheet plain = triangle(2);
    ck_assert_mem_eq(&back, &plain, sizeof back);
    commit();
}
END_TEST

START_TEST(arguments_that_are_missing_are_refused)
{
    occ_sheet one = triangle(0);
    occ_occluder gone = a_sheet;
    occ_object gone_owner = objects[7];
    ck_assert_int_eq(occ_scene_remove(scene, objects[7]), OCC_SUCCESS);
    commit();
    CHECK_REFUSED(occ_scene_add_sheet(scene, NULL, nobody, NULL), OCC_ERROR_INVALID_ARGUMENT);
    CHECK_REFUSED(occ_scene_add_sheets(scene, NULL, NULL, 2, NULL), OCC_ERROR_INVALID_ARGUMENT);
    CHECK_REFUSED(occ_scene_move_sheet(scene, a_sheet, NULL), OCC_ERROR_INVALID_ARGUMENT);
    CHECK_REFUSED(occ_scene_add_sheet(scene, &one, gone_owner, NULL), OCC_ERROR_STALE_HANDLE);
    gone.generation += 2;
    CHECK_REFUSED(occ_scene_move_sheet(scene, gone, &one), OCC_ERROR_STALE_HANDLE);
    CHECK_REFUSED(occ_scene_occluder_sheet(scene, gone, &one, NULL), OCC_ERROR_STALE_HANDLE);
    ck_assert_int_eq(occ_scene_add_sheets(NULL, &one, NULL, 1, NULL), OCC_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(occ_scene_add_sheet(NULL, &one, nobody, NULL), OCC_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(occ_scene_move_sheet(NULL, a_sheet, &one), OCC_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(occ_scene_occluder_sheet(NULL, a_sheet, &one, NULL),
                     OCC_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(occ_scene_add_sheets(scene, NULL, NULL, 0, NULL), OCC_SUCCESS);
}
END_TEST

START_TEST(each_kind_is_asked_for_by_its_own_call)
{
    occ_sheet one = triangle(0);
    occ_box box;
    occ_object owner;
    CHECK_REFUSED(occ_scene_occluder_box(scene, a_sheet, &box, &owner), OCC_ERROR_INVALID_ARGUMENT);
    ck_assert(kit_logged(&record, "is a sheet"));
    CHECK_REFUSED(occ_scene_occluder_box(scene, a_sheet, NULL, NULL), OCC_ERROR_INVALID_ARGUMENT);
    CHECK_REFUSED(occ_scene_occluder_sheet(scene, a_box, &one, &owner), OCC_ERROR_INVALID_ARGUMENT);
    ck_assert(kit_logged(&record, "is a box"));
    ck_assert_int_eq(occ_scene_occluder_sheet(scene, a_sheet, NULL, NULL), OCC_SUCCESS);
}
END_TEST

// --- edits ---------------------------------------------------------------------------------------

START_TEST(moving_an_occluder_makes_it_of_that_kind)
{
    occ_sheet one = triangle(-8), back;
    occ_box box = kit_cube(9, 9, 9, 1), now;
    for (int round = 0; round < 4; round++) {
        ck_assert_int_eq(occ_scene_move_sheet(scene, a_box, &one), OCC_SUCCESS);
        ck_assert_int_eq(occ_scene_move_occluder(scene, a_sheet, &box), OCC_SUCCESS);
        if (round != 1) commit();
        ck_assert_int_eq(occ_scene_occluder_sheet(scene, a_box, &back, NULL), OCC_SUCCESS);
        ck_assert(kit_same_sheets(&back, &one));
        ck_assert_int_eq(occ_scene_occluder_box(scene, a_sheet, &now, NULL), OCC_SUCCESS);
        ck_assert_mem_eq(&now, &box, sizeof now);
        ck_assert_int_eq(occ_scene_move_sheet(scene, a_sheet, &one), OCC_SUCCESS);
        ck_assert_int_eq(occ_scene_move_occluder(scene, a_box, &box), OCC_SUCCESS);
        if (round != 2) commit();
    }
    ck_assert_uint_eq(scene->sheets.taken, 1);
    ck_assert_uint_le(scene->sheets.entries.count, 2);
}
END_TEST

START_TEST(sheets_go_with_their_owner)
{
    occ_sheet several[4] = {triangle(0), triangle(1), triangle(2), triangle(3)}, back;
    occ_object owners[4] = {objects[3], objects[4], objects[3], nobody};
    occ_occluder handles[4];
    ck_assert_int_eq(occ_scene_add_sheets(scene, several, owners, 4, handles), OCC_SUCCESS);
    commit();
    ck_assert_uint_eq(scene->sheets.taken, 5);
    ck_assert_int_eq(occ_scene_remove(scene, objects[3]), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_occluder_sheet(scene, handles[2], &back, NULL),
                     OCC_ERROR_STALE_HANDLE);
    commit();
    ck_assert_uint_eq(scene->sheets.taken, 2);
    ck_assert_int_eq(occ_scene_remove_occluder(scene, handles[1]), OCC_SUCCESS);
    ck_assert_int_eq(occ_scene_remove_occluder(scene, handles[3]), OCC_SUCCESS);
    commit();
    ck_assert_uint_eq(scene->sheets.taken, 0);
    ck_assert_int_eq(occ_scene_add_sheets(scene, several, NULL, 4, handles), OCC_SUCCESS);
    commit();
    ck_assert_uint_eq(scene->sheets.entries.count, 5); // the same places again
}
END_TEST

START_TEST(scene_without_sheets_has_no_room_for_them)
{
    occ_scene *plain;
    ck_assert_int_eq(occ_scene_create(NULL, &plain), OCC_SUCCESS);
    kit_fill(plain, OBJECTS, 1, 3, NULL, NULL);
    ck_assert_int_eq(occ_scene_commit(plain), OCC_SUCCESS);
    ck_assert(!plain->occluder_rows.sheet_of && !plain->sheets.entries.data);
    occ_scene_destroy(plain);
}
END_TEST

// --- the proxy -----------------------------------------------------------------------------------

// The corners are within the bounds of the box, but for rounding.
static void check_held(const occ_box *box, const occ_sheet *one)
{
    float min[3], max[3];
    double size = 0.0;
    for (int j = 0; j < 3; j++) {
        double half = 0.0;
        for (int k = 0; k < 3; k++)
            half += fabs((double)box->axis[k][j]);
        min[j] = (float)((double)box->center[j] - half);
        max[j] = (float)((double)box->center[j] + half);
        size = fmax(size, half);
    }
    for (uint32_t i = 0; i < one->corner_count; i++)
        for (int j = 0; j < 3; j++) {
            double at = (double)one->corner[i][j], room = size * 1e-6 + fabs(at) * 0x1p-24;
            KIT_CHECK(at >= (double)min[j] - room && at <= (double)max[j] + room,
                      "a corner, %g, is out of its sheet's proxy, %g to %g", at, (double)min[j],
                      (double)max[j]);
        }
}

START_TEST(proxy_holds_the_corners_and_is_not_much_larger)
{
    kit_random random = {5};
    for (int i = 0; i < 4000; i++) {
        float center[3];
        for (int j = 0; j < 3; j++)
            center[j] = kit_between(&random, -1000, 1000);
        occ_sheet one = kit_round_sheet(&random, 3 + kit_below(&random, 6), center, 5);
        occ_box box = occ_sheet_proxy(&one);
        double normal[3];
        occ_sheet_normal(&one, normal);
        double area =
            0.5 * sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
        check_held(&box, &one);
        // Its reach is the area of its largest face, all but.
        KIT_CHECK((double)occ_occluder_reach(&box) < 2.1 * area + 0.02, "%g for an area of %g",
                  (double)occ_occluder_reach(&box), area);
    }
}
END_TEST

START_TEST(proxy_of_a_flat_box_is_that_box)
{
    kit_random random = {6};
    for (int i = 0; i < 1000; i++) {
        occ_box box = kit_flat_box(&random, 90, 30);
        occ_sheet one = kit_sheet_of_box(&box);
        occ_box proxy = occ_sheet_proxy(&one);
        float reach[2] = {occ_occluder_reach(&box), occ_occluder_reach(&proxy)};
        check_held(&proxy, &one);
        KIT_CHECK(fabsf(reach[0] - reach[1]) <= 1e-5f * reach[0] + 1e-4f, "%g is not %g",
                  (double)reach[1], (double)reach[0]);
        KIT_CHECK(kit_same_bits(box.center, proxy.center, sizeof box.center), "elsewhere");
    }
}
END_TEST

START_TEST(sheets_of_any_size_and_shape_have_a_proxy)
{
    static const float sizes[] = {0x1p-149f, 1e-40f, 1e-30f, 1e-10f, 1.0f, 1e10f, 1e15f};
    kit_random random = {7};
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++)
        for (int i = 0; i < 200; i++) {
            occ_sheet one = {.corner_count = 3 + kit_below(&random, 6)};
            uint32_t kind = kit_below(&random, 3);
            for (uint32_t c = 0; c < one.corner_count; c++)
                for (int j = 0; j < 3; j++) {
                    float at = kit_below(&random, 3) ? kit_between(&random, -1, 1) : 1.0f;
                    if (kind == 1 && j) at = 0.25f;
                    if (kind == 2 && c) at = one.corner[0][j] / sizes[s];
                    one.corner[c][j] = at * sizes[s];
                }
            occ_occluder handle;
            ck_assert_int_eq(occ_scene_add_sheet(scene, &one, nobody, &handle), OCC_SUCCESS);
            occ_box box = occ_sheet_proxy(&one);
            check_held(&box, &one);
        }
    commit();
}
END_TEST

static TCase *refusals(void)
{
    TCase *tcase = tcase_create("refusals");
    tcase_add_checked_fixture(tcase, set_up, tear_down);
    tcase_add_test(tcase, number_of_corners_out_of_range_is_refused);
    tcase_add_test(tcase, unknown_sides_are_refused);
    tcase_add_test(tcase, bad_number_in_a_corner_is_refused);
    tcase_add_test(tcase, what_is_beyond_the_corners_is_not_read);
    tcase_add_test(tcase, arguments_that_are_missing_are_refused);
    tcase_add_test(tcase, each_kind_is_asked_for_by_its_own_call);
    return tcase;
}

static TCase *edits(void)
{
    TCase *tcase = tcase_create("edits");
    tcase_add_checked_fixture(tcase, set_up, tear_down);
    tcase_add_test(tcase, moving_an_occluder_makes_it_of_that_kind);
    tcase_add_test(tcase, sheets_go_with_their_owner);
    tcase_add_test(tcase, scene_without_sheets_has_no_room_for_them);
    return tcase;
}

static TCase *proxies(void)
{
    TCase *tcase = tcase_create("proxies");
    tcase_add_checked_fixture(tcase, set_up, tear_down);
    tcase_add_test(tcase, proxy_holds_the_corners_and_is_not_much_larger);
    tcase_add_test(tcase, proxy_of_a_flat_box_is_that_box);
    tcase_add_test(tcase, sheets_of_any_size_and_shape_have_a_proxy);
    return tcase;
}

int main(void)
{
    Suite *suite = suite_create("sheet_scene");
    suite_add_tcase(suite, refusals());
    suite_add_tcase(suite, edits());
    suite_add_tcase(suite, proxies());
    return test_run_suite(suite);
}
