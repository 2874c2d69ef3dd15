// SPDX-License-Identifier: Apache-2.0
// Polygons that never forget where they come from. A vertex is where two consecutive lines of a
// piece meet, and a line is an original plane restricted to the sheet: however often a piece is
// cut, the sign of a line at a vertex is one determinant of three original lines, no worse than at
// first. Consecutive lines of a counterclockwise polygon turn left, so the vertex's own denominator
// is positive and need not be looked at.
#include "judge_data.h"

#include <stdlib.h>

// --- lines ---------------------------------------------------------------------------------------

static judge_line *next_line(judge *j)
{
    if (j->line_count == j->line_room) {
        int room = j->line_room ? 2 * j->line_room : 256;
        j->lines = realloc(j->lines, (size_t)room * sizeof *j->lines);
        if (!j->lines) abort();
        for (int i = j->line_room; i < room; i++)
            exact_init(j->lines[i].x, 3);
        j->line_room = room;
    }
    judge_line *line = &j->lines[j->line_count++];
    line->exact = false;
    return line;
}

int judge_add_line(judge *j, judge_origin origin, judge_shadow *shadow, int index)
{
    const num *plane = origin == JUDGE_CLIP   ? j->clip[index]
                       : origin == JUDGE_SIDE ? j->sheet.body->side[index]
                                              : shadow->plane[index];
    judge_line *line = next_line(j);
    line->origin = origin;
    line->shadow = shadow;
    line->index = index;
    line->q[0] = num_dot(plane, j->sheet.u, 4);
    line->q[1] = num_dot(plane, j->sheet.v, 4);
    line->q[2] = num_dot(plane, j->sheet.o, 4);
    num_tame(line->q, 3);
    return j->line_count - 1;
}

static int add_literal(judge *j, double a, double b, double c)
{
    judge_line *line = next_line(j);
    line->origin = JUDGE_LITERAL;
    line->shadow = NULL;
    line->literal[0] = a;
    line->literal[1] = b;
    line->literal[2] = c;
    for (int i = 0; i < 3; i++)
        line->q[i] = num_of(line->literal[i]);
    return j->line_count - 1;
}

// a.b, all four of them.
static void dot4(mpz_t out, mpz_t *a, mpz_t *b)
{
    exact_dot(out, a, b);
    mpz_addmul(out, a[3], b[3]);
}

static mpz_t *exact_line(judge *j, int number)
{
    judge_line *line = &j->lines[number];
    if (line->exact) return line->x;
    line->exact = true;
    if (line->origin == JUDGE_LITERAL) {
        for (int i = 0; i < 3; i++)
            mpz_set_d(line->x[i], line->literal[i]);
        if (j->sheet.clip >= 0) mpz_mul(line->x[2], line->x[2], j->unit);
        return line->x;
    }
    judge_exact_sheet(j);
    mpz_t *plane = NULL;
    if (line->origin == JUDGE_CLIP) plane = j->exact_clip[line->index];
    if (line->origin == JUDGE_SIDE) {
        judge_exact_sides(j, j->sheet.body);
        plane = j->half[line->index];
    }
    if (line->origin == JUDGE_SHADOW) {
        judge_exact_shadow(j, line->shadow);
        plane = line->shadow->exact[line->index];
    }
    dot4(line->x[0], plane, j->xu);
    dot4(line->x[1], plane, j->xv);
    dot4(line->x[2], plane, j->xo);
    return line->x;
}

// --- pieces --------------------------------------------------------------------------------------

// Vertex i, from the edges on both its sides.
static void set_vertex(judge *j, judge_piece *piece, int i)
{
    int a = piece->edge[i], b = piece->edge[(i + 1) % piece->count];
    num *vertex = piece->vertex[i];
    num_cross(vertex, j->lines[a / 2].q, j->lines[b / 2].q);
    for (int k = 0; (a + b) % 2 && k < 3; k++)
        vertex[k] = num_neg(vertex[k]);
}

void judge_start_piece(judge *j, judge_piece *piece)
{
    double reach = j->sheet.reach;
    piece->count = 4;
    piece->edge[0] = 2 * add_literal(j, 1, 0, reach);
    piece->edge[1] = 2 * add_literal(j, 0, 1, reach);
    piece->edge[2] = 2 * add_literal(j, -1, 0, reach);
    piece->edge[3] = 2 * add_literal(j, 0, -1, reach);
    for (int i = 0; i < 4; i++)
        set_vertex(j, piece, i);
}

static int exact_sign(judge *j, int line, const judge_piece *piece, int i)
{
    int a = piece->edge[i], b = piece->edge[(i + 1) % piece->count];
    mpz_t *p = exact_line(j, a / 2), *q = exact_line(j, b / 2), *r = exact_line(j, line);
    exact_cross(j->v, p, q);
    exact_dot(j->t[0], j->v, r);
    return (a + b) % 2 ? -mpz_sgn(j->t[0]) : mpz_sgn(j->t[0]);
}

void judge_signs(judge *j, int line, const judge_piece *piece, signed char *signs, int counts[2])
{
    counts[0] = counts[1] = 0;
    for (int i = 0; i < piece->count; i++) {
        int a = piece->edge[i] / 2, b = piece->edge[(i + 1) % piece->count] / 2;
        int sign = 0;
        if (a != line && b != line) {
            sign = judge_ask(j, num_dot(piece->vertex[i], j->lines[line].q, 3));
            if (sign == NUM_UNSURE) sign = exact_sign(j, line, piece, i);
        }
        signs[i] = (signed char)sign;
        counts[0] += sign > 0;
        counts[1] += sign < 0;
    }
}

// The vertices on the side to keep are a run in the cycle, and the edges at them stay.
void judge_cut(judge *j, int line, const judge_piece *piece, const signed char *signs, int side,
               judge_piece *part)
{
    int count = piece->count, first = 0;
    while (signs[first] * side > 0)
        first++;
    while (signs[first % count] * side <= 0)
        first++;
    part->count = 0;
    for (int i = first; signs[i % count] * side > 0; i++) {
        for (int k = 0; k < 3; k++)
            part->vertex[part->count][k] = piece->vertex[i % count][k];
        part->edge[part->count++] = piece->edge[i % count];
    }
    if (part->count + 2 > JUDGE_EDGES) abort();
    int kept = part->count;
    part->edge[part->count++] = piece->edge[(first + kept) % count];
    part->edge[part->count++] = 2 * line + (side < 0);
    set_vertex(j, part, kept);
    set_vertex(j, part, kept + 1);
}

double judge_piece_area(const judge_piece *piece)
{
    double area = 0.0, x[3], y[3];
    for (int i = 0; i < piece->count; i++) {
        int k = i < 2 ? i : 2;
        x[k] = piece->vertex[i][0].v / piece->vertex[i][2].v;
        y[k] = piece->vertex[i][1].v / piece->vertex[i][2].v;
        if (k < 2) continue;
        area += 0.5 * ((x[1] - x[0]) * (y[2] - y[0]) - (y[1] - y[0]) * (x[2] - x[0]));
        x[1] = x[2];
        y[1] = y[2];
    }
    return area > 0.0 ? area : 0.0;
}

void judge_piece_middle(const judge_piece *piece, double middle[2])
{
    middle[0] = middle[1] = 0.0;
    for (int i = 0; i < piece->count; i++) {
        const num *vertex = piece->vertex[i];
        middle[0] += vertex[0].v / vertex[2].v / piece->count;
        middle[1] += vertex[1].v / vertex[2].v / piece->count;
    }
}
