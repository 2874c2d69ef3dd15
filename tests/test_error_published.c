// SPDX-License-Identifier: Apache-2.0
// The figures of other programs, and that they are shown for the very scenes they belong to alone.
#include "error_published.h"
#include "error_scene.h"
#include "scenes.h"
#include "support.h"

#include <string.h>

// What city_1000 is where the figures come from.
static const uint64_t city_1000 = UINT64_C(0x540245dec19ff6f0);

START_TEST(every_point_can_be_drawn)
{
    for (const error_published *p = error_published_points; p->scene; p++) {
        ck_assert_msg(error_source_find(p->scene), "%s is no scene", p->scene);
        ck_assert(p->ms > 0 && p->ms < 100);
        ck_assert(p->missed_pct >= 0 && p->missed_pct <= 100);
        ck_assert(strlen(p->method) > 0 && strlen(p->setting) > 0);
        ck_assert_ptr_null(strpbrk(p->method, "|,\"\n"));
        ck_assert_ptr_null(strpbrk(p->setting, "|\"\n"));
    }
}
END_TEST

START_TEST(points_of_a_scene_stand_together)
{
    for (const error_published *p = error_published_points; p->scene; p++)
        for (const error_published *q = p + 1; q->scene; q++)
            if (strcmp(p->scene, q->scene) == 0)
                ck_assert_msg(strcmp(q[-1].scene, q->scene) == 0, "%s is torn apart", q->scene);
}
END_TEST

START_TEST(points_are_found_by_name_and_identity)
{
    const error_published *first = error_published_find("city_1000", city_1000);
    ck_assert_ptr_nonnull(first);
    ck_assert_str_eq(first->scene, "city_1000");
    ck_assert(first == error_published_points || strcmp(first[-1].scene, "city_1000") != 0);
    ck_assert_ptr_null(error_published_find("city_1000", city_1000 + 1));
    ck_assert_ptr_null(error_published_find("city_10000", city_1000));
    ck_assert_ptr_null(error_published_find("nameless", city_1000));
}
END_TEST

// Of the same kind and size, but other boxes: other figures.
START_TEST(scenes_of_our_generators_have_no_published_points)
{
    for (const error_source *source = error_sources; source->name; source++) {
        obs_scene scene;
        if (!source->kind || source->count > 10000) continue;
        ck_assert(scenes_make(source->kind, source->count, source->seed, &scene));
        ck_assert_ptr_null(error_published_find(source->name, error_scene_identity(&scene)));
        obs_free(&scene);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("error_published");
    TCase *points = tcase_create("points");
    tcase_add_test(points, every_point_can_be_drawn);
    tcase_add_test(points, points_of_a_scene_stand_together);
    tcase_add_test(points, points_are_found_by_name_and_identity);
    tcase_add_test(points, scenes_of_our_generators_have_no_published_points);
    suite_add_tcase(suite, points);
    return test_run_suite(suite);
}
