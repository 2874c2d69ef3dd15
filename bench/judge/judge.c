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

static void make_room(judge *j, size_t count)
{
    if (count <= j->shadow_room) return;
    j->shadows = realloc(j->shadows, count * sizeof *j->shadows);
    j->candidates = realloc(j->candidates, count * sizeof *j->candidates);
    if (!j->shadows || !j->candidates) abort();
    memset(j->shadows + j->shadow_room, 0, (count - j->shadow_room) * sizeof *j->shadows);
    j->shadow_room = count;
}

void judge_set_occluders(judge *j, const occ_box *boxes, const int *owners, size_t count)
{
    make_room(j, count);
    j->shadow_count = count;
    for (size_t i = 0; i < count; i++)
        judge_admit(j, &boxes[i]);
    for (size_t i = 0; i < count; i++) {
        judge_make_body(j, &j->shadows[i].body, &boxes[i]);
        judge_make_shadow(j, &j->shadows[i], j->has_clips);
        j->shadows[i].owner = owners ? owners[i] : -1;
    }
}

static void add_sheet(judge *j, const occ_sheet *sheet, int owner)
{
    for (uint32_t c = 2; c < sheet->corner_count; c++) {
        judge_shadow *shadow = &j->shadows[j->shadow_count++];
        judge_make_triangle(j, &shadow->body, sheet->corner[0], sheet->corner[c - 1],
                            sheet->corner[c]);
        judge_make_shadow(j, shadow, j->has_clips);
        if (sheet->sides == OCC_SIDES_FRONT) judge_keep_front(shadow);
        shadow->owner = owner;
    }
}

// A sheet is its triangles: closed, so that nothing is seen through what two of them share.
void judge_add_sheets(judge *j, const occ_sheet *sheets, const int *owners, size_t count)
{
    size_t total = j->shadow_count;
    for (size_t i = 0; i < count; i++)
        total += sheets[i].corner_count - 2;
    make_room(j, total);
    for (size_t i = 0; i < count; i++)
        add_sheet(j, &sheets[i], owners ? owners[i] : -1);
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
    double middle[2];
    judge_piece_middle(piece, middle);
    point[0] = num_of(middle[0]);
    point[1] = num_of(middle[1]);
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

static void set_witness(judge *j, const judge_piece *piece)
{
    double middle[2], at[4];
    const judge_sheet *sheet = &j->sheet;
    judge_piece_middle(piece, middle);
    for (int i = 0; i < 4; i++)
        at[i] = sheet->o[i].v + middle[0] * sheet->u[i].v + middle[1] * sheet->v[i].v;
    for (int i = 0; i < 3; i++)
        j->witness[i] = at[i] / at[3] + j->reference[i].v;
    j->has_witness = true;
}

static bool survives(judge *j, const judge_piece *piece)
{
    if (!j->measuring) {
        set_witness(j, piece);
        return true;
    }
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
        if (j->filter && !j->measuring && !choose(j, piece, next)) return survives(j, piece);
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
    if (!judge_cut_sheet(j, &piece)) return false;
    j->whole_area += judge_piece_area(&piece) * j->sheet.area;
    for (size_t i = 0; i < j->candidate_count; i++)
        j->candidates[i].line = -1;
    return is_seen(j, &piece, 0);
}

static bool has_area(judge *j)
{
    judge_piece piece;
    return judge_cut_sheet(j, &piece);
}

// Whether the axes beside `face` span anything.
static bool spans(judge *j, const judge_body *body, int face)
{
    judge_load(j, body);
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
            judge_face_sheet(j, body, k, end);
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
        judge_load(j, body);
        exact_cross(j->m, j->a[1], j->a[2]);
        exact_dot(j->t[0], j->m, j->a[0]);
        turn = mpz_sgn(j->t[0]);
    }
    for (int i = 0; i < body->sides; i++) { // side 2 k has its face where m.x is least
        if (!all && body->sign[i] >= 0) continue;
        ++*facing;
        judge_face_sheet(j, body, i / 2, i % 2 ? turn : -turn);
        if (holds(j)) return true;
    }
    for (int p = 0; j->has_clips && p < JUDGE_CLIPS; p++) {
        if (!all && clip_at_eye(j, p) >= 0) continue;
        if (!judge_section_sheet(j, body, p)) continue;
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
    judge_thread_sheet(j, &j->body);
    return has_area(j);
}

static bool judge_body_in_hand(judge *j)
{
    if (j->body.shape.rank < 2) {
        judge_thread_sheet(j, &j->body);
        return is_sheet_seen(j);
    }
    if (j->body.shape.rank == 2) return each_flat_face(j, is_sheet_seen);
    int facing;
    if (each_facet(j, false, is_sheet_seen, &facing)) return true;
    if (facing) return false;
    j->seen_area = j->whole_area = 1.0; // the eye is in it
    for (int i = 0; i < 3; i++)
        j->witness[i] = j->reference[i].v;
    return j->has_witness = judge_has_inside(j);
}

bool judge_sees(judge *j, const occ_box *object, int self)
{
    judge_make_body(j, &j->body, object);
    find_candidates(j, self);
    j->has_witness = false;
    return judge_body_in_hand(j);
}

bool judge_witness(const judge *j, double point[3])
{
    for (int i = 0; i < 3; i++)
        point[i] = j->has_witness ? j->witness[i] : 0.0;
    return j->has_witness;
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
