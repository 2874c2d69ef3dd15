// SPDX-License-Identifier: Apache-2.0
// A camera, exactly: the eye is where the matrix's rows of x, y and w vanish, and the clip planes
// are sums of its rows.
#include "oracle_data.h"

#include <stdlib.h>

static void each_number(oracle *o, void (*act)(mpz_t *, size_t))
{
    exact3 *vectors[] = {&o->e,       &o->b, &o->center, &o->axis[0], &o->axis[1],
                         &o->axis[2], &o->p, &o->d,      &o->u,       &o->v};
    mpz_t *numbers[] = {&o->ew,     &o->cd,     &o->bw,   &o->low.n, &o->low.d,
                        &o->high.n, &o->high.d, &o->at.n, &o->at.d};
    for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++)
        act(*vectors[i], 3);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        act(numbers[i], 1);
    for (int i = 0; i < CLIP_PLANES; i++)
        act(o->n[i], 3);
    for (int i = 0; i < MOST_SLABS; i++) {
        act(o->slabs[i].m, 3);
        act(&o->slabs[i].w, 1);
    }
    act(o->c, CLIP_PLANES);
    act(o->t, sizeof o->t / sizeof *o->t);
}

// `a` and `b` (three doubles each, or NULL) decide how fine the unit is; floats always fit.
static oracle *make(const double *a, const double *b)
{
    oracle *o = calloc(1, sizeof *o);
    if (!o) abort();
    each_number(o, exact_init);
    o->places = 149;
    for (int j = 0; j < 3; j++) {
        long one = a ? exact_places(a[j]) : 0, two = b ? exact_places(b[j]) : 0;
        if (one > o->places) o->places = one;
        if (two > o->places) o->places = two;
    }
    return o;
}

void oracle_free(oracle *o)
{
    if (!o) return;
    each_number(o, exact_clear);
    free(o);
}

void oracle_set_point(const oracle *o, mpz_t *out, const double point[3])
{
    for (int j = 0; j < 3; j++) {
        if (exact_places(point[j]) > o->places) abort(); // finer than floats are
        exact_set(out[j], point[j], o->places);
    }
}

oracle *oracle_of_eye(const double eye[3])
{
    oracle *o = make(eye, NULL);
    oracle_set_point(o, o->e, eye);
    mpz_set_ui(o->ew, 1);
    return o;
}

oracle *oracle_of_direction(const double toward[3])
{
    oracle *o = make(toward, NULL);
    oracle_set_point(o, o->e, toward);
    mpz_set_ui(o->ew, 0);
    return o;
}

typedef struct row {
    exact3 n;
    mpz_t d;
} row;

// The matrix's rows, in a unit of their own: only their ratio to each other counts.
static void set_rows(row *rows, const float *matrix)
{
    long places = 0;
    for (int i = 0; i < 16; i++) {
        long one = exact_places((double)matrix[i]);
        places = one > places ? one : places;
    }
    for (int r = 0; r < 4; r++) {
        exact_init(rows[r].n, 3);
        mpz_init(rows[r].d);
        for (int j = 0; j < 3; j++)
            exact_set(rows[r].n[j], (double)matrix[4 * j + r], places);
        exact_set(rows[r].d, (double)matrix[12 + r], places);
    }
}

// Plane p is row a plus `sign` times row b (-1: no row).
static void add_plane(oracle *o, int p, row *rows, int a, int sign, int b)
{
    for (int j = 0; j < 3; j++) {
        mpz_set(o->n[p][j], rows[a].n[j]);
        if (b >= 0) (sign > 0 ? mpz_add : mpz_sub)(o->n[p][j], o->n[p][j], rows[b].n[j]);
    }
    mpz_set(o->c[p], rows[a].d);
    if (b >= 0) (sign > 0 ? mpz_add : mpz_sub)(o->c[p], o->c[p], rows[b].d);
}

static void set_planes(oracle *o, row *rows, occ_depth depth)
{
    for (int axis = 0; axis < 2; axis++) {
        add_plane(o, 2 * axis, rows, 3, 1, axis);
        add_plane(o, 2 * axis + 1, rows, 3, -1, axis);
    }
    bool reversed = depth == OCC_DEPTH_ONE_TO_ZERO;
    int lower = NEAR_PLANE + reversed, upper = NEAR_PLANE + !reversed; // bounds of clip z
    if (depth == OCC_DEPTH_MINUS_ONE_TO_ONE) {
        add_plane(o, lower, rows, 3, 1, 2);
    } else {
        add_plane(o, lower, rows, 2, 0, -1);
    }
    add_plane(o, upper, rows, 3, -1, 2);
}

// Where three planes meet, as (x / w) in places of the oracle; w >= 0. False if nowhere.
static bool meet(oracle *o, row *p, row *q, row *r, mpz_t *x, mpz_t w)
{
    exact_cross(o->u, q->n, r->n);
    exact_dot(w, p->n, o->u);
    for (int j = 0; j < 3; j++)
        mpz_mul(x[j], p->d, o->u[j]);
    exact_cross(o->u, r->n, p->n);
    for (int j = 0; j < 3; j++)
        mpz_addmul(x[j], q->d, o->u[j]);
    exact_cross(o->u, p->n, q->n);
    for (int j = 0; j < 3; j++) {
        mpz_addmul(x[j], r->d, o->u[j]);
        if (mpz_sgn(w) > 0) mpz_neg(x[j], x[j]);
        mpz_mul_2exp(x[j], x[j], (mp_bitcnt_t)o->places);
    }
    mpz_abs(w, w);
    return mpz_sgn(w) != 0;
}

// The eye, and the planes as distances from it.
static bool set_perspective(oracle *o, row *rows, const occ_camera_desc *camera)
{
    if (!meet(o, &rows[0], &rows[1], &rows[3], o->e, o->ew)) return false;
    mpz_set(o->cd, o->ew);
    for (int p = 0; p < CLIP_PLANES; p++) {
        mpz_mul(o->t[0], o->c[p], o->ew);
        mpz_mul_2exp(o->t[0], o->t[0], (mp_bitcnt_t)o->places);
        exact_dot(o->c[p], o->n[p], o->e);
        mpz_add(o->c[p], o->c[p], o->t[0]);
    }
    if (camera->eye) {
        oracle_set_point(o, o->e, camera->eye);
        mpz_set_ui(o->ew, 1);
    } else if (camera->origin) {
        oracle_set_point(o, o->u, camera->origin);
        for (int j = 0; j < 3; j++)
            mpz_addmul(o->e[j], o->u[j], o->ew);
    }
    for (int j = 0; j < 3; j++)
        mpz_set(o->b[j], o->e[j]);
    mpz_set(o->bw, o->ew);
    return true;
}

// The direction to the viewer is against the near plane's normal.
static bool set_orthographic(oracle *o, row *rows, const occ_camera_desc *camera)
{
    exact_cross(o->e, rows[0].n, rows[1].n);
    mpz_set_ui(o->ew, 0);
    exact_dot(o->t[0], o->e, o->n[NEAR_PLANE]);
    if (mpz_sgn(o->t[0]) == 0) return false;
    for (int j = 0; j < 3 && mpz_sgn(o->t[0]) > 0; j++)
        mpz_neg(o->e[j], o->e[j]);
    for (int p = 0; p < CLIP_PLANES; p++)
        mpz_mul_2exp(o->c[p], o->c[p], (mp_bitcnt_t)o->places);
    static const double nowhere[3];
    oracle_set_point(o, o->b, camera->origin ? camera->origin : nowhere);
    mpz_set_ui(o->bw, 1);
    mpz_set_ui(o->cd, 1);
    return true;
}

oracle *oracle_of_camera(const occ_camera_desc *camera)
{
    oracle *o = make(camera->eye, camera->origin);
    row rows[4];
    set_rows(rows, camera->view_projection);
    set_planes(o, rows, camera->depth);
    o->has_planes = true;
    bool found = exact_is_zero(rows[3].n) ? set_orthographic(o, rows, camera)
                                          : set_perspective(o, rows, camera);
    for (int r = 0; r < 4; r++) {
        exact_clear(rows[r].n, 3);
        mpz_clear(rows[r].d);
    }
    if (found) return o;
    oracle_free(o);
    return NULL;
}

bool oracle_eye(const oracle *o, double eye[3])
{
    if (mpz_sgn(o->ew) == 0) return false;
    mpq_t value;
    mpq_init(value);
    for (int j = 0; j < 3; j++) {
        mpq_set_num(value, o->e[j]);
        mpq_set_den(value, o->ew);
        mpq_canonicalize(value);
        mpq_div_2exp(value, value, (mp_bitcnt_t)o->places);
        eye[j] = mpq_get_d(value);
    }
    mpq_clear(value);
    return true;
}
