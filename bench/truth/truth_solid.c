// SPDX-License-Identifier: Apache-2.0
#include "truth_shape.h"

#include <math.h>

// What is this much smaller than its factors is the rounding of zero.
static const double negligible = 1e-13;

static double length_of(const double *v)
{
    return sqrt(truth_dot(v, v));
}

// `axes` must be independent.
static void set_up(truth_solid *solid, const double center[3], double axes[3][3], bool is_flat)
{
    double normal[3][3];
    solid->kind = TRUTH_SLABS;
    for (int k = 0; k < 3; k++)
        truth_cross(axes[(k + 1) % 3], axes[(k + 2) % 3], normal[k]);
    double determinant = truth_dot(axes[0], normal[0]);
    for (int k = 0; k < 3; k++) {
        solid->center[k] = center[k];
        solid->extent[k] = is_flat && k == 2 ? 0.0 : 1.0;
        solid->half[k] = fabs(axes[0][k]) + fabs(axes[1][k]) + (is_flat ? 0.0 : fabs(axes[2][k]));
        for (int j = 0; j < 3; j++)
            solid->inverse[k][j] = normal[k][j] / determinant;
    }
}

// The plane's normal holds no ray of the eye, or all of them.
static bool is_edge_on(const truth_view *view, const double center[3], const double normal[3])
{
    bool is_perspective = view->row[2][3] == 0.0;
    const double *to_it = is_perspective ? center : view->direction[0];
    return fabs(truth_dot(to_it, normal)) <= negligible * length_of(to_it) * length_of(normal);
}

// A flat box is the union of the parallelograms that a solid one would show to a viewer along the
// direction (n0 . m, n1 . m, n2 . m) of its own coordinates, m being the normal of its plane.
static int split_flat(const truth_view *view, const double center[3], double axes[3][3],
                      truth_solid *solids)
{
    double normal[3][3], largest = 0.0;
    const double *m = normal[0];
    for (int k = 0; k < 3; k++) {
        truth_cross(axes[(k + 1) % 3], axes[(k + 2) % 3], normal[k]);
        if (length_of(normal[k]) <= largest) continue;
        largest = length_of(normal[k]);
        m = normal[k];
    }
    int count = 0;
    for (int k = 0; k < 3; k++) {
        const double *u = axes[(k + 1) % 3], *v = axes[(k + 2) % 3];
        double area = length_of(normal[k]), side = truth_dot(normal[k], m) > 0.0 ? 1.0 : -1.0;
        if (area == 0.0 || area <= negligible * length_of(u) * length_of(v)) continue;
        double middle[3], sheet[3][3];
        for (int j = 0; j < 3; j++) {
            middle[j] = center[j] + side * axes[k][j];
            sheet[0][j] = u[j];
            sheet[1][j] = v[j];
            sheet[2][j] = normal[k][j] / sqrt(area);
        }
        if (is_edge_on(view, middle, normal[k])) continue;
        set_up(&solids[count++], middle, sheet, true);
    }
    return count;
}

int truth_solids_of(const truth_view *view, const occ_box *box,
                    truth_solid solids[TRUTH_MAX_SOLIDS])
{
    double center[3], axes[3][3], normal[3], size = 1.0;
    for (int k = 0; k < 3; k++) {
        center[k] = (double)box->center[k] - view->eye[k];
        for (int j = 0; j < 3; j++)
            axes[k][j] = (double)box->axis[k][j];
        size *= length_of(axes[k]);
    }
    truth_cross(axes[1], axes[2], normal);
    double volume = fabs(truth_dot(axes[0], normal));
    if (volume == 0.0 || volume <= negligible * size) return split_flat(view, center, axes, solids);
    set_up(solids, center, axes, false);
    return 1;
}

static void bound_triangle(truth_solid *solid)
{
    for (int j = 0; j < 3; j++) {
        double least = INFINITY, most = -INFINITY;
        for (int c = 0; c < 3; c++) {
            least = fmin(least, solid->corner[c][j]);
            most = fmax(most, solid->corner[c][j]);
        }
        solid->center[j] = 0.5 * (least + most);
        solid->half[j] = 0.5 * (most - least);
    }
}

bool truth_triangle_of(const truth_view *view, const occ_sheet *sheet, uint32_t t,
                       truth_solid *solid)
{
    const uint32_t corner[3] = {0, t + 1, t + 2};
    solid->kind = sheet->sides == OCC_SIDES_FRONT ? TRUTH_FRONT : TRUTH_TRIANGLE;
    for (int c = 0; c < 3; c++)
        for (int j = 0; j < 3; j++)
            solid->corner[c][j] = (double)sheet->corner[corner[c]][j] - view->eye[j];
    double first[3], last[3];
    for (int j = 0; j < 3; j++) {
        first[j] = solid->corner[1][j] - solid->corner[0][j];
        last[j] = solid->corner[2][j] - solid->corner[0][j];
    }
    truth_cross(first, last, solid->normal);
    double area = length_of(solid->normal);
    bound_triangle(solid);
    return area > negligible * length_of(first) * length_of(last) &&
           !is_edge_on(view, solid->corner[0], solid->normal);
}

double truth_aside(const truth_solid *solid, int k, const double origin[3],
                   const double direction[3])
{
    const double *a = solid->corner[k], *b = solid->corner[(k + 1) % 3];
    const double edge[3] = {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    double normal[3];
    truth_cross(direction, edge, normal);
    return truth_dot(origin, normal);
}

// The determinant of the direction and the corners' offsets from the origin.
double truth_pass(const truth_solid *solid, int k, const double origin[3],
                  const double direction[3])
{
    double moment[3];
    truth_cross(solid->corner[k], solid->corner[(k + 1) % 3], moment);
    return truth_dot(direction, moment) - truth_aside(solid, k, origin, direction);
}

static double enter_triangle(const truth_solid *solid, const double origin[3],
                             const double direction[3])
{
    double least = INFINITY, most = -INFINITY, offset[3];
    for (int k = 0; k < 3; k++) {
        double pass = truth_pass(solid, k, origin, direction);
        least = fmin(least, pass);
        most = fmax(most, pass);
        offset[k] = solid->corner[0][k] - origin[k];
    }
    double facing = truth_dot(solid->normal, direction);
    bool is_met =
        solid->kind == TRUTH_FRONT ? most <= 0.0 && facing < 0.0 : most <= 0.0 || least >= 0.0;
    return is_met ? truth_dot(solid->normal, offset) / facing : INFINITY;
}

double truth_enter(const truth_solid *solid, const double origin[3], const double direction[3],
                   double low, double high)
{
    if (solid->kind != TRUTH_SLABS) {
        double at = enter_triangle(solid, origin, direction);
        return at >= low && at <= high ? at : INFINITY;
    }
    double enter = -INFINITY, leave = INFINITY, offset[3];
    for (int j = 0; j < 3; j++)
        offset[j] = origin[j] - solid->center[j];
    for (int k = 0; k < 3; k++) {
        double at = truth_dot(solid->inverse[k], offset);
        double step = 1.0 / truth_dot(solid->inverse[k], direction);
        double a = (-solid->extent[k] - at) * step, b = (solid->extent[k] - at) * step;
        double first = a < b ? a : b, last = a < b ? b : a;
        enter = first > enter ? first : enter;
        leave = last < leave ? last : leave;
    }
    return enter <= leave && enter >= low && enter <= high ? enter : INFINITY;
}
