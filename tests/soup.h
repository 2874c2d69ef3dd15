// SPDX-License-Identifier: Apache-2.0
// Small models made by hand, for the tests of what is done with models.
#ifndef OCC_TEST_SOUP_H
#define OCC_TEST_SOUP_H

#include "model.h"

#include <check.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// An empty model with room for `triangles`.
static inline model soup_make(uint32_t triangles)
{
    model m = {0};
    m.positions = calloc(3 * (size_t)triangles + 1, sizeof *m.positions);
    m.corners = calloc((size_t)triangles + 1, sizeof *m.corners);
    m.see_through = calloc((size_t)triangles + 1, sizeof *m.see_through);
    ck_assert(m.positions && m.corners && m.see_through);
    for (int k = 0; k < 3; k++) {
        m.min[k] = INFINITY;
        m.max[k] = -INFINITY;
    }
    return m;
}

static inline void soup_free(model *m)
{
    free(m->positions);
    free(m->corners);
    free(m->see_through);
    *m = (model){0};
}

// Equal positions are one vertex, as in a model that was read.
static inline uint32_t soup_vertex(model *m, const float p[3])
{
    for (uint32_t v = 0; v < m->vertex_count; v++) {
        const float *q = m->positions[v];
        if (q[0] == p[0] && q[1] == p[1] && q[2] == p[2]) return v;
    }
    for (int k = 0; k < 3; k++) {
        m->min[k] = fminf(m->min[k], p[k]);
        m->max[k] = fmaxf(m->max[k], p[k]);
        m->positions[m->vertex_count][k] = p[k];
    }
    return m->vertex_count++;
}

static inline void soup_triangle(model *m, const float *a, const float *b, const float *c)
{
    uint32_t *corners = m->corners[m->triangle_count++];
    corners[0] = soup_vertex(m, a);
    corners[1] = soup_vertex(m, b);
    corners[2] = soup_vertex(m, c);
}

// Two triangles with the diagonal a-c.
static inline void soup_quad(model *m, const float *a, const float *b, const float *c,
                             const float *d)
{
    soup_triangle(m, a, b, c);
    soup_triangle(m, a, c, d);
}

// The six faces of a box, seen from outside or from inside.
static inline void soup_box(model *m, const float low[3], const float high[3], bool inward)
{
    for (int axis = 0; axis < 3; axis++)
        for (int side = 0; side < 2; side++) {
            float p[4][3];
            for (int i = 0; i < 4; i++) {
                bool far_u = i == 1 || i == 2, far_v = i >= 2;
                p[i][axis] = side ? high[axis] : low[axis];
                p[i][(axis + 1) % 3] = far_u ? high[(axis + 1) % 3] : low[(axis + 1) % 3];
                p[i][(axis + 2) % 3] = far_v ? high[(axis + 2) % 3] : low[(axis + 2) % 3];
            }
            if ((side == 1) != inward)
                soup_quad(m, p[0], p[1], p[2], p[3]);
            else
                soup_quad(m, p[0], p[3], p[2], p[1]);
        }
}

#endif
