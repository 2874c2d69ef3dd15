// SPDX-License-Identifier: Apache-2.0
// What boxes and triangles touch of the frustum. A convex box and a convex frustum meet if a face
// of the box, cut by the frustum's planes, leaves something, or if the box holds the frustum's near
// corners.
#include "truth_shape.h"

#include <math.h>
#include <string.h>

static void find_corners(const truth_view *view, const occ_box *box, double corners[8][3])
{
    for (int i = 0; i < 8; i++)
        for (int j = 0; j < 3; j++) {
            double sum = (double)box->center[j] - view->eye[j];
            for (int k = 0; k < 3; k++)
                sum += (i >> k & 1 ? 1.0 : -1.0) * (double)box->axis[k][j];
            corners[i][j] = sum;
        }
}

static void cut(truth_polygon *polygon, const double plane[4])
{
    truth_polygon whole = *polygon;
    polygon->count = 0;
    for (int i = 0; i < whole.count; i++) {
        const double *a = whole.corner[i], *b = whole.corner[(i + 1) % whole.count];
        double at_a = truth_value(plane, a), at_b = truth_value(plane, b);
        if (at_a >= 0.0 && polygon->count < TRUTH_MAX_CORNERS)
            memcpy(polygon->corner[polygon->count++], a, 3 * sizeof *a);
        if ((at_a >= 0.0) == (at_b >= 0.0) || polygon->count == TRUTH_MAX_CORNERS) continue;
        double *between = polygon->corner[polygon->count++];
        for (int j = 0; j < 3; j++)
            between[j] = a[j] + (b[j] - a[j]) * (at_a / (at_a - at_b));
    }
}

static void cut_to_frustum(const truth_view *view, truth_polygon *polygon)
{
    for (int p = 0; p < TRUTH_PLANES && polygon->count > 0; p++)
        if (view->has_plane[p]) cut(polygon, view->plane[p]);
}

void truth_face(const truth_view *view, const occ_box *box, int face, truth_polygon *polygon)
{
    static const int turn[4] = {0, 1, 3, 2};
    double corners[8][3];
    find_corners(view, box, corners);
    int k = face / 2, i = (k + 1) % 3, j = (k + 2) % 3;
    polygon->count = 4;
    for (int c = 0; c < 4; c++) {
        int corner = (face & 1) << k | (turn[c] & 1) << i | turn[c] >> 1 << j;
        memcpy(polygon->corner[c], corners[corner], sizeof corners[corner]);
    }
    cut_to_frustum(view, polygon);
}

bool truth_face_is_seen(const truth_view *view, const occ_box *box, int face)
{
    int k = face / 2;
    double u[3], v[3], out[3], normal[3], middle[3], side = face & 1 ? 1.0 : -1.0;
    for (int j = 0; j < 3; j++) {
        u[j] = (double)box->axis[(k + 1) % 3][j];
        v[j] = (double)box->axis[(k + 2) % 3][j];
        out[j] = side * (double)box->axis[k][j];
        middle[j] = (double)box->center[j] - view->eye[j] + out[j];
    }
    truth_cross(u, v, normal);
    bool is_perspective = view->row[2][3] == 0.0;
    double facing = truth_dot(normal, is_perspective ? middle : view->direction[0]);
    return facing * truth_dot(normal, out) <= 0.0;
}

// The rays that meet a point; all of them if it is too near for a quotient.
static void widen(const truth_view *view, const double point[3], double bounds[4])
{
    double divisor = truth_value(view->row[2], point);
    double x = truth_value(view->row[0], point), y = truth_value(view->row[1], point);
    bool is_sound = divisor > 1e-9 * (fabs(x) + fabs(y));
    bounds[0] = is_sound ? fmin(bounds[0], x / divisor) : -1.0;
    bounds[1] = is_sound ? fmin(bounds[1], y / divisor) : -1.0;
    bounds[2] = is_sound ? fmax(bounds[2], x / divisor) : 1.0;
    bounds[3] = is_sound ? fmax(bounds[3], y / divisor) : 1.0;
}

static bool holds_near_corner(const truth_view *view, const occ_box *box)
{
    truth_solid solids[TRUTH_MAX_SOLIDS];
    if (truth_solids_of(view, box, solids) != 1 || solids->extent[2] == 0.0) return false;
    for (int c = 0; c < 4; c++) {
        double offset[3], largest = 0.0;
        for (int j = 0; j < 3; j++)
            offset[j] = view->near_corner[c][j] - solids->center[j];
        for (int k = 0; k < 3; k++)
            largest = fmax(largest, fabs(truth_dot(solids->inverse[k], offset)));
        if (largest <= 1.0) return true;
    }
    return false;
}

// For a box that crosses a plane of the frustum.
static bool bound_crossing(const truth_view *view, const occ_box *box, double bounds[4])
{
    bool is_inside = false;
    for (int face = 0; face < 6; face++) {
        truth_polygon polygon;
        truth_face(view, box, face, &polygon);
        is_inside |= polygon.count > 0;
        for (int c = 0; c < polygon.count; c++)
            widen(view, polygon.corner[c], bounds);
    }
    if (!holds_near_corner(view, box)) return is_inside;
    for (int i = 0; i < 4; i++)
        bounds[i] = i < 2 ? -1.0 : 1.0;
    return true;
}

// Sample `at` of truth_at(), a sample more on either side.
static int to_sample(double at, int count, int more)
{
    double sample = floor((at + 1.0) * 0.5 * count) + more;
    return sample < 0.0 ? 0 : sample > count ? count : (int)sample;
}

// What all corners together say. False if they are outside one plane; `*is_crossing` if some are.
static bool look_at_corners(const truth_view *view, double (*corners)[3], int count,
                            bool *is_crossing)
{
    *is_crossing = false;
    for (int p = 0; p < TRUTH_PLANES; p++) {
        int inside = 0;
        for (int i = 0; view->has_plane[p] && i < count; i++)
            inside += truth_value(view->plane[p], corners[i]) >= 0.0;
        if (view->has_plane[p] && inside == 0) return false;
        *is_crossing |= view->has_plane[p] && inside < count;
    }
    return true;
}

static void set_outline(const truth_view *view, double (*corners)[3], int count,
                        const double bounds[4], truth_outline *outline)
{
    outline->depth = INFINITY;
    for (int i = 0; i < count; i++)
        outline->depth = fmin(outline->depth, truth_value(view->depth, corners[i]));
    outline->rect =
        (truth_rect){to_sample(bounds[0], view->width, -1), to_sample(bounds[1], view->height, -1),
                     to_sample(bounds[2], view->width, 2), to_sample(bounds[3], view->height, 2)};
}

bool truth_outline_box(const truth_view *view, const occ_box *box, truth_outline *outline)
{
    double corners[8][3], bounds[4] = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    bool is_crossing;
    find_corners(view, box, corners);
    if (!look_at_corners(view, corners, 8, &is_crossing)) return false;
    for (int i = 0; !is_crossing && i < 8; i++)
        widen(view, corners[i], bounds);
    if (is_crossing && !bound_crossing(view, box, bounds)) return false;
    set_outline(view, corners, 8, bounds, outline);
    return true;
}

bool truth_outline_triangle(const truth_view *view, double corner[3][3], truth_outline *outline)
{
    double bounds[4] = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    bool is_crossing;
    if (!look_at_corners(view, corner, 3, &is_crossing)) return false;
    truth_polygon polygon = {.count = 3};
    memcpy(polygon.corner, corner, 3 * sizeof *corner);
    if (is_crossing) cut_to_frustum(view, &polygon);
    for (int i = 0; i < polygon.count; i++)
        widen(view, polygon.corner[i], bounds);
    set_outline(view, corner, 3, bounds, outline);
    return polygon.count > 0;
}
