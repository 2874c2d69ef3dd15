// SPDX-License-Identifier: Apache-2.0
// labels: property oracle
// How triangles and boxes meet, against linear inequalities in GMP's rationals.
#include "kit.h"
#include "overlap.h"
#include "support.h"

#include <gmp.h>
#include <math.h>
#include <stdlib.h>

// --- an oracle that knows no axes ----------------------------------------------------------------

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

static bool common_point(const occ_box *box, float corner[3][3], bool open)
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

static bool has_volume(const occ_box *box)
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

static occ_contact judge(const occ_box *box, float corner[3][3])
{
    if (!common_point(box, corner, false)) return OCC_APART;
    return has_volume(box) && common_point(box, corner, true) ? OCC_ENTERING : OCC_TOUCHING;
}

// --- boxes and triangles that meet in every way --------------------------------------------------

static float step_of(kit_random *random, int most)
{
    return (float)((int)kit_below(random, 2 * (uint32_t)most + 1) - most);
}

// Few bits: contacts, common planes and common lines are frequent. Scaled by a power of two.
static void make_coarse(kit_random *random, occ_box *box, float corner[3][3])
{
    float scale = ldexpf(1.0f, (int)kit_below(random, 60) - 40);
    int most = 1 + (int)kit_below(random, 3);
    for (int j = 0; j < 3; j++)
        box->center[j] = step_of(random, 2) * scale;
    for (int k = 0; k < 9; k++)
        box->axis[k / 3][k % 3] = step_of(random, most) * scale;
    if (kit_below(random, 2))
        for (int k = 0; k < 9; k++)
            if (k % 4) box->axis[k / 3][k % 3] = 0.0f;
    for (int k = 0; k < 9; k++)
        corner[k / 3][k % 3] = step_of(random, 4) * scale;
}

// A point of the box that rounding has moved by next to nothing.
static void near_box(kit_random *random, const occ_box *box, float point[3])
{
    double s[3];
    for (int k = 0; k < 3; k++)
        s[k] = kit_below(random, 2) ? 1.0 : (double)kit_between(random, -1.0f, 1.0f);
    for (int j = 0; j < 3; j++) {
        double x = (double)box->center[j];
        for (int k = 0; k < 3; k++)
            x += s[k] * (double)box->axis[k][j];
        point[j] = (float)x;
    }
}

static void make_close(kit_random *random, occ_box *box, float corner[3][3])
{
    float size = ldexpf(1.0f, (int)kit_below(random, 90) - 50);
    *box = kit_box(random, size * (kit_below(random, 2) ? 1.0f : 1000.0f), size);
    if (kit_below(random, 4) == 0) memset(box->axis[kit_below(random, 3)], 0, 3 * sizeof(float));
    for (int i = 0; i < 3; i++) {
        near_box(random, box, corner[i]);
        if (i && kit_below(random, 3) == 0)
            for (int j = 0; j < 3; j++)
                corner[i][j] += kit_between(random, -3.0f, 3.0f) * size;
    }
    if (kit_below(random, 8) == 0)
        memcpy(corner[2], corner[kit_below(random, 2)], 3 * sizeof(float));
}

// Magnitudes that have nothing to do with each other.
static void make_wild(kit_random *random, occ_box *box, float corner[3][3])
{
    float *number[] = {box->center, box->axis[0], box->axis[1], box->axis[2],
                       corner[0],   corner[1],    corner[2]};
    for (int i = 0; i < 21; i++) {
        int exponent = kit_below(random, 2) ? 0 : (int)kit_below(random, 195) - 149;
        float value = ldexpf(kit_between(random, -1.0f, 1.0f), exponent);
        number[i / 3][i % 3] = kit_below(random, 5) ? value : 0.0f;
    }
}

static void check_pair(const occ_box *box, float corner[3][3], int trial, unsigned seen[3])
{
    occ_ready_box ready;
    occ_ready_box_make(box, &ready);
    KIT_CHECK(ready.flat == !has_volume(box), "trial %d: flat", trial);
    occ_contact want = judge(box, corner);
    const float *const by_pointer[3] = {corner[0], corner[1], corner[2]};
    occ_contact got = occ_ready_box_meets(&ready, by_pointer);
    KIT_CHECK(got == want, "trial %d: %d, not %d", trial, (int)got, (int)want);
    KIT_CHECK(occ_ready_box_entered(&ready, by_pointer) == (want == OCC_ENTERING),
              "trial %d: entered", trial);
    float point[3][3] = {{corner[0][0], corner[0][1], corner[0][2]},
                         {corner[0][0], corner[0][1], corner[0][2]},
                         {corner[0][0], corner[0][1], corner[0][2]}};
    KIT_CHECK(occ_ready_box_holds(&ready, corner[0]) == common_point(box, point, false),
              "trial %d: point", trial);
    seen[want]++;
}

static const struct {
    void (*make)(kit_random *random, occ_box *box, float corner[3][3]);
    const char *name;
    int trials;
} kinds[] = {{make_coarse, "coarse", 4000}, {make_close, "close", 3000}, {make_wild, "wild", 4000}};

START_TEST(contact_is_what_rational_numbers_say)
{
    kit_random random = steady_seed(1, kinds[_i].name);
    unsigned seen[3] = {0};
    for (int trial = 0; trial < kinds[_i].trials; trial++) {
        occ_box box;
        float corner[3][3];
        kinds[_i].make(&random, &box, corner);
        check_pair(&box, corner, trial, seen);
    }
    // Each answer must have been asked for.
    for (int k = 0; k < 3; k++)
        ck_assert_uint_gt(seen[k], 20);
}
END_TEST

static const occ_box cube = {{0, 0, 0}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

START_TEST(surface_is_told_from_the_interior)
{
    occ_ready_box ready;
    occ_ready_box_make(&cube, &ready);
    const float in = nextafterf(1.0f, 0.0f), out = nextafterf(1.0f, 2.0f);
    const float high[3] = {5, 0, 5}, low[3] = {5, 0, -5};
    const struct {
        float x;
        occ_contact contact;
    } want[] = {{1.0f, OCC_TOUCHING}, {in, OCC_ENTERING}, {out, OCC_APART}};
    for (int i = 0; i < 3; i++) {
        const float point[3] = {want[i].x, 0, 0};
        const float *const corner[3] = {point, high, low};
        ck_assert_int_eq(occ_ready_box_meets(&ready, corner), want[i].contact);
        ck_assert_int_eq(occ_ready_box_holds(&ready, point), want[i].contact != OCC_APART);
    }
}
END_TEST

START_TEST(box_within_a_large_triangle_is_entered)
{
    occ_ready_box ready;
    occ_ready_box_make(&cube, &ready);
    const float a[3] = {-1e6f, -1e6f, 0.5f}, b[3] = {1e6f, -1e6f, 0.5f}, c[3] = {0, 1e6f, 0.5f};
    const float *const corner[3] = {a, b, c};
    ck_assert_int_eq(occ_ready_box_meets(&ready, corner), OCC_ENTERING);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("overlap");
    TCase *contacts = tcase_create("contacts");
    tcase_add_loop_test(contacts, contact_is_what_rational_numbers_say, 0,
                        (int)(sizeof kinds / sizeof *kinds));
    tcase_add_test(contacts, surface_is_told_from_the_interior);
    tcase_add_test(contacts, box_within_a_large_triangle_is_entered);
    suite_add_tcase(suite, contacts);
    return test_run_suite(suite);
}
