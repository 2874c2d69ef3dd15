// SPDX-License-Identifier: Apache-2.0
#include "voxels.h"

#include "progress.h"
#include "steady.h"

#include <math.h>
#include <stdlib.h>

// What a ray meets, as it is kept while cells are swept.
enum { MEETS_NOTHING = 0, MEETS_FRONT = 1, MEETS_BACK = 2, MEETS_BOTH = 3 };

// The sum of the normals in a cell, weighted, and of the weights.
typedef struct cell_normal {
    float sum[3], weight;
} cell_normal;

typedef struct triangle_shape {
    double corner[3][3], edge[3][3], normal[3];
} triangle_shape;

static const int DIRECTION[VOXEL_DIRECTIONS][3] = {
    {0, -1, 0}, {0, 1, 0},  {1, 0, 0},   {-1, 0, 0}, {0, 0, 1},   {0, 0, -1},  {1, 1, 1},
    {-1, 1, 1}, {1, 1, -1}, {-1, 1, -1}, {1, -1, 1}, {-1, -1, 1}, {1, -1, -1}, {-1, -1, -1}};

static double dot3(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static triangle_shape shape_of(const model *m, uint32_t triangle)
{
    triangle_shape s;
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < 3; k++)
            s.corner[c][k] = (double)m->positions[m->corners[triangle][c]][k];
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < 3; k++)
            s.edge[c][k] = s.corner[(c + 1) % 3][k] - s.corner[c][k];
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        s.normal[k] = s.edge[0][i] * s.edge[1][j] - s.edge[0][j] * s.edge[1][i];
    }
    return s;
}

// Whether the triangle and a cube are apart along an axis. Slightly reluctant, so that rounding
// never frees a cell that is touched.
static bool apart(const triangle_shape *s, const double center[3], double half,
                  const double axis[3])
{
    double least = INFINITY, most = -INFINITY;
    for (int c = 0; c < 3; c++) {
        double d[3] = {s->corner[c][0] - center[0], s->corner[c][1] - center[1],
                       s->corner[c][2] - center[2]};
        double along = dot3(d, axis);
        least = fmin(least, along);
        most = fmax(most, along);
    }
    double reach = half * (fabs(axis[0]) + fabs(axis[1]) + fabs(axis[2])) * (1 + 1e-6);
    return least > reach || most < -reach;
}

// The separating axes that the cell range does not already settle: the normal, and edges times
// axes.
static bool touches_cell(const triangle_shape *s, const double center[3], double half)
{
    if (apart(s, center, half, s->normal)) return false;
    for (int e = 0; e < 3; e++)
        for (int k = 0; k < 3; k++) {
            double axis[3] = {0, 0, 0};
            axis[(k + 1) % 3] = -s->edge[e][(k + 2) % 3];
            axis[(k + 2) % 3] = s->edge[e][(k + 1) % 3];
            if (apart(s, center, half, axis)) return false;
        }
    return true;
}

static size_t index_of(const voxel_grid *g, int x, int y, int z)
{
    return ((size_t)y * (size_t)g->size[2] + (size_t)z) * (size_t)g->size[0] + (size_t)x;
}

static int cell_along(const voxel_grid *g, double at, int axis)
{
    double c = floor((at - g->origin[axis]) / g->cell);
    return c < 0 ? 0 : c >= g->size[axis] ? g->size[axis] - 1 : (int)c;
}

static void mark(voxel_grid *g, cell_normal *normals, size_t index, const triangle_shape *s)
{
    double length = sqrt(dot3(s->normal, s->normal));
    double weight = fmin(length, g->cell * g->cell);
    g->solid[index] = true;
    if (length == 0) return;
    for (int k = 0; k < 3; k++)
        normals[index].sum[k] += (float)(s->normal[k] / length * weight);
    normals[index].weight += (float)weight;
}

static void add_triangle_cells(voxel_grid *g, cell_normal *normals, const triangle_shape *s)
{
    int low[3], high[3];
    double slack = g->cell * 1e-6;
    for (int k = 0; k < 3; k++) {
        double min = fmin(s->corner[0][k], fmin(s->corner[1][k], s->corner[2][k]));
        double max = fmax(s->corner[0][k], fmax(s->corner[1][k], s->corner[2][k]));
        low[k] = cell_along(g, min - slack, k);
        high[k] = cell_along(g, max + slack, k);
    }
    for (int y = low[1]; y <= high[1]; y++)
        for (int z = low[2]; z <= high[2]; z++)
            for (int x = low[0]; x <= high[0]; x++) {
                size_t index = index_of(g, x, y, z);
                double center[3];
                voxels_center(g, index, center);
                if (touches_cell(s, center, g->cell / 2)) mark(g, normals, index, s);
            }
}

static void add_detail(voxel_grid *g, const triangle_shape *s)
{
    double middle[3];
    for (int k = 0; k < 3; k++)
        middle[k] = (s->corner[0][k] + s->corner[1][k] + s->corner[2][k]) / 3;
    size_t index = voxels_at(g, middle);
    if (index != SIZE_MAX && g->detail[index] < UINT16_MAX) g->detail[index]++;
}

static uint8_t seen_from(const cell_normal *n, const int direction[3])
{
    float along = 0, length = 0;
    for (int k = 0; k < 3; k++) {
        along += n->sum[k] * (float)direction[k];
        length += (float)(direction[k] * direction[k]);
    }
    along /= sqrtf(length);
    if (fabsf(along) <= 0.1f * n->weight) return MEETS_BOTH;
    return along < 0 ? MEETS_FRONT : MEETS_BACK;
}

// What the ray from each cell along a direction meets, from what the next cell's meets: cells are
// visited with the next one first.
static void sweep(voxel_grid *g, const cell_normal *normals, const int d[3], uint8_t *meets)
{
    for (size_t i = 0; i < g->count; i++) {
        size_t index = i;
        if (d[1] > 0 || (d[1] == 0 && (d[2] > 0 || (d[2] == 0 && d[0] > 0)))) {
            index = g->count - 1 - i;
        }
        size_t row = index / (size_t)g->size[0];
        int x = (int)(index % (size_t)g->size[0]) + d[0];
        int z = (int)(row % (size_t)g->size[2]) + d[2], y = (int)(row / (size_t)g->size[2]) + d[1];
        uint8_t found = MEETS_NOTHING;
        if (x >= 0 && x < g->size[0] && y >= 0 && y < g->size[1] && z >= 0 && z < g->size[2]) {
            size_t next = index_of(g, x, y, z);
            found = g->solid[next] ? seen_from(&normals[next], d) : meets[next];
        }
        meets[index] = found;
        g->hits[index] = (uint8_t)(g->hits[index] + (found != MEETS_NOTHING));
        g->facing[index] =
            (int8_t)(g->facing[index] + (found == MEETS_FRONT) - (found == MEETS_BACK));
    }
}

static void measure_height(voxel_grid *g)
{
    size_t layer = (size_t)g->size[0] * (size_t)g->size[2];
    for (size_t i = 0; i < g->count; i++) {
        g->height[i] = UINT16_MAX;
        if (i < layer || g->solid[i]) continue;
        if (g->solid[i - layer]) g->height[i] = 1;
        if (!g->solid[i - layer] && g->height[i - layer] != UINT16_MAX) {
            g->height[i] = (uint16_t)(g->height[i - layer] + 1);
        }
    }
}

// The room of a cell from those of the 13 neighbours that a pass has seen before it.
static uint8_t room_from(const voxel_grid *g, int x, int y, int z, int direction)
{
    if (x == 0 || y == 0 || z == 0 || x == g->size[0] - 1 || y == g->size[1] - 1 ||
        z == g->size[2] - 1) {
        return 1;
    }
    uint8_t least = UINT8_MAX - 1;
    for (int n = 0; n < 13; n++) {
        int dx = n % 3 - 1, dz = n / 3 % 3 - 1, dy = n / 9 - 1;
        size_t next = index_of(g, x + direction * dx, y + direction * dy, z + direction * dz);
        if (g->room[next] < least) least = g->room[next];
    }
    return (uint8_t)(least + 1);
}

// The chessboard distance: one pass from the first cell to the last, one back.
static void measure_room(voxel_grid *g)
{
    for (size_t i = 0; i < g->count; i++)
        g->room[i] = g->solid[i] ? 0 : UINT8_MAX;
    for (int direction = 1; direction >= -1; direction -= 2)
        for (size_t n = 0; n < g->count; n++) {
            size_t i = direction > 0 ? n : g->count - 1 - n;
            if (g->room[i] == 0) continue;
            size_t row = i / (size_t)g->size[0];
            uint8_t room =
                room_from(g, (int)(i % (size_t)g->size[0]), (int)(row / (size_t)g->size[2]),
                          (int)(row % (size_t)g->size[2]), direction);
            if (room < g->room[i]) g->room[i] = room;
        }
}

static void choose_cells(const model *m, double cells, voxel_grid *g)
{
    double extent[3], longest = 0, volume = 1;
    for (int k = 0; k < 3; k++) {
        extent[k] = (double)m->max[k] - (double)m->min[k];
        longest = fmax(longest, extent[k]);
    }
    if (longest == 0) longest = fmax(1e-30, fabs((double)m->max[0]) * 1e-6);
    for (int k = 0; k < 3; k++)
        volume *= fmax(extent[k], longest / 64);
    g->cell = fmax(steady_cbrt(volume / cells), longest / 512);
    g->count = 1;
    for (int k = 0; k < 3; k++) {
        g->size[k] = (int)ceil(extent[k] / g->cell) + 2;
        g->origin[k] = (double)m->min[k] - 0.5 * ((double)g->size[k] * g->cell - extent[k]);
        g->count *= (size_t)g->size[k];
    }
}

static bool fill(const model *m, voxel_grid *g)
{
    cell_normal *normals = calloc(g->count, sizeof *normals);
    uint8_t *meets = calloc(g->count, sizeof *meets);
    bool done = normals && meets;
    progress_begin("mapping free space, by triangle", m->triangle_count);
    for (uint32_t t = 0; done && t < m->triangle_count; t++) {
        progress_step(t);
        triangle_shape s = shape_of(m, t);
        add_triangle_cells(g, normals, &s);
        add_detail(g, &s);
    }
    progress_end();
    for (int d = 0; done && d < VOXEL_DIRECTIONS; d++)
        sweep(g, normals, DIRECTION[d], meets);
    free(normals);
    free(meets);
    return done;
}

bool voxels_build(const model *m, double cells, voxel_grid *out)
{
    *out = (voxel_grid){0};
    choose_cells(m, cells, out);
    out->solid = calloc(out->count, sizeof *out->solid);
    out->detail = calloc(out->count, sizeof *out->detail);
    out->hits = calloc(out->count, sizeof *out->hits);
    out->facing = calloc(out->count, sizeof *out->facing);
    out->room = malloc(out->count * sizeof *out->room);
    out->height = malloc(out->count * sizeof *out->height);
    bool done = out->solid && out->detail && out->hits && out->facing && out->room && out->height &&
                fill(m, out);
    if (done) {
        measure_height(out);
        measure_room(out);
    } else {
        voxels_free(out);
    }
    return done;
}

size_t voxels_at(const voxel_grid *grid, const double point[3])
{
    int c[3];
    for (int k = 0; k < 3; k++) {
        double at = floor((point[k] - grid->origin[k]) / grid->cell);
        if (!(at >= 0 && at < grid->size[k])) return SIZE_MAX;
        c[k] = (int)at;
    }
    return index_of(grid, c[0], c[1], c[2]);
}

void voxels_center(const voxel_grid *grid, size_t index, double out[3])
{
    size_t row = index / (size_t)grid->size[0];
    const size_t c[3] = {index % (size_t)grid->size[0], row / (size_t)grid->size[2],
                         row % (size_t)grid->size[2]};
    for (int k = 0; k < 3; k++)
        out[k] = grid->origin[k] + ((double)c[k] + 0.5) * grid->cell;
}

void voxels_free(voxel_grid *grid)
{
    free(grid->solid);
    free(grid->detail);
    free(grid->hits);
    free(grid->facing);
    free(grid->room);
    free(grid->height);
    *grid = (voxel_grid){0};
}
