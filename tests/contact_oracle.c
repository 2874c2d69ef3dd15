// SPDX-License-Identifier: Apache-2.0
#include "contact_oracle.h"

#include "kit.h"

#include <gmp.h>

// A triangle's points are a + x0 (b - a) + x1 (c - a), a box's center + x2 axis[0] + x3 axis[1] +
// x4 axis[2]. The three equations of both are solved for some of the x, and the inequalities that
// bound them are then eliminated one unknown after the other (Fourier and Motzkin).
enum { UNKNOWNS = 5, BOUND = UNKNOWNS, COLUMNS, MOST_ROWS = 4000 };

// The sum of coefficients times unknowns is at most, or if strict less than, the last column.
typedef struct inequality {
    mpq_t at[COLUMNS];
    bool strict;
} inequality;

typedef struct inequalities {
    inequality row[MOST_ROWS];
    int count;
} inequalities;

static inequality *new_row(inequalities *list)
{
    KIT_CHECK(list->count < MOST_ROWS, "too many inequalities");
    inequality *row = &list->row[list->count++];
    for (int k = 0; k < COLUMNS; k++)
        mpq_init(row->at[k]);
    row->strict = false;
    return row;
}

static void drop_row(inequalities *list, int i)
{
    for (int k = 0; k < COLUMNS; k++)
        mpq_clear(list->row[i].at[k]);
    list->row[i] = list->row[--list->count];
}

// out += factor * row
static void add_multiple(mpq_t *out, mpq_t *row, const mpq_t factor)
{
    mpq_t part;
    mpq_init(part);
    for (int k = 0; k < COLUMNS; k++) {
        mpq_mul(part, row[k], factor);
        mpq_add(out[k], out[k], part);
    }
    mpq_clear(part);
}

static void bound_unknowns(inequalities *list, bool open)
{
    for (int k = 0; k < UNKNOWNS; k++) {
        inequality *row = new_row(list);
        mpq_set_si(row->at[k], -1, 1);
        if (k < 2) continue; // x >= 0
        mpq_set_si(row->at[BOUND], 1, 1);
        row->strict = open;
        row = new_row(list);
        mpq_set_si(row->at[k], 1, 1);
        mpq_set_si(row->at[BOUND], 1, 1);
        row->strict = open;
    }
    inequality *row = new_row(list);
    mpq_set_si(row->at[0], 1, 1);
    mpq_set_si(row->at[1], 1, 1);
    mpq_set_si(row->at[BOUND], 1, 1);
}

static void set_difference(mpq_t out, float a, float b)
{
    mpq_t other;
    mpq_init(other);
    mpq_set_d(out, (double)a);
    mpq_set_d(other, (double)b);
    mpq_sub(out, out, other);
    mpq_clear(other);
}

static void make_equations(const occ_box *box, float corner[3][3], mpq_t equation[3][COLUMNS])
{
    for (int j = 0; j < 3; j++) {
        for (int k = 0; k < COLUMNS; k++)
            mpq_init(equation[j][k]);
        set_difference(equation[j][0], corner[1][j], corner[0][j]);
        set_difference(equation[j][1], corner[2][j], corner[0][j]);
        for (int k = 0; k < 3; k++)
            mpq_set_d(equation[j][2 + k], -(double)box->axis[k][j]);
        set_difference(equation[j][BOUND], box->center[j], corner[0][j]);
    }
}

// Uses an equation to remove an unknown from the other equations and from the inequalities. False
// if the equation is 0 = something else.
static bool substitute(mpq_t equation[3][COLUMNS], int from, inequalities *list)
{
    int pivot = 0;
    while (pivot < UNKNOWNS && mpq_sgn(equation[from][pivot]) == 0)
        pivot++;
    if (pivot == UNKNOWNS) return mpq_sgn(equation[from][BOUND]) == 0;
    mpq_t factor;
    mpq_init(factor);
    for (int j = from + 1; j < 3; j++) {
        mpq_div(factor, equation[j][pivot], equation[from][pivot]);
        mpq_neg(factor, factor);
        add_multiple(equation[j], equation[from], factor);
    }
    for (int i = 0; i < list->count; i++) {
        mpq_div(factor, list->row[i].at[pivot], equation[from][pivot]);
        mpq_neg(factor, factor);
        add_multiple(list->row[i].at, equation[from], factor);
    }
    mpq_clear(factor);
    return true;
}

static void eliminate(inequalities *list, int unknown)
{
    int before = list->count;
    mpq_t factor;
    mpq_init(factor);
    for (int i = 0; i < before; i++)
        for (int j = 0; j < before; j++) {
            inequality *up = &list->row[i], *down = &list->row[j];
            if (mpq_sgn(up->at[unknown]) <= 0 || mpq_sgn(down->at[unknown]) >= 0) continue;
            inequality *row = new_row(list);
            mpq_inv(factor, up->at[unknown]);
            add_multiple(row->at, up->at, factor);
            mpq_inv(factor, down->at[unknown]);
            mpq_neg(factor, factor);
            add_multiple(row->at, down->at, factor);
            row->strict = up->strict || down->strict;
        }
    mpq_clear(factor);
    for (int i = list->count - 1; i >= 0; i--)
        if (mpq_sgn(list->row[i].at[unknown]) != 0) drop_row(list, i);
}

// Whether every inequality without unknowns holds; these are dropped.
static bool constants_hold(inequalities *list)
{
    bool hold = true;
    for (int i = list->count - 1; i >= 0; i--) {
        inequality *row = &list->row[i];
        int k = 0;
        while (k < UNKNOWNS && mpq_sgn(row->at[k]) == 0)
            k++;
        if (k < UNKNOWNS) continue;
        int sign = mpq_sgn(row->at[BOUND]);
        hold = hold && (row->strict ? sign > 0 : sign >= 0);
        drop_row(list, i);
    }
    return hold;
}

bool contact_oracle_meet(const occ_box *box, float corner[3][3], bool open)
{
    static inequalities list;
    mpq_t equation[3][COLUMNS];
    make_equations(box, corner, equation);
    bound_unknowns(&list, open);
    bool there_is = true;
    for (int j = 0; j < 3; j++)
        there_is = substitute(equation, j, &list) && there_is;
    for (int k = UNKNOWNS - 1; k >= 0; k--) {
        there_is = there_is && constants_hold(&list);
        if (there_is) eliminate(&list, k);
    }
    there_is = there_is && constants_hold(&list);
    while (list.count)
        drop_row(&list, list.count - 1);
    for (int i = 0; i < 3 * COLUMNS; i++)
        mpq_clear(equation[i / COLUMNS][i % COLUMNS]);
    return there_is;
}

bool contact_oracle_has_volume(const occ_box *box)
{
    mpq_t sum, term, factor;
    mpq_inits(sum, term, factor, NULL);
    for (int i = 0; i < 6; i++) {
        static const int order[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1},
                                        {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
        mpq_set_si(term, i < 3 ? 1 : -1, 1);
        for (int k = 0; k < 3; k++) {
            mpq_set_d(factor, (double)box->axis[k][order[i][k]]);
            mpq_mul(term, term, factor);
        }
        mpq_add(sum, sum, term);
    }
    bool has = mpq_sgn(sum) != 0;
    mpq_clears(sum, term, factor, NULL);
    return has;
}

occ_contact contact_oracle(const occ_box *box, float corner[3][3])
{
    if (!contact_oracle_meet(box, corner, false)) return OCC_APART;
    return contact_oracle_has_volume(box) && contact_oracle_meet(box, corner, true) ? OCC_ENTERING
                                                                                    : OCC_TOUCHING;
}
