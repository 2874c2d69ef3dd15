// SPDX-License-Identifier: Apache-2.0
// Clusters of triangles: whole, compact, as large as allowed, and the same every time.
#include "soups.h"
#include "support.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

enum { MOST = 20000 };

typedef struct clustered {
    uint32_t order[MOST], first[MOST + 1], count;
} clustered;

static clustered found, again;
static float position[3 * MOST][3];
static uint32_t label[MOST], group[MOST];
static kit_log record;
static kit_heap heap;

static occ_soup_work watched(void)
{
    kit_forget(&record);
    heap = (kit_heap){0};
    return (occ_soup_work){.allocator = kit_allocator(&heap), .logger = kit_logger(&record)};
}

static occ_soup loose(uint32_t triangles)
{
    return (occ_soup){position[0], 3 * triangles, 0, NULL, triangles};
}

static void put_triangle(uint32_t i, float x, float y, float z, float size)
{
    for (uint32_t c = 0; c < 3; c++) {
        float *p = position[3 * i + c];
        p[0] = x + (c == 1 ? size : 0.0f);
        p[1] = y + (c == 2 ? size : 0.0f);
        p[2] = z;
    }
}

static void scatter_triangles(kit_random *random, uint32_t triangles)
{
    for (uint32_t i = 0; i < triangles; i++)
        put_triangle(i, kit_between(random, -50, 50), kit_between(random, -50, 50),
                     kit_between(random, -5, 5), kit_between(random, 0, 2));
}

// --- what every split must be --------------------------------------------------------------------

static void check_whole(const clustered *c, uint32_t triangles)
{
    static uint32_t times[MOST];
    memset(times, 0, triangles * sizeof *times);
    ck_assert_uint_eq(c->first[0], 0);
    ck_assert_uint_eq(c->first[c->count], triangles);
    for (uint32_t i = 0; i < c->count; i++) {
        KIT_CHECK(c->first[i] < c->first[i + 1], "cluster %u is empty", i);
        for (uint32_t k = c->first[i]; k < c->first[i + 1]; k++) {
            KIT_CHECK(c->order[k] < triangles, "there is no triangle %u", c->order[k]);
            KIT_CHECK(k == c->first[i] || c->order[k - 1] < c->order[k], "not ascending");
            times[c->order[k]]++;
        }
    }
    for (uint32_t t = 0; t < triangles; t++)
        KIT_CHECK(times[t] == 1, "triangle %u is there %u times", t, times[t]);
}

static bool has_group(const uint32_t *groups, uint32_t triangle)
{
    return groups && groups[triangle] != OCC_NO_GROUP;
}

// Labels are not mixed, groups are not parted, and only a group is larger than allowed.
static void check_wishes(const clustered *c, const occ_clusters_desc *desc)
{
    static uint32_t cluster_of_group[MOST];
    memset(cluster_of_group, 0xff, sizeof cluster_of_group);
    uint32_t most = desc->max_triangles ? desc->max_triangles : 32, last = 0;
    for (uint32_t i = 0; i < c->count; i++) {
        uint32_t begin = c->first[i], end = c->first[i + 1];
        for (uint32_t k = begin; k < end; k++) {
            uint32_t t = c->order[k];
            if (desc->labels) {
                KIT_CHECK(desc->labels[t] == desc->labels[c->order[begin]], "labels are mixed");
                KIT_CHECK(desc->labels[t] >= last, "labels are out of order");
                last = desc->labels[t];
            }
            if (!has_group(desc->groups, t)) continue;
            uint32_t *at = &cluster_of_group[desc->groups[t]];
            KIT_CHECK(*at == UINT32_MAX || *at == i, "group %u is parted", desc->groups[t]);
            *at = i;
        }
        if (end - begin <= most) continue;
        for (uint32_t k = begin; k < end; k++)
            KIT_CHECK(has_group(desc->groups, c->order[k]) &&
                          desc->groups[c->order[k]] == desc->groups[c->order[begin]],
                      "cluster %u has %u triangles", i, end - begin);
    }
}

static void split(const occ_soup *soup, const occ_clusters_desc *desc)
{
    ck_assert_int_eq(occ_clusters_find(soup, desc, found.order, found.first, &found.count),
                     OCC_SUCCESS);
    check_whole(&found, soup->triangle_count);
    check_wishes(&found, desc);
}

static void check_bounds(const occ_soup *soup)
{
    static occ_box boxes[MOST];
    static uint32_t index[3 * MOST];
    ck_assert_int_eq(occ_clusters_bounds(soup, found.order, found.first, found.count, NULL, boxes),
                     OCC_SUCCESS);
    for (uint32_t i = 0; i < found.count; i++) {
        occ_soup part = *soup;
        occ_box box;
        part.indices = index;
        part.triangle_count = found.first[i + 1] - found.first[i];
        for (uint32_t k = 0; k < 3 * part.triangle_count; k++) {
            uint32_t corner = 3 * found.order[found.first[i] + k / 3] + k % 3;
            index[k] = soup->indices ? soup->indices[corner] : corner;
        }
        KIT_CHECK(!occ_verify_bounds(&part, &boxes[i], NULL, NULL), "cluster %u: outside", i);
        KIT_CHECK(!occ_bounds_of_soup(&part, NULL, &box), "cluster %u: no bounds", i);
        KIT_CHECK(kit_same_bits(&box, &boxes[i], sizeof box), "cluster %u: another box", i);
    }
}

START_TEST(random_soups_are_split_as_asked_for)
{
    kit_random random = {4711};
    for (uint32_t round = 0; round < 300; round++) {
        static soups_soup made;
        soups_make(&random, &soups_shapes[round % soups_shape_count], 8 + kit_below(&random, 200),
                   round % 4 != 0, &made);
        occ_soup soup = soups_view(&made);
        uint32_t labels = 1 + kit_below(&random, 4), groups = 1 + kit_below(&random, 30);
        for (uint32_t t = 0; t < soup.triangle_count; t++) {
            group[t] = kit_below(&random, 3) ? OCC_NO_GROUP : kit_below(&random, groups);
            label[t] = group[t] == OCC_NO_GROUP ? kit_below(&random, labels) : group[t] % labels;
        }
        occ_clusters_desc desc = {.max_triangles = kit_below(&random, 3) * kit_below(&random, 20),
                                  .labels = kit_below(&random, 2) ? label : NULL,
                                  .groups = kit_below(&random, 2) ? group : NULL};
        split(&soup, &desc);
        if (round % 8 == 1) check_bounds(&soup);
    }
}
END_TEST

START_TEST(clusters_do_not_depend_on_the_run_or_on_how_vertices_are_told)
{
    kit_random random = {5};
    static float wide[3 * MOST][5];
    static uint32_t index[3 * MOST];
    scatter_triangles(&random, MOST);
    for (uint32_t i = 0; i < 3 * MOST; i++) {
        index[i] = 3 * MOST - 1 - i;
        memcpy(wide[index[i]], position[i], sizeof position[i]);
        wide[index[i]][3] = NAN;
    }
    occ_soup soup = loose(MOST), other = {wide[0], 3 * MOST, sizeof wide[0], index, MOST};
    occ_clusters_desc desc = {.max_triangles = 24};
    split(&soup, &desc);
    ck_assert_uint_ge(found.count, MOST / 24);
    ck_assert_int_eq(occ_clusters_find(&other, &desc, again.order, again.first, &again.count),
                     OCC_SUCCESS);
    ck_assert_uint_eq(found.count, again.count);
    ck_assert(kit_same_bits(found.order, again.order, sizeof found.order));
    ck_assert(kit_same_bits(found.first, again.first, (found.count + 1) * sizeof *found.first));
}
END_TEST

// --- shapes --------------------------------------------------------------------------------------

START_TEST(two_heaps_of_triangles_are_not_mixed)
{
    for (uint32_t i = 0; i < 40; i++)
        put_triangle(i, i % 2 ? 1000.0f : 0.0f, (float)i, 0, 1);
    occ_soup soup = loose(40);
    split(&soup, &(occ_clusters_desc){.max_triangles = 30});
    ck_assert_uint_eq(found.count, 2);
    for (uint32_t k = 0; k < 40; k++)
        ck_assert_uint_eq(found.order[k] % 2, found.order[k < 20 ? 0 : 20] % 2);
}
END_TEST

START_TEST(identical_triangles_are_split_all_the_same)
{
    for (uint32_t i = 0; i < MOST; i++)
        put_triangle(i, 1, 2, 3, 1);
    occ_soup soup = loose(MOST);
    split(&soup, &(occ_clusters_desc){0});
    ck_assert_uint_le(found.count, MOST / 8);
    for (uint32_t i = 0; i < MOST; i++)
        put_triangle(i, 1, 2, 3, 0);
    split(&soup, &(occ_clusters_desc){0});
    ck_assert_uint_le(found.count, MOST / 8);
}
END_TEST

// Each triangle is larger than all before it together: every cut is best at the very end.
START_TEST(growing_triangles_are_split_in_time)
{
    for (uint32_t i = 0; i < MOST; i++) {
        float x = ldexpf(1.0f + (float)(i % 400) / 400.0f, (int)(i / 400u) - 20);
        put_triangle(i, x, 0, 0, x);
    }
    occ_soup soup = loose(MOST);
    split(&soup, &(occ_clusters_desc){.max_triangles = 2});
}
END_TEST

START_TEST(largest_coordinates_are_split)
{
    for (uint32_t i = 0; i < MOST; i++) {
        put_triangle(i, i % 2 ? -1e15f : 1e15f, (i & 2) ? -1e15f : 1e15f, 0, 0);
        position[3 * i][2] = (i & 4) ? -1e15f : 1e15f;
    }
    occ_soup soup = loose(MOST);
    split(&soup, &(occ_clusters_desc){0});
}
END_TEST

// A grid of quads is split into patches, not into strips: the sum of areas says so.
START_TEST(clusters_of_a_floor_are_compact)
{
    enum { SIDE = 64 };
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        uint32_t row = i / SIDE;
        put_triangle(i, (float)(i % SIDE), (float)row, 0, 1);
    }
    occ_soup soup = loose(SIDE * SIDE);
    split(&soup, &(occ_clusters_desc){.max_triangles = 64});
    for (uint32_t i = 0; i < found.count; i++) {
        float low[2] = {1e9f, 1e9f}, high[2] = {-1e9f, -1e9f};
        for (uint32_t k = found.first[i]; k < found.first[i + 1]; k++)
            for (int j = 0; j < 2; j++) {
                low[j] = fminf(low[j], position[3 * found.order[k]][j]);
                high[j] = fmaxf(high[j], position[3 * found.order[k]][j]);
            }
        ck_assert_float_le(high[0] - low[0], 16);
        ck_assert_float_le(high[1] - low[1], 16);
    }
}
END_TEST

// --- what is refused, stopped or fails -----------------------------------------------------------

static void check_refused(const occ_soup *soup, const occ_clusters_desc *asked, occ_result want,
                          const char *reason)
{
    occ_clusters_desc desc = *asked;
    desc.work = watched();
    found.count = 77;
    ck_assert_str_eq(
        occ_result_name(occ_clusters_find(soup, &desc, found.order, found.first, &found.count)),
        occ_result_name(want));
    ck_assert_msg(kit_logged(&record, reason), "%s", record.text);
    ck_assert_uint_eq(found.count, 0);
    ck_assert_uint_eq(heap.blocks, 0);
}

START_TEST(bad_input_is_refused_by_name)
{
    put_triangle(0, 0, 0, 0, 1);
    put_triangle(1, 1, 0, 0, 1);
    occ_soup soup = loose(2), empty = soup;
    occ_clusters_desc desc = {0};
    empty.triangle_count = 0;
    check_refused(NULL, &desc, OCC_ERROR_INVALID_ARGUMENT, "the soup is NULL");
    check_refused(&empty, &desc, OCC_ERROR_INVALID_ARGUMENT, "no triangles");
    position[4][1] = NAN;
    check_refused(&soup, &desc, OCC_ERROR_NOT_FINITE, "vertex 4 of triangle 1");
    position[4][1] = FLT_MAX;
    check_refused(&soup, &desc, OCC_ERROR_OUT_OF_RANGE, "vertex 4 of triangle 1");
    put_triangle(1, 1, 0, 0, 1);
    const uint32_t labels[2] = {3, 4}, groups[2] = {9, 9};
    desc = (occ_clusters_desc){.labels = labels, .groups = groups};
    check_refused(&soup, &desc, OCC_ERROR_INVALID_ARGUMENT,
                  "group 9 has triangles of labels 3 and 4");
    occ_box box;
    const uint32_t order[2] = {0, 2}, first[3] = {0, 1, 1};
    occ_soup_work work = watched();
    ck_assert_int_eq(occ_clusters_find(&soup, NULL, NULL, found.first, &found.count),
                     OCC_ERROR_INVALID_ARGUMENT);
    ck_assert_int_eq(occ_clusters_bounds(&soup, order, first, 2, &work, &box),
                     OCC_ERROR_INVALID_ARGUMENT);
    ck_assert(kit_logged(&record, "cluster 1 has no triangles"));
    ck_assert_int_eq(occ_clusters_bounds(&soup, order, (uint32_t[2]){0, 2}, 1, &work, &box),
                     OCC_ERROR_INVALID_ARGUMENT);
    ck_assert(kit_logged(&record, "order names triangle 2 of 2"));
    ck_assert_int_eq(occ_clusters_bounds(&soup, order, first, 0, &work, &box),
                     OCC_ERROR_INVALID_ARGUMENT);
}
END_TEST

typedef struct watch {
    uint32_t calls, stop_at;
    float last;
} watch;

static bool watch_progress(float done, void *user_data)
{
    watch *w = user_data;
    ck_assert(done >= w->last && done <= 1.0f);
    w->last = done;
    return ++w->calls != w->stop_at;
}

START_TEST(progress_rises_and_stops_the_work)
{
    kit_random random = {6};
    scatter_triangles(&random, MOST);
    occ_soup soup = loose(MOST);
    watch w = {0};
    occ_clusters_desc desc = {.work = watched()};
    desc.work.progress = watch_progress;
    desc.work.user_data = &w;
    ck_assert_int_eq(occ_clusters_find(&soup, &desc, found.order, found.first, &found.count),
                     OCC_SUCCESS);
    ck_assert_float_eq(w.last, 1.0f);
    ck_assert_uint_ge(w.calls, 4);
    for (uint32_t stop = 1, calls = w.calls; stop <= calls; stop++) {
        w = (watch){.stop_at = stop};
        ck_assert_int_eq(occ_clusters_find(&soup, &desc, found.order, found.first, &found.count),
                         OCC_ERROR_CANCELLED);
        ck_assert_uint_eq(w.calls, stop);
        ck_assert_uint_eq(heap.blocks, 0);
    }
}
END_TEST

START_TEST(every_failed_allocation_is_told_and_nothing_leaks)
{
    kit_random random = {7};
    scatter_triangles(&random, 500);
    for (uint32_t t = 0; t < 500; t++)
        group[t] = t % 3 ? OCC_NO_GROUP : t / 9;
    occ_soup soup = loose(500);
    occ_clusters_desc desc = {.groups = group};
    split(&soup, &desc);
    static occ_box boxes[MOST];
    occ_result result = OCC_ERROR_OUT_OF_MEMORY;
    uint64_t fail;
    for (fail = 1; result; fail++) {
        desc.work = watched();
        heap.fail_at = fail;
        result = occ_clusters_find(&soup, &desc, again.order, again.first, &again.count);
        if (!result) {
            result = occ_clusters_bounds(&soup, again.order, again.first, again.count, &desc.work,
                                         boxes);
        }
        ck_assert(result == OCC_SUCCESS || result == OCC_ERROR_OUT_OF_MEMORY);
        ck_assert(!result || kit_logged(&record, "OCC_ERROR_OUT_OF_MEMORY: no memory"));
        ck_assert_uint_eq(heap.blocks, 0);
    }
    ck_assert_uint_ge(fail, 7);
    ck_assert_uint_eq(found.count, again.count);
    ck_assert(kit_same_bits(found.order, again.order, 500 * sizeof *found.order));
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("clusters");
    TCase *c = tcase_create("splits");
    tcase_add_test(c, random_soups_are_split_as_asked_for);
    tcase_add_test(c, clusters_do_not_depend_on_the_run_or_on_how_vertices_are_told);
    suite_add_tcase(suite, c);
    c = tcase_create("shapes");
    tcase_add_test(c, two_heaps_of_triangles_are_not_mixed);
    tcase_add_test(c, identical_triangles_are_split_all_the_same);
    tcase_add_test(c, growing_triangles_are_split_in_time);
    tcase_add_test(c, largest_coordinates_are_split);
    tcase_add_test(c, clusters_of_a_floor_are_compact);
    suite_add_tcase(suite, c);
    c = tcase_create("input");
    tcase_add_test(c, bad_input_is_refused_by_name);
    tcase_add_test(c, progress_rises_and_stops_the_work);
    tcase_add_test(c, every_failed_allocation_is_told_and_nothing_leaks);
    suite_add_tcase(suite, c);
    return test_run_suite(suite);
}
