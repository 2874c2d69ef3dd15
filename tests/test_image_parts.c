// SPDX-License-Identifier: Apache-2.0
#include "image_parts.h"
#include "soup.h"
#include "steady.h"
#include "support.h"

// Boxes here and there, of which light passes some triangles.
static model boxes_and_glass(uint32_t boxes)
{
    steady_random random = steady_seed(3, "image parts");
    model m = soup_make(12 * boxes);
    for (uint32_t i = 0; i < boxes; i++) {
        float low[3], high[3];
        for (int k = 0; k < 3; k++) {
            low[k] = (float)steady_between(&random, -40, 40);
            high[k] = low[k] + (float)steady_between(&random, 0.1, 5);
        }
        soup_box(&m, low, high, false);
    }
    for (uint32_t t = 0; t < m.triangle_count; t++) {
        m.see_through[t] = steady_below(&random, 5) == 0;
        m.see_through_count += m.see_through[t];
    }
    return m;
}

// The scene that convert would write, but for occluders and frames.
static obs_scene scene_of(const division *d)
{
    obs_scene scene = {0};
    for (uint32_t i = 0; i < d->count; i++)
        ck_assert_uint_eq(obs_add_object(&scene, &d->boxes[i]), i);
    return scene;
}

// A corner in the box, without rounding: sums of two floats are exact here in double.
static void check_inside(const occ_box *box, const float p[3])
{
    for (int k = 0; k < 3; k++) {
        double center = (double)box->center[k], half = 0;
        for (int a = 0; a < 3; a++)
            half += fabs((double)box->axis[a][k]);
        ck_assert_double_le(center - half, (double)p[k]);
        ck_assert_double_ge(center + half, (double)p[k]);
    }
}

static void check_place(const model *m, const image_parts *parts, const obs_scene *scene,
                        uint32_t object, uint32_t place)
{
    uint32_t triangle = parts->triangles[place];
    ck_assert_uint_eq(image_parts_object(parts, place), object);
    ck_assert_mem_eq(parts->corners[place], m->corners[triangle], sizeof m->corners[triangle]);
    ck_assert(m->see_through[triangle] == (place >= parts->see_through[object]));
    for (int c = 0; c < 3; c++)
        check_inside(&scene->objects[object], parts->positions[parts->corners[place][c]]);
}

START_TEST(every_triangle_has_one_place_in_the_object_that_bounds_it)
{
    model m = boxes_and_glass(150);
    division d;
    image_parts parts;
    static const uint32_t most[] = {2, 9, 32};
    uint32_t *times = calloc(m.triangle_count, sizeof *times);
    ck_assert_ptr_nonnull(times);
    const division_options options = {.most = most[_i]};
    ck_assert(division_make(&m, &options, &d));
    obs_scene scene = scene_of(&d);
    ck_assert(image_parts_agree(&d, &scene, "scene", "model"));
    ck_assert(image_parts_make(&m, &d, &parts));
    ck_assert_uint_eq(parts.object_count, scene.object_count);
    ck_assert_uint_eq(parts.see_through_count, m.see_through_count);
    ck_assert_uint_eq(parts.first[0], 0);
    ck_assert_uint_eq(parts.first[parts.object_count], m.triangle_count);
    for (uint32_t i = 0; i < parts.object_count; i++)
        for (uint32_t place = parts.first[i]; place < parts.first[i + 1]; place++) {
            check_place(&m, &parts, &scene, i, place);
            ck_assert_uint_eq(d.object_of[parts.triangles[place]], i);
            times[parts.triangles[place]]++;
        }
    for (uint32_t t = 0; t < m.triangle_count; t++)
        ck_assert_uint_eq(times[t], 1);
    image_parts_free(&parts);
    obs_free(&scene);
    division_free(&d);
    free(times);
    soup_free(&m);
}
END_TEST

START_TEST(scene_of_another_division_is_refused)
{
    model m = boxes_and_glass(40);
    division d, other;
    const division_options options = {.most = 32}, finer = {.most = 8};
    ck_assert(division_make(&m, &options, &d) && division_make(&m, &finer, &other));
    obs_scene scene = scene_of(&d);
    ck_assert(image_parts_agree(&d, &scene, "scene", "model"));
    ck_assert(!image_parts_agree(&other, &scene, "scene", "model"));
    // One bit of one box.
    ck_assert_ptr_nonnull(scene.objects);
    float *half = &scene.objects[scene.object_count - 1].axis[2][2];
    *half = nextafterf(*half, INFINITY);
    ck_assert(!image_parts_agree(&d, &scene, "scene", "model"));
    obs_free(&scene);
    division_free(&d);
    division_free(&other);
    soup_free(&m);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("image_parts");
    TCase *c = tcase_create("map");
    tcase_add_loop_test(c, every_triangle_has_one_place_in_the_object_that_bounds_it, 0, 3);
    tcase_add_test(c, scene_of_another_division_is_refused);
    suite_add_tcase(suite, c);
    return test_run_suite(suite);
}
