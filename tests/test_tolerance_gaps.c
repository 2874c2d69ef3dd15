// SPDX-License-Identifier: Apache-2.0
// What the angular tolerance closes, what it must leave open, and where it does nothing: by hand.
#include "support.h"
#include "worlds.h"

#include <math.h>

enum { ACROSS = 3, OBJECTS = 24, BOXES = ACROSS * ACROSS };

// A wall of panels ahead of the eye, and objects that each stand behind a seam.
typedef struct wall {
    double scale, away, ahead, tolerance;
    occ_camera_desc camera;
    double eye[3];
    occ_box objects[OBJECTS];
    world_occluder panels[BOXES];
    uint32_t objects_count, panel_count;
} wall;

static const double tolerances[] = {1e-4, 1e-3, 1e-2, 0.1};
static const occ_method methods[] = {OCC_METHOD_SINGLE, OCC_METHOD_PAIRWISE, OCC_METHOD_FUSED};

static occ_box place(const wall *w, double right, double up, double ahead, double half, double deep)
{
    double at[3] = {right, up, -ahead}, axis[3] = {half, half, deep};
    occ_box box = {{0}, {{0}}};
    for (int j = 0; j < 3; j++) {
        box.center[j] = (float)(w->eye[j] + w->scale * at[j]);
        box.axis[j][j] = (float)(w->scale * axis[j]);
    }
    return box;
}

static void look_ahead(wall *w, world_projection projection)
{
    float eye[3], target[3];
    for (int j = 0; j < 3; j++) {
        eye[j] = target[j] = (float)(w->scale * w->away * (j - 0.7));
        w->eye[j] = (double)eye[j];
    }
    target[2] -= (float)w->scale;
    world_lens lens = {.projection = projection,
                       .height = projection == WORLD_ORTHOGRAPHIC ? (float)(2 * w->scale) : 1.0f,
                       .near_z = (float)(0.01 * w->scale),
                       .far_z = (float)(1000 * w->scale)};
    w->camera = world_camera(eye, target, &lens);
    w->camera.eye = w->eye;
}

static void put_panel(wall *w, occ_box box)
{
    w->panels[w->panel_count++] = (world_occluder){box, -1};
}

// Gaps of `gap` between panels; the wall fills the picture. One object behind each crossing of
// seams, as large as a panel and three times as far away, and more behind the seams between them.
static void build(wall *w, double gap)
{
    double half = 0.5 * w->ahead; // of a panel with its gap
    look_ahead(w, WORLD_PERSPECTIVE);
    for (int x = -1; x < 2; x++)
        for (int y = -1; y < 2; y++)
            put_panel(w, place(w, 2 * half * x, 2 * half * y, w->ahead, half - 0.5 * gap, 0));
    for (int i = 0; i < OBJECTS; i++) {
        double beyond = 1.5 + 0.1 * i, seam = i & 1 ? half : -half;
        double along = 0.4 * half * sin((double)i);
        double right = i & 2 ? seam : along, up = i & 2 ? along : seam;
        if (i % 5 == 0) right = up = seam;
        w->objects[w->objects_count++] = place(w, beyond * right, beyond * up, beyond * w->ahead,
                                               0.05 * beyond * w->ahead, 0.02 * w->ahead);
    }
}

// How many of the objects are seen.
static uint32_t count_seen(const wall *w, occ_method method, double tolerance)
{
    uint32_t seen = 0;
    occ_view *view = world_view(OCC_BACKEND_PLAIN, 0);
    occ_scene *scene = world_scene(w->objects, w->objects_count, w->panels, w->panel_count, 4);
    occ_cull_desc knobs = world_knobs(method);
    knobs.tolerance = (float)tolerance;
    kit_cull(view, scene, &w->camera, &knobs);
    for (uint32_t i = 0; i < w->objects_count; i++)
        seen += world_sees(view, i);
    occ_scene_destroy(scene);
    occ_view_destroy(view);
    return seen;
}

typedef void with_wall(const wall *w);

static void try_all(with_wall *check)
{
    for (int i = 0; i < 3 * 2 * 2 * 4; i++) {
        wall w = {.scale = i % 3 == 0   ? 1e-3
                           : i % 3 == 1 ? 1.0
                                        : 1e3,
                  .ahead = i / 3 % 2 ? 2.0 : 20.0,
                  .away = i / 6 % 2 ? 0.0 : 10.0,
                  .tolerance = tolerances[i / 12]};
        check(&w);
    }
}

static void close_gaps(const wall *plan)
{
    wall w = *plan;
    build(&w, 0.25 * w.tolerance * w.ahead);
    uint32_t without = count_seen(&w, OCC_METHOD_FUSED, 0),
             with = count_seen(&w, OCC_METHOD_FUSED, w.tolerance);
    KIT_CHECK(without == OBJECTS, "%u of %d are seen through the gaps", without, OBJECTS);
    KIT_CHECK(with == 0, "%u of %d are seen at %g", with, OBJECTS, w.tolerance);
    ck_assert_uint_eq(count_seen(&w, OCC_METHOD_SINGLE, w.tolerance), OBJECTS);
}

START_TEST(gaps_of_a_quarter_of_the_tolerance_are_closed)
{
    try_all(close_gaps);
}
END_TEST

// Off the middle of the picture a gap looks narrower than straight ahead.
static void leave_gaps(const wall *plan)
{
    wall w = *plan;
    build(&w, 2.0 * w.tolerance * w.ahead * 1.5);
    for (int m = 0; m < 3; m++) {
        uint32_t seen = count_seen(&w, methods[m], w.tolerance);
        KIT_CHECK(seen == OBJECTS, "%u of %d are seen at %g", seen, OBJECTS, w.tolerance);
    }
}

START_TEST(gaps_of_twice_the_tolerance_stay_open)
{
    try_all(leave_gaps);
}
END_TEST

static void look_in_front(const wall *plan)
{
    wall w = *plan;
    look_ahead(&w, WORLD_PERSPECTIVE);
    put_panel(&w, place(&w, 0, 0, w.ahead, 0.3 * w.ahead, 0));
    for (int i = 0; i < 8; i++) { // before the wall, in it, and beside it, but for a little
        double aside = i & 1 ? 0.3 : 0.1, depth = 1e-3 * (1 + (i >> 1)) * w.ahead;
        double at = w.ahead - (i & 2 ? 1.01 : 0.5) * depth;
        w.objects[w.objects_count++] =
            place(&w, aside * w.ahead, 0, at, 1e-3 * w.tolerance * w.ahead, depth);
    }
    for (int m = 0; m < 3; m++)
        ck_assert_uint_eq(count_seen(&w, methods[m], w.tolerance), w.objects_count);
}

START_TEST(what_is_in_front_of_an_occluder_is_seen_at_any_tolerance)
{
    try_all(look_in_front);
}
END_TEST

// A sheet seen edge-on shows nothing, and nothing grows out of it.
START_TEST(a_sheet_seen_edge_on_hides_nothing_at_any_tolerance)
{
    for (int i = 0; i < 4; i++) {
        wall w = {.scale = 1, .ahead = 10, .tolerance = tolerances[i]};
        look_ahead(&w, WORLD_PERSPECTIVE);
        occ_box sheet = place(&w, 0, 0, 10, 3, 3);
        sheet.axis[1][1] = 0; // in the plane of the eye
        put_panel(&w, sheet);
        w.objects[w.objects_count++] = place(&w, 0, 0, 30, 1e-4, 1e-4);
        w.objects[w.objects_count++] = place(&w, 0, 1e-3, 30, 1e-4, 1e-4);
        for (int m = 0; m < 3; m++)
            ck_assert_uint_eq(count_seen(&w, methods[m], w.tolerance), 2);
    }
}
END_TEST

START_TEST(an_orthographic_camera_knows_no_tolerance)
{
    wall w = {.scale = 1, .ahead = 1};
    build(&w, 1e-4);
    look_ahead(&w, WORLD_ORTHOGRAPHIC);
    for (int i = 0; i < 4; i++)
        ck_assert_uint_eq(count_seen(&w, OCC_METHOD_FUSED, tolerances[i]),
                          count_seen(&w, OCC_METHOD_FUSED, 0));
    ck_assert_uint_gt(count_seen(&w, OCC_METHOD_FUSED, 0), 0);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("tolerance gaps");
    TCase *by_hand = tcase_create("by hand");
    tcase_add_test(by_hand, gaps_of_a_quarter_of_the_tolerance_are_closed);
    tcase_add_test(by_hand, gaps_of_twice_the_tolerance_stay_open);
    tcase_add_test(by_hand, what_is_in_front_of_an_occluder_is_seen_at_any_tolerance);
    tcase_add_test(by_hand, a_sheet_seen_edge_on_hides_nothing_at_any_tolerance);
    tcase_add_test(by_hand, an_orthographic_camera_knows_no_tolerance);
    suite_add_tcase(suite, by_hand);
    return test_run_suite(suite);
}
