// SPDX-License-Identifier: Apache-2.0
// labels: unit property
// What the error bounds cost: by how much an object must be inside a shadow to be reported hidden.
// The occluder's size has no part in it, since its shadow is set up in double.
#include "hard.h"
#include "support.h"

#include <math.h>
#include <stdio.h>

// An object behind a wall, from an eye at the origin that looks along -z.
typedef struct setting {
    float distance; // of the wall
    float wall;     // its half width and height
    float object;   // the object's
    bool is_thick;  // as deep as it is wide
} setting;

typedef occ_box place_object(const setting *s, double gap);

// Behind the wall by `gap`, in the middle.
static occ_box behind(const setting *s, double gap)
{
    float depth = s->is_thick ? s->object : 0.0f;
    float z = -(float)((double)s->distance + gap + (double)depth);
    return hard_brick(0, 0, z, s->object, s->object, depth);
}

// Twice as far off as the wall; its upper edge is below the shadow's by `gap`.
static occ_box below(const setting *s, double gap)
{
    float half_height = (float)(0.5 * (2.0 * (double)s->wall - gap));
    return hard_brick(0, half_height, -2 * s->distance, s->object, half_height, 0);
}

static bool is_hidden_in(const setting *s, const occ_box *object, occ_view *view)
{
    world_occluder wall = {hard_brick(0, 0, -s->distance, s->wall, s->wall, 0), -1};
    hard h = {.camera = {.depth = OCC_DEPTH_MINUS_ONE_TO_ONE}};
    const world_lens lens = {.near_z = 0.01f * s->distance, .far_z = 1e9f};
    hard_look(&h, 0, 0, 0, &lens);
    h.camera.eye = h.eye;
    occ_scene *scene = world_scene(object, 1, &wall, 1, 8);
    occ_cull_desc knobs = world_knobs(OCC_METHOD_SINGLE);
    kit_cull(view, scene, &h.camera, &knobs);
    bool hidden = !world_sees(view, 0);
    occ_scene_destroy(scene);
    return hidden;
}

// The smallest gap from which on the object is hidden, to a part in a thousand.
static double clearance(const setting *s, place_object *place, occ_view *view)
{
    double low = 1e-12, high = (double)fminf(1e3f, s->wall);
    occ_box far_off = place(s, high), touching = place(s, 0.0);
    ck_assert(is_hidden_in(s, &far_off, view));
    ck_assert(!is_hidden_in(s, &touching, view));
    while (high > low * 1.001) {
        double middle = sqrt(low * high);
        occ_box object = place(s, middle);
        bool hidden = is_hidden_in(s, &object, view);
        high = hidden ? middle : high;
        low = hidden ? low : middle;
    }
    return high;
}

// 16u L for the box, doubled where the normal is half as long as it may be, and what its own floats
// cannot say. A gap below a silhouette is not measured along the plane's normal: the wider the view
// that the wall fills, the more of it counts.
static double most_that_is_needed(const setting *s, place_object *place, const occ_box *object)
{
    double size = 0.0, largest = 0.0;
    for (int j = 0; j < 3; j++) {
        size += fabs((double)object->center[j]);
        largest = fmax(largest, fabs((double)object->center[j]));
        for (int k = 0; k < 3; k++)
            size += fabs((double)object->axis[k][j]);
    }
    double slope = (double)fmaxf(1, s->wall / s->distance);
    return (place == below ? slope : 1.0) * 2.0 * 0x1p-20 * size * 1.01 + 2.0 * 0x1p-23 * largest;
}

static void measure(const setting *s, place_object *place, const char *what, occ_view *view)
{
    double needed = clearance(s, place, view);
    occ_box object = place(s, needed);
    printf("%-6s wall %8g at %6g, object %8g%s: %.2g\n", what, (double)s->wall, (double)s->distance,
           (double)s->object, s->is_thick ? " thick" : "", needed);
    ck_assert_double_le(needed, most_that_is_needed(s, place, &object));
}

START_TEST(a_wall_needs_the_clearance_that_the_object_calls_for)
{
    occ_view *view = world_view(OCC_BACKEND_PLAIN, 0);
    static const float distances[] = {0.1f, 1, 10, 100, 1000}, sizes[] = {0.1f, 1, 100, 1e4f, 1e6f};
    for (int d = 0; d < 5; d++)
        for (int o = 0; o < 5; o++)
            for (int thick = 0; thick < 2; thick++) {
                setting s = {distances[d], 2e6f, sizes[o], thick == 1};
                measure(&s, behind, "behind", view);
            }
    occ_view_destroy(view);
}
END_TEST

// From a wall that just covers the object to one some ten million times as wide. (Times 16, so that
// its normal has the same length in the end.)
START_TEST(a_larger_wall_needs_no_more_clearance)
{
    occ_view *view = world_view(OCC_BACKEND_PLAIN, 0);
    double first = 0.0;
    for (int power = 1; power < 27; power += 4) {
        float wall = ldexpf(1, power);
        setting s = {1, wall, 1, false};
        double needed = clearance(&s, behind, view);
        printf("wall %8g at 1, object 1: %.3g\n", (double)wall, needed);
        if (first == 0.0) first = needed;
        ck_assert_double_eq_tol(needed, first, 2e-3 * first);
    }
    occ_view_destroy(view);
}
END_TEST

START_TEST(a_silhouette_needs_the_clearance_that_the_object_calls_for)
{
    occ_view *view = world_view(OCC_BACKEND_PLAIN, 0);
    static const float distances[] = {0.1f, 1, 10, 100}, widths[] = {0.1f, 1, 10, 100};
    for (int d = 0; d < 4; d++)
        for (int w = 0; w < 4; w++) {
            float wall = widths[w] * distances[d];
            setting s = {distances[d], wall, 0.01f * wall, false};
            measure(&s, below, "below", view);
        }
    occ_view_destroy(view);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("clearance");
    TCase *walls = tcase_create("walls");
    tcase_add_test(walls, a_wall_needs_the_clearance_that_the_object_calls_for);
    tcase_add_test(walls, a_larger_wall_needs_no_more_clearance);
    tcase_add_test(walls, a_silhouette_needs_the_clearance_that_the_object_calls_for);
    suite_add_tcase(suite, walls);
    return test_run_suite(suite);
}
