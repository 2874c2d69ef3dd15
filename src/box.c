// SPDX-License-Identifier: Apache-2.0
#include "box.h"

#include "rounding.h"

#include <cglm/cglm.h>
#include <math.h>

occ_result occ_box_check(const occ_box *box)
{
    for (int j = 0; j < 3; j++) {
        double reach = fabs((double)box->center[j]);
        for (int k = 0; k < 3; k++)
            reach += fabs((double)box->axis[k][j]);
        if (!isfinite(reach)) return OCC_ERROR_NOT_FINITE;
        if (reach > (double)OCC_MAX_COORDINATE) return OCC_ERROR_OUT_OF_RANGE;
    }
    return OCC_SUCCESS;
}

void occ_box_bounds(const occ_box *box, float min[3], float max[3])
{
    for (int j = 0; j < 3; j++) {
        double center = (double)box->center[j];
        double half = fabs((double)box->axis[0][j]) + fabs((double)box->axis[1][j]) +
                      fabs((double)box->axis[2][j]);
        // The three sums round by 2^-53 of their result each, far less than what is added here.
        double slack = (fabs(center) + half) * 0x1p-50;
        if (half == 0.0) slack = 0.0;
        min[j] = occ_round_down(center - half - slack);
        max[j] = occ_round_up(center + half + slack);
    }
}

float occ_occluder_reach(const occ_box *box)
{
    double area = 0.0;
    for (int k = 0; k < 3; k++) {
        const float *a = box->axis[k], *b = box->axis[(k + 1) % 3];
        double x = (double)a[1] * (double)b[2] - (double)a[2] * (double)b[1];
        double y = (double)a[2] * (double)b[0] - (double)a[0] * (double)b[2];
        double z = (double)a[0] * (double)b[1] - (double)a[1] * (double)b[0];
        area += 4.0 * sqrt(x * x + y * y + z * z);
    }
    return area < 1e38 ? occ_round_up(area * (1.0 + 0x1p-40)) : 3e38f;
}

occ_relative_box occ_box_relative(const occ_box *box, const occ_eye *eye)
{
    occ_relative_box relative;
    for (int j = 0; j < 3; j++)
        relative.t[j] = OCC_RELATIVE(box->center[j], eye->high[j], eye->low[j]);
    for (int k = 0; k < 9; k++)
        relative.a[k] = box->axis[k / 3][k % 3];
    relative.e = occ_box_slack(&relative, eye->slack_floor);
    return relative;
}

// Center and half size of [min, max], outward.
static void set_interval(double min, double max, float *center, float *half)
{
    *center = occ_nearest(0.5 * min + 0.5 * max);
    double up = occ_difference_up(max, (double)*center);
    double down = occ_difference_up((double)*center, min);
    *half = occ_round_up(up > down ? up : down);
}

static bool finite3(const float *v)
{
    return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
}

// Whether a box made of finite numbers may be used. What grew beyond a float came from a coordinate
// out of range.
static occ_result check_made(const occ_box *box)
{
    occ_result result = occ_box_check(box);
    return result == OCC_ERROR_NOT_FINITE ? OCC_ERROR_OUT_OF_RANGE : result;
}

static occ_result aligned_box(const float *min, const float *max, occ_box *box)
{
    occ_box made = {{0}, {{0}}};
    for (int j = 0; j < 3; j++) {
        if (min[j] > max[j]) return OCC_ERROR_INVALID_ARGUMENT;
        set_interval((double)min[j], (double)max[j], &made.center[j], &made.axis[j][j]);
    }
    occ_result result = check_made(&made);
    if (!result) *box = made;
    return result;
}

occ_result occ_box_from_min_max(const float *min, const float *max, occ_box *box)
{
    if (!min || !max || !box) return OCC_ERROR_INVALID_ARGUMENT;
    if (!finite3(min) || !finite3(max)) return OCC_ERROR_NOT_FINITE;
    return aligned_box(min, max, box);
}

occ_result occ_box_from_points(const float *points, size_t count, size_t stride, occ_box *box)
{
    if (!points || !count || !box || (stride && stride < 3 * sizeof(float))) {
        return OCC_ERROR_INVALID_ARGUMENT;
    }
    if (!stride) stride = 3 * sizeof(float);
    vec3 min = {INFINITY, INFINITY, INFINITY}, max = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < count; i++) {
        vec3 point;
        memcpy(point, (const char *)points + i * stride, sizeof point);
        if (!finite3(point)) return OCC_ERROR_NOT_FINITE;
        glm_vec3_minv(min, point, min);
        glm_vec3_maxv(max, point, max);
    }
    return aligned_box(min, max, box);
}

occ_result occ_box_from_model(const float *model, const float *min, const float *max, occ_box *box)
{
    if (!model || !min || !max || !box) return OCC_ERROR_INVALID_ARGUMENT;
    for (int i = 0; i < 16; i++)
        if (!isfinite(model[i])) return OCC_ERROR_NOT_FINITE;
    if (!finite3(min) || !finite3(max)) return OCC_ERROR_NOT_FINITE;
    if (model[3] != 0.0f || model[7] != 0.0f || model[11] != 0.0f || model[15] != 1.0f) {
        return OCC_ERROR_INVALID_ARGUMENT;
    }
    occ_box made;
    for (int j = 0; j < 3; j++) {
        double center = (double)model[12 + j];
        for (int k = 0; k < 3; k++) {
            if (min[k] > max[k]) return OCC_ERROR_INVALID_ARGUMENT;
            double column = (double)model[4 * k + j];
            center += column * (0.5 * (double)min[k] + 0.5 * (double)max[k]);
            made.axis[k][j] = (float)(column * (0.5 * (double)max[k] - 0.5 * (double)min[k]));
        }
        made.center[j] = (float)center;
    }
    occ_result result = check_made(&made);
    if (!result) *box = made;
    return result;
}
