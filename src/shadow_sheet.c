// SPDX-License-Identifier: Apache-2.0
// Shadow volumes of sheets: a plane through the eye and each edge, and one plane across.
//
// Why it is safe. Let the eye be at 0, and n any vector with n.c > 0 for all corners c, between l,
// the least of these products, and h, the greatest. Let x be inside of the plane of each edge, a to
// b: s (a x b).x > 0, with one and the same s of ±1, and n.x > h. Seen from the eye, on the plane
// n.p = 1, x is strictly on one side of every edge, so that going around the loop turns about it in
// one direction all the way, and comes back: the loop winds around x at least once, one way. What
// is made of triangles and has this loop for its boundary is then met by the line from the eye to
// x, whatever its shape, by more triangles of that orientation than of the other. Where its points
// are between l and h along n, it is met before x, which is hidden. Nothing is said of the corners
// but that: they need be neither in one plane nor convex, and n may be any vector. An edge whose
// ends are one point turns about nothing, and is left out: floats that are equal, no tolerance.
//
// For an orthographic eye n.toward < 0 takes the place of n.c > 0, and all rays are parallel.
//
// What is computed is as in shadow.c: in double, and moved inward by what it may have rounded. n is
// exact, being what it is; only n.c rounds.
#include "shadow.h"

#include "rounding.h"
#include "sheet.h"
#include "vector.h"

#define EPS 0x1p-53

// Bounds the error of every component of ray x axis, where |ray_j| <= from[j].
static double cross_error(const double from[3], const double axis[3])
{
    double most = 0.0;
    for (int j = 0; j < 3; j++) {
        int p = (j + 1) % 3, q = (j + 2) % 3;
        most = occ_larger(most, from[p] * fabs(axis[q]) + from[q] * fabs(axis[p]));
    }
    return 8.0 * EPS * most;
}

// Stores n.x + d > 0, where the components of n are off by at most `normal_error` and d by at most
// `d_error`. False if n is too short for its error: then its direction means nothing.
static bool add_plane(occ_shadow *shadow, const double n[3], double normal_error, double d,
                      double d_error)
{
    double size = occ_largest(n);
    if (!(size > 0.0) || !(size < 1e200) || normal_error > size * 0x1p-26) return false;
    double scale = occ_unit_scale(size);
    float *plane = shadow->plane[shadow->planes++];
    for (int j = 0; j < 3; j++)
        plane[j] = (float)(n[j] * scale);
    double inward = (d - d_error) * scale;
    plane[3] = occ_round_down(inward - fabs(inward) * 0x1p-21);
    return true;
}

// A sheet relative to the eye.
typedef struct loop {
    double corner[OCC_SHEET_CORNERS][3]; // each component within EPS of itself, and the doubt
    uint32_t source[OCC_SHEET_CORNERS];  // which corner of the sheet it is
    uint32_t count;
    double size[3]; // bounds every corner's coordinate; and the doubt about the eye
    double turn;    // s above: 1 if the corners go clockwise for the eye, -1 if they do not
    double n[3];    // away from the eye
    double low, high, error;
} loop;

// An edge's plane through the eye: n.x + d > 0, the sheet inside.
typedef struct side {
    double n[3], error; // of its components
    double middle[3], ray[3];
} side;

static bool same_point(const float a[3], const float b[3])
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

// Takes the corners that are not where the one before is.
static void set_corners(loop *l, const occ_camera *camera, const occ_sheet *sheet)
{
    uint32_t before = sheet->corner_count - 1;
    l->count = 0;
    for (int j = 0; j < 3; j++)
        l->size[j] = 0.0;
    for (uint32_t i = 0; i < sheet->corner_count; before = i++) {
        if (same_point(sheet->corner[i], sheet->corner[before])) continue;
        for (int j = 0; j < 3; j++) {
            double at = (double)sheet->corner[i][j] - camera->eye[j];
            l->corner[l->count][j] = at;
            l->size[j] = occ_larger(l->size[j], fabs(at));
        }
        l->source[l->count++] = i;
    }
    for (int j = 0; j < 3; j++)
        l->size[j] += camera->doubt[j];
}

// How far along n the corners are, and what that may be off by.
static void measure(loop *l)
{
    l->low = INFINITY;
    l->high = -INFINITY;
    for (uint32_t i = 0; i < l->count; i++) {
        double at = occ_dot(l->n, l->corner[i]);
        l->low = at < l->low ? at : l->low;
        l->high = at > l->high ? at : l->high;
    }
    l->error = 16.0 * EPS * occ_dot_magnitude(l->n, l->size);
}

// Turns n away from the eye. False if the eye is not in front of all corners for certain, or on the
// wrong side.
static bool face_eye(loop *l, const occ_camera *camera, const occ_sheet *sheet)
{
    double normal[3], away, error;
    occ_sheet_normal(sheet, normal);
    away = camera->orthographic ? -occ_dot(normal, camera->toward) : occ_dot(normal, l->corner[0]);
    l->turn = away < 0.0 ? -1.0 : 1.0;
    if (sheet->sides == OCC_SIDES_FRONT && l->turn > 0.0) return false;
    for (int j = 0; j < 3; j++)
        l->n[j] = l->turn * normal[j];
    measure(l);
    if (!camera->orthographic) return l->low > l->error;
    error = 8.0 * EPS * occ_dot_magnitude(normal, camera->toward);
    return fabs(away) > error;
}

// --- the planes ----------------------------------------------------------------------------------

// The edge from corner i to the next.
static void set_side(side *e, const loop *l, const occ_camera *camera, const occ_sheet *sheet,
                     uint32_t i)
{
    uint32_t next = i + 1 < l->count ? i + 1 : 0;
    const float *from = sheet->corner[l->source[i]], *to = sheet->corner[l->source[next]];
    const double *a = l->corner[i], *b = l->corner[next];
    double along[3], bound[3];
    for (int j = 0; j < 3; j++) {
        e->middle[j] = 0.5 * (a[j] + b[j]);
        e->ray[j] = camera->orthographic ? -camera->toward[j] : e->middle[j];
        along[j] = (double)to[j] - (double)from[j];
        bound[j] = occ_larger(fabs(a[j]), fabs(b[j])) + camera->doubt[j];
        if (camera->orthographic) bound[j] = fabs(e->ray[j]);
    }
    occ_cross(e->ray, along, e->n);
    for (int j = 0; j < 3; j++)
        e->n[j] *= l->turn;
    e->error = cross_error(bound, along);
}

// Whether the outline is convex for certain, every corner within all edges that do not end there.
static bool is_convex(const loop *l, const side *sides)
{
    for (uint32_t i = 0; i < l->count; i++) {
        const double *n = sides[i].n;
        double slack = 3.0 * sides[i].error * occ_largest(l->size);
        slack += 16.0 * EPS * occ_dot_magnitude(n, l->size);
        for (uint32_t k = 0; k < l->count; k++) {
            if (k == i || k == (i + 1) % l->count) continue;
            if (!(occ_dot(n, l->corner[k]) > slack)) return false;
        }
    }
    return true;
}

// The planes of a convex outline, turned outward about the eye as in shadow.c. Where planes of
// other outlines meet may be far from any corner, so that these stay as they are.
static void turn_outward(side *sides, uint32_t count, double tolerance)
{
    double unit[OCC_SHEET_CORNERS][3], length[OCC_SHEET_CORNERS];
    for (uint32_t i = 0; i < count; i++) {
        length[i] = sqrt(occ_dot(sides[i].n, sides[i].n));
        for (int j = 0; j < 3; j++)
            unit[i][j] = sides[i].n[j] / length[i];
    }
    for (uint32_t i = 0; i < count; i++) {
        uint32_t before = (i + count - 1) % count, after = (i + 1) % count;
        double least = fmin(occ_dot(unit[i], unit[before]), occ_dot(unit[i], unit[after]));
        double limit = fmin(1.0, sqrt(fmax(1.0 + least, 0.0)));
        double by = 0.5 * tolerance * (1.0 - 0x1p-20) * limit;
        double scale = by * length[i] / sqrt(occ_dot(sides[i].ray, sides[i].ray));
        for (int j = 0; j < 3; j++)
            sides[i].n[j] += scale * sides[i].ray[j];
        sides[i].error += 4.0 * EPS * length[i];
    }
}

static bool add_side(occ_shadow *shadow, const loop *l, const occ_camera *camera, const side *e)
{
    const double *n = e->n;
    double d = 0.0, d_error = 8.0 * EPS * occ_dot_magnitude(n, camera->doubt);
    if (camera->orthographic) {
        d = -occ_dot(n, e->middle);
        d_error =
            16.0 * EPS * occ_dot_magnitude(n, l->size) + 3.0 * e->error * occ_largest(l->size);
    }
    return add_plane(shadow, n, e->error, d, d_error);
}

// Every other edge first, and then those between: one that is opposite to the first, as a box has
// them, tells most of what the first leaves open.
static bool add_sides(occ_shadow *shadow, const loop *l, const occ_camera *camera,
                      const occ_sheet *sheet)
{
    side sides[OCC_SHEET_CORNERS];
    for (uint32_t i = 0; i < l->count; i++)
        set_side(&sides[i], l, camera, sheet, i);
    if (camera->tolerance > 0.0 && !camera->orthographic && is_convex(l, sides))
        turn_outward(sides, l->count, camera->tolerance);
    for (uint32_t odd = 0; odd < 2; odd++)
        for (uint32_t i = odd; i < l->count; i += 2)
            if (!add_side(shadow, l, camera, &sides[i])) return false;
    return true;
}

// --- the near plane ------------------------------------------------------------------------------

// Whether all that can stand for the sheet is beyond a plane: on the rays to the corners, from them
// to where they are as near to the eye, along n, as the nearest.
static bool is_beyond(const loop *l, const occ_camera *camera, const double *cutter)
{
    double size = occ_dot_magnitude(cutter, l->size) + fabs(cutter[3]), low = l->low - l->error;
    for (uint32_t i = 0; i < l->count; i++) {
        double at = occ_dot(cutter, l->corner[i]), height = occ_dot(l->n, l->corner[i]);
        double nearer = at / height * (low - height);
        if (camera->orthographic) {
            nearer = occ_dot(cutter, camera->toward) / occ_dot(l->n, camera->toward);
            nearer *= low - height;
        }
        double least = nearer < 0.0 ? at + nearer : at;
        if (!(least + cutter[3] > (size + fabs(nearer)) * 1e-9)) return false;
    }
    return true;
}

// Whether all that the near plane cuts away is in front of the sheet.
static bool cut_is_in_front(const loop *l, const occ_camera *camera)
{
    for (int c = 0; c < 4; c++) {
        const double *corner = camera->near_corner[c];
        double size[3];
        for (int j = 0; j < 3; j++)
            size[j] = fabs(corner[j]) + l->size[j];
        if (!(l->low - occ_dot(l->n, corner) > occ_dot_magnitude(l->n, size) * 1e-9)) return false;
    }
    return true;
}

// As in shadow.c.
static bool survives_near(const loop *l, const occ_camera *camera)
{
    if (camera->cutter == OCC_NO_PLANE) return true;
    if (is_beyond(l, camera, camera->plane[camera->cutter]) &&
        (!camera->far_cuts_too || is_beyond(l, camera, camera->plane[OCC_NEAR_PLANE + 1]))) {
        return true;
    }
    return camera->has_corners && cut_is_in_front(l, camera);
}

bool occ_shadow_of_sheet(occ_shadow *shadow, const occ_camera *camera, const occ_sheet *sheet,
                         uint32_t owner)
{
    loop l;
    set_corners(&l, camera, sheet);
    if (l.count < 3 || !face_eye(&l, camera, sheet) || !survives_near(&l, camera)) return false;
    *shadow = (occ_shadow){.owner = owner};
    if (!add_sides(shadow, &l, camera, sheet)) return false;
    shadow->silhouettes = shadow->planes;
    return add_plane(shadow, l.n, 0.0, -l.high, l.error);
}
