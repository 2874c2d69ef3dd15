// SPDX-License-Identifier: Apache-2.0
// Separating axes (Gottschalk, "Separating axis theorem", TR96-024). In floating point the box is
// led to the cube [-1, 1]^3 and the triangle with it, as in Akenine-Moller, "Fast 3D triangle-box
// overlap testing", 2001; axes that cannot be decided there are tested in world space without
// rounding.
//
// Errors. u is 2^-53, q a coordinate in the cube's space, e its error, Q >= 1 a bound on all |q|.
// An edge is off by 2e + 2uQ, its product with a cube's axis and the reach of the cube along that
// by 12eQ + 20uQ^2 in sum; the triangle's normal times a corner and its reach by
// 120eQ^2 + 312uQ^3. As long as e < 2^-10 the terms of higher order are less than what was added
// to these in EDGE_ERROR and NORMAL_ERROR.
#include "soup/overlap.h"

#include "soup/unrounded.h"

#include <math.h>
#include <stdint.h>

#define EDGE_ERROR(e, q)   (16.0 * (e) * (q) + 0x1p-48 * (q) * (q))
#define NORMAL_ERROR(e, q) (128.0 * (e) * (q) * (q) + 0x1p-44 * (q) * (q) * (q))

// The axes: three normals of the box, the triangle's, and the products of edges and the box's axes.
enum { AXIS_FACE = 0, AXIS_NORMAL = 3, AXIS_EDGE = 4, AXES = 13 };

// --- making ready --------------------------------------------------------------------------------

// The products of two floats are doubles, so that each coordinate is rounded once.
static void cross_floats(const float *a, const float *b, double out[3])
{
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        out[k] = (double)a[i] * (double)b[j] - (double)a[j] * (double)b[i];
    }
}

static bool has_no_volume(const occ_box *box)
{
    occ_unrounded_vector a[3];
    for (int k = 0; k < 3; k++)
        a[k] = occ_unrounded_vector_from(box->axis[k]);
    return occ_unrounded_determinant(&a[0], &a[1], &a[2]).sign == 0;
}

// The one element of a row that is not zero, or -1 if there are several. The elements of the
// inverse are zero where those of the normals are: rounding makes none so.
static int only_element(const double row[3])
{
    int used = (row[0] != 0.0) + (row[1] != 0.0) + (row[2] != 0.0);
    if (used != 1) return -1;
    return row[0] != 0.0 ? 0 : row[1] != 0.0 ? 1 : 2;
}

void occ_ready_box_make(const occ_box *box, occ_ready_box *ready)
{
    double normal[3][3], volume = 0.0, terms = 0.0, most = 0.0;
    *ready = (occ_ready_box){.box = *box, .error = INFINITY, .along = {-1, -1, -1}};
    for (int k = 0; k < 3; k++)
        cross_floats(box->axis[(k + 1) % 3], box->axis[(k + 2) % 3], normal[k]);
    for (int j = 0; j < 3; j++) {
        double term = (double)box->axis[0][j] * normal[0][j];
        volume += term;
        terms += fabs(term);
    }
    // The volume is off by less than 5u terms.
    if (!(fabs(volume) > 0x1p-40 * terms)) {
        ready->flat = has_no_volume(box);
        return;
    }
    for (int k = 0; k < 3; k++) {
        double size = 0.0;
        for (int j = 0; j < 3; j++) {
            ready->inverse[k][j] = normal[k][j] / volume;
            size += fabs(ready->inverse[k][j]);
        }
        if (size > most) most = size;
    }
    // An element of the inverse is off by 2u and the volume's error, relative to itself; led with
    // it, a coordinate by 4u more of the sum of magnitudes (its own difference, product, two sums).
    for (int k = 0; k < 3; k++)
        ready->along[k] = only_element(ready->inverse[k]);
    ready->error = most * (8.0 + 6.0 * (terms / fabs(volume))) * 0x1p-53;
}

// --- in floating point ---------------------------------------------------------------------------

// A triangle in the space where the box is a cube.
typedef struct led_triangle {
    double q[3][3];
    double error; // of each coordinate
    double most;  // no coordinate is larger; 1 at least
} led_triangle;

// Three points, relative to the center, led to the cube's space.
static void lead(const occ_ready_box *ready, const float *const *corner, int corners,
                 led_triangle *led)
{
    double reach = 0.0, most = 1.0;
    for (int i = 0; i < corners; i++) {
        double d[3];
        for (int j = 0; j < 3; j++) {
            d[j] = (double)corner[i][j] - (double)ready->box.center[j];
            if (fabs(d[j]) > reach) reach = fabs(d[j]);
        }
        for (int k = 0; k < 3; k++) {
            const double *row = ready->inverse[k];
            double q = row[0] * d[0] + row[1] * d[1] + row[2] * d[2];
            if (fabs(q) > most) most = fabs(q);
            led->q[i][k] = q;
        }
    }
    led->error = ready->error * reach;
    led->most = most;
}

// What an axis tells of a triangle and the box.
typedef enum verdict_on_axis {
    AXIS_OVERLAPS, // nothing
    AXIS_TOUCHES,  // that they touch at most
    AXIS_IN_DOUBT,
    AXIS_SEPARATES // that they are apart
} verdict_on_axis;

// Of a triangle's range along an axis and the cube's, [-reach, reach], which in sum are off by at
// most `error`.
static inline verdict_on_axis judge_range(double low, double high, double reach, double error)
{
    if (low > reach + error || high < -reach - error) return AXIS_SEPARATES;
    return low < reach - error && high > error - reach ? AXIS_OVERLAPS : AXIS_IN_DOUBT;
}

// The same without rounding where the faces are perpendicular to a coordinate and differences of
// floats are doubles, as they mostly are.
static verdict_on_axis judge_upright(const occ_ready_box *ready, const float *const *corner,
                                     int corners, int k)
{
    int j = ready->along[k];
    double center = (double)ready->box.center[j], half = fabs((double)ready->box.axis[k][j]);
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < corners; i++) {
        double x = (double)corner[i][j], d = x - center;
        if (center + d != x || x - d != center) return AXIS_IN_DOUBT;
        low = d < low ? d : low;
        high = d > high ? d : high;
    }
    if (low > half || high < -half) return AXIS_SEPARATES;
    return low < half && high > -half ? AXIS_OVERLAPS : AXIS_TOUCHES;
}

// What is known on the way.
typedef struct contact_search {
    const occ_ready_box *ready;
    const float *const *corner;
    occ_contact contact; // no better than this
    occ_contact enough;  // the search may end there
    uint32_t doubt;      // axes that floating point left
} contact_search;

// Whether the search may go on.
static inline bool take_verdict(contact_search *search, verdict_on_axis verdict, int axis)
{
    if (verdict == AXIS_SEPARATES) search->contact = OCC_APART;
    if (verdict == AXIS_TOUCHES) search->contact = OCC_TOUCHING;
    if (verdict == AXIS_IN_DOUBT) search->doubt |= 1u << axis;
    return search->contact > search->enough;
}

// The next are for all axes of a kind: false ends the search.

static bool try_faces(contact_search *search, const led_triangle *led, int corners)
{
    for (int k = 0; k < 3; k++) {
        double low = led->q[0][k], high = low;
        for (int i = 1; i < corners; i++) {
            double q = led->q[i][k];
            low = q < low ? q : low;
            high = q > high ? q : high;
        }
        verdict_on_axis verdict = judge_range(low, high, 1.0, led->error);
        if (verdict == AXIS_IN_DOUBT && search->ready->along[k] >= 0)
            verdict = judge_upright(search->ready, search->corner, corners, k);
        if (!take_verdict(search, verdict, AXIS_FACE + k)) return false;
    }
    return true;
}

static bool try_edges(contact_search *search, const led_triangle *led)
{
    double error = EDGE_ERROR(led->error, led->most);
    for (int e = 0; e < 3; e++) {
        const double *a = led->q[e], *b = led->q[(e + 1) % 3], *c = led->q[(e + 2) % 3];
        const double f[3] = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
        for (int k = 0; k < 3; k++) {
            int i = (k + 1) % 3, j = (k + 2) % 3;
            double p = f[j] * a[i] - f[i] * a[j], r = f[j] * c[i] - f[i] * c[j];
            double low = p < r ? p : r, high = p < r ? r : p;
            verdict_on_axis verdict = judge_range(low, high, fabs(f[i]) + fabs(f[j]), error);
            if (!take_verdict(search, verdict, AXIS_EDGE + 3 * e + k)) return false;
        }
    }
    return true;
}

static bool try_normal(contact_search *search, const led_triangle *led)
{
    const double *a = led->q[0], *b = led->q[1], *c = led->q[2];
    double level = 0.0, reach = 0.0;
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        double n = (b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i]);
        level += n * a[k];
        reach += fabs(n);
    }
    double error = NORMAL_ERROR(led->error, led->most);
    return take_verdict(search, judge_range(level, level, reach, error), AXIS_NORMAL);
}

static bool surely_inside(const led_triangle *led, int corner)
{
    double limit = 1.0 - led->error;
    const double *q = led->q[corner];
    return fabs(q[0]) < limit && fabs(q[1]) < limit && fabs(q[2]) < limit;
}

// All that floating point has to say; what it cannot is in `doubt`.
static void search_in_doubles(contact_search *search)
{
    led_triangle led;
    lead(search->ready, search->corner, 3, &led);
    if (!(led.error < 0x1p-10)) {
        search->doubt = (1u << AXES) - 1;
        return;
    }
    if (surely_inside(&led, 0) || surely_inside(&led, 1) || surely_inside(&led, 2)) return;
    (void)(try_faces(search, &led, 3) && try_normal(search, &led) && try_edges(search, &led));
}

// --- without rounding ----------------------------------------------------------------------------

// The triangle relative to the box's center, its edges, and the box's axes.
typedef struct exact_pair {
    occ_unrounded_vector corner[3], edge[3], axis[3];
} exact_pair;

static void make_exact(const occ_box *box, const float *const corner[3], exact_pair *pair)
{
    occ_unrounded_vector center = occ_unrounded_vector_from(box->center);
    for (int i = 0; i < 3; i++) {
        occ_unrounded_vector point = occ_unrounded_vector_from(corner[i]);
        pair->corner[i] = occ_unrounded_vector_subtract(&point, &center);
        pair->axis[i] = occ_unrounded_vector_from(box->axis[i]);
    }
    for (int i = 0; i < 3; i++)
        pair->edge[i] = occ_unrounded_vector_subtract(&pair->corner[(i + 1) % 3], &pair->corner[i]);
}

// The sign of value - reach, where reach >= 0.
static int sign_beyond(const occ_unrounded *value, const occ_unrounded *reach)
{
    if (value->sign > 0) return occ_unrounded_compare_magnitude(value, reach);
    return value->sign == 0 && reach->sign == 0 ? 0 : -1;
}

// What the direction n tells apart. The zero vector tells nothing.
static occ_contact contact_along(const exact_pair *pair, const occ_unrounded_vector *n)
{
    if (n->at[0].sign == 0 && n->at[1].sign == 0 && n->at[2].sign == 0) return OCC_ENTERING;
    occ_unrounded reach = {0};
    for (int k = 0; k < 3; k++) {
        occ_unrounded part = occ_unrounded_dot(n, &pair->axis[k]);
        part.sign = part.sign != 0;
        reach = occ_unrounded_add(&reach, &part);
    }
    int least_above = 1, least_below = 1; // how far beyond the reach, on either side
    for (int i = 0; i < 3; i++) {
        occ_unrounded value = occ_unrounded_dot(n, &pair->corner[i]);
        int above = sign_beyond(&value, &reach);
        value.sign = -value.sign;
        int below = sign_beyond(&value, &reach);
        least_above = above < least_above ? above : least_above;
        least_below = below < least_below ? below : least_below;
    }
    int most = least_above > least_below ? least_above : least_below;
    return most > 0 ? OCC_APART : most == 0 ? OCC_TOUCHING : OCC_ENTERING;
}

// The k-th coordinate's direction, as a number of no factor.
static occ_unrounded_vector unit_vector(int k)
{
    occ_unrounded_vector unit = {0};
    unit.at[k] = (occ_unrounded){.sign = 1, .used = 1, .limb = {1}};
    return unit;
}

static occ_contact contact_along_axis(const exact_pair *pair, const occ_ready_box *ready, int axis)
{
    occ_unrounded_vector n;
    if (axis < AXIS_NORMAL) {
        n = ready->along[axis] >= 0
                ? unit_vector(ready->along[axis])
                : occ_unrounded_cross(&pair->axis[(axis + 1) % 3], &pair->axis[(axis + 2) % 3]);
    } else if (axis == AXIS_NORMAL) {
        n = occ_unrounded_cross(&pair->edge[0], &pair->edge[1]);
    } else {
        n = occ_unrounded_cross(&pair->edge[(axis - AXIS_EDGE) / 3],
                                &pair->axis[(axis - AXIS_EDGE) % 3]);
    }
    return contact_along(pair, &n);
}

// The axes in doubt.
static void search_exactly(contact_search *search)
{
    if (search->contact <= search->enough || !search->doubt) return;
    exact_pair pair;
    make_exact(&search->ready->box, search->corner, &pair);
    for (int axis = 0; axis < AXES && search->contact > search->enough; axis++) {
        if (!(search->doubt >> axis & 1u)) continue;
        occ_contact along = contact_along_axis(&pair, search->ready, axis);
        if (along < search->contact) search->contact = along;
    }
}

// A flat box and a triangle may lie in one plane or line, where the axes above do not suffice. All
// edges being in one plane, the products of them with the coordinates' directions are perpendicular
// to them, and one of the three for each edge is not perpendicular to the plane as well; being in
// one line, the three of one edge hold the triangle to the line, and a coordinate's direction
// compares along it.
static bool flat_box_is_met(const occ_ready_box *ready, const float *const corner[3])
{
    exact_pair pair;
    contact_search search = {ready, corner, OCC_TOUCHING, OCC_APART, (1u << AXES) - 1};
    search_exactly(&search);
    if (search.contact == OCC_APART) return false;
    make_exact(&ready->box, corner, &pair);
    for (int k = 0; k < 3; k++) {
        occ_unrounded_vector unit = unit_vector(k);
        if (contact_along(&pair, &unit) == OCC_APART) return false;
        for (int i = 0; i < 6; i++) {
            occ_unrounded_vector n =
                occ_unrounded_cross(i < 3 ? &pair.edge[i] : &pair.axis[i - 3], &unit);
            if (contact_along(&pair, &n) == OCC_APART) return false;
        }
    }
    return true;
}

// Whether a direction surely does not tell a point, d from the center, from a flat box. `n` and `d`
// are off by 2^-53 of each element, or not at all: what is zero here is zero.
static bool surely_not_apart(const occ_ready_box *ready, const double n[3], const double d[3])
{
    double value = 0.0, reach = 0.0, terms = 0.0;
    for (int j = 0; j < 3; j++) {
        value += n[j] * d[j];
        terms += fabs(n[j] * d[j]);
    }
    for (int k = 0; k < 3; k++) {
        double part = 0.0;
        for (int j = 0; j < 3; j++) {
            double term = n[j] * (double)ready->box.axis[k][j];
            part += term;
            terms += fabs(term);
        }
        reach += fabs(part);
    }
    return fabs(value) + terms * 0x1p-49 <= reach;
}

// The same of all directions that matter for a point: see flat_box_is_met().
static bool flat_box_surely_holds(const occ_ready_box *ready, const float *point)
{
    double d[3], n[3];
    for (int j = 0; j < 3; j++)
        d[j] = (double)point[j] - (double)ready->box.center[j];
    for (int k = 0; k < 3; k++) {
        float unit[3] = {0.0f, 0.0f, 0.0f};
        unit[k] = 1.0f;
        cross_floats(ready->box.axis[k], ready->box.axis[(k + 1) % 3], n);
        if (!surely_not_apart(ready, n, d)) return false;
        for (int i = 0; i < 3; i++) {
            cross_floats(ready->box.axis[i], unit, n);
            if (!surely_not_apart(ready, n, d)) return false;
        }
        for (int j = 0; j < 3; j++)
            n[j] = (double)unit[j];
        if (!surely_not_apart(ready, n, d)) return false;
    }
    return true;
}

// --- questions -----------------------------------------------------------------------------------

static occ_contact contact_of(const occ_ready_box *ready, const float *const corner[3],
                              occ_contact enough)
{
    contact_search search = {ready, corner, OCC_ENTERING, enough, 0};
    search_in_doubles(&search);
    search_exactly(&search);
    return search.contact;
}

occ_contact occ_ready_box_meets(const occ_ready_box *ready, const float *const corner[3])
{
    if (ready->flat) return flat_box_is_met(ready, corner) ? OCC_TOUCHING : OCC_APART;
    return contact_of(ready, corner, OCC_APART);
}

bool occ_ready_box_entered(const occ_ready_box *ready, const float *const corner[3])
{
    return !ready->flat && contact_of(ready, corner, OCC_TOUCHING) == OCC_ENTERING;
}

bool occ_ready_box_holds(const occ_ready_box *ready, const float *point)
{
    const float *const corner[3] = {point, point, point};
    if (ready->flat) return flat_box_surely_holds(ready, point) || flat_box_is_met(ready, corner);
    led_triangle led;
    lead(ready, corner, 1, &led);
    if (surely_inside(&led, 0)) return true;
    contact_search search = {ready, corner, OCC_ENTERING, OCC_APART, 0};
    if (try_faces(&search, &led, 1)) search_exactly(&search);
    return search.contact != OCC_APART;
}
