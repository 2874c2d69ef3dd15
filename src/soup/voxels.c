// SPDX-License-Identifier: Apache-2.0
// Separating axes, as in Schwarz and Seidel, "Fast parallel surface and solid voxelization on GPUs"
// (2010). A cell is left untouched only where an axis separates it from the triangle by more than
// all rounding: coordinates in cells are below 2^24 and off by less than 2^-25, and what is made of
// them is off by less than 2^-24 of the magnitudes that enter; MARGIN is 2^8 times that. So errors
// touch a cell too many and never one too few.
#include "soup/voxels.h"

#include <math.h>
#include <string.h>

#define MARGIN 0x1p-16

// --- ready for a grid ----------------------------------------------------------------------------

static bool invert(const double a[3][3], double out[3][3])
{
    double c[3][3], det = 0.0, size = 0.0;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            int p = (i + 1) % 3, q = (i + 2) % 3, r = (j + 1) % 3, s = (j + 2) % 3;
            c[i][j] = a[p][r] * a[q][s] - a[p][s] * a[q][r];
        }
    for (int j = 0; j < 3; j++) {
        det += a[0][j] * c[0][j];
        size += fabs(a[0][j] * c[0][j]);
    }
    if (!(fabs(det) > 1e-6 * size) || !(fabs(det) < INFINITY)) return false;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[i][j] = c[j][i] / det;
    return true;
}

// The longest way across a cell, in world units, a little too long rather than too short.
static double cell_width(const occ_voxels *v)
{
    double most = 0.0;
    for (int turn = 0; turn < 4; turn++) {
        double sum = 0.0;
        for (int j = 0; j < 3; j++) {
            double d = v->inverse[j][0] + (turn & 1 ? -1.0 : 1.0) * v->inverse[j][1] +
                       (turn & 2 ? -1.0 : 1.0) * v->inverse[j][2];
            sum += d * d;
        }
        most = occ_most(most, sqrt(sum));
    }
    return most * (1.0 + 0x1p-12); // margins and the rounding of axes included
}

// The width of a ball that may pass is below twice the distance from the surface at which cells are
// never blocked: such a ball's middle is in free cells all the way.
static void set_hole(occ_voxels *v)
{
    double hole = 2.0 * (v->grid.closing + 1.0) * cell_width(v);
    v->grid.hole = (float)(hole * (1.0 + 0x1p-20));
}

bool occ_voxels_set(occ_voxels *voxels, const occ_inner_grid *grid)
{
    double rows[3][3], inverse[3][3];
    uint64_t count = 1;
    for (int k = 0; k < 3; k++) {
        if (!(grid->cell[k] > 0.0f && grid->cell[k] < INFINITY)) return false;
        if (grid->size[k] < 3 || grid->size[k] > OCC_MOST_CELLS) return false;
        if (grid->origin[k] < -(1 << 25) || grid->origin[k] > 1 << 25) return false;
        count *= grid->size[k];
        if (count > OCC_MOST_CELLS) return false;
        for (int j = 0; j < 3; j++) {
            if (!(fabsf(grid->axis[k][j]) <= 1.5f)) return false;
            rows[k][j] = (double)grid->axis[k][j] / (double)grid->cell[k];
        }
    }
    if (grid->closing > 1024 || !invert((const double(*)[3])rows, inverse)) return false;
    voxels->grid = *grid;
    memcpy(voxels->inverse, inverse, sizeof inverse);
    voxels->count = (uint32_t)count;
    voxels->step[0] = 1;
    voxels->step[1] = grid->size[0];
    voxels->step[2] = (size_t)grid->size[0] * grid->size[1];
    set_hole(voxels);
    return true;
}

occ_result occ_voxels_reserve(occ_hooks *hooks, occ_voxels *voxels)
{
    if (voxels->count <= voxels->room) return OCC_SUCCESS;
    occ_voxels_free(hooks, voxels);
    voxels->state = occ_alloc(hooks, voxels->count);
    voxels->work = occ_alloc(hooks, voxels->count * sizeof *voxels->work);
    voxels->room = voxels->count;
    return voxels->state && voxels->work ? OCC_SUCCESS : OCC_ERROR_OUT_OF_MEMORY;
}

void occ_voxels_free(occ_hooks *hooks, occ_voxels *voxels)
{
    occ_free(hooks, voxels->state, voxels->room);
    occ_free(hooks, voxels->work, voxels->room * sizeof *voxels->work);
    voxels->state = NULL;
    voxels->work = NULL;
    voxels->room = 0;
}

static double dot_float(const float a[3], const float p[3])
{
    return (double)a[0] * (double)p[0] + (double)a[1] * (double)p[1] + (double)a[2] * (double)p[2];
}

void occ_voxels_lead(const occ_voxels *voxels, const float point[3], double out[3])
{
    const occ_inner_grid *g = &voxels->grid;
    for (int k = 0; k < 3; k++)
        out[k] = dot_float(g->axis[k], point) / (double)g->cell[k] - (double)g->origin[k];
}

void occ_voxels_lead_back(const occ_voxels *voxels, const double at[3], double out[3])
{
    for (int j = 0; j < 3; j++) {
        out[j] = 0.0;
        for (int k = 0; k < 3; k++)
            out[j] += voxels->inverse[j][k] * (at[k] + (double)voxels->grid.origin[k]);
    }
}

bool occ_voxels_are_near(const occ_voxels *voxels, const occ_mesh *mesh)
{
    for (int k = 0; k < 3; k++) {
        double most = 0.0;
        for (int j = 0; j < 3; j++) {
            double reach = occ_most(fabs((double)mesh->min[j]), fabs((double)mesh->max[j]));
            most += fabs((double)voxels->grid.axis[k][j]) * reach;
        }
        if (!(most / (double)voxels->grid.cell[k] < 0x1p24)) return false;
    }
    return true;
}

// --- which cells a triangle touches --------------------------------------------------------------

// Cells are separated if low <= u * cu + v * cv <= high does not hold for their middle.
typedef struct stripe {
    double u, v, low, high;
} stripe;

typedef struct marker {
    const occ_voxels *voxels;
    int32_t first[3], last[3];
    stripe edge[3][3]; // [axis that is looked along][edge]
    double normal[3], low, high;
    int along; // the axis that the normal is nearest to
} marker;

// The cells that [low, high] may touch; none where first > last.
static void clip_range(const occ_voxels *v, int k, double low, double high, int32_t *first,
                       int32_t *last)
{
    double most = (double)v->grid.size[k] - 1.0;
    double a = floor(low - MARGIN), b = floor(high + MARGIN);
    if (a == low - MARGIN) a -= 1.0; // closed cells: it touches the one before as well
    *first = (int32_t)(a < 0.0 ? 0.0 : a > most + 1.0 ? most + 1.0 : a);
    *last = (int32_t)(b > most ? most : b < -1.0 ? -1.0 : b);
}

static stripe make_stripe(const double p[3][3], int edge, int u, int v)
{
    const double *a = p[edge], *b = p[(edge + 1) % 3];
    stripe s = {a[v] - b[v], b[u] - a[u], INFINITY, -INFINITY};
    for (int i = 0; i < 3; i++) {
        double at = s.u * p[i][u] + s.v * p[i][v];
        s.low = occ_least(s.low, at);
        s.high = occ_most(s.high, at);
    }
    double reach = (0.5 + MARGIN) * (fabs(s.u) + fabs(s.v));
    s.low -= reach;
    s.high += reach;
    return s;
}

static void set_normal(marker *m, const double p[3][3])
{
    double most = 0.0, reach = 0.0;
    m->along = 2;
    m->low = INFINITY;
    m->high = -INFINITY;
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        m->normal[k] =
            (p[1][i] - p[0][i]) * (p[2][j] - p[0][j]) - (p[1][j] - p[0][j]) * (p[2][i] - p[0][i]);
        reach += (0.5 + MARGIN) * fabs(m->normal[k]);
        if (fabs(m->normal[k]) <= most) continue;
        most = fabs(m->normal[k]);
        m->along = k;
    }
    for (int i = 0; i < 3; i++) {
        double at = 0.0;
        for (int k = 0; k < 3; k++)
            at += m->normal[k] * p[i][k];
        m->low = occ_least(m->low, at);
        m->high = occ_most(m->high, at);
    }
    m->low -= reach;
    m->high += reach;
}

static bool in_stripes(const stripe *edge, double u, double v)
{
    for (int i = 0; i < 3; i++) {
        double at = edge[i].u * u + edge[i].v * v;
        if (at < edge[i].low || at > edge[i].high) return false;
    }
    return true;
}

// The cells of a column that the triangle's plane may touch.
static void plane_range(const marker *m, const double middle[3], int32_t *first, int32_t *last)
{
    int w = m->along, u = (w + 1) % 3, v = (w + 2) % 3;
    *first = m->first[w];
    *last = m->last[w];
    if (m->normal[w] == 0.0) return;
    double base = m->normal[u] * middle[u] + m->normal[v] * middle[v];
    double a = (m->low - base) / m->normal[w], b = (m->high - base) / m->normal[w];
    double low = ceil(occ_least(a, b) - 0.5 - MARGIN), high = floor(occ_most(a, b) - 0.5 + MARGIN);
    if (low > *first) *first = low > *last ? *last + 1 : (int32_t)low;
    if (high < *last) *last = high < *first ? *first - 1 : (int32_t)high;
}

static void touch(const occ_voxels *v, const int32_t at[3])
{
    uint32_t place[3] = {(uint32_t)at[0], (uint32_t)at[1], (uint32_t)at[2]};
    __atomic_store_n(&v->state[occ_cell_at(v, place)], OCC_CELL_TOUCHED, __ATOMIC_RELAXED);
}

static void touch_column(const marker *m, int32_t at[3], double middle[3])
{
    int w = m->along, u = (w + 1) % 3, v = (w + 2) % 3;
    int32_t first, last;
    plane_range(m, middle, &first, &last);
    for (at[w] = first; at[w] <= last; at[w]++) {
        middle[w] = at[w] + 0.5;
        // Looked along u, the plane's axes are v and w; along v, w and u.
        if (in_stripes(m->edge[u], middle[v], middle[w]) &&
            in_stripes(m->edge[v], middle[w], middle[u]))
            touch(m->voxels, at);
    }
}

static void mark_triangle(const occ_voxels *voxels, const double p[3][3])
{
    marker m = {.voxels = voxels};
    int32_t cells = 1;
    for (int k = 0; k < 3; k++) {
        double low = occ_least(p[0][k], occ_least(p[1][k], p[2][k]));
        double high = occ_most(p[0][k], occ_most(p[1][k], p[2][k]));
        clip_range(voxels, k, low, high, &m.first[k], &m.last[k]);
        if (m.first[k] > m.last[k]) return;
        if (m.first[k] != m.last[k]) cells = 2;
    }
    if (cells == 1) {
        touch(voxels, m.first);
        return;
    }
    set_normal(&m, p);
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < 3; i++)
            m.edge[k][i] = make_stripe(p, i, (k + 1) % 3, (k + 2) % 3);
    int w = m.along, u = (w + 1) % 3, v = (w + 2) % 3;
    int32_t at[3];
    double middle[3];
    for (at[u] = m.first[u]; at[u] <= m.last[u]; at[u]++) {
        middle[u] = at[u] + 0.5;
        for (at[v] = m.first[v]; at[v] <= m.last[v]; at[v]++) {
            middle[v] = at[v] + 0.5;
            if (in_stripes(m.edge[w], middle[u], middle[v])) touch_column(&m, at, middle);
        }
    }
}

typedef struct mark_job {
    const occ_voxels *voxels;
    const occ_triangles *triangles;
    uint32_t parts;
} mark_job;

static void mark_some(void *context, uint32_t part)
{
    const mark_job *job = context;
    const occ_triangles *t = job->triangles;
    uint32_t end = occ_part_first(t->count, job->parts, part + 1);
    for (uint32_t i = occ_part_first(t->count, job->parts, part); i < end; i++) {
        double p[3][3];
        for (int c = 0; c < 3; c++)
            occ_voxels_lead(job->voxels, occ_mesh_corner(t->mesh, occ_triangle_at(t, i), c), p[c]);
        mark_triangle(job->voxels, (const double(*)[3])p);
    }
}

void occ_voxels_mark(occ_voxels *voxels, const occ_triangles *triangles, occ_team *team)
{
    memset(voxels->state, 0, voxels->count);
    mark_job job = {voxels, triangles, occ_parts_of(triangles->count)};
    if (triangles->count >= OCC_MOST_PARTS) job.parts = OCC_MOST_PARTS; // they differ in size
    occ_do_parts(team, job.parts, mark_some, &job);
}
