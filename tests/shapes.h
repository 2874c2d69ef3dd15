// SPDX-License-Identifier: Apache-2.0
// Closed surfaces made by hand, each triangle with the number of the solid that it is of.
#ifndef OCC_TEST_SHAPES_H
#define OCC_TEST_SHAPES_H

#include "kit.h"

#include <math.h>

enum { SHAPES_MOST = 3000 };

typedef struct shapes {
    float at[3 * SHAPES_MOST][3];
    uint32_t solid[SHAPES_MOST];
    uint32_t triangles, solids;
    float turn[3][3], shift[3]; // of what is added from now on
} shapes;

static inline void shapes_reset(shapes *s)
{
    s->triangles = s->solids = 0;
    for (int j = 0; j < 3; j++) {
        s->shift[j] = 0.0f;
        for (int k = 0; k < 3; k++)
            s->turn[j][k] = j == k ? 1.0f : 0.0f;
    }
}

static inline occ_soup shapes_soup(const shapes *s)
{
    return (occ_soup){.positions = &s->at[0][0],
                      .vertex_count = 3 * s->triangles,
                      .triangle_count = s->triangles};
}

static inline void shapes_corner(const shapes *s, uint32_t triangle, const float *corner[3])
{
    for (uint32_t i = 0; i < 3; i++)
        corner[i] = s->at[3 * triangle + i];
}

static inline void shapes_triangle(shapes *s, const float *a, const float *b, const float *c)
{
    const float *corner[3] = {a, b, c};
    KIT_CHECK(s->triangles < SHAPES_MOST, "too many triangles");
    for (uint32_t i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            s->at[3 * s->triangles + i][j] = s->shift[j] + s->turn[j][0] * corner[i][0] +
                                             s->turn[j][1] * corner[i][1] +
                                             s->turn[j][2] * corner[i][2];
    s->solid[s->triangles++] = s->solids;
}

// Counterclockwise from outside.
static inline void shapes_box(shapes *s, const float low[3], const float high[3])
{
    static const int quad[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                   {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    float p[8][3];
    for (int i = 0; i < 8; i++)
        for (int k = 0; k < 3; k++)
            p[i][k] = i >> k & 1 ? high[k] : low[k];
    for (int f = 0; f < 6; f++) {
        shapes_triangle(s, p[quad[f][0]], p[quad[f][1]], p[quad[f][2]]);
        shapes_triangle(s, p[quad[f][0]], p[quad[f][2]], p[quad[f][3]]);
    }
    s->solids++;
}

static inline void shapes_tetrahedron(shapes *s, const float p[4][3])
{
    shapes_triangle(s, p[0], p[2], p[1]);
    shapes_triangle(s, p[0], p[1], p[3]);
    shapes_triangle(s, p[1], p[2], p[3]);
    shapes_triangle(s, p[2], p[0], p[3]);
    s->solids++;
}

// Of radius 1 around the origin; `tube` is 0 for a sphere, or the radius of a torus's tube.
static inline void shapes_round(shapes *s, int rings, float tube)
{
    enum { MOST = 24 };
    float p[MOST + 1][2 * MOST][3];
    int around = 2 * rings;
    for (int i = 0; i <= rings; i++)
        for (int j = 0; j < around; j++) {
            float a = 6.2831853f * (float)j / (float)around;
            float b = 6.2831853f * (float)(i % rings) / (float)rings;
            float out = 1.0f + tube * cosf(b), up = tube * sinf(b);
            if (tube == 0.0f) {
                out = i == 0 || i == rings ? 0.0f : sinf(3.1415927f * (float)i / (float)rings);
                up = -cosf(3.1415927f * (float)i / (float)rings);
            }
            p[i][j][0] = out * cosf(a);
            p[i][j][1] = out * sinf(a);
            p[i][j][2] = up;
        }
    for (int i = 0; i < rings; i++)
        for (int j = 0; j < around; j++) {
            int next = (j + 1) % around;
            // At the poles one of the two has no area.
            shapes_triangle(s, p[i][j], p[i][next], p[i + 1][next]);
            shapes_triangle(s, p[i][j], p[i + 1][next], p[i + 1][j]);
        }
    s->solids++;
}

#endif
