// SPDX-License-Identifier: Apache-2.0
// labels: property
// The sampling oracle against one that takes every ray to every face of every box, and its tree
// against taking every solid.
#include "kit.h"
#include "support.h"
#include "truth_sample.h"
#include "truth_tree.h"

#include <math.h>
#include <stdlib.h>

enum { WIDTH = 50, HEIGHT = 34, OBJECTS = 60, OCCLUDERS = 20, SHEETS = 16, SCENES = 12 };

typedef struct line {
    double from[3], along[3];
} line;

static double determinant(const double *a, const double *b, const double *c)
{
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
}

// Widens low..high by where the line meets a face: from + t along = middle + i u + j v.
static void meet_face(const line *ray, const occ_box *box, int face, double *low, double *high)
{
    int k = face / 2;
    double u[3], v[3], to[3], side = face & 1 ? 1 : -1, minus[3];
    for (int j = 0; j < 3; j++) {
        u[j] = (double)box->axis[(k + 1) % 3][j];
        v[j] = (double)box->axis[(k + 2) % 3][j];
        to[j] = (double)box->center[j] + side * (double)box->axis[k][j] - ray->from[j];
        minus[j] = -ray->along[j];
    }
    double whole = determinant(minus, u, v);
    if (whole == 0) return;
    if (fabs(determinant(minus, to, v)) > fabs(whole)) return;
    if (fabs(determinant(minus, u, to)) > fabs(whole)) return;
    double t = -determinant(to, u, v) / whole;
    *low = fmin(*low, t);
    *high = fmax(*high, t);
}

static void meet_box(const line *ray, const occ_box *box, double *low, double *high)
{
    *low = INFINITY;
    *high = -INFINITY;
    for (int face = 0; face < 6; face++)
        meet_face(ray, box, face, low, high);
}

// Widens low..high by where the line meets a triangle: from + t along = a + i (b - a) + j (c - a).
static void meet_triangle(const line *ray, const occ_sheet *sheet, uint32_t c, double *low,
                          double *high)
{
    double u[3], v[3], to[3], minus[3];
    for (int j = 0; j < 3; j++) {
        double corner = (double)sheet->corner[0][j];
        u[j] = (double)sheet->corner[c - 1][j] - corner;
        v[j] = (double)sheet->corner[c][j] - corner;
        to[j] = ray->from[j] - corner;
        minus[j] = -ray->along[j];
    }
    double whole = determinant(minus, u, v);
    if (whole == 0 || (sheet->sides == OCC_SIDES_FRONT && whole < 0)) return;
    double i = determinant(minus, to, v) / whole, j = determinant(minus, u, to) / whole;
    if (i < 0 || j < 0 || i + j > 1) return;
    double t = determinant(to, u, v) / whole;
    *low = fmin(*low, t);
    *high = fmax(*high, t);
}

// The part of a ray before any occluder of another owner.
static double free_length(const obs_scene *scene, const line *ray, uint32_t object, double near_t)
{
    double limit = INFINITY, low, high;
    for (uint32_t i = 0; i < scene->occluder_count; i++) {
        if (scene->occluders[i].owner == object) continue;
        meet_box(ray, &scene->occluders[i].box, &low, &high);
        if (low <= high && low >= near_t) limit = fmin(limit, low);
    }
    for (uint32_t i = 0; i < scene->sheet_count; i++)
        for (uint32_t c = 2; c < scene->sheets[i].sheet.corner_count; c++) {
            low = INFINITY;
            high = -INFINITY;
            if (scene->sheets[i].owner != object)
                meet_triangle(ray, &scene->sheets[i].sheet, c, &low, &high);
            if (low <= high && low >= near_t) limit = fmin(limit, low);
        }
    return limit;
}

static bool sees(const obs_scene *scene, const line *ray, uint32_t object, double near_t,
                 double far_t)
{
    double low, high;
    meet_box(ray, &scene->objects[object], &low, &high);
    double at = fmax(low, near_t);
    if (low > high || at > fmin(high, far_t)) return false;
    return at <= free_length(scene, ray, object, near_t);
}

// Every fourth box is flat.
static occ_box random_box(kit_random *random, float reach, float size)
{
    occ_box box = kit_box(random, reach, size);
    for (int j = 0; j < 3 && kit_below(random, 4) == 0; j++)
        box.axis[2][j] = 0;
    return box;
}

// Corners in order around a middle, half of the sheets bent.
static occ_sheet random_sheet(kit_random *random)
{
    const occ_box frame = kit_box(random, 12, 3);
    occ_sheet sheet = {.corner_count = 3 + kit_below(random, 6),
                       .sides = (occ_sides)kit_below(random, 2)};
    float bend = kit_below(random, 2) ? 0.0f : 0.5f;
    for (uint32_t c = 0; c < sheet.corner_count; c++) {
        double angle = 6.28 * (c + 0.9 * (double)kit_between(random, 0, 1)) / sheet.corner_count;
        float u = (float)cos(angle), v = (float)sin(angle), w = bend * kit_between(random, -1, 1);
        for (int j = 0; j < 3; j++)
            sheet.corner[c][j] = frame.center[j] + u * frame.axis[0][j] + v * frame.axis[1][j] +
                                 w * frame.axis[2][j];
    }
    return sheet;
}

static void make_scene(obs_scene *scene, uint64_t seed)
{
    static const double directions[4][3] = {{0, 0, -1}, {1, 0, 0}, {0, 0, 1}, {-1, 0, 0}};
    kit_random random = {seed};
    double eye[3];
    for (int j = 0; j < 3; j++)
        eye[j] = (double)kit_between(&random, -2, 2);
    obs_frame frame = obs_look(eye, directions[seed % 4], 1, 1, 0.125, 24);
    obs_add_frame(scene, &frame);
    for (int i = 0; i < OBJECTS; i++) {
        occ_box box = random_box(&random, 20, 1.5f);
        obs_add_object(scene, &box);
    }
    for (int i = 0; i < OCCLUDERS; i++) {
        occ_box box = random_box(&random, 12, 2);
        obs_add_occluder(scene, &box, kit_below(&random, OBJECTS));
    }
    for (int i = 0; seed % 3 > 0 && i < SHEETS; i++) {
        occ_sheet sheet = random_sheet(&random);
        obs_add_sheet(scene, &sheet, kit_below(&random, OBJECTS));
    }
}

static line ray_of(const obs_frame *frame, int x, int y)
{
    line ray;
    for (int j = 0; j < 3; j++) {
        double side = (double)frame->view[4 * j], up = (double)frame->view[4 * j + 1];
        ray.from[j] = (double)frame->eye[j];
        ray.along[j] = side * ((2 * x + 1.0) / WIDTH - 1) + up * ((2 * y + 1.0) / HEIGHT - 1) -
                       (double)frame->view[4 * j + 2];
    }
    return ray;
}

START_TEST(every_sample_agrees_with_brute_force)
{
    obs_scene scene = {0};
    truth_verdict verdicts[OBJECTS];
    make_scene(&scene, (uint64_t)_i);
    ck_assert_ptr_null(truth_sample(&scene, 0, WIDTH, HEIGHT, verdicts));
    uint32_t seen = 0;
    for (uint32_t object = 0; object < OBJECTS; object++) {
        uint32_t expected = 0;
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            line ray = ray_of(&scene.frames[0], i % WIDTH, i / WIDTH);
            expected += sees(&scene, &ray, object, 0.125, 24);
        }
        KIT_CHECK(verdicts[object].samples == expected, "object %u: %u samples, expected %u",
                  object, verdicts[object].samples, expected);
        KIT_CHECK(expected == 0 || verdicts[object].flags, "object %u is in the frustum", object);
        seen += expected > 0;
    }
    ck_assert_uint_gt(seen, 0);
    obs_free(&scene);
}
END_TEST

START_TEST(tree_finds_a_solid_where_there_is_one)
{
    enum { SOLIDS = 500, RAYS = 2000 };
    kit_random random = {77};
    truth_solid *solids = calloc(SOLIDS + TRUTH_MAX_SOLIDS + 1, sizeof *solids);
    ck_assert_ptr_nonnull(solids);
    truth_view view = {.height = 1};
    uint32_t count = 0, hits = 0;
    while (count < SOLIDS) {
        occ_box box = random_box(&random, 20, 1);
        int made = truth_solids_of(&view, &box, solids + count);
        for (int i = 0; i < made; i++)
            solids[count++].owner = kit_below(&random, 3);
        occ_sheet sheet = random_sheet(&random);
        if (truth_triangle_of(&view, &sheet, 0, &solids[count]))
            solids[count++].owner = kit_below(&random, 3);
    }
    truth_tree tree;
    ck_assert(truth_tree_make(&tree, solids, count));
    for (int r = 0; r < RAYS; r++) {
        truth_query query = {.low = 0.1, .high = 1, .owner = kit_below(&random, 4)};
        for (int j = 0; j < 3; j++) {
            query.origin[j] = (double)kit_between(&random, -20, 20);
            query.direction[j] = (double)kit_between(&random, -20, 20);
        }
        uint32_t expected = 0, found = truth_tree_find(&tree, &query);
        for (uint32_t i = 0; i < count; i++)
            expected += solids[i].owner != query.owner &&
                        truth_enter(&solids[i], query.origin, query.direction, 0.1, 1) < INFINITY;
        KIT_CHECK((found != TRUTH_NONE) == (expected > 0), "ray %d meets %u solids", r, expected);
        hits += expected > 0;
    }
    ck_assert_uint_gt(hits, RAYS / 20);
    ck_assert_uint_lt(hits, RAYS - RAYS / 20);
    truth_tree_free(&tree);
    free(solids);
}
END_TEST

START_TEST(larger_viewport_keeps_every_visible_object)
{
    obs_scene scene = {0};
    truth_verdict small[OBJECTS], large[OBJECTS];
    make_scene(&scene, (uint64_t)_i);
    ck_assert_ptr_null(truth_sample(&scene, 0, WIDTH, HEIGHT, small));
    ck_assert_ptr_null(truth_sample(&scene, 0, 3 * WIDTH, 3 * HEIGHT, large));
    for (int i = 0; i < OBJECTS; i++) {
        KIT_CHECK(small[i].flags == large[i].flags, "object %d is in one frustum", i);
        // The middle one of nine samples is the old one.
        KIT_CHECK(large[i].samples >= small[i].samples, "object %d: %u and %u samples", i,
                  small[i].samples, large[i].samples);
    }
    obs_free(&scene);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("truth_brute");
    TCase *samples = tcase_create("samples");
    tcase_add_loop_test(samples, every_sample_agrees_with_brute_force, 0, SCENES);
    tcase_add_loop_test(samples, larger_viewport_keeps_every_visible_object, 0, SCENES);
    suite_add_tcase(suite, samples);
    TCase *tree = tcase_create("tree");
    tcase_add_test(tree, tree_finds_a_solid_where_there_is_one);
    suite_add_tcase(suite, tree);
    return test_run_suite(suite);
}
