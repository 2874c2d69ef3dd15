// SPDX-License-Identifier: Apache-2.0
#include "truth_view.h"

#include <math.h>
#include <string.h>

// Solves p_i . x = b_i by Cramer's rule. False if the three have no single solution.
static bool solve(const double *p, const double *q, const double *r, const double b[3], double x[3])
{
    double qr[3], rp[3], pq[3];
    truth_cross(q, r, qr);
    truth_cross(r, p, rp);
    truth_cross(p, q, pq);
    double determinant = truth_dot(p, qr);
    double size = sqrt(truth_dot(p, p) * truth_dot(q, q) * truth_dot(r, r));
    if (!(fabs(determinant) > 1e-13 * size)) return false;
    for (int k = 0; k < 3; k++)
        x[k] = (b[0] * qr[k] + b[1] * rp[k] + b[2] * pq[k]) / determinant;
    return true;
}

static void add_planes(truth_view *view, double rows[4][4])
{
    for (int p = 0; p < TRUTH_PLANES; p++) {
        double sign = p % 2 == 0 ? 1.0 : -1.0;
        for (int k = 0; k < 4; k++)
            view->plane[p][k] = rows[3][k] + sign * rows[p / 2][k];
        view->has_plane[p] = truth_dot(view->plane[p], view->plane[p]) > 0.0;
    }
}

// Turns all coefficients from the matrix's coordinates to those relative to the matrix's own eye.
static void shift_planes(truth_view *view, const double own[3], bool sides_meet_there)
{
    for (int p = 0; p < TRUTH_PLANES; p++) {
        double constant = truth_value(view->plane[p], own);
        view->plane[p][3] = sides_meet_there && p < TRUTH_NEAR ? 0.0 : constant;
    }
}

// The ray of (x, y) is where row 0 is x times row 3, and row 1 is y times row 3.
static bool make_perspective(truth_view *view, double rows[4][4], const float eye[3])
{
    double own[3], parts[3][3];
    const double wanted[3] = {-rows[0][3], -rows[1][3], -rows[3][3]};
    if (!solve(rows[0], rows[1], rows[3], wanted, own)) return false;
    shift_planes(view, own, true);
    truth_cross(rows[0], rows[1], parts[0]);
    truth_cross(rows[1], rows[3], parts[1]);
    truth_cross(rows[3], rows[0], parts[2]);
    double scale = truth_dot(rows[3], parts[0]);
    for (int k = 0; k < 3; k++) {
        view->eye[k] = (double)eye[k];
        view->depth[k] = rows[3][k];
        for (int i = 0; i < 3; i++) {
            view->direction[i][k] = parts[i][k] / scale;
            view->row[i][k] = rows[i == 2 ? 3 : i][k];
        }
    }
    return true;
}

// All rays run from the near plane along the line where rows 0 and 1 do not change.
static bool make_orthographic(truth_view *view, double rows[4][4])
{
    const double *near_plane = view->plane[TRUTH_NEAR];
    if (!(rows[3][3] > 0.0)) return false;
    const double wanted[3] = {-rows[0][3], -rows[1][3], -near_plane[3]};
    const double x[3] = {rows[3][3], 0, 0}, y[3] = {0, rows[3][3], 0}, along[3] = {0, 0, 1};
    if (!solve(rows[0], rows[1], near_plane, wanted, view->eye) ||
        !solve(rows[0], rows[1], near_plane, x, view->origin[1]) ||
        !solve(rows[0], rows[1], near_plane, y, view->origin[2]) ||
        !solve(rows[0], rows[1], near_plane, along, view->direction[0]))
        return false;
    memcpy(view->depth, near_plane, 3 * sizeof *near_plane);
    shift_planes(view, view->eye, false);
    for (int k = 0; k < 3; k++) {
        view->row[0][k] = rows[0][k];
        view->row[1][k] = rows[1][k];
    }
    view->row[2][3] = rows[3][3];
    return true;
}

static bool find_near_corners(truth_view *view)
{
    const double *near_plane = view->plane[TRUTH_NEAR];
    for (int c = 0; c < 4; c++) {
        const double *across = view->plane[c & 1], *up = view->plane[2 + (c >> 1)];
        const double wanted[3] = {-across[3], -up[3], -near_plane[3]};
        if (!solve(across, up, near_plane, wanted, view->near_corner[c])) return false;
    }
    return true;
}

bool truth_view_make(truth_view *view, const obs_frame *frame, int width, int height)
{
    *view = (truth_view){.width = width, .height = height};
    float matrix[16];
    double rows[4][4];
    obs_view_projection(frame, matrix);
    for (int i = 0; i < 16; i++) {
        rows[i % 4][i / 4] = (double)matrix[i];
        if (!isfinite(matrix[i])) return false;
    }
    add_planes(view, rows);
    bool is_orthographic = truth_dot(rows[3], rows[3]) == 0.0;
    bool found =
        is_orthographic ? make_orthographic(view, rows) : make_perspective(view, rows, frame->eye);
    return found && find_near_corners(view);
}

void truth_clip_ray(const truth_view *view, const double origin[3], const double direction[3],
                    double *low, double *high)
{
    *low = 0.0;
    *high = INFINITY;
    for (int p = 0; p < TRUTH_PLANES; p++) {
        if (!view->has_plane[p]) continue;
        double rise = truth_dot(view->plane[p], direction);
        double start = truth_value(view->plane[p], origin);
        if (rise > 0.0 && -start > *low * rise) *low = -start / rise;
        if (rise < 0.0 && start < *high * -rise) *high = start / -rise;
        if (rise == 0.0 && start < 0.0) *high = -INFINITY;
    }
}
