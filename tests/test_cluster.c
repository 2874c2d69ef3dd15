// SPDX-License-Identifier: Apache-2.0
#include "cluster.h"
#include "soup.h"
#include "steady.h"
#include "support.h"

// Loose triangles and pairs of them, anywhere.
static model random_soup(uint32_t triangles, const char *label)
{
    steady_random random = steady_seed(5, label);
    model m = soup_make(triangles);
    while (m.triangle_count + 2 <= triangles) {
        float p[4][3], size = (float)steady_between(&random, 0.1, 3);
        for (int k = 0; k < 3; k++)
            p[0][k] = (float)steady_between(&random, -50, 50);
        for (int i = 1; i < 4; i++)
            memcpy(p[i], p[0], sizeof *p);
        int axis = (int)steady_below(&random, 3);
        p[1][axis] = p[2][axis] = p[0][axis] + size;
        p[2][(axis + 1) % 3] = p[3][(axis + 1) % 3] = p[0][(axis + 1) % 3] + size;
        if (steady_below(&random, 2))
            soup_quad(&m, p[0], p[1], p[2], p[3]);
        else
            soup_triangle(&m, p[0], p[1], p[2]);
    }
    return m;
}

static void check_objects(const model *m, const sheet_list *sheets, const cluster_list *list,
                          uint32_t most)
{
    uint32_t *times = calloc((size_t)m->triangle_count + 1, sizeof *times);
    ck_assert_ptr_nonnull(times);
    ck_assert_uint_eq(list->first[0], 0);
    ck_assert_uint_eq(list->first[list->count], m->triangle_count);
    for (uint32_t o = 0; o < list->count; o++) {
        ck_assert_uint_lt(list->first[o], list->first[o + 1]);
        ck_assert_uint_le(list->first[o + 1] - list->first[o], most);
        for (uint32_t i = list->first[o]; i < list->first[o + 1]; i++) {
            times[list->triangles[i]]++;
            ck_assert_uint_eq(list->object_of[list->triangles[i]], o);
        }
    }
    for (uint32_t t = 0; t < m->triangle_count; t++)
        ck_assert_uint_eq(times[t], 1);
    for (uint32_t s = 0; s < sheets->count; s++)
        ck_assert_uint_eq(list->object_of[sheets->at[s].triangles[0]],
                          list->object_of[sheets->at[s].triangles[1]]);
    free(times);
}

static void split_and_check(const model *m, uint32_t most)
{
    sheet_list sheets;
    cluster_list list;
    ck_assert(sheets_find(m, &sheets));
    ck_assert(clusters_build(m, &sheets, most, &list));
    check_objects(m, &sheets, &list, most);
    clusters_free(&list);
    sheets_free(&sheets);
}

START_TEST(every_triangle_is_in_one_object_and_pairs_stay_together)
{
    model m = random_soup(3000, "cluster");
    static const uint32_t limits[] = {2, 3, 17, 64, 5000};
    for (size_t i = 0; i < sizeof limits / sizeof *limits; i++)
        split_and_check(&m, limits[i]);
    soup_free(&m);
}
END_TEST

START_TEST(objects_do_not_depend_on_the_run)
{
    model m = random_soup(2000, "cluster");
    sheet_list sheets;
    cluster_list a, b;
    ck_assert(sheets_find(&m, &sheets));
    ck_assert(clusters_build(&m, &sheets, 32, &a) && clusters_build(&m, &sheets, 32, &b));
    ck_assert_uint_eq(a.count, b.count);
    ck_assert_mem_eq(a.triangles, b.triangles, m.triangle_count * sizeof *a.triangles);
    ck_assert_mem_eq(a.first, b.first, (a.count + 1) * sizeof *a.first);
    clusters_free(&a);
    clusters_free(&b);
    sheets_free(&sheets);
    soup_free(&m);
}
END_TEST

START_TEST(two_heaps_of_triangles_are_not_mixed)
{
    model m = soup_make(40);
    for (int heap = 0; heap < 2; heap++)
        for (int i = 0; i < 20; i++) {
            float x = (float)(heap * 1000), y = (float)i;
            const float a[3] = {x, y, 0}, b[3] = {x + 1, y, 0}, c[3] = {x, y, 1};
            soup_triangle(&m, a, b, c);
        }
    sheet_list none = {0};
    cluster_list list;
    ck_assert(clusters_build(&m, &none, 30, &list));
    ck_assert_uint_eq(list.object_of[0], list.object_of[19]);
    ck_assert_uint_ne(list.object_of[0], list.object_of[20]);
    clusters_free(&list);
    soup_free(&m);
}
END_TEST

START_TEST(identical_triangles_are_split_all_the_same)
{
    static const float a[3] = {0, 0, 0}, b[3] = {1, 0, 0}, c[3] = {0, 1, 0};
    model m = soup_make(5000);
    for (int i = 0; i < 5000; i++)
        soup_triangle(&m, a, b, c);
    split_and_check(&m, 32);
    soup_free(&m);
}
END_TEST

// Each triangle is larger than all before it together: every cut is best at the very end.
START_TEST(growing_triangles_do_not_make_a_deep_recursion)
{
    enum { COUNT = 20000 };
    model m = soup_make(COUNT);
    for (uint32_t i = 0; i < COUNT; i++) {
        float x = (float)ldexp(1.0 + i % 400 / 400.0, (int)(i / 400) - 20);
        float *p[3] = {m.positions[3 * i], m.positions[3 * i + 1], m.positions[3 * i + 2]};
        p[0][0] = p[1][0] = p[2][0] = x;
        p[1][1] = p[2][2] = x;
        for (uint32_t k = 0; k < 3; k++)
            m.corners[i][k] = 3 * i + k;
    }
    m.triangle_count = COUNT;
    m.vertex_count = 3 * COUNT;
    split_and_check(&m, 2);
    soup_free(&m);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("cluster");
    TCase *objects = tcase_create("objects");
    tcase_add_test(objects, every_triangle_is_in_one_object_and_pairs_stay_together);
    tcase_add_test(objects, objects_do_not_depend_on_the_run);
    tcase_add_test(objects, two_heaps_of_triangles_are_not_mixed);
    tcase_add_test(objects, identical_triangles_are_split_all_the_same);
    tcase_add_test(objects, growing_triangles_do_not_make_a_deep_recursion);
    suite_add_tcase(suite, objects);
    return test_run_suite(suite);
}
