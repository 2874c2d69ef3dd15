// SPDX-License-Identifier: Apache-2.0
// labels: unit property oracle
// timeout: 300
// The angular tolerance. What it hides although it can be seen must be hidden for the judge as well
// once that has the very planes that the tolerance allows: these are no more than atan(tolerance /
// 2) outside of the silhouette planes, and stop at the same faces. That covers all that is seen of
// the object, and with exact numbers. It says nothing of how far corners may move: for that, the
// point at which the judge sees the object has to be near an occluder's outline.
#include "judge.h"
#include "sight.h"
#include "support.h"
#include "worlds.h"

#include <math.h>
#include <stdio.h>

enum { MOST = 24 };

typedef struct stage {
    double tolerance, scale, eye[3];
    occ_preset preset;
    occ_camera_desc camera;
    occ_box objects[MOST], boxes[MOST];
    world_occluder occluders[MOST];
    int owners[MOST];
    uint32_t object_count, occluder_count;
} stage;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int j = 0; j < 3; j++) {
        int p = (j + 1) % 3, q = (j + 2) % 3;
        out[j] = a[p] * b[q] - a[q] * b[p];
    }
}

static void cull_into(bool seen[MOST], const stage *s, const occ_scene *scene, occ_view *view,
                      occ_method method, double tolerance)
{
    occ_cull_desc knobs = world_knobs(method);
    knobs.preset = s->preset;
    knobs.tolerance = (float)tolerance;
    kit_cull(view, scene, &s->camera, &knobs);
    for (uint32_t i = 0; i < s->object_count; i++)
        seen[i] = world_sees(view, i);
}

// Whether a point that is seen is next to an occluder that may not hide it, but that the tolerance
// makes hide it: no farther than the corner of a square would move.
static bool is_next_to_outline(const stage *s, const double point[3], int self)
{
    double x[3], at[3], length;
    for (int j = 0; j < 3; j++)
        at[j] = point[j] - s->eye[j];
    length = sqrt(dot(at, at));
    for (int j = 0; j < 3; j++)
        x[j] = at[j] / length;
    for (uint32_t i = 0; i < s->occluder_count; i++) {
        if (s->owners[i] == self || !sight_is_behind(s->eye, &s->boxes[i], at)) continue;
        if (sight_sine(s->eye, &s->boxes[i], x) <= s->tolerance * sqrt(0.5) + 1e-6) return true;
    }
    return false;
}

// --- at random -----------------------------------------------------------------------------------

// Of the objects in the frustum: what cannot be seen, how much of that was found without and with
// tolerance, and what is hidden although it can be seen.
typedef struct tally {
    unsigned hidden, found, found_wide, wrong, worlds, grown;
} tally;

typedef struct bench {
    judge *judge, *wide;
    bool has_grown;
    occ_view *view;
} bench;

static void check_wrong(const stage *s, const bench *b, int number, uint32_t i)
{
    double witness[3];
    KIT_CHECK(!b->has_grown || !judge_sees(b->wide, &s->objects[i], (int)i),
              "world %d: object %u is hidden, but seen past the widened occluders", number, i);
    KIT_CHECK(judge_witness(b->judge, witness) && is_next_to_outline(s, witness, (int)i),
              "world %d: object %u is hidden, but seen far from all outlines", number, i);
}

static void try_method(const stage *s, const bench *b, int number, occ_method method, tally *sum)
{
    bool seen[MOST], wide[MOST];
    occ_scene *scene = world_scene(s->objects, s->object_count, s->occluders, s->occluder_count, 4);
    cull_into(seen, s, scene, b->view, method, 0.0);
    cull_into(wide, s, scene, b->view, method, s->tolerance);
    for (uint32_t i = 0; i < s->object_count; i++) {
        if (judge_frustum(b->judge, &s->objects[i]) == JUDGE_OUTSIDE) continue;
        bool truth = judge_sees(b->judge, &s->objects[i], (int)i);
        KIT_CHECK(!truth || seen[i], "world %d: object %u is hidden without tolerance", number, i);
        if (truth && !wide[i]) check_wrong(s, b, number, i);
        sum->hidden += !truth;
        sum->found += !truth && !seen[i];
        sum->found_wide += !truth && !wide[i];
        sum->wrong += truth && !wide[i];
    }
    occ_scene_destroy(scene);
}

static void judge_stage(const stage *s, occ_view *view, int number, tally *sum)
{
    static const occ_method methods[] = {OCC_METHOD_SINGLE, OCC_METHOD_FUSED, OCC_METHOD_PAIRWISE};
    bench b = {.judge = judge_of_camera(&s->camera), .wide = judge_of_camera(&s->camera)};
    ck_assert(b.judge && b.wide);
    judge_set_occluders(b.judge, s->boxes, s->owners, s->occluder_count);
    judge_set_occluders(b.wide, s->boxes, s->owners, s->occluder_count);
    b.has_grown = judge_grow(b.wide, 0.5 * (double)(float)s->tolerance + 1e-12);
    b.view = view;
    sum->worlds++;
    sum->grown += b.has_grown;
    for (int m = 0; m < (number % 8 ? 2 : 3); m++)
        try_method(s, &b, number, methods[m], sum);
    judge_free(b.judge);
    judge_free(b.wide);
}

static void put_occluder(stage *s, occ_box box, int owner)
{
    s->boxes[s->occluder_count] = box;
    s->owners[s->occluder_count] = owner;
    s->occluders[s->occluder_count++] = (world_occluder){box, owner};
}

// At any scale from 1e-3 to 1e3, up to a hundred times that away from the origin, looking down -z.
static void any_stage(kit_random *random, stage *s)
{
    static const double tolerances[] = {1e-4, 1e-3, 1e-2, 0.1};
    *s = (stage){.tolerance = tolerances[kit_below(random, 4)],
                 .scale = world_scale(random, 1e-3, 1e3),
                 .preset = (occ_preset)kit_below(random, 3)};
    double away = kit_below(random, 2) ? s->scale * world_scale(random, 0.1, 100) : 0.0, offset[3];
    world_direction(random, offset);
    float eye[3], target[3];
    for (int j = 0; j < 3; j++) {
        eye[j] = (float)(away * offset[j]);
        s->eye[j] = (double)eye[j];
        target[j] = (float)(s->eye[j] + s->scale * world_between(random, -0.2, 0.2));
    }
    target[2] = (float)(s->eye[2] - s->scale);
    world_lens lens = {.projection = (world_projection)kit_below(random, WORLD_ORTHOGRAPHIC),
                       .depth = (occ_depth)kit_below(random, 3),
                       .height = 1.2f,
                       .near_z = (float)(1e-3 * s->scale),
                       .far_z = (float)(1e4 * s->scale)};
    s->camera = world_camera(eye, target, &lens);
}

// The point in a direction (right, up, ahead) from the eye.
static void at_from_eye(const stage *s, double right, double up, double ahead, double out[3])
{
    out[0] = s->eye[0] + s->scale * right;
    out[1] = s->eye[1] + s->scale * up;
    out[2] = s->eye[2] - s->scale * ahead;
}

// Small objects behind the occluders' corners and edges and next to them, and some anywhere.
static void put_objects(kit_random *random, stage *s)
{
    for (s->object_count = 0; s->object_count < MOST; s->object_count++) {
        double center[3], size, beyond = world_scale(random, 1.01, 4);
        const occ_box *box = &s->boxes[kit_below(random, s->occluder_count)];
        double corner[2][3], between = kit_below(random, 2) ? world_between(random, 0, 1) : 0.0;
        unsigned first = kit_below(random, 8), axis = kit_below(random, 3);
        world_corner(box, first, corner[0]);
        world_corner(box, first ^ 1u << axis, corner[1]);
        double ray[3], aside[3], length;
        for (int j = 0; j < 3; j++)
            ray[j] = corner[0][j] + between * (corner[1][j] - corner[0][j]) - s->eye[j];
        length = sqrt(dot(ray, ray));
        world_direction(random, aside);
        double off = s->tolerance * world_between(random, 0, 2);
        for (int j = 0; j < 3; j++)
            center[j] = s->eye[j] + beyond * (ray[j] + off * length * aside[j]);
        size = beyond * length * s->tolerance * world_scale(random, 0.02, 1);
        if (kit_below(random, 4) == 0) {
            at_from_eye(s, world_between(random, -6, 6), world_between(random, -4, 4),
                        world_between(random, 4, 30), center);
            size = s->scale * world_scale(random, 0.01, 2);
        }
        s->objects[s->object_count] =
            world_box(random, (world_shape)kit_below(random, WORLD_SHAPES), center, size);
    }
}

// Boxes of all kinds, some near the eye and some far.
static void crowd(kit_random *random, stage *s)
{
    static const world_shape shapes[] = {WORLD_ALIGNED, WORLD_TURNED, WORLD_SHEARED, WORLD_MIRRORED,
                                         WORLD_SHEET,   WORLD_NEEDLE, WORLD_PLATE};
    any_stage(random, s);
    for (int i = 0; i < 16; i++) {
        double center[3], ahead = world_scale(random, 1, 12);
        at_from_eye(s, ahead * world_between(random, -0.8, 0.8),
                    ahead * world_between(random, -0.5, 0.5), ahead, center);
        double size = 0.2 * ahead * s->scale * world_scale(random, 0.1, 1);
        put_occluder(s, world_box(random, shapes[kit_below(random, 7)], center, size),
                     kit_below(random, 4) ? -1 : (int)kit_below(random, MOST));
    }
    put_objects(random, s);
}

// A leaning wall of panels, up to four by four, with gaps of up to three times the tolerance; some
// stand a little forward.
static void panels(kit_random *random, stage *s)
{
    any_stage(random, s);
    int across = 1 + (int)kit_below(random, 4), up = 1 + (int)kit_below(random, 4);
    double ahead = world_scale(random, 0.3, 10), lean = world_between(random, -0.5, 0.5);
    double wide = 1.2 * ahead / across, high = 0.8 * ahead / up;
    double gap = ahead * s->tolerance * world_between(random, -0.5, 3);
    double forward = kit_below(random, 2) ? 0.05 * ahead : 0.0;
    for (int x = 0; x < across; x++)
        for (int y = 0; y < up; y++) {
            double right = (x + 0.5) * wide - 0.6 * ahead + 1e-3 * ahead, center[3];
            at_from_eye(s, right, (y + 0.5) * high - 0.4 * ahead,
                        ahead + lean * right + forward * world_between(random, -1, 0), center);
            occ_box box = {{0}, {{0}}};
            for (int j = 0; j < 3; j++)
                box.center[j] = (float)center[j];
            box.axis[0][0] = (float)(0.5 * s->scale * (wide - gap));
            box.axis[0][2] = (float)(-lean * (double)box.axis[0][0]);
            box.axis[1][1] = (float)(0.5 * s->scale * (high - gap));
            box.axis[2][2] = kit_below(random, 2) ? 0.0f : (float)(0.01 * ahead * s->scale);
            put_occluder(s, box, -1);
        }
    put_objects(random, s);
}

// Sheets seen nearly edge-on, a corner first: their outlines end in points as sharp as can be.
static void blades(kit_random *random, stage *s)
{
    any_stage(random, s);
    for (int i = 0; i < 16; i++) {
        double center[3], ray[3], aside[3], up[3], ahead = world_scale(random, 1, 12);
        at_from_eye(s, ahead * world_between(random, -0.8, 0.8),
                    ahead * world_between(random, -0.5, 0.5), ahead, center);
        for (int j = 0; j < 3; j++)
            ray[j] = (center[j] - s->eye[j]) / (ahead * s->scale);
        double turn[3][3], thin = world_scale(random, 1e-5, 0.3),
                           deep = world_scale(random, 0.01, 1);
        world_turn(random, turn);
        cross(ray, turn[0], aside);
        cross(ray, aside, up);
        occ_box box = {{0}, {{0}}};
        for (int j = 0; j < 3; j++) {
            double along = deep * ray[j] + thin * up[j], size = 0.15 * ahead * s->scale;
            box.center[j] = (float)center[j];
            box.axis[0][j] = (float)(size * (aside[j] + along));
            box.axis[1][j] = (float)(size * (aside[j] - along));
            if (kit_below(random, 2)) box.axis[2][j] = (float)(1e-4 * size * turn[1][j]);
        }
        put_occluder(s, box, -1);
    }
    put_objects(random, s);
}

typedef void make_stage(kit_random *random, stage *s);

static tally judge_many(make_stage *make, uint64_t seed, int count)
{
    occ_view *view = world_view(OCC_BACKEND_PLAIN, 0);
    kit_random random = {seed};
    tally sum = {0, 0, 0, 0, 0, 0};
    for (int i = 0; i < count; i++) {
        stage s;
        make(&random, &s);
        judge_stage(&s, view, i, &sum);
    }
    occ_view_destroy(view);
    printf("hidden %u, found %u, with tolerance %u, and %u that can be seen; %u of %u worlds "
           "judged with wider occluders\n",
           sum.hidden, sum.found, sum.found_wide, sum.wrong, sum.grown, sum.worlds);
    ck_assert_uint_gt(sum.found_wide, sum.found);
    ck_assert_uint_gt(sum.grown, sum.worlds - sum.worlds / 10);
    return sum;
}

START_TEST(what_a_crowd_hides_too_much_is_next_to_its_outlines)
{
    tally sum = judge_many(crowd, 91, WORLD_SHARE(1500));
    ck_assert_uint_gt(sum.wrong, sum.worlds);
}
END_TEST

START_TEST(what_panels_hide_too_much_is_next_to_their_seams)
{
    tally sum = judge_many(panels, 92, WORLD_SHARE(1500));
    ck_assert_uint_gt(sum.wrong, sum.worlds);
}
END_TEST

START_TEST(what_blades_hide_too_much_is_not_far_from_their_points)
{
    tally sum = judge_many(blades, 93, WORLD_SHARE(1500));
    ck_assert_uint_gt(sum.wrong, sum.worlds);
}
END_TEST

static void same_on(occ_view *other, make_stage *make, uint64_t seed, int count)
{
    occ_view *plain = world_view(OCC_BACKEND_PLAIN, 0);
    kit_random random = {seed};
    for (int i = 0; other && i < count; i++) {
        stage s;
        bool seen[2][MOST] = {{false}};
        make(&random, &s);
        occ_scene *scene = world_scene(s.objects, s.object_count, s.occluders, s.occluder_count, 4);
        cull_into(seen[0], &s, scene, plain, OCC_METHOD_FUSED, s.tolerance);
        cull_into(seen[1], &s, scene, other, OCC_METHOD_FUSED, s.tolerance);
        KIT_CHECK(kit_same_bits(seen[0], seen[1], sizeof seen[0]), "world %d differs", i);
        occ_scene_destroy(scene);
    }
    occ_view_destroy(plain);
}

START_TEST(openmp_tolerates_as_plain_does)
{
    occ_view *view = world_view(OCC_BACKEND_OPENMP, 2);
    same_on(view, crowd, 94, WORLD_SHARE(1000));
    same_on(view, panels, 95, WORLD_SHARE(1000));
    occ_view_destroy(view);
}
END_TEST

START_TEST(a_device_tolerates_as_plain_does)
{
    occ_view *view = world_view(OCC_BACKEND_OPENCL, 0);
    same_on(view, crowd, 96, WORLD_SHARE(300));
    same_on(view, panels, 97, WORLD_SHARE(300));
    occ_view_destroy(view);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("tolerance");
    TCase *random = tcase_create("random");
    tcase_add_test(random, what_a_crowd_hides_too_much_is_next_to_its_outlines);
    tcase_add_test(random, what_panels_hide_too_much_is_next_to_their_seams);
    tcase_add_test(random, what_blades_hide_too_much_is_not_far_from_their_points);
    suite_add_tcase(suite, random);
    TCase *backends = tcase_create("backends");
    tcase_add_test(backends, openmp_tolerates_as_plain_does);
    tcase_add_test(backends, a_device_tolerates_as_plain_does);
    suite_add_tcase(suite, backends);
    return test_run_suite(suite);
}
