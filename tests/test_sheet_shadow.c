// SPDX-License-Identifier: Apache-2.0
// labels: unit property oracle
// Shadows of sheets. Each plane against the exact one of its edge, or across; and points that a
// shadow holds against the sheet's own triangles, exactly.
#include <gmp.h>

#include "kit_sheets.h"
#include "sheet.h"
#include "sheet_sight.h"
#include "support.h"
#include "vector.h"
#include "verdicts.h"
#include "worlds.h"

#include <stdio.h>

#define U 0x1p-24

// --- sheets and eyes -----------------------------------------------------------------------------

typedef enum sheet_kind {
    KIND_FLAT,   // convex, flat but for what the floats round
    KIND_BENT,   // its corners lie about a plane
    KIND_NOTCH,  // flat, not convex
    KIND_TANGLE, // any points
    KIND_REPEAT, // flat, some corners twice
    KIND_PLANE,  // a parallelogram, exactly
    KINDS
} sheet_kind;

static occ_sheet any_sheet(kit_random *random, sheet_kind kind, double size)
{
    float center[3], across[3];
    uint32_t corners = 3 + kit_below(random, 6);
    if (kind == KIND_PLANE) {
        occ_box box = kit_flat_box(random, 10, 1);
        box = world_scaled(&box, exp2f(rintf(log2f((float)size))));
        return kit_sheet_of_box(&box);
    }
    for (int j = 0; j < 3; j++) {
        center[j] = (float)(size * world_between(random, -10, 10));
        across[j] = (float)(size * world_scale(random, 1e-6, 0.3));
    }
    if (kind == KIND_NOTCH && corners == 3) corners = 4;
    occ_sheet sheet = kit_round_sheet(random, corners, center, (float)size);
    uint32_t chosen = kit_below(random, corners), next = (chosen + 1) % corners;
    for (uint32_t i = 0; i < corners; i++)
        for (int j = 0; j < 3; j++) {
            float *at = &sheet.corner[i][j];
            if (kind == KIND_BENT) *at += kit_between(random, -1, 1) * across[j];
            if (kind == KIND_TANGLE) *at = center[j] + kit_between(random, -1, 1) * (float)size;
            if (kind == KIND_NOTCH && i == chosen) *at = 0.8f * center[j] + 0.2f * *at;
            if (kind == KIND_REPEAT && i == next) *at = sheet.corner[chosen][j];
        }
    if (kit_below(random, 2)) sheet.sides = OCC_SIDES_FRONT;
    return sheet;
}

// What the sheet is seen from: from anywhere, next to its plane, next to the line of an edge, or in
// its plane but for rounding.
static occ_frame any_view(kit_random *random, const occ_sheet *sheet, double size, sight_from *from)
{
    double normal[3], eye[3], along[3], length;
    uint32_t kind = kit_below(random, 5), n = sheet->corner_count, edge = kit_below(random, n);
    occ_sheet_normal(sheet, normal);
    length = sqrt(occ_dot(normal, normal)) + 1e-300;
    world_direction(random, along);
    double away = size * world_scale(random, 0.1, 1e3), off = size * world_scale(random, 1e-14, 1);
    for (int j = 0; j < 3; j++) {
        double at = (double)sheet->corner[edge][j];
        double step = (double)sheet->corner[(edge + 1) % n][j] - at;
        eye[j] = at + away * along[j];
        if (kind == 1) eye[j] -= away * along[j] * (1.0 - 1e-3) - off * normal[j] / length;
        if (kind == 2) eye[j] = at + 7.0 * step + off * along[j];
        if (kind == 3) eye[j] = at - 3.0 * step + along[0] * ((double)sheet->corner[0][j] - at);
    }
    *from = (sight_from){.direction = kit_below(random, 4) == 0};
    occ_frame frame = verdict_frame_at(eye);
    frame.camera.orthographic = from->direction;
    for (int j = 0; j < 3; j++) {
        if (from->direction) frame.camera.toward[j] = eye[j] - (double)sheet->corner[0][j];
        from->at[j] = from->direction ? frame.camera.toward[j] : eye[j];
    }
    return frame;
}

// --- planes --------------------------------------------------------------------------------------

typedef mpq_t rational3[3];

typedef struct workshop {
    rational3 corner[OCC_SHEET_CORNERS], ray, step, n; // relative to the eye
    mpq_t d, part, scale;
    double normal_error, least_inward;
    unsigned planes;
} workshop;

static void open_workshop(workshop *w)
{
    for (int j = 0; j < 3; j++) {
        for (int i = 0; i < OCC_SHEET_CORNERS; i++)
            mpq_init(w->corner[i][j]);
        mpq_inits(w->ray[j], w->step[j], w->n[j], NULL);
    }
    mpq_inits(w->d, w->part, w->scale, NULL);
    w->least_inward = INFINITY;
}

static void close_workshop(workshop *w)
{
    for (int j = 0; j < 3; j++) {
        for (int i = 0; i < OCC_SHEET_CORNERS; i++)
            mpq_clear(w->corner[i][j]);
        mpq_clears(w->ray[j], w->step[j], w->n[j], NULL);
    }
    mpq_clears(w->d, w->part, w->scale, NULL);
}

static void set_corners(workshop *w, const occ_sheet *sheet, const occ_camera *camera)
{
    for (uint32_t i = 0; i < sheet->corner_count; i++)
        for (int j = 0; j < 3; j++) {
            mpq_set_d(w->corner[i][j], (double)sheet->corner[i][j]);
            mpq_set_d(w->part, camera->eye[j]);
            mpq_sub(w->corner[i][j], w->corner[i][j], w->part);
        }
}

static void set_dot(workshop *w, mpq_t out, mpq_t *a, mpq_t *b)
{
    mpq_set_si(out, 0, 1);
    for (int j = 0; j < 3; j++) {
        mpq_mul(w->part, a[j], b[j]);
        mpq_add(out, out, w->part);
    }
}

// The exact plane of an edge, n and d, where the loop is turned by `turn`. False: it has none.
static bool set_edge(workshop *w, const occ_sheet *sheet, const occ_camera *camera, uint32_t i,
                     int turn)
{
    uint32_t next = (i + 1) % sheet->corner_count;
    bool any = false;
    for (int j = 0; j < 3; j++) {
        mpq_sub(w->step[j], w->corner[next][j], w->corner[i][j]);
        any = any || mpq_sgn(w->step[j]) != 0;
        mpq_set(w->ray[j], w->corner[i][j]);
        if (camera->orthographic) mpq_set_d(w->ray[j], -camera->toward[j]);
    }
    for (int j = 0; j < 3; j++) {
        int p = (j + 1) % 3, q = (j + 2) % 3;
        mpq_mul(w->n[j], w->ray[p], w->step[q]);
        mpq_mul(w->part, w->ray[q], w->step[p]);
        mpq_sub(w->n[j], w->n[j], w->part);
        if (turn < 0) mpq_neg(w->n[j], w->n[j]);
    }
    set_dot(w, w->d, w->n, w->corner[i]);
    mpq_neg(w->d, w->d);
    if (!camera->orthographic) mpq_set_si(w->d, 0, 1);
    return any;
}

static int largest_of(const float n[3])
{
    int largest = fabsf(n[1]) > fabsf(n[0]) ? 1 : 0;
    return fabsf(n[2]) > fabsf(n[largest]) ? 2 : largest;
}

// By how many u the normal is off when w->n, times a power of two, is the exact one; w->scale gets
// that power.
static double normal_error(workshop *w, const float plane[4])
{
    int largest = largest_of(plane);
    double exact = mpq_get_d(w->n[largest]), most = 0.0;
    if (exact == 0.0 || (exact < 0.0) != (plane[largest] < 0.0f)) return INFINITY;
    mpq_set_d(w->scale, exp2(round(log2((double)plane[largest] / exact))));
    for (int j = 0; j < 3; j++) {
        double stored = (double)plane[j];
        mpq_mul(w->part, w->n[j], w->scale);
        mpq_t difference;
        mpq_init(difference);
        mpq_set_d(difference, stored);
        mpq_sub(difference, w->part, difference);
        most = fmax(most, fabs(mpq_get_d(difference)));
        mpq_clear(difference);
    }
    return most / U;
}

// How far inward of the exact plane, which has w->d, the stored one lies.
static double inward_by(workshop *w, const float plane[4])
{
    mpq_mul(w->d, w->d, w->scale);
    mpq_set_d(w->part, (double)plane[3]);
    mpq_sub(w->d, w->d, w->part);
    return mpq_get_d(w->d);
}

static void note_plane(workshop *w, const float plane[4], double error, double inward)
{
    double d = fabs((double)plane[3]);
    w->planes++;
    w->normal_error = fmax(w->normal_error, error);
    KIT_CHECK(inward >= (8.0 - 1e-5) * U * d, "inward by %g u|d|", inward / (U * d));
    if (d > 0.0) w->least_inward = fmin(w->least_inward, inward / (U * d));
}

// Every edge has its plane, all turned the same way.
static bool edges_have_planes(workshop *w, const occ_sheet *sheet, const occ_camera *camera,
                              const occ_shadow *shadow, int turn)
{
    uint32_t edges = 0;
    for (uint32_t i = 0; i < sheet->corner_count; i++) {
        double error = INFINITY;
        if (!set_edge(w, sheet, camera, i, turn)) continue;
        edges++;
        const float *found = NULL;
        for (uint32_t p = 0; p < shadow->silhouettes; p++) {
            double its_error = normal_error(w, shadow->plane[p]);
            if (!(its_error < error)) continue;
            error = its_error;
            found = shadow->plane[p];
        }
        if (!(error <= 0.75)) return false;
        (void)normal_error(w, found);
        note_plane(w, found, error, inward_by(w, found));
    }
    return edges == shadow->silhouettes && edges + 1 == shadow->planes;
}

// -1 if the corners go counterclockwise for the eye, else 1.
static int turn_of(workshop *w, const occ_sheet *sheet, const occ_camera *camera)
{
    double normal[3];
    occ_sheet_normal(sheet, normal);
    for (int j = 0; j < 3; j++) {
        mpq_set_d(w->n[j], normal[j]);
        mpq_set(w->ray[j], w->corner[0][j]);
        if (camera->orthographic) mpq_set_d(w->ray[j], -camera->toward[j]);
    }
    set_dot(w, w->d, w->n, w->ray);
    return mpq_sgn(w->d) < 0 ? -1 : 1;
}

// The plane across: the eye before all corners, and what it holds beyond them.
static void check_face(workshop *w, const occ_sheet *sheet, const occ_camera *camera,
                       const occ_shadow *shadow, int turn)
{
    const float *plane = shadow->plane[shadow->planes - 1];
    double normal[3];
    occ_sheet_normal(sheet, normal);
    for (int j = 0; j < 3; j++) {
        mpq_set_d(w->n[j], turn * normal[j]);
        mpq_set_d(w->ray[j], -camera->toward[j]);
    }
    set_dot(w, w->d, w->n, w->ray);
    KIT_CHECK(!camera->orthographic || mpq_sgn(w->d) > 0, "the viewer is behind the sheet");
    double error = normal_error(w, plane), inward = INFINITY;
    KIT_CHECK(error <= 0.75, "the plane across is off by %g u", error);
    for (uint32_t i = 0; i < sheet->corner_count; i++) {
        set_dot(w, w->d, w->n, w->corner[i]);
        KIT_CHECK(camera->orthographic || mpq_sgn(w->d) > 0, "the eye is behind a corner");
        mpq_neg(w->d, w->d);
        inward = fmin(inward, inward_by(w, plane));
    }
    note_plane(w, plane, error, inward);
}

START_TEST(every_plane_is_next_to_the_exact_one_and_inside)
{
    workshop w = {.planes = 0};
    open_workshop(&w);
    kit_random random = {(uint64_t)_i + 11};
    for (int trial = 0; trial < WORLD_SHARE(4000); trial++) {
        double size = world_scale(&random, 1e-6, 1e6);
        occ_sheet sheet = any_sheet(&random, (sheet_kind)_i, size);
        sight_from from;
        occ_frame frame = any_view(&random, &sheet, size, &from);
        occ_shadow shadow;
        if (!occ_shadow_of_sheet(&shadow, &frame.camera, &sheet, OCC_NOBODY)) continue;
        set_corners(&w, &sheet, &frame.camera);
        int turn = turn_of(&w, &sheet, &frame.camera);
        KIT_CHECK(edges_have_planes(&w, &sheet, &frame.camera, &shadow, turn),
                  "trial %d: an edge has no plane", trial);
        KIT_CHECK(turn < 0 || sheet.sides == OCC_SIDES_BOTH, "trial %d: from behind", trial);
        check_face(&w, &sheet, &frame.camera, &shadow, turn);
    }
    printf("%u planes: normals off by up to %.3f u, offsets inward by %.3f u|d| and more\n",
           w.planes, w.normal_error, w.least_inward);
    ck_assert_uint_gt(w.planes, WORLD_SHARE(4000));
    close_workshop(&w);
}
END_TEST

// --- points --------------------------------------------------------------------------------------

typedef struct tally {
    unsigned held, clear, found; // of the points that are hidden with room to spare: found
} tally;

// A point on the line from the eye through one that is next to an edge or well within, beyond it by
// a little or by much. *clear: it is hidden with room to spare, if the sheet is flat and convex.
static void any_point(kit_random *random, const occ_sheet *sheet, const sight_from *from,
                      double point[3], bool *clear)
{
    uint32_t n = sheet->corner_count, i = kit_below(random, n);
    double middle[3] = {0}, t = world_between(random, 0, 1);
    double in =
        kit_below(random, 2) ? world_between(random, 0.3, 0.9) : world_scale(random, 1e-8, 1e-1);
    if (kit_below(random, 6) == 0) in = -in;
    double beyond = world_scale(random, 1e-7, 10.0);
    *clear = in > 0.1 && beyond > 0.1 && t > 0.1 && t < 0.9;
    for (uint32_t k = 0; k < n; k++)
        for (int j = 0; j < 3; j++)
            middle[j] += (double)sheet->corner[k][j] / n;
    for (int j = 0; j < 3; j++) {
        double a = (double)sheet->corner[i][j], b = (double)sheet->corner[i + 1 < n ? i + 1 : 0][j];
        double at = a + t * (b - a);
        at += in * (middle[j] - at);
        point[j] = from->direction ? at - beyond * from->at[j] : at + beyond * (at - from->at[j]);
    }
}

static void check_points(kit_random *random, const occ_frame *frame, const occ_sheet *sheet,
                         const occ_shadow *shadow, const sight_from *from, tally *sum)
{
    for (int k = 0; k < 30; k++) {
        double point[3];
        bool clear;
        occ_box speck = {.center = {0}};
        any_point(random, sheet, from, point, &clear);
        for (int j = 0; j < 3; j++) {
            speck.center[j] = (float)point[j];
            point[j] = (double)speck.center[j];
        }
        occ_relative_box box = occ_frame_relative(frame, &speck);
        bool held = occ_box_in_shadow(&box, shadow->plane[0], shadow->planes);
        sum->held += held;
        sum->clear += clear;
        sum->found += clear && held;
        for (uint32_t fan = 0; held && fan < sheet->corner_count; fan++)
            KIT_CHECK(sight_is_hidden(from, sheet, fan, point),
                      "held, but seen past the triangles around corner %u", fan);
    }
}

START_TEST(what_a_shadow_holds_is_hidden_by_every_surface_of_that_outline)
{
    kit_random random = {(uint64_t)_i + 97};
    tally sum = {0, 0, 0};
    for (int trial = 0; trial < WORLD_SHARE(6000); trial++) {
        double size = world_scale(&random, 1e-3, 1e3);
        occ_sheet sheet = any_sheet(&random, (sheet_kind)_i, size);
        sight_from from;
        occ_frame frame = any_view(&random, &sheet, size, &from);
        occ_shadow shadow;
        if (!occ_shadow_of_sheet(&shadow, &frame.camera, &sheet, OCC_NOBODY)) continue;
        check_points(&random, &frame, &sheet, &shadow, &from, &sum);
    }
    printf("%u points held; %u of %u that are well hidden\n", sum.held, sum.found, sum.clear);
    ck_assert_uint_gt(sum.held, _i == KIND_TANGLE ? WORLD_SHARE(300) : WORLD_SHARE(5000));
    if (_i == KIND_FLAT) ck_assert_uint_gt(sum.found, sum.clear * 8 / 10);
}
END_TEST

// --- tolerance -----------------------------------------------------------------------------------

// The sine of the angle between a direction and the nearest one in which the outline is seen.
static double sine_to_outline(const occ_sheet *sheet, const double eye[3], const double x[3])
{
    double least = 2.0;
    for (uint32_t i = 0; i < sheet->corner_count; i++) {
        double a[3], b[3], n[3], end[2][3];
        for (int j = 0; j < 3; j++) {
            a[j] = (double)sheet->corner[i][j] - eye[j];
            b[j] = (double)sheet->corner[(i + 1) % sheet->corner_count][j] - eye[j];
        }
        occ_cross(a, b, n);
        occ_cross(n, a, end[0]);
        occ_cross(b, n, end[1]);
        if (occ_dot(end[0], x) >= 0.0 && occ_dot(end[1], x) >= 0.0) {
            least = fmin(least, fabs(occ_dot(n, x)) / sqrt(occ_dot(n, n) * occ_dot(x, x)));
            continue;
        }
        for (int k = 0; k < 2; k++) {
            const double *to = k ? b : a;
            double turn[3];
            occ_cross(to, x, turn);
            if (occ_dot(to, x) <= 0.0) continue;
            least = fmin(least, sqrt(occ_dot(turn, turn) / occ_dot(to, to) / occ_dot(x, x)));
        }
    }
    return least;
}

// A point beyond the sheet in a direction that is off an edge by up to twice the tolerance.
static void point_beside(kit_random *random, const occ_sheet *sheet, const double eye[3],
                         double tolerance, double point[3])
{
    uint32_t n = sheet->corner_count, i = kit_below(random, n);
    double t = world_between(random, -0.1, 1.1), off[3], length = 0.0;
    double by = 2.0 * tolerance * world_between(random, 0, 1);
    double beyond = world_scale(random, 1e-3, 10);
    world_direction(random, off);
    for (int j = 0; j < 3; j++) {
        double a = (double)sheet->corner[i][j], b = (double)sheet->corner[i + 1 < n ? i + 1 : 0][j];
        point[j] = a + t * (b - a) - eye[j];
        length += point[j] * point[j];
    }
    for (int j = 0; j < 3; j++)
        point[j] = eye[j] + (1.0 + beyond) * (point[j] + by * sqrt(length) * off[j]);
}

// What is held although it can be seen is no farther from the outline than the tolerance allows;
// and if the outline is not convex for certain, there is nothing of the kind.
START_TEST(tolerance_holds_no_more_than_it_may)
{
    kit_random random = {(uint64_t)_i + 53};
    unsigned wrong = 0, held = 0;
    double farthest = 0.0;
    for (int trial = 0; trial < WORLD_SHARE(6000); trial++) {
        double size = world_scale(&random, 1e-2, 1e2);
        double tolerance = world_scale(&random, 1e-4, 0.1);
        occ_sheet sheet = any_sheet(&random, (sheet_kind)_i, size);
        sight_from from;
        occ_frame frame = any_view(&random, &sheet, size, &from);
        occ_shadow shadow;
        frame.camera.tolerance = tolerance;
        if (from.direction) continue;
        if (!occ_shadow_of_sheet(&shadow, &frame.camera, &sheet, OCC_NOBODY)) continue;
        for (int k = 0; k < 40; k++) {
            double point[3], x[3];
            occ_box speck = {.center = {0}};
            point_beside(&random, &sheet, from.at, tolerance, point);
            for (int j = 0; j < 3; j++) {
                speck.center[j] = (float)point[j];
                point[j] = (double)speck.center[j];
                x[j] = point[j] - from.at[j];
            }
            occ_relative_box box = occ_frame_relative(&frame, &speck);
            if (!occ_box_in_shadow(&box, shadow.plane[0], shadow.planes)) continue;
            held++;
            if (sight_is_hidden(&from, &sheet, 0, point)) continue;
            wrong++;
            double sine = sine_to_outline(&sheet, from.at, x) / tolerance;
            farthest = fmax(farthest, sine);
            KIT_CHECK(sine <= sqrt(0.5) + 1e-5, "a point off by %g of the tolerance is held", sine);
        }
    }
    printf("%u held, %u of them seen, off by up to %.3f of the tolerance\n", held, wrong, farthest);
    ck_assert_uint_gt(held, WORLD_SHARE(500));
    if (_i == KIND_FLAT) ck_assert(wrong > WORLD_SHARE(3000) && farthest > 0.49);
}
END_TEST

static TCase *shadows(void)
{
    TCase *tcase = tcase_create("exact");
    tcase_add_loop_test(tcase, every_plane_is_next_to_the_exact_one_and_inside, 0, KINDS);
    tcase_add_loop_test(tcase, what_a_shadow_holds_is_hidden_by_every_surface_of_that_outline, 0,
                        KINDS);
    tcase_add_loop_test(tcase, tolerance_holds_no_more_than_it_may, 0, KINDS);
    return tcase;
}

int main(void)
{
    Suite *suite = suite_create("sheet_shadow");
    suite_add_tcase(suite, shadows());
    return test_run_suite(suite);
}
