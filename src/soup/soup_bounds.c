// SPDX-License-Identifier: Apache-2.0
#include "soup/fit.h"

#include "box.h"
#include "log.h"
#include "soup/triangles.h"

#include <math.h>

// Finds a frame, and as long as points that the sample lacks reach beyond its box, adds them and
// looks again.
static occ_result find_frame(const occ_points *points, const occ_soup_work *work,
                             const occ_hooks *hooks, occ_sample *sample, occ_frame3 *best,
                             occ_extent *best_extent)
{
    enum { ROUNDS = 6 };
    double least = INFINITY;
    occ_result result = OCC_SUCCESS;
    bool more = true;
    for (int round = 0; round < ROUNDS && more && !result; round++) {
        occ_frame3 frame;
        occ_extent extent;
        double side[3];
        occ_fit_frame(sample, &frame);
        more = occ_sample_extend(points, &frame, sample, &extent);
        for (int k = 0; k < 3; k++)
            side[k] = extent.high[k] - extent.low[k];
        double measure = occ_fit_measure(sample, side);
        if (measure < least) {
            least = measure;
            *best = frame;
            *best_extent = extent;
        }
        result = occ_soup_progress(work, hooks, 0.2 + 0.1 * round);
    }
    return result;
}

occ_result occ_fit_points(const occ_points *points, const occ_frame3 *given,
                          const occ_soup_work *work, const occ_hooks *hooks, occ_box *box)
{
    occ_sample sample;
    occ_frame3 frame;
    occ_extent extent;
    occ_box upright, turned;
    occ_sample_take(points, &sample);
    occ_result result = occ_box_from_min_max(sample.min, sample.max, &upright);
    if (result) return occ_fail(hooks, result, "the bounds reach beyond OCC_MAX_COORDINATE");
    if (given) {
        frame = *given;
        (void)occ_sample_extend(points, given, &sample, &extent);
    } else {
        result = find_frame(points, work, hooks, &sample, &frame, &extent);
    }
    if (!result && sample.grain > 0.0 && occ_fit_hold(points, &sample, &frame, &extent, &turned)) {
        double side[2][3];
        occ_fit_sides(&upright, side[0]);
        occ_fit_sides(&turned, side[1]);
        // A box along the axes that is as good but for rounding is the better one to look at.
        if (occ_fit_measure(&sample, side[1]) < occ_fit_measure(&sample, side[0]) * (1.0 - 0x1p-10))
            upright = turned;
    }
    if (!result) result = occ_soup_progress(work, hooks, 1.0);
    if (!result) *box = upright;
    return result;
}

static occ_result check_points(const float *points, size_t count, size_t stride,
                               const occ_hooks *hooks)
{
    const char *complaint = NULL;
    if (!points || !count) complaint = "there are no points";
    if (stride % sizeof(float) || (stride && stride < 3 * sizeof(float)))
        complaint = "the stride is neither 0 nor a multiple of 4 that is at least 12";
    if (complaint) return occ_fail(hooks, OCC_ERROR_INVALID_ARGUMENT, "%s", complaint);
    if (!stride) stride = 3 * sizeof(float);
    for (size_t i = 0; i < count; i++) {
        const float *at = (const float *)(const void *)((const char *)points + i * stride);
        for (int k = 0; k < 3; k++) {
            if (fabsf(at[k]) <= OCC_MAX_COORDINATE) continue;
            occ_result result = isfinite(at[k]) ? OCC_ERROR_OUT_OF_RANGE : OCC_ERROR_NOT_FINITE;
            return occ_fail(hooks, result, "point %zu: %c is %g", i, "xyz"[k], (double)at[k]);
        }
    }
    return OCC_SUCCESS;
}

occ_result occ_bounds_of_points(const float *points, size_t count, size_t stride,
                                const occ_soup_work *work, occ_box *box)
{
    occ_hooks hooks;
    occ_result result = occ_soup_hooks(work, &hooks);
    if (result) return result;
    if (!box) return occ_fail(&hooks, OCC_ERROR_INVALID_ARGUMENT, "there is no box to write to");
    result = check_points(points, count, stride, &hooks);
    if (result) return result;
    occ_points all = {points, stride ? stride : 3 * sizeof(float), count, NULL};
    return occ_fit_points(&all, NULL, work, &hooks, box);
}

occ_result occ_bounds_of_soup(const occ_soup *soup, const occ_soup_work *work, occ_box *box)
{
    occ_hooks hooks;
    occ_result result = occ_soup_hooks(work, &hooks);
    if (result) return result;
    if (!box) return occ_fail(&hooks, OCC_ERROR_INVALID_ARGUMENT, "there is no box to write to");
    result = occ_soup_validate(soup, &hooks);
    if (result) return result;
    occ_points corners = {soup->positions, soup->stride ? soup->stride : 3 * sizeof(float),
                          3 * (size_t)soup->triangle_count, soup->indices};
    return occ_fit_points(&corners, NULL, work, &hooks, box);
}

occ_result occ_verify_bounds(const occ_soup *soup, const occ_box *box, const occ_soup_work *work,
                             uint32_t *vertex)
{
    occ_hooks hooks;
    occ_ready_box ready;
    occ_result result = occ_soup_hooks(work, &hooks);
    if (!result) result = occ_soup_validate(soup, &hooks);
    if (result) return result;
    if (!box) return occ_fail(&hooks, OCC_ERROR_INVALID_ARGUMENT, "there is no box to verify");
    result = occ_box_check(box);
    if (result) return occ_fail(&hooks, result, "the box has a bad number");
    occ_ready_box_make(box, &ready);
    for (uint32_t t = 0; t < soup->triangle_count; t++) {
        for (int c = 0; c < 3; c++) {
            uint32_t v = occ_soup_index(soup, t, c);
            if (occ_ready_box_holds(&ready, occ_soup_vertex(soup, v))) continue;
            if (vertex) *vertex = v;
            return occ_fail(&hooks, OCC_ERROR_NOT_INSIDE, "vertex %u of triangle %u is outside",
                            (unsigned)v, (unsigned)t);
        }
        if (t % 65536 == 65535) {
            result = occ_soup_progress(work, &hooks, (double)t / (double)soup->triangle_count);
            if (result) return result;
        }
    }
    return OCC_SUCCESS;
}
