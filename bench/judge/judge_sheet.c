// SPDX-License-Identifier: Apache-2.0
// Sheets: the faces of bodies, bodies that are no more than a segment or a point, and where clip
// planes cut solids. Written once for nums and once for integers.
#include "judge_data.h"

// --- as nums -------------------------------------------------------------------------------------

void judge_face_sheet(judge *j, const judge_body *body, int face, int end)
{
    judge_sheet *sheet = &j->sheet;
    *sheet = (judge_sheet){.body = body, .clip = -1, .face = face, .end = end, .reach = 1.0};
    for (int i = 0; i < 3; i++) {
        sheet->o[i] = body->center[i];
        if (end > 0) sheet->o[i] = num_add(sheet->o[i], body->axis[face][i]);
        if (end < 0) sheet->o[i] = num_sub(sheet->o[i], body->axis[face][i]);
        sheet->u[i] = body->axis[(face + 1) % 3][i];
        sheet->v[i] = body->axis[(face + 2) % 3][i];
    }
    sheet->o[3] = num_of(1.0);
    num normal[3];
    num_cross(normal, sheet->u, sheet->v);
    sheet->area = hypot(hypot(normal[0].v, normal[1].v), normal[2].v);
}

// A segment or a point: see exact_thread(). Parallel axes have components of equal or of opposite
// signs.
void judge_thread_sheet(judge *j, const judge_body *body)
{
    judge_sheet *sheet = &j->sheet;
    const num *main = body->axis[body->shape.pick];
    *sheet = (judge_sheet){.body = body, .clip = -1, .reach = 1.0, .area = 1.0};
    for (int k = 0; k < 3; k++) {
        bool against = false;
        for (int i = 0; i < 3; i++)
            against = against || (main[i].v < 0.0 && body->axis[k][i].v > 0.0) ||
                      (main[i].v > 0.0 && body->axis[k][i].v < 0.0);
        for (int i = 0; i < 3; i++) {
            num add = against ? num_neg(body->axis[k][i]) : body->axis[k][i];
            sheet->u[i] = num_add(sheet->u[i], add);
        }
    }
    for (int i = 0; i < 3; i++)
        sheet->o[i] = body->center[i];
    sheet->o[3] = num_of(1.0);
}

// Where a clip plane n.x + d = 0 cuts the body, with n_r the largest component of n: s and t are
// the two other coordinates, and (x_r, x_p, x_q, w) = (-d - n_p s - n_q t, n_r s, n_r t, n_r).
// False if the plane has no normal.
bool judge_section_sheet(judge *j, const judge_body *body, int clip)
{
    const num *plane = j->clip[clip];
    int r = 0;
    double far_away = 1.0;
    for (int i = 0; i < 3; i++) {
        double reach = fabs(body->center[i].v) + body->center[i].e;
        if (fabs(plane[i].v) > fabs(plane[r].v)) r = i;
        for (int k = 0; k < 3; k++)
            reach += fabs(body->axis[k][i].v);
        far_away = fmax(far_away, reach);
    }
    if (num_sign(plane[r]) == 0 || num_sign(plane[r]) == NUM_UNSURE) return false;
    judge_sheet *sheet = &j->sheet;
    *sheet = (judge_sheet){.body = body, .clip = clip, .face = r};
    sheet->reach = ldexp(1.0, ilogb(far_away) + 2);
    int p = (r + 1) % 3, q = (r + 2) % 3;
    bool same = plane[r].v > 0.0;
    sheet->o[3] = sheet->u[p] = sheet->v[q] = num_abs(plane[r]);
    sheet->o[r] = same ? num_neg(plane[3]) : plane[3];
    sheet->u[r] = same ? num_neg(plane[p]) : plane[p];
    sheet->v[r] = same ? num_neg(plane[q]) : plane[q];
    sheet->area = hypot(hypot(plane[0].v, plane[1].v), plane[2].v) / fabs(plane[r].v);
    return true;
}

// --- as integers ---------------------------------------------------------------------------------

static void exact_face(judge *j)
{
    int face = j->sheet.face;
    judge_load(j, j->sheet.body);
    for (int i = 0; i < 3; i++) {
        mpz_set(j->xo[i], j->c[i]);
        if (j->sheet.end > 0) mpz_add(j->xo[i], j->xo[i], j->a[face][i]);
        if (j->sheet.end < 0) mpz_sub(j->xo[i], j->xo[i], j->a[face][i]);
        mpz_set(j->xu[i], j->a[(face + 1) % 3][i]);
        mpz_set(j->xv[i], j->a[(face + 2) % 3][i]);
    }
    mpz_set_ui(j->xo[3], 1);
    mpz_set_ui(j->xu[3], 0);
    mpz_set_ui(j->xv[3], 0);
}

// A segment is the sheet c + s (the sum of its axes, turned alike) + t 0, and a point c + s 0 + t
// 0: no line ever crosses them along t.
static void exact_thread(judge *j)
{
    judge_load(j, j->sheet.body);
    for (int i = 0; i < 3; i++) {
        mpz_set(j->xo[i], j->c[i]);
        mpz_set_ui(j->xu[i], 0);
        mpz_set_ui(j->xv[i], 0);
    }
    int pick = j->sheet.body->shape.pick;
    for (int k = 0; k < 3; k++) {
        exact_dot(j->t[0], j->a[pick], j->a[k]);
        for (int i = 0; i < 3; i++)
            (mpz_sgn(j->t[0]) < 0 ? mpz_sub : mpz_add)(j->xu[i], j->xu[i], j->a[k][i]);
    }
    mpz_set_ui(j->xo[3], 1);
    mpz_set_ui(j->xu[3], 0);
    mpz_set_ui(j->xv[3], 0);
}

// s and t are two coordinates, and the plane gives the third: see judge_section_sheet().
static void exact_section(judge *j)
{
    mpz_t *plane = j->exact_clip[j->sheet.clip];
    int r = j->sheet.face, p = (r + 1) % 3, q = (r + 2) % 3;
    for (int i = 0; i < 4; i++) {
        mpz_set_ui(j->xo[i], 0);
        mpz_set_ui(j->xu[i], 0);
        mpz_set_ui(j->xv[i], 0);
    }
    mpz_abs(j->xo[3], plane[r]);
    mpz_set(j->xu[p], j->xo[3]);
    mpz_set(j->xv[q], j->xo[3]);
    bool same = mpz_sgn(plane[r]) > 0;
    (same ? mpz_neg : mpz_set)(j->xo[r], plane[3]);
    (same ? mpz_neg : mpz_set)(j->xu[r], plane[p]);
    (same ? mpz_neg : mpz_set)(j->xv[r], plane[q]);
}

void judge_exact_sheet(judge *j)
{
    if (j->sheet.exact) return;
    j->sheet.exact = true;
    if (j->sheet.clip >= 0) {
        exact_section(j);
    } else if (j->sheet.body->shape.rank < 2) {
        exact_thread(j);
    } else {
        exact_face(j);
    }
}

// --- clip planes ---------------------------------------------------------------------------------

static int sign_at_center(judge *j, const judge_body *body, int clip)
{
    int sign = judge_ask(j, num_add(num_dot(j->clip[clip], body->center, 3), j->clip[clip][3]));
    if (sign != NUM_UNSURE) return sign;
    judge_load(j, body);
    exact_dot(j->t[0], j->exact_clip[clip], j->c);
    mpz_add(j->t[0], j->t[0], j->exact_clip[clip][3]);
    return mpz_sgn(j->t[0]);
}

// Keeps what is inside of a line. False if that is nothing. A plane in which the whole sheet lies
// leaves a solid's face only if the solid is on its inner side.
static bool keep_inside(judge *j, judge_origin origin, int index, judge_piece *piece)
{
    signed char signs[JUDGE_EDGES];
    int counts[2], line = judge_add_line(j, origin, NULL, index);
    judge_signs(j, line, piece, signs, counts);
    if (counts[0] == 0 && counts[1] == 0) {
        const judge_body *body = j->sheet.body;
        int clip = origin == JUDGE_CLIP ? index : j->sheet.clip;
        return body->shape.rank < 3 || sign_at_center(j, body, clip) >= 0;
    }
    if (counts[1] == 0) return true;
    if (counts[0] == 0) return false;
    judge_piece part;
    judge_cut(j, line, piece, signs, 1, &part);
    *piece = part;
    return true;
}

// The sheet in hand as a piece, cut by clip planes and, where it is a section, by the body's sides.
// False if nothing is left.
bool judge_cut_sheet(judge *j, judge_piece *piece)
{
    j->line_count = 0;
    judge_start_piece(j, piece);
    for (int i = 0; j->sheet.clip >= 0 && i < j->sheet.body->sides; i++)
        if (!keep_inside(j, JUDGE_SIDE, i, piece)) return false;
    for (int p = 0; j->has_clips && p < JUDGE_CLIPS; p++)
        if (p != j->sheet.clip && !keep_inside(j, JUDGE_CLIP, p, piece)) return false;
    return true;
}
