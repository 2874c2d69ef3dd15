// SPDX-License-Identifier: Apache-2.0
// How a box is turned: for a direction, the best rectangle around the points seen along it is found
// exactly (Freeman and Shapira, "Determining the minimum-area encasing rectangle", 1975: one side
// lies along the hull). Directions are tried from the points' axes, their spread and the
// tetrahedra of Larsson and Kallberg; the best are improved by looking along the other sides of
// the box found, and by tilting.
#include "soup/fit.h"

#include "soup/jacobi.h"
#include "vector.h"

#include <math.h>
#include <string.h>

// A frame and what its box measures.
typedef struct fit {
    occ_frame3 frame;
    double measure;
} fit;

static void subtract3(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = a[k] - b[k];
}

// False if there is no direction.
static bool normalize3(double a[3])
{
    double most = fmax(fabs(a[0]), fmax(fabs(a[1]), fabs(a[2])));
    if (!(most > 0.0)) return false;
    for (int k = 0; k < 3; k++)
        a[k] /= most; // squares of small numbers would vanish
    double length = sqrt(occ_dot(a, a));
    for (int k = 0; k < 3; k++)
        a[k] /= length;
    return true;
}

// Two directions that make a frame with n.
static void complete(const double n[3], double u[3], double v[3])
{
    int least = 0;
    for (int k = 1; k < 3; k++)
        if (fabs(n[k]) < fabs(n[least])) least = k;
    double unit[3] = {0.0, 0.0, 0.0};
    unit[least] = 1.0;
    occ_cross(n, unit, u);
    normalize3(u);
    occ_cross(n, u, v);
}

// --- the best box for a direction ----------------------------------------------------------------

// The points seen along a direction.
typedef struct flat_points {
    int count;
    double same; // the square of a distance that is none: rounding alone makes it
    double at[OCC_FIT_POINTS][2];
} flat_points;

static double turn(const double *a, const double *b, const double *c)
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static double distance2(const double *a, const double *b)
{
    return (b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1]);
}

// Wraps the hull, counterclockwise. Rounding may make it a little wrong, which costs a candidate.
static void wrap(const flat_points *all, flat_points *hull)
{
    int start = 0;
    for (int i = 1; i < all->count; i++) {
        const double *p = all->at[i], *q = all->at[start];
        if (p[0] < q[0] || (p[0] == q[0] && p[1] < q[1])) start = i;
    }
    hull->count = 0;
    for (int here = start; hull->count < all->count;) {
        const double *p = all->at[here];
        memcpy(hull->at[hull->count++], p, 2 * sizeof *p);
        int next = -1;
        for (int i = 0; i < all->count; i++) {
            const double *q = all->at[i];
            if (distance2(p, q) <= all->same) continue;
            double side = next < 0 ? -1.0 : turn(p, all->at[next], q);
            bool beyond = side == 0.0 && distance2(p, q) > distance2(p, all->at[next]);
            if (side < 0.0 || beyond) next = i;
        }
        if (next < 0 || distance2(all->at[next], hull->at[0]) <= all->same) break;
        here = next;
    }
}

// The sides of the rectangle along (x, y), of length 1.
static void rectangle(const flat_points *hull, double x, double y, double *along, double *across)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int i = 0; i < hull->count; i++) {
        const double *p = hull->at[i];
        const double s[2] = {x * p[0] + y * p[1], x * p[1] - y * p[0]};
        for (int k = 0; k < 2; k++) {
            if (s[k] < low[k]) low[k] = s[k];
            if (s[k] > high[k]) high[k] = s[k];
        }
    }
    *along = high[0] - low[0];
    *across = high[1] - low[1];
}

// The best frame with n as its first axis.
static fit fit_along(const occ_sample *sample, const double n[3])
{
    fit best = {.measure = INFINITY};
    flat_points seen, hull;
    double u[3], v[3], low = INFINITY, high = -INFINITY;
    complete(n, u, v);
    seen.count = sample->count;
    seen.same = sample->grain * sample->grain * 0x1p-40;
    for (int i = 0; i < sample->count; i++) {
        double s = occ_dot(n, sample->at[i]);
        low = s < low ? s : low;
        high = s > high ? s : high;
        seen.at[i][0] = occ_dot(u, sample->at[i]);
        seen.at[i][1] = occ_dot(v, sample->at[i]);
    }
    wrap(&seen, &hull);
    double x = 1.0, y = 0.0;
    for (int i = 0; i < hull.count; i++) {
        const double *p = hull.at[i], *q = hull.at[(i + 1) % hull.count];
        double length = sqrt(distance2(p, q)), side[3] = {high - low, 0.0, 0.0};
        double dx = length > 0.0 ? (q[0] - p[0]) / length : 1.0;
        double dy = length > 0.0 ? (q[1] - p[1]) / length : 0.0;
        rectangle(&hull, dx, dy, &side[1], &side[2]);
        double measure = occ_fit_measure(sample, side);
        if (!(measure < best.measure)) continue;
        best.measure = measure;
        x = dx;
        y = dy;
    }
    // The hull, made with rounding, may lack a point: what is said of the best is true of all.
    double side[3] = {high - low, 0.0, 0.0};
    rectangle(&seen, x, y, &side[1], &side[2]);
    best.measure = occ_fit_measure(sample, side);
    memcpy(best.frame.axis[0], n, 3 * sizeof *n);
    for (int k = 0; k < 3; k++)
        best.frame.axis[1][k] = x * u[k] + y * v[k];
    normalize3(best.frame.axis[1]);
    occ_cross(n, best.frame.axis[1], best.frame.axis[2]);
    return best;
}

// --- where to start ------------------------------------------------------------------------------

enum { STARTS = 2, TILTS = 7, FEW = 5 };

// The best fits so far, best first.
typedef struct ranking {
    const occ_sample *sample;
    int count;
    fit at[STARTS];
} ranking;

static void try_direction(ranking *list, const double direction[3])
{
    double n[3] = {direction[0], direction[1], direction[2]};
    if (!normalize3(n)) return;
    fit found = fit_along(list->sample, n);
    int place = list->count;
    while (place && found.measure < list->at[place - 1].measure)
        place--;
    // The same box is often found from several sides.
    if (place && found.measure <= list->at[place - 1].measure * (1.0 + 1e-6)) return;
    if (place == STARTS) return;
    if (list->count < STARTS) list->count++;
    for (int i = list->count - 1; i > place; i--)
        list->at[i] = list->at[i - 1];
    list->at[place] = found;
}

static void try_spread(ranking *list)
{
    const occ_sample *sample = list->sample;
    double mean[3] = {0}, c[3][3] = {{0}}, axes[3][3];
    for (int i = 0; i < sample->count; i++)
        for (int k = 0; k < 3; k++)
            mean[k] += sample->at[i][k] / sample->count;
    for (int i = 0; i < sample->count; i++) {
        double d[3];
        subtract3(sample->at[i], mean, d);
        for (int k = 0; k < 9; k++)
            c[k / 3][k % 3] += d[k / 3] * d[k % 3];
    }
    occ_jacobi_axes(c, 8, axes);
    for (int k = 0; k < 3; k++)
        try_direction(list, axes[k]);
}

// The sample's point that is furthest in a direction, or against it.
static const double *furthest(const occ_sample *sample, const double n[3], double sign)
{
    const double *found = sample->at[0];
    for (int i = 1; i < sample->count; i++)
        if (sign * occ_dot(n, sample->at[i]) > sign * occ_dot(n, found)) found = sample->at[i];
    return found;
}

// Two points as far apart as is easily found, the one furthest from their line, and the two on
// either side of the plane of all three.
static void find_corners(const occ_sample *sample, const double *corner[FEW], double normal[3])
{
    double e[3], most = -1.0;
    corner[0] = corner[1] = corner[2] = sample->at[0];
    for (int i = 0; i + 1 < sample->count; i += 2) { // pairs of opposite extremes come first
        subtract3(sample->at[i + 1], sample->at[i], e);
        double length = occ_dot(e, e);
        if (length <= most) continue;
        most = length;
        corner[0] = sample->at[i];
        corner[1] = sample->at[i + 1];
    }
    subtract3(corner[1], corner[0], e);
    most = -1.0;
    for (int i = 0; i < sample->count; i++) {
        double d[3], n[3];
        subtract3(sample->at[i], corner[0], d);
        occ_cross(e, d, n);
        double off = occ_dot(n, n);
        if (off <= most) continue;
        most = off;
        corner[2] = sample->at[i];
        memcpy(normal, n, sizeof n);
    }
    corner[3] = furthest(sample, normal, 1.0);
    corner[4] = furthest(sample, normal, -1.0);
}

static void try_tetrahedra(ranking *list)
{
    const double *corner[FEW];
    double normal[3] = {0}, e[3], f[3];
    find_corners(list->sample, corner, normal);
    try_direction(list, normal);
    for (int i = 0; i < 3; i++) {
        subtract3(corner[(i + 1) % 3], corner[i], e);
        try_direction(list, e);
        for (int top = 3; top < FEW; top++) {
            subtract3(corner[top], corner[i], f);
            try_direction(list, f);
            occ_cross(e, f, normal);
            try_direction(list, normal);
        }
    }
}

// --- improving -----------------------------------------------------------------------------------

static bool take_if_better(fit *best, const fit *other)
{
    if (!(other->measure < best->measure * (1.0 - 1e-9))) return false;
    *best = *other;
    return true;
}

// Looks along each side of the box in turn.
static void look_along_sides(const occ_sample *sample, fit *best)
{
    for (int k = 0, idle = 0, tries = 0; idle < 3 && tries < 24; k = (k + 1) % 3, tries++) {
        fit other = fit_along(sample, best->frame.axis[k]);
        idle = take_if_better(best, &other) ? 0 : idle + 1;
    }
}

static bool tilt(const occ_sample *sample, fit *best, double step)
{
    const occ_frame3 from = best->frame;
    bool better = false;
    for (int way = 0; way < 4; way++) {
        double n[3];
        for (int k = 0; k < 3; k++)
            n[k] = from.axis[0][k] + (way & 1 ? -step : step) * from.axis[1 + way / 2][k];
        if (!normalize3(n)) continue;
        fit other = fit_along(sample, n);
        better = take_if_better(best, &other) || better;
    }
    return better;
}

static void improve(const occ_sample *sample, fit *best)
{
    look_along_sides(sample, best);
    double step = 0.25;
    for (int level = 0; level < TILTS; level++, step *= 0.5)
        for (int tries = 0; tries < 6 && tilt(sample, best, step); tries++)
            look_along_sides(sample, best);
}

void occ_fit_frame(const occ_sample *sample, occ_frame3 *frame)
{
    static const double unit[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    ranking list = {.sample = sample};
    for (int k = 0; k < 3; k++)
        try_direction(&list, unit[k]);
    try_spread(&list);
    try_tetrahedra(&list);
    int best = 0;
    for (int i = 0; i < list.count; i++) {
        improve(sample, &list.at[i]);
        if (list.at[i].measure < list.at[best].measure) best = i;
    }
    *frame = list.at[best].frame;
}
