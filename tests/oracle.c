// SPDX-License-Identifier: Apache-2.0
// A box is where |m.(x - center)| <= w for a few slabs (m, w), w being the support sum |m.axis_j|:
// the three pairs of faces of a solid; the plane and the strips of a flat one; and so on down to a
// point. A segment x = p + s d, with d = e - p ew for the homogeneous eye (e, ew), meets it where
// the slabs leave some s of [0, 1 / ew].
#include "oracle_data.h"

// --- an occluder as slabs ------------------------------------------------------------------------

static slab *next_slab(oracle *o)
{
    return &o->slabs[o->slab_count++];
}

static void finish_slab(oracle *o, slab *s)
{
    mpz_set_ui(s->w, 0);
    for (int k = 0; k < 3; k++) {
        exact_dot(o->t[0], s->m, o->axis[k]);
        mpz_abs(o->t[0], o->t[0]);
        mpz_add(s->w, s->w, o->t[0]);
    }
}

// Between its pairs of faces.
static void add_faces(oracle *o)
{
    for (int k = 0; k < 3; k++) {
        slab *s = next_slab(o);
        exact_cross(s->m, o->axis[(k + 1) % 3], o->axis[(k + 2) % 3]);
        finish_slab(o, s);
    }
}

// In its plane, and between the edges along each axis.
static void add_sheet(oracle *o, int k)
{
    slab *plane = next_slab(o);
    exact_cross(plane->m, o->axis[(k + 1) % 3], o->axis[(k + 2) % 3]);
    finish_slab(o, plane);
    for (int i = 0; i < 3; i++) {
        if (exact_is_zero(o->axis[i])) continue;
        slab *strip = next_slab(o);
        exact_cross(strip->m, o->axis[i], plane->m);
        finish_slab(o, strip);
    }
}

// On its line and between its ends, or at its point.
static void add_line(oracle *o, int longest)
{
    for (int j = 0; j < 3; j++) {
        slab *s = next_slab(o);
        for (int i = 0; i < 3; i++)
            mpz_set_ui(o->v[i], i == j);
        exact_cross(s->m, o->axis[longest], o->v);
        if (o->rank == 0)
            for (int i = 0; i < 3; i++)
                mpz_set_ui(s->m[i], i == j);
        finish_slab(o, s);
    }
    if (o->rank == 0) return;
    slab *ends = next_slab(o);
    for (int i = 0; i < 3; i++)
        mpz_set(ends->m[i], o->axis[longest][i]);
    finish_slab(o, ends);
}

static void set_slabs(oracle *o, const occ_box *box)
{
    int line = 0, sheet = -1;
    for (int j = 0; j < 3; j++) {
        exact_set(o->center[j], (double)box->center[j], o->places);
        for (int k = 0; k < 3; k++)
            exact_set(o->axis[k][j], (double)box->axis[k][j], o->places);
    }
    o->slab_count = 0;
    o->rank = 0;
    for (int k = 0; k < 3; k++) {
        exact_cross(o->u, o->axis[(k + 1) % 3], o->axis[(k + 2) % 3]);
        if (!exact_is_zero(o->axis[k])) line = k;
        if (!exact_is_zero(o->axis[k]) && o->rank < 1) o->rank = 1;
        if (exact_is_zero(o->u)) continue;
        sheet = k;
        exact_dot(o->t[0], o->u, o->axis[k]);
        o->rank = mpz_sgn(o->t[0]) ? 3 : 2;
    }
    if (o->rank == 3) {
        add_faces(o);
    } else if (o->rank == 2) {
        add_sheet(o, sheet);
    } else {
        add_line(o, line);
    }
}

static bool holds_eye(oracle *o)
{
    if (mpz_sgn(o->ew) == 0) return false;
    for (int j = 0; j < 3; j++) {
        mpz_set(o->u[j], o->e[j]);
        mpz_submul(o->u[j], o->center[j], o->ew);
    }
    for (int i = 0; i < o->slab_count; i++) {
        exact_dot(o->t[0], o->slabs[i].m, o->u);
        mpz_mul(o->t[1], o->slabs[i].w, o->ew);
        if (mpz_cmpabs(o->t[0], o->t[1]) > 0) return false;
    }
    return true;
}

// --- a segment against slabs ---------------------------------------------------------------------

static int compare(oracle *o, fraction *a, fraction *b)
{
    mpz_mul(o->t[0], a->n, b->d);
    mpz_mul(o->t[1], b->n, a->d);
    return mpz_cmp(o->t[0], o->t[1]);
}

static void copy(fraction *to, fraction *from)
{
    mpz_set(to->n, from->n);
    mpz_set(to->d, from->d);
}

// Keeps the s with value + s slope >= 0. Lowers *sight if nothing, or nothing but the end, is left.
static void keep(oracle *o, mpz_t value, mpz_t slope, oracle_sight *sight)
{
    int sign = mpz_sgn(slope), side = mpz_sgn(value);
    if (sign == 0) {
        if (side == 0 && *sight > ORACLE_GRAZED) *sight = ORACLE_GRAZED;
        if (side < 0) *sight = ORACLE_SEEN;
        return;
    }
    mpz_neg(o->at.n, value);
    mpz_set(o->at.d, slope);
    if (sign < 0) {
        mpz_neg(o->at.n, o->at.n);
        mpz_neg(o->at.d, o->at.d);
        if (compare(o, &o->at, &o->high) < 0) copy(&o->high, &o->at);
    } else if (compare(o, &o->at, &o->low) > 0) {
        copy(&o->low, &o->at);
    }
}

// What the slabs that have a width leave of the segment, and then what those without do.
static oracle_sight cross_slabs(oracle *o, oracle_sight sight)
{
    bool flat = false;
    for (int i = 0; i < 2 * o->slab_count && sight != ORACLE_SEEN; i++) {
        slab *s = &o->slabs[i / 2];
        flat = flat || mpz_sgn(s->w) == 0;
        if (mpz_sgn(s->w) == 0) continue;
        exact_dot(o->t[2], s->m, o->u); // u = p - center
        exact_dot(o->t[3], s->m, o->d);
        if (i % 2) {
            mpz_neg(o->t[2], o->t[2]);
            mpz_neg(o->t[3], o->t[3]);
        }
        mpz_add(o->t[2], o->t[2], s->w);
        keep(o, o->t[2], o->t[3], &sight);
    }
    int order = compare(o, &o->low, &o->high);
    if (order > 0) return ORACLE_SEEN;
    if (order == 0 && sight > ORACLE_GRAZED) sight = ORACLE_GRAZED;
    if (!flat || sight == ORACLE_SEEN) return sight;
    for (int i = 0; i < o->slab_count; i++) {
        slab *s = &o->slabs[i];
        if (mpz_sgn(s->w)) continue;
        exact_dot(o->at.n, s->m, o->u);
        exact_dot(o->at.d, s->m, o->d);
        if (mpz_sgn(o->at.d) == 0) { // along it
            if (mpz_sgn(o->at.n)) return ORACLE_SEEN;
            sight = ORACLE_GRAZED;
            continue;
        }
        if (mpz_sgn(o->at.d) < 0) {
            mpz_neg(o->at.d, o->at.d);
        } else {
            mpz_neg(o->at.n, o->at.n);
        }
        int above = compare(o, &o->at, &o->low), below = compare(o, &o->high, &o->at);
        if (above < 0 || below < 0) return ORACLE_SEEN;
        if (above == 0 || below == 0 || o->rank < 2) sight = ORACLE_GRAZED;
        copy(&o->low, &o->at);
        copy(&o->high, &o->at);
    }
    return sight;
}

// From p towards the eye: [0, 1 / ew].
static void start_segment(oracle *o)
{
    for (int j = 0; j < 3; j++) {
        mpz_set(o->d[j], o->e[j]);
        mpz_submul(o->d[j], o->p[j], o->ew);
        mpz_sub(o->u[j], o->p[j], o->center[j]);
    }
    mpz_set_ui(o->low.n, 0);
    mpz_set_ui(o->low.d, 1);
    mpz_set_ui(o->high.n, 1);
    mpz_set(o->high.d, o->ew);
}

// The value of a plane at p, times bw cd, in t[2]; t[0] is lost.
static void plane_at(oracle *o, int plane, mpz_t *p)
{
    mpz_set_ui(o->t[2], 0);
    for (int j = 0; j < 3; j++) {
        mpz_mul(o->t[0], p[j], o->bw);
        mpz_sub(o->t[0], o->t[0], o->b[j]);
        mpz_addmul(o->t[2], o->t[0], o->n[plane][j]);
    }
    mpz_mul(o->t[2], o->t[2], o->cd);
    mpz_addmul(o->t[2], o->c[plane], o->bw);
}

oracle_sight oracle_point(oracle *o, const double point[3], const occ_box *occluder)
{
    set_slabs(o, occluder);
    if (holds_eye(o)) return ORACLE_SEEN;
    oracle_set_point(o, o->p, point);
    start_segment(o);
    oracle_sight sight = ORACLE_HIDDEN;
    for (int plane = NEAR_PLANE; o->has_planes && plane < CLIP_PLANES; plane++) {
        plane_at(o, plane, o->p);
        exact_dot(o->t[3], o->n[plane], o->d);
        mpz_mul(o->t[3], o->t[3], o->bw);
        mpz_mul(o->t[3], o->t[3], o->cd);
        keep(o, o->t[2], o->t[3], &sight);
    }
    return cross_slabs(o, sight);
}

// --- boxes ---------------------------------------------------------------------------------------

static void set_corner(oracle *o, const occ_box *box, unsigned corner)
{
    for (int j = 0; j < 3; j++) {
        exact_set(o->p[j], (double)box->center[j], o->places);
        for (int k = 0; k < 3; k++) {
            exact_set(o->t[0], (double)box->axis[k][j], o->places);
            (corner >> k & 1u ? mpz_add : mpz_sub)(o->p[j], o->p[j], o->t[0]);
        }
    }
}

oracle_sight oracle_box(oracle *o, const occ_box *object, const occ_box *occluder)
{
    set_slabs(o, occluder);
    if (holds_eye(o)) return ORACLE_SEEN;
    oracle_sight least = ORACLE_HIDDEN;
    for (unsigned c = 0; c < 8 && least != ORACLE_SEEN; c++) {
        set_corner(o, object, c);
        start_segment(o);
        oracle_sight sight = cross_slabs(o, ORACLE_HIDDEN);
        least = sight < least ? sight : least;
    }
    return least;
}

bool oracle_outside(oracle *o, const occ_box *object)
{
    for (int plane = 0; plane < CLIP_PLANES; plane++) {
        unsigned outside = 0;
        for (unsigned c = 0; c < 8; c++) {
            set_corner(o, object, c);
            plane_at(o, plane, o->p);
            outside += mpz_sgn(o->t[2]) < 0;
        }
        if (outside == 8) return true;
    }
    return false;
}

bool oracle_holds(oracle *o, const double point[3])
{
    oracle_set_point(o, o->p, point);
    for (int plane = 0; plane < CLIP_PLANES; plane++) {
        plane_at(o, plane, o->p);
        if (mpz_sgn(o->t[2]) < 0) return false;
    }
    return true;
}
