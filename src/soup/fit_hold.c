// SPDX-License-Identifier: Apache-2.0
// From directions in doubles to a box of floats. Rounding moves its center and turns its axes a
// little, so sides are lengthened until every point is inside, which is tested exactly.
#include "soup/fit.h"

#include "box.h"
#include "rounding.h"

#include <math.h>
#include <string.h>

enum { HOLD_TRIES = 16 };

static void set_axis(occ_box *box, int k, const double direction[3], double half)
{
    for (int j = 0; j < 3; j++)
        box->axis[k][j] = occ_nearest(half * direction[j]);
}

// Lengthens a side; each float is rounded away from zero.
static void stretch(float axis[3], double factor)
{
    for (int j = 0; j < 3; j++) {
        double longer = (double)axis[j] * factor;
        axis[j] = longer < 0.0   ? -occ_round_up(-longer)
                  : longer > 0.0 ? occ_round_up(longer)
                                 : 0.0f;
    }
}

// How far the points reach along the box's axes, in units of these; of a flat box, or one that is
// nearly, nothing is known. The first point that is outside is told.
static bool holds_all(const occ_points *points, const occ_ready_box *ready, double reach[3])
{
    bool all = true;
    reach[0] = reach[1] = reach[2] = 0.0;
    for (size_t i = 0; i < points->count; i++) {
        const float *point = occ_points_at(points, i);
        if (occ_ready_box_holds(ready, point)) continue;
        all = false;
        if (!isfinite(ready->error)) break;
        double d[3];
        for (int j = 0; j < 3; j++)
            d[j] = (double)point[j] - (double)ready->box.center[j];
        for (int k = 0; k < 3; k++) {
            const double *row = ready->inverse[k];
            double s = fabs(row[0] * d[0] + row[1] * d[1] + row[2] * d[2]);
            if (s > reach[k]) reach[k] = s;
        }
    }
    return all;
}

// What the floats of a box may be off by, for each coordinate.
static double grain_of(const occ_box *box)
{
    double most = 0.0;
    for (int j = 0; j < 3; j++) {
        double reach = fabs((double)box->center[j]);
        for (int k = 0; k < 3; k++)
            reach += fabs((double)box->axis[k][j]);
        most = reach > most ? reach : most;
    }
    return most * 0x1p-23 + 0x1p-148;
}

bool occ_fit_hold(const occ_points *points, const occ_sample *sample, const occ_frame3 *frame,
                  const occ_extent *extent, occ_box *box)
{
    double half[3], reach[3];
    for (int j = 0; j < 3; j++) {
        double center = sample->origin[j];
        for (int k = 0; k < 3; k++)
            center += 0.5 * (extent->low[k] + extent->high[k]) * frame->axis[k][j];
        box->center[j] = occ_nearest(center);
    }
    for (int k = 0; k < 3; k++) {
        half[k] = 0.5 * (extent->high[k] - extent->low[k]);
        set_axis(box, k, frame->axis[k], half[k]);
    }
    double grain = grain_of(box);
    for (int tries = 0; tries < HOLD_TRIES; tries++, grain *= 2.0) {
        occ_ready_box ready;
        if (occ_box_check(box)) return false;
        occ_ready_box_make(box, &ready);
        if (holds_all(points, &ready, reach)) return true;
        for (int k = 0; k < 3; k++) {
            if (!isfinite(ready.error)) {
                half[k] += half[k] < grain ? grain : 0.0;
                set_axis(box, k, frame->axis[k], half[k]);
            } else if (reach[k] > 1.0 - 0x1p-40) {
                stretch(box->axis[k], reach[k] * (1.0 + 0x1p-24 * (double)(1 << tries)));
            }
        }
    }
    return false;
}

void occ_fit_sides(const occ_box *box, double side[3])
{
    for (int k = 0; k < 3; k++) {
        double sum = 0.0;
        for (int j = 0; j < 3; j++)
            sum += (double)box->axis[k][j] * (double)box->axis[k][j];
        side[k] = 2.0 * sqrt(sum);
    }
}
