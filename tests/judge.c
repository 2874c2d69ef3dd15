// SPDX-License-Identifier: Apache-2.0
// What several occluders leave of an object: its sheets towards the eye, cut by the clip planes,
// and from each the shadows taken away one after the other, depth first, until something survives
// all.
#include "judge_data.h"

#include <stdlib.h>
#include <string.h>

void judge_filter(judge *j, bool on)
{
    j->filter = on;
}

judge_effort judge_spent(const judge *j)
{
    return j->effort;
}

void judge_set_occluders(judge *j, const occ_box *boxes, const int *owners, size_t count)
{
    if (count > j->shadow_room) {
        j->shadows = realloc(j->shadows, count * sizeof *j->shadows);
        j->candidates = realloc(j->candidates, count * sizeof *j->candidates);
        if (!j->shadows || !j->candidates) abort();
        memset(j->shadows + j->shadow_room, 0, (count - j->shadow_room) * sizeof *j->shadows);
        j->shadow_room = count;
    }
    j->shadow_count = count;
    for (size_t i = 0; i < count; i++)
        judge_admit(j, &boxes[i]);
    for (size_t i = 0; i < count; i++) {
        judge_make_shadow(j, &j->shadows[i], &boxes[i], j->has_clips);
        j->shadows[i].owner = owners ? owners[i] : -1;
    }
}

// --- sheets --------------------------------------------------------------------------------------

static void face_sheet(judge *j, const judge_body *body, int face, int end)
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
static void thread_sheet(judge *j, const judge_body *body)
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
static bool num_section(judge *j, const judge_body *body, int clip)
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

// --- clip planes ---------------------------------------------------------------------------------

static int sign_at_center(judge *j, const judge_body *body, int clip)
{
    int sign = judge_ask(j, num_add(num_dot(j->clip[clip], body->center, 3), j->clip[clip][3]));
    if (sign != NUM_UNSURE) return sign;
    judge_load(j, &body->box);
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
static bool cut_sheet(judge *j, judge_piece *piece)
{
    j->line_count = 0;
    judge_start_piece(j, piece);
    for (int i = 0; j->sheet.clip >= 0 && i < j->sheet.body->sides; i++)
        if (!keep_inside(j, JUDGE_SIDE, i, piece)) return false;
    for (int p = 0; j->has_clips && p < JUDGE_CLIPS; p++)
        if (p != j->sheet.clip && !keep_inside(j, JUDGE_CLIP, p, piece)) return false;
    return true;
}

// --- shadows -------------------------------------------------------------------------------------

// Drops the occluders whose shadow surely misses the object.
static void find_candidates(judge *j, int self)
{
    j->candidate_count = 0;
    for (size_t i = 0; i < j->shadow_count; i++) {
        judge_shadow *shadow = &j->shadows[i];
        bool apart = shadow->empty || (self >= 0 && shadow->owner == self);
        for (int p = 0; j->filter && !apart && p < shadow->count; p++)
            apart = judge_extreme_sign(j, &j->body, shadow->plane[p], NULL, 1) == -1;
        if (!apart) j->candidates[j->candidate_count++].shadow = shadow;
    }
}

static int lines_of(judge *j, judge_candidate *candidate)
{
    if (candidate->line >= 0) return candidate->line;
    candidate->line = j->line_count;
    for (int p = 0; p < candidate->shadow->count; p++)
        judge_add_line(j, JUDGE_SHADOW, candidate->shadow, p);
    return candidate->line;
}

static int sign_at_point(const judge *j, int line, const num *point)
{
    return num_sign(num_dot(j->lines[line].q, point, 3));
}

// A point that is surely inside the piece.
static bool find_inner_point(const judge *j, const judge_piece *piece, num *point)
{
    double x = 0.0, y = 0.0;
    for (int i = 0; i < piece->count; i++) {
        x += piece->vertex[i][0].v / piece->vertex[i][2].v;
        y += piece->vertex[i][1].v / piece->vertex[i][2].v;
    }
    point[0] = num_of(x / piece->count);
    point[1] = num_of(y / piece->count);
    point[2] = num_of(1.0);
    for (int i = 0; i < piece->count; i++)
        if (sign_at_point(j, piece->edge[i] / 2, point) != (piece->edge[i] % 2 ? -1 : 1))
            return false;
    return true;
}

static bool surely_misses(judge *j, judge_candidate *candidate, const num *point)
{
    int line = lines_of(j, candidate);
    for (int p = 0; p < candidate->shadow->count; p++)
        if (sign_at_point(j, line + p, point) == -1) return true;
    return false;
}

// Puts an occluder at place `next` that may hide the piece's middle. False if none does: then the
// middle is seen, whatever the occluders that are left hide around it.
static bool choose(judge *j, const judge_piece *piece, size_t next)
{
    num point[3];
    if (!find_inner_point(j, piece, point)) return true;
    for (size_t i = next; i < j->candidate_count; i++) {
        if (surely_misses(j, &j->candidates[i], point)) continue;
        judge_candidate chosen = j->candidates[i];
        j->candidates[i] = j->candidates[next];
        j->candidates[next] = chosen;
        return true;
    }
    return false;
}

// Whether the shadow has no point in common with the piece's inner points. If it may have, the
// lines that cross the piece are listed.
static bool misses(judge *j, judge_candidate *candidate, const judge_piece *piece, int *crossing,
                   int *crossings)
{
    signed char signs[JUDGE_EDGES];
    int counts[2], line = lines_of(j, candidate);
    *crossings = 0;
    for (int p = 0; p < candidate->shadow->count; p++) {
        judge_signs(j, line + p, piece, signs, counts);
        if (counts[1] > 0 && counts[0] == 0) return true;
        if (counts[1] > 0) crossing[(*crossings)++] = line + p;
    }
    return false;
}

static bool survives(judge *j, const judge_piece *piece)
{
    if (!j->measuring) return true;
    j->seen_area += fmax(judge_piece_area(piece) * j->sheet.area, DBL_MIN);
    return false;
}

// Whether something of the piece is outside of the shadows from place `next` on. The depth is that
// of the list of candidates.
static bool is_seen(judge *j, const judge_piece *piece, size_t next)
{
    int crossing[JUDGE_PLANES], crossings = 0;
    for (;; next++) {
        if (next == j->candidate_count) return survives(j, piece);
        if (j->filter && !j->measuring && !choose(j, piece, next)) return true;
        if (!misses(j, &j->candidates[next], piece, crossing, &crossings)) break;
    }
    judge_piece *buffer = malloc(3 * sizeof *buffer);
    if (!buffer) abort();
    int current = 0;
    bool seen = false;
    for (int i = 0; i < crossings && !seen; i++) {
        signed char signs[JUDGE_EDGES];
        int counts[2];
        judge_signs(j, crossing[i], piece, signs, counts);
        if (counts[1] == 0) continue;
        if (counts[0] == 0) {
            seen = is_seen(j, piece, next + 1);
            break;
        }
        judge_cut(j, crossing[i], piece, signs, -1, &buffer[2]);
        seen = is_seen(j, &buffer[2], next + 1);
        judge_cut(j, crossing[i], piece, signs, 1, &buffer[current]);
        piece = &buffer[current];
        current = 1 - current;
    }
    free(buffer);
    return seen;
}

// --- verdicts ------------------------------------------------------------------------------------

static bool is_sheet_seen(judge *j)
{
    judge_piece piece;
    if (!cut_sheet(j, &piece)) return false;
    j->whole_area += judge_piece_area(&piece) * j->sheet.area;
    for (size_t i = 0; i < j->candidate_count; i++)
        j->candidates[i].line = -1;
    return is_seen(j, &piece, 0);
}

static bool has_area(judge *j)
{
    judge_piece piece;
    return cut_sheet(j, &piece);
}

// Whether the axes beside `face` span anything.
static bool spans(judge *j, const judge_body *body, int face)
{
    judge_load(j, &body->box);
    exact_cross(j->m, j->a[(face + 1) % 3], j->a[(face + 2) % 3]);
    return !exact_is_zero(j->m);
}

static bool each_flat_face(judge *j, bool (*holds)(judge *))
{
    const judge_body *body = &j->body;
    for (int k = 0; k < 3; k++) {
        if (!spans(j, body, k)) continue;
        bool zero = true;
        for (int i = 0; i < 3; i++)
            zero = zero && body->axis[k][i].v == 0.0;
        for (int end = zero ? 0 : -1; end < 2; end += 2) {
            face_sheet(j, body, k, end);
            if (holds(j)) return true;
        }
    }
    return false;
}

static int clip_at_eye(judge *j, int clip)
{
    const num *plane = j->clip[clip];
    int sign = judge_ask(j, j->at_infinity ? num_dot(plane, j->toward, 3) : plane[3]);
    if (sign != NUM_UNSURE) return sign;
    if (!j->at_infinity) return mpz_sgn(j->exact_clip[clip][3]);
    exact_dot(j->t[0], j->exact_clip[clip], j->from);
    return mpz_sgn(j->t[0]);
}

// Asks all facets of what the clip planes leave of a solid, or those towards the eye. `*facing`
// counts them.
static bool each_facet(judge *j, bool all, bool (*holds)(judge *), int *facing)
{
    const judge_body *body = &j->body;
    *facing = 0;
    num normal[3];
    num_cross(normal, body->axis[1], body->axis[2]);
    int turn = judge_ask(j, num_dot(normal, body->axis[0], 3));
    if (turn == NUM_UNSURE) {
        judge_load(j, &body->box);
        exact_cross(j->m, j->a[1], j->a[2]);
        exact_dot(j->t[0], j->m, j->a[0]);
        turn = mpz_sgn(j->t[0]);
    }
    for (int i = 0; i < body->sides; i++) { // side 2 k has its face where m.x is least
        if (!all && body->sign[i] >= 0) continue;
        ++*facing;
        face_sheet(j, body, i / 2, i % 2 ? turn : -turn);
        if (holds(j)) return true;
    }
    for (int p = 0; j->has_clips && p < JUDGE_CLIPS; p++) {
        if (!all && clip_at_eye(j, p) >= 0) continue;
        if (!num_section(j, body, p)) continue;
        ++*facing;
        if (holds(j)) return true;
    }
    return false;
}

bool judge_has_inside(judge *j)
{
    int facing;
    if (j->body.shape.rank == 3) return each_facet(j, true, has_area, &facing);
    if (j->body.shape.rank == 2) return each_flat_face(j, has_area);
    thread_sheet(j, &j->body);
    return has_area(j);
}

static bool judge_body_in_hand(judge *j)
{
    if (j->body.shape.rank < 2) {
        thread_sheet(j, &j->body);
        return is_sheet_seen(j);
    }
    if (j->body.shape.rank == 2) return each_flat_face(j, is_sheet_seen);
    int facing;
    if (each_facet(j, false, is_sheet_seen, &facing)) return true;
    if (facing) return false;
    j->seen_area = j->whole_area = 1.0; // the eye is in it
    return judge_has_inside(j);
}

bool judge_sees(judge *j, const occ_box *object, int self)
{
    judge_make_body(j, &j->body, object);
    find_candidates(j, self);
    return judge_body_in_hand(j);
}

double judge_share(judge *j, const occ_box *object, int self)
{
    judge_make_body(j, &j->body, object);
    find_candidates(j, self);
    j->measuring = true;
    j->seen_area = j->whole_area = 0.0;
    bool seen = judge_body_in_hand(j);
    j->measuring = false;
    if (seen) return 1.0;
    return j->whole_area > 0.0 && j->seen_area > 0.0 ? fmin(j->seen_area / j->whole_area, 1.0)
                                                     : 0.0;
}
