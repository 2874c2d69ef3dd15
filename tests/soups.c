// SPDX-License-Identifier: Apache-2.0
#include "soups.h"

#include <math.h>

static double any(kit_random *random)
{
    return (double)kit_between(random, -1.0f, 1.0f);
}

// --- shapes within [-1, 1]^3 ---------------------------------------------------------------------

static void make_cloud(kit_random *random, double at[][3], uint32_t count)
{
    for (uint32_t i = 0; i < 3 * count; i++)
        at[i / 3][i % 3] = any(random);
}

static void make_ball(kit_random *random, double at[][3], uint32_t count)
{
    for (uint32_t i = 0; i < count;) {
        double *p = at[i], square = 0.0;
        for (int k = 0; k < 3; k++) {
            p[k] = any(random);
            square += p[k] * p[k];
        }
        i += square <= 1.0;
    }
}

static void make_sphere(kit_random *random, double at[][3], uint32_t count)
{
    make_ball(random, at, count);
    for (uint32_t i = 0; i < count; i++) {
        double length = sqrt(at[i][0] * at[i][0] + at[i][1] * at[i][1] + at[i][2] * at[i][2]);
        for (int k = 0; k < 3; k++)
            at[i][k] /= length;
    }
}

static void make_box(kit_random *random, double at[][3], uint32_t count)
{
    for (uint32_t i = 0; i < 3 * count; i++)
        at[i / 3][i % 3] = kit_below(random, 2) ? 1.0 : -1.0;
}

static void make_ring(kit_random *random, double at[][3], uint32_t count)
{
    double taper = 0.5 + 0.5 * any(random);
    for (uint32_t i = 0; i < count; i++) {
        double angle = 6.283185307179586 * (double)(i - i % 2) / (double)(count + count % 2);
        at[i][0] = cos(angle) * (i % 2 ? 1.0 : taper);
        at[i][1] = sin(angle) * (i % 2 ? 1.0 : taper);
        at[i][2] = i % 2 ? 1.0 : -1.0;
    }
}

// Corners of a few boxes that stand on each other, as furniture does.
static void make_stack(kit_random *random, double at[][3], uint32_t count)
{
    double low[3] = {0}, high[3] = {0};
    for (uint32_t i = 0; i < count; i++) {
        for (int k = 0; k < 3 && i % 8 == 0; k++) {
            double a = any(random), b = any(random);
            low[k] = a < b ? a : b;
            high[k] = a < b ? b : a;
        }
        for (int k = 0; k < 3; k++)
            at[i][k] = i >> k & 1 ? high[k] : low[k];
    }
}

static void make_plane(kit_random *random, double at[][3], uint32_t count)
{
    make_cloud(random, at, count);
    for (uint32_t i = 0; i < count; i++)
        at[i][2] = 0.25;
}

static void make_line(kit_random *random, double at[][3], uint32_t count)
{
    for (uint32_t i = 0; i < count; i++)
        at[i][0] = at[i][1] = at[i][2] = any(random);
}

static void make_point(kit_random *random, double at[][3], uint32_t count)
{
    make_cloud(random, at, 1);
    for (uint32_t i = 3; i < 3 * count; i++)
        at[i / 3][i % 3] = at[0][i % 3];
}

const soups_shape soups_shapes[] = {
    {"cloud", make_cloud, true},  {"ball", make_ball, true},  {"sphere", make_sphere, true},
    {"box", make_box, true},      {"ring", make_ring, true},  {"stack", make_stack, true},
    {"plane", make_plane, false}, {"line", make_line, false}, {"point", make_point, false},
};
const uint32_t soups_shape_count = (uint32_t)(sizeof soups_shapes / sizeof *soups_shapes);

// --- where it is put -----------------------------------------------------------------------------

// An affine map: a turn, stretched along the axes, and a way to go.
typedef struct placement {
    double column[3][3], shift[3];
} placement;

static void make_turn(kit_random *random, double column[3][3])
{
    double q[4], length = 0.0;
    for (int k = 0; k < 4; k++) {
        q[k] = any(random);
        length += q[k] * q[k];
    }
    for (int k = 0; k < 4; k++)
        q[k] /= sqrt(length);
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        column[i][i] = 1.0 - 2.0 * (q[j] * q[j] + q[k] * q[k]);
        column[i][j] = 2.0 * (q[i] * q[j] + q[k] * q[3]);
        column[i][k] = 2.0 * (q[i] * q[k] - q[j] * q[3]);
    }
}

static placement make_placement(kit_random *random, bool gently)
{
    placement p = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0}};
    if (kit_below(random, 4)) make_turn(random, p.column);
    // Sizes from 2^-140 to 2^48, and flatness down to nothing.
    double scale = gently ? 1.0 : ldexp(1.0, (int)kit_below(random, 189) - 140);
    for (int k = 0; k < 3; k++) {
        double stretch = ldexp(1.0, -(int)kit_below(random, gently ? 4 : 30)) * scale;
        for (int j = 0; j < 3; j++)
            p.column[k][j] *= stretch;
        p.shift[k] = gently ? 10.0 * any(random) : 100.0 * any(random) * scale;
        if (!gently && kit_below(random, 3) == 0) p.shift[k] = 0.0;
    }
    return p;
}

static float placed(const placement *p, const double at[3], int j)
{
    double x = p->shift[j];
    for (int k = 0; k < 3; k++)
        x += at[k] * p->column[k][j];
    if (x > 4e14) x = 4e14;
    if (x < -4e14) x = -4e14;
    return (float)x;
}

void soups_make(kit_random *random, const soups_shape *shape, uint32_t vertices, bool gently,
                soups_soup *soup)
{
    static double at[SOUPS_MOST_VERTICES][3];
    shape->make(random, at, vertices);
    placement p = make_placement(random, gently);
    for (uint32_t i = 0; i < 3 * vertices; i++)
        soup->position[i / 3][i % 3] = placed(&p, at[i / 3], (int)(i % 3));
    soup->vertices = vertices;
    // Every vertex is named, and then some again.
    soup->triangles = (vertices + 2) / 3 + kit_below(random, 20);
    for (uint32_t i = 0; i < 3 * soup->triangles; i++)
        soup->index[i] = i < vertices ? i : kit_below(random, vertices);
}
