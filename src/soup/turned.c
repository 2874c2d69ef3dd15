// SPDX-License-Identifier: Apache-2.0
#include "soup/turned.h"

#include "soup/jacobi.h"
#include "vector.h"

#include <math.h>
#include <string.h>

#define BINS        24     // along each edge of each of three faces of a cube of normals
#define LEAST_SHARE 0.03   // of the area, for a direction to count
#define NEARLY      0x1p-9 // how far off an axis may be and still be the same

typedef struct bin {
    double sum[3], area; // normals times twice the area, and its length
} bin;

static bool normalise(double v[3])
{
    double length = sqrt(occ_dot(v, v));
    if (!(length > 0.0) || !(length < INFINITY)) return false;
    for (int k = 0; k < 3; k++)
        v[k] /= length;
    return true;
}

// Twice the area times the normal.
static void area_vector(const occ_mesh *mesh, uint32_t triangle, double out[3])
{
    double u[3], v[3];
    for (int k = 0; k < 3; k++) {
        double p = (double)occ_mesh_corner(mesh, triangle, 0)[k];
        u[k] = (double)occ_mesh_corner(mesh, triangle, 1)[k] - p;
        v[k] = (double)occ_mesh_corner(mesh, triangle, 2)[k] - p;
    }
    occ_cross(u, v, out);
}

static uint32_t bin_coordinate(double at)
{
    double place = floor((at + 1.0) * 0.5 * BINS);
    return place < 0.0 ? 0 : place > BINS - 1 ? BINS - 1 : (uint32_t)place;
}

static void fill_bins(const occ_triangles *t, bin bins[3 * BINS * BINS])
{
    memset(bins, 0, 3 * BINS * BINS * sizeof *bins);
    for (uint32_t i = 0; i < t->count; i++) {
        double n[3];
        int k = 0;
        area_vector(t->mesh, occ_triangle_at(t, i), n);
        for (int j = 1; j < 3; j++)
            if (fabs(n[j]) > fabs(n[k])) k = j;
        if (n[k] == 0.0) continue;
        double turn = n[k] < 0.0 ? -1.0 : 1.0;
        uint32_t u = bin_coordinate(n[(k + 1) % 3] / n[k]);
        uint32_t v = bin_coordinate(n[(k + 2) % 3] / n[k]);
        bin *b = &bins[((uint32_t)k * BINS + u) * BINS + v];
        for (int j = 0; j < 3; j++)
            b->sum[j] += turn * n[j];
        b->area += sqrt(occ_dot(n, n));
    }
}

// The direction with most area; if `across` is given, of those at right angles to it, nearly.
static bool find_direction(const bin *bins, const double *across, double least, double out[3])
{
    double most = least;
    bool found = false;
    for (uint32_t i = 0; i < 3 * BINS * BINS; i++) {
        double n[3];
        if (bins[i].area <= most) continue;
        memcpy(n, bins[i].sum, sizeof n);
        if (!normalise(n) || (across && fabs(occ_dot(n, across)) > 0.05)) continue;
        most = bins[i].area;
        found = true;
        memcpy(out, n, sizeof n);
    }
    return found;
}

static bool axes_of_normals(const occ_triangles *t, double a[3][3])
{
    bin bins[3 * BINS * BINS];
    double area = 0.0;
    fill_bins(t, bins);
    for (uint32_t i = 0; i < 3 * BINS * BINS; i++)
        area += bins[i].area;
    if (!find_direction(bins, NULL, LEAST_SHARE * area, a[0])) return false;
    if (!find_direction(bins, a[0], LEAST_SHARE * area, a[1])) return false;
    double off = occ_dot(a[0], a[1]);
    for (int k = 0; k < 3; k++)
        a[1][k] -= off * a[0][k];
    if (!normalise(a[1])) return false;
    occ_cross(a[0], a[1], a[2]);
    return true;
}

// The second moments of the area around its middle, by weight of the triangles.
static bool find_moments(const occ_triangles *t, double m[3][3])
{
    double weight = 0.0, middle[3] = {0.0, 0.0, 0.0};
    memset(m, 0, 9 * sizeof(double));
    for (int pass = 0; pass < 2; pass++)
        for (uint32_t i = 0; i < t->count; i++) {
            double n[3], p[4][3];
            area_vector(t->mesh, occ_triangle_at(t, i), n);
            double area = sqrt(occ_dot(n, n));
            for (int k = 0; k < 3; k++) {
                p[3][k] = 0.0;
                for (int c = 0; c < 3; c++) {
                    double at = (double)occ_mesh_corner(t->mesh, occ_triangle_at(t, i), c)[k];
                    p[c][k] = at - middle[k] * (pass ? 1.0 / weight : 0.0);
                    p[3][k] += p[c][k] / 3.0;
                }
                if (!pass) middle[k] += area * p[3][k];
            }
            if (!pass) weight += area;
            for (int c = 0; pass && c < 4; c++)
                for (int j = 0; j < 3; j++)
                    for (int k = 0; k < 3; k++)
                        m[j][k] += area * (c == 3 ? 9.0 : 1.0) * p[c][j] * p[c][k];
        }
    return weight > 0.0 && m[0][0] + m[1][1] + m[2][2] < INFINITY;
}

static bool axes_of_extent(const occ_triangles *t, double a[3][3])
{
    double m[3][3];
    if (!find_moments(t, m)) return false;
    occ_jacobi_axes(m, 12, a);
    return normalise(a[0]) && normalise(a[1]) && normalise(a[2]);
}

// Whether each axis of one is an axis of the other, nearly, in either direction.
static bool are_same(const double a[3][3], const float b[3][3])
{
    for (int i = 0; i < 3; i++) {
        bool found = false;
        for (int j = 0; j < 3; j++) {
            double other[3] = {(double)b[j][0], (double)b[j][1], (double)b[j][2]}, off[3];
            occ_cross(a[i], other, off);
            found |= occ_dot(off, off) < NEARLY * NEARLY;
        }
        if (!found) return false;
    }
    return true;
}

uint32_t occ_turned_axes(const occ_triangles *triangles, float axes[OCC_MOST_TURNS][3][3])
{
    uint32_t count = 1;
    for (int j = 0; j < 3; j++)
        for (int k = 0; k < 3; k++)
            axes[0][j][k] = j == k ? 1.0f : 0.0f;
    for (int kind = 0; kind < 2; kind++) {
        double a[3][3];
        bool known = !(kind ? axes_of_extent(triangles, a) : axes_of_normals(triangles, a));
        for (uint32_t i = 0; i < count && !known; i++)
            known = are_same((const double(*)[3])a, (const float(*)[3])axes[i]);
        if (known) continue;
        for (int j = 0; j < 3; j++)
            for (int k = 0; k < 3; k++)
                axes[count][j][k] = (float)a[j][k];
        count++;
    }
    return count;
}
