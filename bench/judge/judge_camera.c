// SPDX-License-Identifier: Apache-2.0
// Cameras: the eye is where the matrix's rows of x, y and w vanish, and the clip planes are sums of
// its rows. Then the unit: so fine that every number which takes part is an integer.
#include "judge_data.h"

#include <stdint.h>
#include <stdlib.h>

// Places behind the binary point.
static long places_of(double value)
{
    int exponent;
    if (value == 0.0) return 0;
    uint64_t mantissa = (uint64_t)ldexp(frexp(fabs(value), &exponent), 53);
    long places = 53L - exponent;
    for (; mantissa % 2u == 0u; mantissa /= 2u)
        places--;
    return places > 0 ? places : 0;
}

static void each_number(judge *j, void (*act)(mpz_t *, size_t))
{
    act(j->from, 3);
    act(&j->from_w, 1);
    act(&j->unit, 1);
    act(j->exact_reference, 3);
    for (int i = 0; i < JUDGE_CLIPS; i++) {
        act(j->clip_source[i], 4);
        act(j->exact_clip[i], 4);
    }
    act(j->xo, 4);
    act(j->xu, 4);
    act(j->xv, 4);
    act(j->c, 3);
    for (int k = 0; k < 3; k++)
        act(j->a[k], 3);
    act(j->m, 3);
    act(j->s, 3);
    act(j->v, 3);
    for (int i = 0; i < JUDGE_HALVES; i++)
        act(j->half[i], 4);
    act(j->at_eye, JUDGE_HALVES);
    act(j->t, sizeof j->t / sizeof *j->t);
}

judge *judge_make(void)
{
    judge *j = calloc(1, sizeof *j);
    if (!j) abort();
    each_number(j, exact_init);
    mpz_set_ui(j->from_w, 1);
    j->filter = true;
    return j;
}

void judge_free(judge *j)
{
    if (!j) return;
    for (size_t i = 0; i < j->shadow_room; i++)
        judge_free_shadow(&j->shadows[i]);
    judge_free_shadow(&j->single);
    for (int i = 0; i < j->line_room; i++)
        exact_clear(j->lines[i].x, 3);
    free(j->shadows);
    free(j->candidates);
    free(j->lines);
    each_number(j, exact_clear);
    free(j);
}

// --- nums of integers ----------------------------------------------------------------------------

// n / d 2^shift, d > 0. GMP cuts off what a double does not hold: less than 2^-52 of it, twice, and
// the division rounds.
static num num_of_fraction(const mpz_t n, const mpz_t d, long shift)
{
    long n_exponent, d_exponent;
    double top = mpz_get_d_2exp(&n_exponent, n), bottom = mpz_get_d_2exp(&d_exponent, d);
    long exponent = n_exponent - d_exponent + shift;
    if (top == 0.0) return num_of(0.0);
    if (exponent > 2000) exponent = 2000;
    if (exponent < -2000) exponent = -2000;
    double v = ldexp(top / bottom, (int)exponent);
    return (num){v, 0x1p-50 * fabs(v) + DBL_MIN};
}

// --- the unit ------------------------------------------------------------------------------------

// The bits of the largest number.
static long largest(mpz_t *numbers, int count)
{
    size_t most = 0;
    for (int i = 0; i < count; i++) {
        size_t bits = mpz_sizeinbase(numbers[i], 2);
        most = bits > most ? bits : most;
    }
    return (long)most;
}

static void refresh_clips(judge *j)
{
    for (int p = 0; j->has_clips && p < JUDGE_CLIPS; p++) {
        mpz_t *source = j->clip_source[p];
        long size = largest(source, 4);
        mpz_set_ui(j->t[0], 1);
        for (int i = 0; i < 4; i++) {
            j->clip[p][i] = num_of_fraction(source[i], j->t[0], -size);
            mpz_set(j->exact_clip[p][i], source[i]);
        }
        mpz_mul(j->exact_clip[p][3], j->exact_clip[p][3], j->unit);
    }
}

void judge_refresh(judge *j)
{
    bool finite = !j->at_infinity;
    j->version++;
    mpz_set_ui(j->unit, 1);
    mpz_mul_2exp(j->unit, j->unit, (mp_bitcnt_t)j->places);
    if (finite) mpz_mul(j->unit, j->unit, j->from_w);
    for (int i = 0; i < 3; i++) {
        mpz_t *reference = &j->exact_reference[i];
        exact_set(*reference, j->origin[i], j->places);
        if (finite) mpz_mul(*reference, *reference, j->from_w);
        mpz_mul_2exp(j->t[0], j->from[i], (mp_bitcnt_t)(j->places - (finite ? j->from_places : 0)));
        if (finite) mpz_add(*reference, *reference, j->t[0]);
        j->reference[i] = num_of(j->origin[i]);
        if (finite && mpz_sgn(j->from[i]))
            j->reference[i] =
                num_add(j->reference[i], num_of_fraction(j->from[i], j->from_w, -j->from_places));
        j->toward[i] = num_of(0.0);
    }
    mpz_set_ui(j->t[0], 1);
    for (int i = 0; !finite && i < 3; i++)
        j->toward[i] = num_of_fraction(j->from[i], j->t[0], -largest(j->from, 3));
    refresh_clips(j);
}

void judge_admit(judge *j, const occ_box *box)
{
    long places = j->places;
    for (int i = 0; i < 3; i++) {
        long one = places_of((double)box->center[i]);
        places = one > places ? one : places;
        for (int k = 0; k < 3; k++) {
            one = places_of((double)box->axis[k][i]);
            places = one > places ? one : places;
        }
    }
    if (places == j->places) return;
    j->places = places;
    judge_refresh(j);
}

static void admit_point(judge *j, const double point[3])
{
    for (int i = 0; i < 3; i++) {
        long one = places_of(point[i]);
        j->places = one > j->places ? one : j->places;
        j->origin[i] = point[i];
    }
}

// --- without planes ------------------------------------------------------------------------------

judge *judge_of_eye(const double eye[3])
{
    judge *j = judge_make();
    admit_point(j, eye);
    judge_refresh(j);
    return j;
}

judge *judge_of_direction(const double toward[3])
{
    judge *j = judge_make();
    long places = 0;
    for (int i = 0; i < 3; i++) {
        long one = places_of(toward[i]);
        places = one > places ? one : places;
    }
    for (int i = 0; i < 3; i++)
        exact_set(j->from[i], toward[i], places);
    j->at_infinity = true;
    judge_refresh(j);
    return j;
}

judge *judge_of_corner(const occ_box *eyes, unsigned corner)
{
    judge *j = judge_make();
    judge_admit(j, eyes);
    j->from_places = j->places;
    for (int i = 0; i < 3; i++) {
        exact_set(j->from[i], (double)eyes->center[i], j->places);
        for (int k = 0; k < 3; k++) {
            exact_set(j->t[0], (double)eyes->axis[k][i], j->places);
            (corner >> k & 1u ? mpz_add : mpz_sub)(j->from[i], j->from[i], j->t[0]);
        }
    }
    judge_refresh(j);
    return j;
}

// --- matrices ------------------------------------------------------------------------------------

// The rows in a unit of their own: only their ratio counts.
static void set_rows(exact4 *rows, const float *matrix)
{
    long places = 0;
    for (int i = 0; i < 16; i++) {
        long one = places_of((double)matrix[i]);
        places = one > places ? one : places;
    }
    for (int r = 0; r < 4; r++) {
        exact_init(rows[r], 4);
        for (int c = 0; c < 4; c++)
            exact_set(rows[r][c], (double)matrix[4 * c + r], places);
    }
}

// Row a plus `sign` times row b.
static void set_plane(mpz_t *plane, exact4 *rows, int a, int sign, int b)
{
    for (int i = 0; i < 4; i++) {
        mpz_set(plane[i], rows[a][i]);
        if (sign > 0) mpz_add(plane[i], plane[i], rows[b][i]);
        if (sign < 0) mpz_sub(plane[i], plane[i], rows[b][i]);
    }
}

static void set_planes(judge *j, exact4 *rows, occ_depth depth)
{
    bool reversed = depth == OCC_DEPTH_ONE_TO_ZERO, full = depth == OCC_DEPTH_MINUS_ONE_TO_ONE;
    exact4 *planes = j->clip_source;
    for (int axis = 0; axis < 2; axis++) {
        set_plane(planes[2 * axis], rows, 3, 1, axis);
        set_plane(planes[2 * axis + 1], rows, 3, -1, axis);
    }
    set_plane(planes[JUDGE_NEAR + (reversed ? 1 : 0)], rows, full ? 3 : 2, full ? 1 : 0, 2);
    set_plane(planes[JUDGE_NEAR + (reversed ? 0 : 1)], rows, 3, -1, 2);
    j->has_clips = true;
}

// By Cramer's rule; from_w > 0. False if the rows' planes do not meet in one point.
static bool find_eye(judge *j, exact4 *rows)
{
    static const int meet[3] = {0, 1, 3};
    for (int i = 0; i < 3; i++)
        mpz_set_ui(j->from[i], 0);
    for (int r = 0; r < 3; r++) {
        mpz_t *p = rows[meet[r]], *q = rows[meet[(r + 1) % 3]], *o = rows[meet[(r + 2) % 3]];
        exact_cross(j->m, q, o);
        exact_dot(j->from_w, p, j->m);
        for (int i = 0; i < 3; i++)
            mpz_submul(j->from[i], p[3], j->m[i]);
    }
    for (int i = 0; i < 3 && mpz_sgn(j->from_w) < 0; i++)
        mpz_neg(j->from[i], j->from[i]);
    mpz_abs(j->from_w, j->from_w);
    return mpz_sgn(j->from_w) != 0;
}

// The planes count from the eye: d becomes n.eye + d, over from_w.
static void carry_planes(judge *j)
{
    for (int p = 0; p < JUDGE_CLIPS; p++) {
        mpz_t *plane = j->clip_source[p];
        exact_dot(j->t[0], plane, j->from);
        mpz_addmul(j->t[0], plane[3], j->from_w);
        mpz_set(plane[3], j->t[0]);
        for (int i = 0; mpz_sgn(plane[3]) && i < 3; i++)
            mpz_mul(plane[i], plane[i], j->from_w);
    }
}

static bool set_perspective(judge *j, exact4 *rows, const occ_camera_desc *camera)
{
    if (!find_eye(j, rows)) return false;
    carry_planes(j);
    if (camera->origin) admit_point(j, camera->origin);
    if (camera->eye) {
        admit_point(j, camera->eye);
        mpz_set_ui(j->from_w, 1);
        for (int i = 0; i < 3; i++)
            mpz_set_ui(j->from[i], 0);
    }
    return true;
}

// The direction to the viewer is against the near plane's normal.
static bool set_orthographic(judge *j, exact4 *rows, const occ_camera_desc *camera)
{
    j->at_infinity = true;
    exact_cross(j->from, rows[0], rows[1]);
    exact_dot(j->t[0], j->from, j->clip_source[JUDGE_NEAR]);
    for (int i = 0; i < 3 && mpz_sgn(j->t[0]) > 0; i++)
        mpz_neg(j->from[i], j->from[i]);
    if (camera->origin) admit_point(j, camera->origin);
    return mpz_sgn(j->t[0]) != 0;
}

judge *judge_of_camera(const occ_camera_desc *camera)
{
    judge *j = judge_make();
    exact4 rows[4];
    set_rows(rows, camera->view_projection);
    set_planes(j, rows, camera->depth);
    bool found = exact_is_zero(rows[3]) ? set_orthographic(j, rows, camera)
                                        : set_perspective(j, rows, camera);
    for (int r = 0; r < 4; r++)
        exact_clear(rows[r], 4);
    if (found) {
        judge_refresh(j);
        return j;
    }
    judge_free(j);
    return NULL;
}
