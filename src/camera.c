// SPDX-License-Identifier: Apache-2.0
// Frustum planes are sums of the matrix's rows (Gribb and Hartmann, 2001); the eye is where the
// rows of x, y and w all vanish. Each sum of two floats is exact in double or rounds by 2^-53 of
// itself.
#include "camera.h"

#include "rounding.h"
#include "vector.h"

#include <cglm/cglm.h>
#include <string.h>

typedef double row4[4];

// Solves p_i . x + d_i = 0 for three planes by Cramer's rule. False if they meet in no single
// point, as far as `least` tells: their determinant over its terms. For planes of floats, whose
// cross products round only once, x_j is off by less than 2^-50 of doubt_j.
static bool meet(const double *p, const double *q, const double *r, double least, double x[3],
                 double doubt[3])
{
    double qr[3], rp[3], pq[3];
    occ_cross(q, r, qr);
    occ_cross(r, p, rp);
    occ_cross(p, q, pq);
    double determinant = occ_dot(p, qr);
    double size = occ_largest(p) * occ_largest(q) * occ_largest(r);
    if (!(fabs(determinant) > size * least)) return false;
    double terms = occ_dot_magnitude(p, qr);
    for (int j = 0; j < 3; j++) {
        x[j] = -(p[3] * qr[j] + q[3] * rp[j] + r[3] * pq[j]) / determinant;
        doubt[j] = fabs(p[3] * qr[j]) + fabs(q[3] * rp[j]) + fabs(r[3] * pq[j]);
        doubt[j] = (doubt[j] + fabs(x[j]) * terms) / fabs(determinant);
    }
    return isfinite(x[0] + doubt[0]) && isfinite(x[1] + doubt[1]) && isfinite(x[2] + doubt[2]);
}

static occ_result check_numbers(const occ_camera_desc *desc, const char **reason)
{
    for (int i = 0; i < 16; i++) {
        if (!isfinite(desc->view_projection[i])) {
            *reason = "the view-projection matrix is not finite";
            return OCC_ERROR_NOT_FINITE;
        }
    }
    for (int j = 0; j < 3; j++) {
        double eye = desc->eye ? desc->eye[j] : 0.0, origin = desc->origin ? desc->origin[j] : 0.0;
        if (!isfinite(eye) || !isfinite(origin)) {
            *reason = "the eye or the origin is not finite";
            return OCC_ERROR_NOT_FINITE;
        }
        if (fabs(eye) > (double)OCC_MAX_COORDINATE || fabs(origin) > (double)OCC_MAX_COORDINATE) {
            *reason = "the eye or the origin is beyond OCC_MAX_COORDINATE";
            return OCC_ERROR_OUT_OF_RANGE;
        }
    }
    if ((unsigned)desc->depth > OCC_DEPTH_ONE_TO_ZERO) {
        *reason = "there is no such depth range";
        return OCC_ERROR_INVALID_ARGUMENT;
    }
    return OCC_SUCCESS;
}

static void add_rows(const double *a, double sign, const double *b, double *sum)
{
    for (int i = 0; i < 4; i++)
        sum[i] = a[i] + sign * b[i];
}

// The six planes in the matrix's own coordinates.
static void frustum_planes(const row4 *row, occ_depth depth, row4 *plane)
{
    static const double nothing[4];
    for (int axis = 0; axis < 2; axis++) {
        add_rows(row[3], 1.0, row[axis], plane[2 * axis]);
        add_rows(row[3], -1.0, row[axis], plane[2 * axis + 1]);
    }
    double *near = plane[OCC_NEAR_PLANE], *far = plane[OCC_NEAR_PLANE + 1];
    switch (depth) {
    case OCC_DEPTH_ZERO_TO_ONE:
        add_rows(nothing, 1.0, row[2], near);
        add_rows(row[3], -1.0, row[2], far);
        break;
    case OCC_DEPTH_ONE_TO_ZERO:
        add_rows(row[3], -1.0, row[2], near);
        add_rows(nothing, 1.0, row[2], far);
        break;
    default:
        add_rows(row[3], 1.0, row[2], near);
        add_rows(row[3], -1.0, row[2], far);
    }
}

// The direction to the viewer is against the near plane's normal; without depth there is none.
static bool orthographic_direction(const row4 *row, const double *near, double toward[3])
{
    double along[3];
    occ_cross(row[0], row[1], along);
    double facing = occ_dot(along, near), size = occ_largest(along);
    if (!(size > 1e-12 * occ_largest(row[0]) * occ_largest(row[1])) || facing == 0.0) return false;
    double scale = occ_unit_scale(size) * (facing > 0.0 ? -1.0 : 1.0);
    for (int j = 0; j < 3; j++)
        toward[j] = along[j] * scale;
    return true;
}

// Moves a plane to be relative to `own`, the eye in the matrix's coordinates, scales it and makes
// the floats, rounded outward. False if it is no plane (an infinite far plane). A plane through an
// eye that was given is exact; one through an eye that was derived is not.
static bool set_plane(occ_camera *camera, uint32_t p, const double *plane, const double own[3],
                      bool through_eye)
{
    double size = occ_largest(plane);
    if (size == 0.0) return false;
    double scale = occ_unit_scale(size), error = 0.0, d = 0.0;
    if (!through_eye) {
        d = occ_dot(plane, own) + plane[3];
        error = occ_dot_magnitude(plane, own) + fabs(plane[3]);
        error = (error + occ_dot_magnitude(plane, camera->doubt)) * 0x1p-50;
    }
    float *constant = camera->constants.plane[p];
    for (int j = 0; j < 3; j++) {
        camera->plane[p][j] = plane[j] * scale;
        constant[j] = (float)(plane[j] * scale);
    }
    camera->plane[p][3] = p < OCC_NEAR_PLANE ? d * scale : (d - error) * scale;
    double wide = (d + error) * scale;
    if (!(fabs(wide) < 1e30)) return false; // too far to matter, or to be told from infinity
    constant[3] = occ_round_up(wide + fabs(wide) * 0x1p-21);
    return true;
}

// A corner of the cutter must be inside of the planes opposite to those that it is on. Behind the
// eye it is not: then some rays of the frustum are cut away as far as they go.
static bool is_ahead(const double *opposite, const double corner[3])
{
    double height = occ_dot(opposite, corner) + opposite[3];
    return height > 1e-6 * (occ_dot_magnitude(opposite, corner) + fabs(opposite[3]));
}

// The eye is outside of at most one of near and far, since their sum is not negative there. Where
// rounding leaves it open which, both may cut, unless it is certain of one.
static void find_cutter(occ_camera *camera)
{
    const uint32_t near = OCC_NEAR_PLANE, far = OCC_NEAR_PLANE + 1;
    bool may[2];
    for (uint32_t p = near; p <= far; p++)
        may[p - near] = (camera->planes >> p & 1u) && camera->plane[p][3] < 0.0;
    if (camera->orthographic) may[0] = (camera->planes >> near & 1u) != 0;
    bool both = may[0] && may[1] && !camera->orthographic;
    if (both && camera->constants.plane[far][3] < 0.0) may[0] = false;
    if (both && camera->constants.plane[near][3] < 0.0) may[1] = false;
    camera->cutter = may[0] ? near : may[1] ? far : OCC_NO_PLANE;
    camera->far_cuts_too = both && may[0] && may[1];
    camera->has_corners =
        camera->cutter != OCC_NO_PLANE && !camera->far_cuts_too && (camera->planes & 0xfu) == 0xfu;
    for (int c = 0; c < 4 && camera->has_corners; c++) {
        const double *left = camera->plane[c & 1], *low = camera->plane[2 + (c >> 1)];
        const double *right = camera->plane[!(c & 1)], *high = camera->plane[2 + !(c >> 1)];
        double *corner = camera->near_corner[c], doubt[3];
        camera->has_corners = meet(left, low, camera->plane[camera->cutter], 1e-5, corner, doubt) &&
                              is_ahead(right, corner) && is_ahead(high, corner);
    }
}

// The area that an orthographic camera shows, from two sides of its near rectangle.
static void measure_view(occ_camera *camera)
{
    if (!camera->orthographic || !camera->has_corners) return;
    double side[2][3], normal[3];
    for (int j = 0; j < 3; j++) {
        side[0][j] = camera->near_corner[1][j] - camera->near_corner[0][j];
        side[1][j] = camera->near_corner[2][j] - camera->near_corner[0][j];
    }
    occ_cross(side[0], side[1], normal);
    camera->view_area = sqrt(occ_dot(normal, normal));
}

// The rows of x, y and w, times one power of two, so that nothing overflows. The eye is where they
// vanish; for an orthographic camera, where w does not.
static void set_screen(occ_camera *camera, const row4 *row)
{
    static const int used[3] = {0, 1, 3};
    occ_screen *screen = &camera->screen;
    double most = 0.0, w = camera->orthographic ? row[3][3] : 0.0;
    for (int r = 0; r < 3; r++) {
        const double *of = row[used[r]];
        most = occ_larger(most, fabs(of[0]) + fabs(of[1]) + fabs(of[2]));
    }
    double scale = occ_unit_scale(occ_larger(most, fabs(w)));
    for (int r = 0; r < 3; r++)
        for (int j = 0; j < 3; j++)
            screen->row[r][j] = (float)(row[used[r]][j] * scale);
    screen->w = (float)(w * scale);
    screen->least = (float)(most * scale * 0x1p-8);
}

static void set_constants(occ_camera *camera)
{
    double reach = 0.0;
    for (int j = 0; j < 3; j++) {
        float high = occ_nearest(camera->eye[j]);
        camera->constants.high[j] = high;
        camera->constants.low[j] = (float)(camera->eye[j] - (double)high);
        reach += fabs(camera->eye[j]);
    }
    double doubt = 0.0, length = sqrt(occ_dot(camera->toward, camera->toward));
    for (int j = 0; j < 3; j++) {
        doubt = fmax(doubt, camera->doubt[j]);
        if (camera->orthographic)
            camera->constants.toward[j] = occ_nearest(camera->toward[j] / length);
    }
    camera->constants.toward[3] = camera->orthographic ? 1.0f : 0.0f;
    camera->constants.doubt = occ_round_up(doubt * 0x1p-48);
    camera->constants.slack_floor = occ_round_up(reach * 0x1p-46 + 0x1p-80);
}

occ_result occ_camera_init(occ_camera *camera, const occ_camera_desc *desc, const char **reason)
{
    *camera = (occ_camera){.orthographic = false};
    occ_result result = check_numbers(desc, reason);
    if (result) return result;
    mat4 rows;
    memcpy(rows, desc->view_projection, sizeof rows); // the caller's floats need not be aligned
    glm_mat4_transpose(rows);
    row4 row[4], plane[OCC_FRUSTUM_PLANES];
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++)
            row[r][c] = (double)rows[r][c];
    frustum_planes((const row4 *)row, desc->depth, plane);
    camera->orthographic = occ_largest(row[3]) == 0.0;
    double own[3];
    bool found =
        camera->orthographic
            ? meet(row[0], row[1], plane[OCC_NEAR_PLANE], 1e-12, own, camera->doubt) &&
                  orthographic_direction((const row4 *)row, plane[OCC_NEAR_PLANE], camera->toward)
            : meet(row[0], row[1], row[3], 1e-12, own, camera->doubt);
    if (!found) {
        *reason = "the view-projection matrix is singular: it has no eye";
        return OCC_ERROR_DEGENERATE_CAMERA;
    }
    bool given = desc->eye && !camera->orthographic;
    for (int j = 0; j < 3; j++) {
        camera->eye[j] = given ? desc->eye[j] : own[j] + (desc->origin ? desc->origin[j] : 0.0);
        if (!given) camera->doubt[j] += fabs(camera->eye[j]); // the sum rounds as well
        if (fabs(camera->eye[j]) > (double)OCC_MAX_COORDINATE) {
            *reason = "the eye is beyond OCC_MAX_COORDINATE";
            return OCC_ERROR_OUT_OF_RANGE;
        }
    }
    for (uint32_t p = 0; p < OCC_FRUSTUM_PLANES; p++) {
        if (set_plane(camera, p, plane[p], own, given && p < OCC_NEAR_PLANE)) {
            camera->planes |= 1u << p;
        }
    }
    find_cutter(camera);
    for (int j = 0; j < 3 && (given || camera->orthographic); j++)
        camera->doubt[j] = 0.0;
    measure_view(camera);
    set_screen(camera, (const row4 *)row);
    set_constants(camera);
    return OCC_SUCCESS;
}
