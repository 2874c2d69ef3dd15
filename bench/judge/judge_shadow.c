// SPDX-License-Identifier: Apache-2.0
// A point p is in the shadow of a body if p + r e is in the body for some r >= 0, e being the eye
// as a homogeneous point. The body is where f_i(x) >= 0 for some half-spaces, and f_i(p + r e) =
// f_i(p) + r f_i(e), so that Fourier and Motzkin's elimination of r gives the shadow exactly:
// f_i(p) >= 0 where f_i(e) <= 0, and f_i(e) f_j(p) - f_j(e) f_i(p) >= 0, a plane through the eye,
// for every f_i(e) > 0 and f_j(e) < 0. It does not ask what the body looks like, so that sheets,
// eyes in the planes of faces and bodies cut by the near plane need no cases of their own. Opposite
// sides are not paired: the plane between them follows from the one that faces the eye.
#include "judge_data.h"

#include <stdlib.h>

static void add_plane(judge_shadow *shadow, int one, int two)
{
    if (shadow->count == JUDGE_PLANES) abort();
    shadow->one[shadow->count] = one;
    shadow->two[shadow->count++] = two;
}

// Half-space i is side i, or a clip plane.
static const num *half_num(const judge *j, const judge_shadow *shadow, int i)
{
    int sides = shadow->body.sides;
    return i < sides ? shadow->body.side[i] : j->clip[shadow->clip[i - sides]];
}

static num value_at_eye(const judge *j, const num *half)
{
    return j->at_infinity ? num_dot(half, j->toward, 3) : half[3];
}

static int sign_at_eye(judge *j, const judge_shadow *shadow, int i)
{
    int sides = shadow->body.sides;
    if (i < sides) return shadow->body.sign[i];
    int clip = shadow->clip[i - sides];
    int sign = judge_ask(j, value_at_eye(j, j->clip[clip]));
    if (sign != NUM_UNSURE) return sign;
    if (!j->at_infinity) return mpz_sgn(j->exact_clip[clip][3]);
    exact_dot(j->t[0], j->exact_clip[clip], j->from);
    return mpz_sgn(j->t[0]);
}

// The near and the far plane, where the body is not wholly inside of them.
static void add_clips(judge *j, judge_shadow *shadow)
{
    for (int clip = JUDGE_NEAR; clip < JUDGE_CLIPS; clip++) {
        int least = judge_extreme_sign(j, &shadow->body, j->clip[clip], j->exact_clip[clip], -1);
        if (least < 0) shadow->clip[shadow->halves++ - shadow->body.sides] = clip;
    }
}

static bool opposite(const judge_shadow *shadow, int i, int k)
{
    return i < shadow->body.paired && k < shadow->body.paired && i / 2 == k / 2;
}

static void num_planes(judge *j, judge_shadow *shadow)
{
    for (int p = 0; p < shadow->count; p++) {
        int one = shadow->one[p], two = shadow->two[p];
        const num *f = half_num(j, shadow, one), *g = two < 0 ? NULL : half_num(j, shadow, two);
        for (int i = 0; i < 4; i++) {
            shadow->plane[p][i] = f[i];
            if (g)
                shadow->plane[p][i] =
                    num_sub(num_mul(value_at_eye(j, g), f[i]), num_mul(value_at_eye(j, f), g[i]));
        }
        if (g && !j->at_infinity) shadow->plane[p][3] = num_of(0.0);
        num_tame(shadow->plane[p], 4);
    }
}

void judge_make_shadow(judge *j, judge_shadow *shadow, bool clipped)
{
    int sign[JUDGE_HALVES];
    shadow->count = 0;
    shadow->version = -1;
    shadow->halves = shadow->body.sides;
    shadow->grown = false;
    shadow->empty =
        judge_holds_eye(j, &shadow->body) || (shadow->body.triangle && shadow->body.shape.rank < 2);
    if (shadow->empty) return;
    if (clipped) add_clips(j, shadow);
    for (int i = 0; i < shadow->halves; i++) {
        sign[i] = sign_at_eye(j, shadow, i);
        if (sign[i] <= 0) add_plane(shadow, i, -1);
    }
    for (int i = 0; i < shadow->halves; i++)
        for (int k = 0; k < shadow->halves; k++)
            if (sign[i] < 0 && sign[k] > 0 && !opposite(shadow, i, k)) add_plane(shadow, i, k);
    num_planes(j, shadow);
}

void judge_keep_front(judge_shadow *shadow)
{
    if (shadow->body.sign[0] <= 0) shadow->empty = true;
}

void judge_free_shadow(judge_shadow *shadow)
{
    for (int p = 0; shadow->exact && p < JUDGE_PLANES; p++)
        exact_clear(shadow->exact[p], 4);
    free(shadow->exact);
}

// --- as integers ---------------------------------------------------------------------------------

// By what the combination of two sides can be divided: two solid's sides meet along an axis, a
// sheet's plane and strip along another, and both leave a factor that is known. In t[1]; else 1.
static void common_factor(judge *j, const judge_shadow *shadow, int one, int two)
{
    const judge_body *body = &shadow->body;
    mpz_set_ui(j->t[1], 1);
    if (one >= body->sides || two >= body->sides) return;
    if (body->shape.rank == 3) {
        exact_dot(j->t[1], j->half[0], j->a[0]);
        mpz_abs(j->t[1], j->t[1]);
    } else if (body->shape.rank == 2 && (one < 2) != (two < 2)) {
        exact_dot(j->t[1], j->half[0], j->half[0]);
    }
}

static void combine(judge *j, const judge_shadow *shadow, int one, int two, mpz_t *out)
{
    common_factor(j, shadow, one, two);
    for (int i = 0; i < 4; i++) {
        mpz_mul(out[i], j->at_eye[two], j->half[one][i]);
        mpz_submul(out[i], j->at_eye[one], j->half[two][i]);
        mpz_divexact(out[i], out[i], j->t[1]);
    }
}

void judge_exact_shadow(judge *j, judge_shadow *shadow)
{
    if (shadow->version == j->version) return;
    if (!shadow->exact) {
        shadow->exact = calloc(JUDGE_PLANES, sizeof *shadow->exact);
        if (!shadow->exact) abort();
        for (int p = 0; p < JUDGE_PLANES; p++)
            exact_init(shadow->exact[p], 4);
    }
    judge_exact_sides(j, &shadow->body);
    for (int i = 0; i < shadow->halves; i++) {
        for (int k = 0; i >= shadow->body.sides && k < 4; k++)
            mpz_set(j->half[i][k], j->exact_clip[shadow->clip[i - shadow->body.sides]][k]);
        if (j->at_infinity) exact_dot(j->at_eye[i], j->half[i], j->from);
        if (!j->at_infinity) mpz_set(j->at_eye[i], j->half[i][3]);
    }
    for (int p = 0; p < shadow->count; p++) {
        int one = shadow->one[p], two = shadow->two[p];
        for (int i = 0; two < 0 && i < 4; i++)
            mpz_set(shadow->exact[p][i], j->half[one][i]);
        if (two >= 0 && shadow->grown)
            judge_grown_plane(shadow, p, shadow->exact[p]);
        else if (two >= 0)
            combine(j, shadow, one, two, shadow->exact[p]);
    }
    shadow->version = j->version;
}
