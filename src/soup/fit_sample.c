// SPDX-License-Identifier: Apache-2.0
// After Larsson and Kallberg, "Fast computation of tight-fitting oriented bounding boxes", 2011: a
// few directions find the points that decide how a box is turned. Here they are more, and points
// that turn out to matter are added.
#include "soup/fit.h"

#include <math.h>
#include <string.h>

// Every direction of whole numbers up to 2, of two opposite ones one.
static void list_directions(double direction[OCC_FIT_DIRECTIONS][3])
{
    int count = 0;
    for (int x = 0; x <= 2; x++)
        for (int y = -2; y <= 2; y++)
            for (int z = -2; z <= 2; z++) {
                bool first_is_positive = x > 0 || (x == 0 && (y > 0 || (y == 0 && z > 0)));
                if (!first_is_positive || (x % 2 == 0 && y % 2 == 0 && z % 2 == 0)) continue;
                direction[count][0] = x;
                direction[count][1] = y;
                direction[count++][2] = z;
            }
}

static void relative(const occ_sample *sample, const float *point, double out[3])
{
    for (int j = 0; j < 3; j++)
        out[j] = (double)point[j] - sample->origin[j];
}

// Adds a point that the sample does not have. False if it has it, or no room.
static bool add(occ_sample *sample, const double point[3])
{
    for (int i = 0; i < sample->count; i++) {
        const double *at = sample->at[i];
        if (at[0] == point[0] && at[1] == point[1] && at[2] == point[2]) return false;
    }
    if (sample->count == OCC_FIT_POINTS) return false;
    memcpy(sample->at[sample->count++], point, 3 * sizeof *point);
    return true;
}

static void find_bounds(const occ_points *points, occ_sample *sample)
{
    double diagonal = 0.0;
    for (int j = 0; j < 3; j++) {
        sample->min[j] = INFINITY;
        sample->max[j] = -INFINITY;
    }
    for (size_t i = 0; i < points->count; i++) {
        const float *point = occ_points_at(points, i);
        for (int j = 0; j < 3; j++) {
            if (point[j] < sample->min[j]) sample->min[j] = point[j];
            if (point[j] > sample->max[j]) sample->max[j] = point[j];
        }
    }
    for (int j = 0; j < 3; j++) {
        double low = (double)sample->min[j], high = (double)sample->max[j];
        sample->origin[j] = 0.5 * (low + high);
        diagonal += (high - low) * (high - low);
    }
    sample->grain = sqrt(diagonal) * 0x1p-20;
}

void occ_sample_take(const occ_points *points, occ_sample *sample)
{
    double direction[OCC_FIT_DIRECTIONS][3];
    struct {
        double low, high;
        size_t low_at, high_at;
    } found[OCC_FIT_DIRECTIONS];
    sample->count = 0;
    find_bounds(points, sample);
    list_directions(direction);
    for (int d = 0; d < OCC_FIT_DIRECTIONS; d++) {
        found[d].low = INFINITY;
        found[d].high = -INFINITY;
        found[d].low_at = found[d].high_at = 0;
    }
    for (size_t i = 0; i < points->count; i++) {
        double p[3];
        relative(sample, occ_points_at(points, i), p);
        for (int d = 0; d < OCC_FIT_DIRECTIONS; d++) {
            double s = direction[d][0] * p[0] + direction[d][1] * p[1] + direction[d][2] * p[2];
            if (s < found[d].low) {
                found[d].low = s;
                found[d].low_at = i;
            }
            if (s > found[d].high) {
                found[d].high = s;
                found[d].high_at = i;
            }
        }
    }
    for (int d = 0; d < OCC_FIT_DIRECTIONS; d++) {
        double p[3];
        relative(sample, occ_points_at(points, found[d].low_at), p);
        add(sample, p);
        relative(sample, occ_points_at(points, found[d].high_at), p);
        add(sample, p);
    }
}

bool occ_sample_extend(const occ_points *points, const occ_frame3 *frame, occ_sample *sample,
                       occ_extent *extent)
{
    size_t at[6] = {0};
    for (int k = 0; k < 3; k++) {
        extent->low[k] = INFINITY;
        extent->high[k] = -INFINITY;
    }
    for (size_t i = 0; i < points->count; i++) {
        double p[3];
        relative(sample, occ_points_at(points, i), p);
        for (int k = 0; k < 3; k++) {
            const double *a = frame->axis[k];
            double s = a[0] * p[0] + a[1] * p[1] + a[2] * p[2];
            if (s < extent->low[k]) {
                extent->low[k] = s;
                at[2 * k] = i;
            }
            if (s > extent->high[k]) {
                extent->high[k] = s;
                at[2 * k + 1] = i;
            }
        }
    }
    bool grown = false;
    for (int i = 0; i < 6; i++) {
        double p[3];
        relative(sample, occ_points_at(points, at[i]), p);
        grown = add(sample, p) || grown;
    }
    return grown;
}
