// SPDX-License-Identifier: Apache-2.0
// labels: unit property oracle
// Every plane of a shadow against the exact plane of the edge or face that it stands for: the
// normal as near as docs/accuracy.md says, the offset inward by what it says, and by no more.
#include "exact.h"
#include "support.h"
#include "verdicts.h"
#include "worlds.h"

#include <math.h>
#include <stdio.h>

enum { OCCLUDERS = 40000, WAYS = 12 + 6 };

#define U 0x1p-24

// An occluder relative to the eye, in a unit of 2^-places.
typedef struct exact_solid {
    long places;
    exact3 center, axis[3];
} exact_solid;

// A plane through an edge and the eye, or through a face. n is in 2^-2 places, d in 2^-3 places.
typedef struct exact_plane {
    exact3 n;
    mpz_t d;
    bool has_offset;
} exact_plane;

typedef struct workshop {
    exact_solid solid;
    exact_plane way[WAYS];
    exact3 point;
    mpf_t scaled, part;
    double normal_error, least_inward, most_inward; // the worst so far: in u, in u|d|, of the bound
    unsigned planes;
} workshop;

static void open_workshop(workshop *w)
{
    exact_init(w->solid.center, 3);
    for (int k = 0; k < 3; k++)
        exact_init(w->solid.axis[k], 3);
    for (int i = 0; i < WAYS; i++) {
        exact_init(w->way[i].n, 3);
        mpz_init(w->way[i].d);
    }
    exact_init(w->point, 3);
    mpf_init2(w->scaled, 1024);
    mpf_init2(w->part, 1024);
    w->least_inward = INFINITY;
}

static void close_workshop(workshop *w)
{
    exact_clear(w->solid.center, 3);
    for (int k = 0; k < 3; k++)
        exact_clear(w->solid.axis[k], 3);
    for (int i = 0; i < WAYS; i++) {
        exact_clear(w->way[i].n, 3);
        mpz_clear(w->way[i].d);
    }
    exact_clear(w->point, 3);
    mpf_clear(w->scaled);
    mpf_clear(w->part);
}

static void set_exact_solid(workshop *w, const occ_box *box, const double eye[3])
{
    exact_solid *s = &w->solid;
    s->places = 0;
    for (int j = 0; j < 3; j++) {
        s->places = (long)fmax((double)s->places, (double)exact_places(eye[j]));
        s->places = (long)fmax((double)s->places, (double)exact_places((double)box->center[j]));
        for (int k = 0; k < 3; k++)
            s->places =
                (long)fmax((double)s->places, (double)exact_places((double)box->axis[k][j]));
    }
    for (int j = 0; j < 3; j++) {
        exact_set(s->center[j], (double)box->center[j], s->places);
        exact_set(w->point[j], eye[j], s->places);
        mpz_sub(s->center[j], s->center[j], w->point[j]);
        for (int k = 0; k < 3; k++)
            exact_set(s->axis[k][j], (double)box->axis[k][j], s->places);
    }
}

// The solid's center moved along axes.
static void set_point(workshop *w, const int along[3])
{
    for (int j = 0; j < 3; j++) {
        mpz_set(w->point[j], w->solid.center[j]);
        for (int k = 0; k < 3; k++) {
            if (along[k] > 0) mpz_add(w->point[j], w->point[j], w->solid.axis[k][j]);
            if (along[k] < 0) mpz_sub(w->point[j], w->point[j], w->solid.axis[k][j]);
        }
    }
}

static void set_ways(workshop *w)
{
    exact_plane *way = w->way;
    for (int k = 0; k < 3; k++)
        for (int corner = 0; corner < 4; corner++, way++) {
            int along[3] = {0, 0, 0};
            along[(k + 1) % 3] = corner & 1 ? 1 : -1;
            along[(k + 2) % 3] = corner & 2 ? 1 : -1;
            set_point(w, along);
            exact_cross(way->n, w->point, w->solid.axis[k]);
            mpz_set_si(way->d, 0);
            way->has_offset = false;
        }
    for (int k = 0; k < 3; k++)
        for (int side = -1; side < 2; side += 2, way++) {
            int along[3] = {0, 0, 0};
            along[k] = side;
            set_point(w, along);
            exact_cross(way->n, w->solid.axis[(k + 1) % 3], w->solid.axis[(k + 2) % 3]);
            exact_dot(way->d, way->n, w->point);
            mpz_neg(way->d, way->d);
            way->has_offset = true;
        }
}

// value 2^-places times 2^shift, as w->scaled.
static void scale_exactly(workshop *w, mpz_t value, long places)
{
    mpf_set_z(w->scaled, value);
    if (places >= 0) {
        mpf_div_2exp(w->scaled, w->scaled, (mp_bitcnt_t)places);
    } else {
        mpf_mul_2exp(w->scaled, w->scaled, (mp_bitcnt_t)-places);
    }
}

// The exact value less the float.
static double excess(workshop *w, mpz_t value, long places, float stored)
{
    scale_exactly(w, value, places);
    mpf_set_d(w->part, (double)stored);
    mpf_sub(w->scaled, w->scaled, w->part);
    return mpf_get_d(w->scaled);
}

static int largest_of(const float n[3])
{
    int largest = fabsf(n[1]) > fabsf(n[0]) ? 1 : 0;
    return fabsf(n[2]) > fabsf(n[largest]) ? 2 : largest;
}

// By how much a stored normal is off, in u, if it stands for this way; `*places` gets the way's
// scale, `*sign` its direction.
static double normal_error_of(workshop *w, exact_plane *way, const float n[3], long *places,
                              int *sign)
{
    int largest = largest_of(n);
    long exponent;
    double mantissa = mpz_get_d_2exp(&exponent, way->n[largest]);
    if (mantissa == 0.0) return INFINITY;
    *sign = (mantissa < 0.0) == (n[largest] < 0.0f) ? 1 : -1;
    *places = exponent + lrint(log2(fabs(mantissa)) - log2(fabs((double)n[largest])));
    double most = 0.0;
    for (int j = 0; j < 3; j++)
        most = fmax(most, fabs(excess(w, way->n[j], *places, (float)*sign * n[j])));
    return most / U;
}

// How far inward of the exact plane the stored one lies.
static double inward_by(workshop *w, exact_plane *way, const float plane[4], long places, int sign)
{
    if (!way->has_offset) return -(double)plane[3];
    if (sign < 0) mpz_neg(way->d, way->d);
    double inward = excess(w, way->d, places + w->solid.places, plane[3]);
    if (sign < 0) mpz_neg(way->d, way->d);
    return inward;
}

// It lies inward by 8u|d| and what set-up may have lost, and by no more than that and its rounding.
static void check_inward(workshop *w, double inward, double d, double most)
{
    KIT_CHECK(inward >= (8.0 - 1e-5) * U * d, "inward by %g u|d|", inward / (U * d));
    if (d > 0.0) w->least_inward = fmin(w->least_inward, inward / (U * d));
    w->most_inward = fmax(w->most_inward, inward / most);
}

// The nearest of all edges and faces must be near. Opposite faces have the same normal: the plane
// is that of the nearer one, unless the box is so flat that either will do (shadow.c).
static void check_plane(workshop *w, const float plane[4], double size)
{
    double error = INFINITY, inward = -INFINITY, d = fabs((double)plane[3]);
    double most = 10.0 * U * d + 0x1p-46 * size;
    for (int i = 0; i < WAYS; i++) {
        long places = 0;
        int sign = 1;
        double its_error = normal_error_of(w, &w->way[i], plane, &places, &sign);
        if (its_error > error || w->way[i].has_offset != (d > 0.0)) continue;
        double its_inward = inward_by(w, &w->way[i], plane, places, sign);
        if (its_inward > most) continue;
        inward = its_error < error ? its_inward : fmax(inward, its_inward);
        error = its_error;
    }
    KIT_CHECK(error <= 0.75, "a normal is off by %g u", error);
    w->normal_error = fmax(w->normal_error, error);
    w->planes++;
    check_inward(w, inward, d, most);
}

// An eye at any distance: nearly on the line of an edge as often as not.
static void any_eye(kit_random *random, const occ_box *box, double size, double eye[3])
{
    world_direction(random, eye);
    double away = size * world_scale(random, 0.1, 1e4), corner[3];
    world_corner(box, kit_below(random, 8), corner);
    uint32_t along = kit_below(random, 6);
    for (int j = 0; j < 3; j++) {
        if (along < 3) {
            double line = corner[j] + (double)box->axis[along][j] * world_scale(random, 2, 100);
            eye[j] = line + size * world_scale(random, 1e-15, 1e-2) * eye[j];
        } else {
            eye[j] = (double)box->center[j] + away * eye[j];
        }
    }
}

START_TEST(every_plane_of_a_shadow_is_next_to_the_exact_one_and_inside)
{
    workshop w = {.planes = 0};
    open_workshop(&w);
    kit_random random = {31};
    for (int i = 0; i < WORLD_SHARE(OCCLUDERS); i++) {
        double size = world_scale(&random, 1e-6, 1e6), eye[3], center[3];
        for (int j = 0; j < 3; j++)
            center[j] = size * world_between(&random, -10, 10);
        occ_box box =
            world_box(&random, (world_shape)kit_below(&random, WORLD_SHAPES), center, size);
        any_eye(&random, &box, size, eye);
        occ_frame frame = verdict_frame_at(eye);
        occ_shadow shadow;
        if (!occ_lanes_choose()->shade(&shadow, &frame.camera, &box, OCC_NOBODY)) continue;
        set_exact_solid(&w, &box, eye);
        set_ways(&w);
        double reach = 0.0;
        for (int j = 0; j < 3; j++) {
            reach += fabs((double)box.center[j] - eye[j]);
            for (int k = 0; k < 3; k++)
                reach += fabs((double)box.axis[k][j]);
        }
        for (uint32_t p = 0; p < shadow.planes; p++)
            check_plane(&w, shadow.plane[p], reach);
    }
    printf(
        "%u planes: normals off by up to %.3f u, offsets inward by %.3f u|d| and more, and by up "
        "to %.3f of what is allowed\n",
        w.planes, w.normal_error, w.least_inward, w.most_inward);
    ck_assert_uint_gt(w.planes, WORLD_SHARE(OCCLUDERS));
    close_workshop(&w);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("shadow planes");
    TCase *exact = tcase_create("exact");
    tcase_add_test(exact, every_plane_of_a_shadow_is_next_to_the_exact_one_and_inside);
    suite_add_tcase(suite, exact);
    return test_run_suite(suite);
}
