// SPDX-License-Identifier: Apache-2.0
// The judge of many occluders against dense sampling in double. A sample is seen if its segment to
// the eye misses every occluder though each is made a little larger.
// labels: property oracle
// timeout: 120
#include "judge.h"

#include "support.h"
#include "worlds.h"

#include <math.h>

enum { MOST_OCCLUDERS = 16, SAMPLES = 4000 };

#define GROWTH (1.0 + 1e-6)

// --- boxes in double -----------------------------------------------------------------------------

// Rows that take (x - center) to coordinates that run over ±1 in the box.
typedef struct frame {
    double center[3], axis[3][3], row[3][3];
} frame;

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int j = 0; j < 3; j++) {
        int p = (j + 1) % 3, q = (j + 2) % 3;
        out[j] = a[p] * b[q] - a[q] * b[p];
    }
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// A sheet gets a thickness of 1e-7.
static frame frame_of(const occ_box *box)
{
    frame f;
    for (int j = 0; j < 3; j++) {
        f.center[j] = (double)box->center[j];
        for (int k = 0; k < 3; k++)
            f.axis[k][j] = (double)box->axis[k][j];
    }
    for (int k = 0; k < 3; k++) {
        if (dot(f.axis[k], f.axis[k]) > 0.0) continue;
        cross(f.axis[(k + 1) % 3], f.axis[(k + 2) % 3], f.axis[k]);
        double length = sqrt(dot(f.axis[k], f.axis[k]));
        for (int j = 0; j < 3; j++)
            f.axis[k][j] *= 1e-7 / length;
    }
    for (int k = 0; k < 3; k++) {
        cross(f.axis[(k + 1) % 3], f.axis[(k + 2) % 3], f.row[k]);
        double volume = dot(f.row[k], f.axis[k]);
        for (int j = 0; j < 3; j++)
            f.row[k][j] /= volume;
    }
    return f;
}

// What of the line p + t d, low <= t <= high, the grown box holds.
static bool clip_line(const frame *f, double growth, const double p[3], const double d[3],
                      double *low, double *high)
{
    double from[3] = {p[0] - f->center[0], p[1] - f->center[1], p[2] - f->center[2]};
    for (int k = 0; k < 3; k++) {
        double at = dot(f->row[k], from), slope = dot(f->row[k], d);
        double a = (-growth - at) / slope, b = (growth - at) / slope;
        if (slope == 0.0 && fabs(at) > growth) return false;
        if (slope == 0.0) continue;
        *low = fmax(*low, fmin(a, b));
        *high = fmin(*high, fmax(a, b));
    }
    return *low <= *high;
}

static bool is_clear(const frame *occluders, int count, double growth, const double p[3],
                     const double d[3], double end)
{
    for (int i = 0; i < count; i++) {
        double low = 0.0, high = end;
        if (clip_line(&occluders[i], growth, p, d, &low, &high)) return false;
    }
    return true;
}

static bool holds(const frame *f, double growth, const double p[3])
{
    static const double nowhere[3];
    double low = 0.0, high = 1.0;
    return clip_line(f, growth, p, nowhere, &low, &high);
}

// --- scenes --------------------------------------------------------------------------------------

typedef struct world {
    double eye[3];
    int count;
    occ_box boxes[MOST_OCCLUDERS];
    frame frames[MOST_OCCLUDERS];
} world;

static const world_shape shapes[] = {WORLD_ALIGNED, WORLD_TURNED, WORLD_SHEARED, WORLD_MIRRORED,
                                     WORLD_SHEET};

static occ_box any_box(kit_random *random, double reach, double size)
{
    double center[3];
    for (int j = 0; j < 3; j++)
        center[j] = world_between(random, -reach, reach);
    return world_box(random, shapes[kit_below(random, 5)], center, size);
}

static world any_world(kit_random *random)
{
    world w = {.count = 4 + (int)kit_below(random, 12)};
    world_direction(random, w.eye);
    for (int j = 0; j < 3; j++)
        w.eye[j] = (double)(float)(w.eye[j] * 12.0);
    for (int i = 0; i < w.count; i++) {
        do {
            w.boxes[i] = any_box(random, 3, world_between(random, 1, 4));
            w.frames[i] = frame_of(&w.boxes[i]);
        } while (holds(&w.frames[i], GROWTH, w.eye));
    }
    return w;
}

// Behind the occluders, mostly.
static occ_box any_object(kit_random *random, const world *w)
{
    occ_box object = any_box(random, 3, world_between(random, 0.5, 3));
    for (int j = 0; j < 3; j++)
        object.center[j] -= (float)(0.5 * w->eye[j]);
    return object;
}

// --- shares of faces -----------------------------------------------------------------------------

// The part that is seen of the faces towards the eye.
static double sample_share(kit_random *random, const world *w, const occ_box *object)
{
    double area[6], whole = 0.0, seen = 0.0, to_eye[3];
    frame f = frame_of(object);
    for (int j = 0; j < 3; j++)
        to_eye[j] = w->eye[j] - f.center[j];
    for (int face = 0; face < 6; face++) {
        double normal[3], end = face % 2 ? 1.0 : -1.0;
        int k = face / 2;
        cross(f.axis[(k + 1) % 3], f.axis[(k + 2) % 3], normal);
        area[face] = sqrt(dot(normal, normal));
        if (end * dot(f.row[k], to_eye) <= 1.0) area[face] = 0.0;
        whole += area[face];
    }
    for (int i = 0; i < SAMPLES; i++) {
        int face = 0;
        double left = world_between(random, 0, whole), p[3], d[3];
        for (; face < 5 && left >= area[face]; face++)
            left -= area[face];
        double s = world_between(random, -1, 1), t = world_between(random, -1, 1);
        int k = face / 2;
        for (int j = 0; j < 3; j++) {
            p[j] = f.center[j] + (face % 2 ? 1.0 : -1.0) * f.axis[k][j] +
                   s * f.axis[(k + 1) % 3][j] + t * f.axis[(k + 2) % 3][j];
            d[j] = w->eye[j] - p[j];
        }
        seen += is_clear(w->frames, w->count, GROWTH, p, d, 1.0);
    }
    return seen / SAMPLES;
}

// The point that the judge names is in the object, and no occluder made a little smaller is before
// it.
static void check_witness(const judge *j, const world *w, const frame *object)
{
    double p[3], d[3];
    KIT_CHECK(judge_witness(j, p), "seen, but nowhere");
    for (int i = 0; i < 3; i++)
        d[i] = w->eye[i] - p[i];
    KIT_CHECK(holds(object, GROWTH, p), "the witness is not in the object");
    KIT_CHECK(is_clear(w->frames, w->count, 2.0 - GROWTH, p, d, 1.0), "the witness is not seen");
}

START_TEST(shares_agree_with_samples_of_faces)
{
    kit_random random = {21};
    unsigned hidden = 0, partly = 0;
    double worst = 0.0;
    for (int i = 0; i < WORLD_SHARE(150); i++) {
        world w = any_world(&random);
        judge *j = judge_of_eye(w.eye);
        judge_set_occluders(j, w.boxes, NULL, (size_t)w.count);
        for (int k = 0; k < 6; k++) {
            occ_box object = any_object(&random, &w);
            frame f = frame_of(&object);
            if (holds(&f, GROWTH, w.eye)) continue;
            double share = judge_share(j, &object, -1),
                   sampled = sample_share(&random, &w, &object);
            bool seen = judge_sees(j, &object, -1);
            if (seen) check_witness(j, &w, &f);
            KIT_CHECK(seen == (share > 0.0), "share %g", share);
            KIT_CHECK(seen || sampled == 0.0, "said hidden, but %g of it is seen", sampled);
            KIT_CHECK(share < 0.01 || sampled > 0.0, "%g of it is seen, but no sample", share);
            worst = fmax(worst, fabs(share - sampled));
            hidden += !seen;
            partly += share > 0.01 && share < 0.99;
        }
        judge_free(j);
    }
    ck_assert_double_lt(worst, 5.0 * 0.5 / sqrt(SAMPLES)); // five standard deviations
    ck_assert_uint_gt(hidden, WORLD_SHARE(60));
    ck_assert_uint_gt(partly, WORLD_SHARE(60));
}
END_TEST

// --- cameras -------------------------------------------------------------------------------------

// Clip planes, as n.x + d; 4: near.
typedef struct frustum {
    double plane[6][4];
} frustum;

static frustum frustum_of(const occ_camera_desc *camera)
{
    frustum out;
    for (int p = 0; p < 6; p++)
        for (int c = 0; c < 4; c++) {
            const float *column = camera->view_projection + 4 * c;
            double w = (double)column[3], other = (double)column[p / 2];
            out.plane[p][c] = p % 2 ? w - other : w + other;
        }
    return out;
}

static double value(const double plane[4], const double p[3])
{
    return dot(plane, p) + plane[3];
}

// Samples the object's volume within the frustum, carries each to where its line of sight comes
// out of the object or through the near plane, and counts those that are seen from there.
static int sample_volume(kit_random *random, const world *w, const frustum *view,
                         const occ_box *object)
{
    frame f = frame_of(object);
    int seen = 0;
    for (int i = 0; i < SAMPLES; i++) {
        double p[3], d[3], low = 0.0, high = 1.0;
        for (int j = 0; j < 3; j++)
            p[j] = f.center[j];
        for (int k = 0; k < 3; k++) {
            double s = world_between(random, -1, 1);
            for (int j = 0; j < 3; j++)
                p[j] += s * f.axis[k][j];
        }
        bool inside = true;
        for (int k = 0; k < 6; k++)
            inside = inside && value(view->plane[k], p) > 1e-4;
        if (!inside) continue;
        for (int j = 0; j < 3; j++)
            d[j] = w->eye[j] - p[j];
        double at = value(view->plane[4], p), end = value(view->plane[4], w->eye);
        end = at / (at - end); // there it meets the near plane
        clip_line(&f, 1.0, p, d, &low, &high);
        high = fmin(high, end) * (1.0 - 1e-6);
        for (int j = 0; j < 3; j++)
            p[j] += high * d[j];
        seen += is_clear(w->frames, w->count, GROWTH, p, d, (end - high) * (1.0 + 1e-6));
    }
    return seen;
}

START_TEST(what_samples_see_in_a_frustum_is_seen)
{
    kit_random random = {22};
    unsigned hidden = 0, partly = 0, missed = 0;
    for (int i = 0; i < WORLD_SHARE(150); i++) {
        world w = any_world(&random);
        float eye[3], target[3];
        for (int j = 0; j < 3; j++) {
            eye[j] = (float)w.eye[j];
            target[j] = kit_between(&random, -3, 3);
        }
        world_lens lens = {.near_z = i % 2 ? 0.5f : 9.0f};
        occ_camera_desc camera = world_camera(eye, target, &lens);
        camera.eye = w.eye;
        frustum view = frustum_of(&camera);
        judge *j = judge_of_camera(&camera);
        judge_set_occluders(j, w.boxes, NULL, (size_t)w.count);
        for (int k = 0; k < 6; k++) {
            occ_box object = any_object(&random, &w);
            bool seen = judge_sees(j, &object, -1);
            double share = judge_share(j, &object, -1);
            int samples = sample_volume(&random, &w, &view, &object);
            KIT_CHECK(seen || !samples, "said hidden, but %d samples are seen", samples);
            KIT_CHECK(share < 0.05 || samples, "%g of it is seen, but no sample", share);
            hidden += !seen;
            partly += share > 0.01 && share < 0.99;
            missed += seen && !samples;
        }
        judge_free(j);
    }
    ck_assert_uint_gt(hidden, WORLD_SHARE(60));
    ck_assert_uint_gt(partly, WORLD_SHARE(60));
    ck_assert_uint_lt(missed, WORLD_SHARE(60)); // seen by slivers alone
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("judge_samples");
    TCase *faces = tcase_create("faces");
    tcase_add_test(faces, shares_agree_with_samples_of_faces);
    suite_add_tcase(suite, faces);
    TCase *frusta = tcase_create("frusta");
    tcase_add_test(frusta, what_samples_see_in_a_frustum_is_seen);
    suite_add_tcase(suite, frusta);
    return test_run_suite(suite);
}
