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
#include "overlap.h"

#include "unrounded.h"

#include <math.h>
#include <stdint.h>

#define EDGE_ERROR(e, q)   (16.0 * (e) * (q) + 0x1p-48 * (q) * (q))
#define NORMAL_ERROR(e, q) (128.0 * (e) * (q) * (q) + 0x1p-44 * (q) * (q) * (q))

// The axes: three normals of the box, the triangle's, and the products of edges and the box's axes.
enum { AXIS_FACE = 0, AXIS_NORMAL = 3, AXIS_EDGE = 4 };

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

void occ_ready_box_make(const occ_box *box, occ_ready_box *ready)
{
    double normal[3][3], volume = 0.0, terms = 0.0, most = 0.0;
    *ready = (occ_ready_box){.box = *box, .error = INFINITY};
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

// What a range of a triangle along an axis says where the cube's is [-reach, reach] and their sum
// is off by at most `error`.
typedef enum verdict_on_axis { AXIS_OVERLAPS, AXIS_IN_DOUBT, AXIS_SEPARATES } verdict_on_axis;

static inline verdict_on_axis judge_range(double low, double high, double reach, double error)
{
    if (low > reach + error || high < -reach - error) return AXIS_SEPARATES;
    return low < reach - error && high > error - reach ? AXIS_OVERLAPS : AXIS_IN_DOUBT;
}

// The next are for all axes of a kind: false if one separates, else those in doubt are added.

static bool try_faces(const led_triangle *led, uint32_t *doubt)
{
    for (int k = 0; k < 3; k++) {
        double low = led->q[0][k], high = low;
        for (int i = 1; i < 3; i++) {
            double q = led->q[i][k];
            low = q < low ? q : low;
            high = q > high ? q : high;
        }
        verdict_on_axis verdict = judge_range(low, high, 1.0, led->error);
        if (verdict == AXIS_SEPARATES) return false;
        if (verdict == AXIS_IN_DOUBT) *doubt |= 1u << (AXIS_FACE + k);
    }
    return true;
}

static bool try_edges(const led_triangle *led, uint32_t *doubt)
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
            if (verdict == AXIS_SEPARATES) return false;
            if (verdict == AXIS_IN_DOUBT) *doubt |= 1u << (AXIS_EDGE + 3 * e + k);
        }
    }
    return true;
}

static bool try_normal(const led_triangle *led, uint32_t *doubt)
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
    verdict_on_axis verdict = judge_range(level, level, reach, error);
    if (verdict == AXIS_IN_DOUBT) *doubt |= 1u << AXIS_NORMAL;
    return verdict != AXIS_SEPARATES;
}

static bool surely_inside(const led_triangle *led, int corner)
{
    double limit = 1.0 - led->error;
    const double *q = led->q[corner];
    return fabs(q[0]) < limit && fabs(q[1]) < limit && fabs(q[2]) < limit;
}

// Whether floating point has the answer; if not, `doubt` has the axes that are left.
static bool decide_in_doubles(const occ_ready_box *ready, const float *const corner[3],
                              occ_contact *contact, uint32_t *doubt)
{
    led_triangle led;
    *doubt = (1u << 13) - 1;
    lead(ready, corner, 3, &led);
    if (!(led.error < 0x1p-10)) return false;
    *doubt = 0;
    *contact = OCC_ENTERING;
    if (surely_inside(&led, 0) || surely_inside(&led, 1) || surely_inside(&led, 2)) return true;
    if (try_faces(&led, doubt) && try_normal(&led, doubt) && try_edges(&led, doubt))
        return *doubt == 0;
    *contact = OCC_APART;
    return true;
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

static occ_contact contact_along_axis(const exact_pair *pair, const occ_ready_box *ready,
                                      uint32_t axis)
{
    occ_unrounded_vector n;
    if (axis < AXIS_NORMAL) {
        // The elements of the inverse are zero where the normal's are: no rounding makes one so.
        const double *row = ready->inverse[axis];
        int used = (row[0] != 0.0) + (row[1] != 0.0) + (row[2] != 0.0);
        if (used == 1) {
            n = unit_vector(row[0] != 0.0 ? 0 : row[1] != 0.0 ? 1 : 2);
        } else {
            n = occ_unrounded_cross(&pair->axis[(axis + 1) % 3], &pair->axis[(axis + 2) % 3]);
        }
    } else if (axis == AXIS_NORMAL) {
        n = occ_unrounded_cross(&pair->edge[0], &pair->edge[1]);
    } else {
        n = occ_unrounded_cross(&pair->edge[(axis - AXIS_EDGE) / 3],
                                &pair->axis[(axis - AXIS_EDGE) % 3]);
    }
    return contact_along(pair, &n);
}

// The axes of `mask`, which are all that matter.
static occ_contact decide_exactly(const occ_ready_box *ready, const float *const corner[3],
                                  uint32_t mask)
{
    exact_pair pair;
    make_exact(&ready->box, corner, &pair);
    occ_contact contact = OCC_ENTERING;
    for (uint32_t axis = 0; mask && contact != OCC_APART; axis++, mask >>= 1) {
        if (!(mask & 1u)) continue;
        occ_contact along = contact_along_axis(&pair, ready, axis);
        if (along < contact) contact = along;
    }
    return contact;
}

// A flat box and a triangle may lie in one plane or line, where the axes above do not suffice. All
// edges being in one plane, the products of them with the coordinates' directions are perpendicular
// to them, and one of the three for each edge is not perpendicular to the plane as well; being in
// one line, the three of one edge hold the triangle to the line, and a coordinate's direction
// compares along it.
static occ_contact decide_flat(const occ_ready_box *ready, const float *const corner[3])
{
    exact_pair pair;
    occ_contact contact = decide_exactly(ready, corner, (1u << 13) - 1);
    if (contact == OCC_APART) return OCC_APART;
    make_exact(&ready->box, corner, &pair);
    for (int k = 0; k < 3; k++) {
        occ_unrounded_vector unit = unit_vector(k);
        if (contact_along(&pair, &unit) == OCC_APART) return OCC_APART;
        for (int i = 0; i < 6; i++) {
            occ_unrounded_vector n =
                occ_unrounded_cross(i < 3 ? &pair.edge[i] : &pair.axis[i - 3], &unit);
            if (contact_along(&pair, &n) == OCC_APART) return OCC_APART;
        }
    }
    return OCC_TOUCHING;
}

// --- questions -----------------------------------------------------------------------------------

occ_contact occ_ready_box_meets(const occ_ready_box *ready, const float *const corner[3])
{
    occ_contact contact;
    uint32_t doubt;
    if (ready->flat) return decide_flat(ready, corner);
    if (decide_in_doubles(ready, corner, &contact, &doubt)) return contact;
    return decide_exactly(ready, corner, doubt);
}

bool occ_ready_box_holds(const occ_ready_box *ready, const float *point)
{
    const float *const corner[3] = {point, point, point};
    if (ready->flat) return decide_flat(ready, corner) != OCC_APART;
    led_triangle led;
    lead(ready, corner, 1, &led);
    if (surely_inside(&led, 0)) return true;
    if (led.most > 1.0 + led.error) return false;
    return decide_exactly(ready, corner, 7u << AXIS_FACE) != OCC_APART;
}
