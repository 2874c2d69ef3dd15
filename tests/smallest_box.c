// SPDX-License-Identifier: Apache-2.0
// O'Rourke, "Finding minimal enclosing boxes", 1985: some smallest box has a face that holds an
// edge of the hull. For each edge the normals between those of its two faces are searched; for each
// normal the best rectangle has a side along the points' outline, and all are tried.
#include "smallest_box.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

enum { ARC_STEPS = 48, ARC_ROUNDS = 3, ARC_ZOOM = 12 };

typedef struct hull_points {
    uint32_t count;
    double at[SMALLEST_MOST][3];
} hull_points;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static bool unit(double a[3])
{
    double length = sqrt(dot(a, a));
    for (int k = 0; k < 3; k++)
        a[k] /= length;
    return length > 1e-9;
}

static double extent(const hull_points *hull, const double n[3])
{
    double low = INFINITY, high = -INFINITY;
    for (uint32_t i = 0; i < hull->count; i++) {
        double s = dot(n, hull->at[i]);
        low = fmin(low, s);
        high = fmax(high, s);
    }
    return high - low;
}

// The smallest box with faces across n: another of its faces is along two points of the outline.
static double volume_across(const hull_points *hull, const double n[3])
{
    double best = INFINITY, depth = extent(hull, n);
    for (uint32_t i = 0; i < hull->count; i++)
        for (uint32_t j = i + 1; j < hull->count; j++) {
            double e[3], side[3], along[3], low = 0.0, high = 0.0;
            for (int k = 0; k < 3; k++)
                e[k] = hull->at[j][k] - hull->at[i][k];
            cross(n, e, side);
            if (!unit(side)) continue;
            for (uint32_t p = 0; p < hull->count; p++) {
                double s = dot(side, hull->at[p]) - dot(side, hull->at[i]);
                low = fmin(low, s);
                high = fmax(high, s);
            }
            if (fmin(-low, high) > 1e-9 * (high - low)) continue; // not of the outline
            cross(n, side, along);
            best = fmin(best, depth * (high - low) * extent(hull, along));
        }
    return best;
}

// The normals of the hull's faces at an edge that are furthest apart. False if it is no edge.
static bool normals_at(const hull_points *hull, uint32_t i, uint32_t j, double first[3],
                       double second[3])
{
    double least = 2.0, e[3], found[2 * SMALLEST_MOST][3];
    int count = 0;
    for (int k = 0; k < 3; k++)
        e[k] = hull->at[j][k] - hull->at[i][k];
    for (uint32_t p = 0; p < hull->count; p++) {
        double d[3], n[3], low = 0.0, high = 0.0;
        for (int k = 0; k < 3; k++)
            d[k] = hull->at[p][k] - hull->at[i][k];
        cross(e, d, n);
        if (!unit(n)) continue;
        for (uint32_t q = 0; q < hull->count; q++) {
            double s = dot(n, hull->at[q]) - dot(n, hull->at[i]);
            low = fmin(low, s);
            high = fmax(high, s);
        }
        if (fmin(-low, high) > 1e-9 * (high - low)) continue;
        for (int k = 0; k < 3; k++)
            found[count][k] = high < -low ? n[k] : -n[k];
        count++;
    }
    for (int a = 0; a < count; a++)
        for (int b = a; b < count; b++) {
            if (dot(found[a], found[b]) >= least) continue;
            least = dot(found[a], found[b]);
            memcpy(first, found[a], 3 * sizeof *first);
            memcpy(second, found[b], 3 * sizeof *second);
        }
    return count > 0;
}

// The smallest box with a face that holds an edge whose faces have these normals.
static double volume_on_arc(const hull_points *hull, const double first[3], const double second[3])
{
    double best = INFINITY, from = 0.0, to = 1.0, best_at = 0.0;
    for (int round = 0; round < ARC_ROUNDS; round++) {
        int steps = round ? ARC_ZOOM : ARC_STEPS;
        for (int i = 0; i <= steps; i++) {
            double at = from + (to - from) * i / steps, n[3];
            for (int k = 0; k < 3; k++)
                n[k] = (1.0 - at) * first[k] + at * second[k];
            if (!unit(n)) continue;
            double volume = volume_across(hull, n);
            if (volume >= best) continue;
            best = volume;
            best_at = at;
        }
        double step = (to - from) / steps;
        from = fmax(0.0, best_at - step);
        to = fmin(1.0, best_at + step);
    }
    return best;
}

// Points inside the hull are dropped: those that are on no edge.
static void keep_corners(const hull_points *all, hull_points *hull)
{
    double first[3], second[3];
    hull->count = 0;
    for (uint32_t i = 0; i < all->count; i++) {
        bool corner = false;
        for (uint32_t j = 0; j < all->count && !corner; j++)
            corner = i != j && normals_at(all, i, j, first, second);
        if (corner) memcpy(hull->at[hull->count++], all->at[i], sizeof all->at[i]);
    }
}

double smallest_box_volume(const float (*points)[3], uint32_t count)
{
    hull_points all = {0}, hull;
    for (uint32_t i = 0; i < count; i++) {
        bool known = false;
        double p[3];
        for (int k = 0; k < 3; k++)
            p[k] = (double)points[i][k] - (double)points[0][k];
        for (uint32_t j = 0; j < all.count; j++)
            known = known || (all.at[j][0] == p[0] && all.at[j][1] == p[1] && all.at[j][2] == p[2]);
        if (!known) memcpy(all.at[all.count++], p, sizeof p);
    }
    keep_corners(&all, &hull);
    double best = INFINITY, first[3], second[3];
    for (uint32_t i = 0; i < hull.count; i++)
        for (uint32_t j = i + 1; j < hull.count; j++)
            if (normals_at(&hull, i, j, first, second))
                best = fmin(best, volume_on_arc(&hull, first, second));
    return best;
}
