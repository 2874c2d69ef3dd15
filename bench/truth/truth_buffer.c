// SPDX-License-Identifier: Apache-2.0
// Blocks of 8 x 8 samples remember how far their farthest occluder is (the second one of each
// sample), and what lies wholly beyond is skipped (Greene, Kass and Miller, 1993).
#include "truth_buffer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { BLOCK = 8, TILE = 128, TILE_BLOCKS = TILE / BLOCK, NO_OWNER = -1 };

typedef struct tile_block {
    double nearest[BLOCK][BLOCK], second[BLOCK][BLOCK]; // second: of another owner
    double low[BLOCK][BLOCK], high[BLOCK][BLOCK];       // the ray's part in the frustum
    int64_t owner[BLOCK][BLOCK];                        // of the nearest
    double farthest_nearest, farthest;                  // of `nearest` and of `second`
} tile_block;

typedef struct tile {
    const truth_view *view;
    truth_rect rect;
    tile_block block[TILE_BLOCKS][TILE_BLOCKS];
} tile;

// A solid's own coordinates of a ray: constant, and per x and y of the viewport. Of a triangle
// those of the edges, see truth_pass(), and how it faces the ray and is ahead of its origin.
typedef struct slabs {
    double origin[3][3], direction[3][3], extent[3]; // [axis][part]
    truth_kind kind;
    double pass[3][3], facing[3], ahead[3]; // [edge][part]
} slabs;

// A perspective ray changes its direction alone, an orthographic one its origin, and so what
// truth_pass() says is linear in x and y.
static void set_edges(slabs *s, const truth_view *view, const truth_solid *solid)
{
    const double *constant = view->direction[0];
    for (int part = 0; part < 3; part++) {
        const double *origin = view->origin[part], *direction = view->direction[part];
        bool is_moved = part > 0 && view->row[2][3] != 0.0;
        for (int k = 0; k < 3; k++)
            s->pass[k][part] = is_moved ? -truth_aside(solid, k, origin, constant)
                                        : truth_pass(solid, k, origin, direction);
        s->facing[part] = truth_dot(solid->normal, direction);
        s->ahead[part] = -truth_dot(solid->normal, origin);
    }
    s->ahead[0] += truth_dot(solid->normal, solid->corner[0]);
}

static void set_slabs(slabs *s, const truth_view *view, const truth_solid *solid)
{
    s->kind = solid->kind;
    if (solid->kind != TRUTH_SLABS) {
        set_edges(s, view, solid);
        return;
    }
    for (int part = 0; part < 3; part++) {
        double origin[3];
        for (int j = 0; j < 3; j++)
            origin[j] = view->origin[part][j] - (part == 0 ? solid->center[j] : 0.0);
        for (int k = 0; k < 3; k++) {
            s->origin[k][part] = truth_dot(solid->inverse[k], origin);
            s->direction[k][part] = truth_dot(solid->inverse[k], view->direction[part]);
        }
    }
    memcpy(s->extent, solid->extent, sizeof s->extent);
}

// A ray that misses leaves before it enters.
static void cross_triangle(const slabs *s, const double x[BLOCK], double y, double *restrict enter,
                           double *restrict leave)
{
    double most[BLOCK], least[BLOCK];
    for (int i = 0; i < BLOCK; i++) {
        most[i] = -INFINITY;
        least[i] = s->kind == TRUTH_FRONT ? -1.0 : INFINITY; // from behind all are positive
    }
    for (int k = 0; k < 3; k++) {
        double constant = s->pass[k][0] + y * s->pass[k][2];
        for (int i = 0; i < BLOCK; i++) {
            double pass = constant + x[i] * s->pass[k][1];
            most[i] = pass > most[i] ? pass : most[i];
            least[i] = pass < least[i] ? pass : least[i];
        }
    }
    for (int i = 0; i < BLOCK; i++) {
        double facing = s->facing[0] + y * s->facing[2] + x[i] * s->facing[1];
        double ahead = s->ahead[0] + y * s->ahead[2] + x[i] * s->ahead[1];
        bool is_met = (most[i] <= 0.0 || least[i] >= 0.0) && facing != 0.0;
        enter[i] = is_met ? ahead / facing : INFINITY;
        leave[i] = is_met ? enter[i] : -INFINITY;
    }
}

// Where the rays of a row of samples enter and leave. They miss where they leave before they enter.
static void cross_row(const slabs *s, const double x[BLOCK], double y, double *restrict enter,
                      double *restrict leave)
{
    if (s->kind != TRUTH_SLABS) {
        cross_triangle(s, x, y, enter, leave);
        return;
    }
    for (int i = 0; i < BLOCK; i++) {
        enter[i] = -INFINITY;
        leave[i] = INFINITY;
    }
    for (int k = 0; k < 3; k++) {
        double origin = s->origin[k][0] + y * s->origin[k][2], extent = s->extent[k];
        double direction = s->direction[k][0] + y * s->direction[k][2];
        for (int i = 0; i < BLOCK; i++) {
            double at = origin + x[i] * s->origin[k][1];
            double step = 1.0 / (direction + x[i] * s->direction[k][1]);
            double a = (-extent - at) * step, b = (extent - at) * step;
            double first = a < b ? a : b, last = a < b ? b : a;
            enter[i] = first > enter[i] ? first : enter[i];
            leave[i] = last < leave[i] ? last : leave[i];
        }
    }
}

static void find_farthest(tile_block *block)
{
    block->farthest = block->farthest_nearest = -INFINITY;
    for (int i = 0; i < BLOCK * BLOCK; i++) {
        double nearest = block->nearest[i / BLOCK][i % BLOCK];
        double second = block->second[i / BLOCK][i % BLOCK];
        if (nearest > block->farthest_nearest) block->farthest_nearest = nearest;
        if (second > block->farthest) block->farthest = second;
    }
}

// Samples beyond the viewport's edge are where no ray passes and everything is hidden.
static void clear_block(const truth_view *view, tile_block *block, int x0, int y0)
{
    for (int j = 0; j < BLOCK; j++)
        for (int i = 0; i < BLOCK; i++) {
            double x = truth_at(x0 + i, view->width), y = truth_at(y0 + j, view->height);
            double origin[3], direction[3];
            for (int k = 0; k < 3; k++) {
                origin[k] = view->origin[0][k] + x * view->origin[1][k] + y * view->origin[2][k];
                direction[k] =
                    view->direction[0][k] + x * view->direction[1][k] + y * view->direction[2][k];
            }
            bool is_inside = x0 + i < view->width && y0 + j < view->height;
            block->nearest[j][i] = block->second[j][i] = is_inside ? INFINITY : -INFINITY;
            block->low[j][i] = INFINITY;
            block->high[j][i] = -INFINITY;
            block->owner[j][i] = NO_OWNER;
            if (is_inside)
                truth_clip_ray(view, origin, direction, &block->low[j][i], &block->high[j][i]);
        }
    find_farthest(block);
}

static void add_hit(tile_block *block, int j, int i, double enter, uint32_t owner)
{
    if (block->owner[j][i] == (int64_t)owner) {
        if (enter < block->nearest[j][i]) block->nearest[j][i] = enter;
    } else if (enter < block->nearest[j][i]) {
        block->second[j][i] = block->nearest[j][i];
        block->nearest[j][i] = enter;
        block->owner[j][i] = owner;
    } else if (enter < block->second[j][i]) {
        block->second[j][i] = enter;
    }
}

// What happens to a block; returns samples at which the solid is visible.
typedef uint32_t visit_block(tile_block *block, const slabs *s, const truth_solid *solid,
                             const double x[BLOCK], const double y[BLOCK]);

static uint32_t cover_block(tile_block *block, const slabs *s, const truth_solid *solid,
                            const double x[BLOCK], const double y[BLOCK])
{
    if (solid->outline.depth > block->farthest) return 0;
    bool has_changed = false;
    for (int j = 0; j < BLOCK; j++) {
        double enter[BLOCK], leave[BLOCK];
        cross_row(s, x, y[j], enter, leave);
        for (int i = 0; i < BLOCK; i++) {
            if (!(enter[i] <= leave[i]) || enter[i] < block->low[j][i] ||
                enter[i] >= block->second[j][i])
                continue;
            add_hit(block, j, i, enter[i], solid->owner);
            has_changed = true;
        }
    }
    if (has_changed) find_farthest(block);
    return 0;
}

// Whether everything from `depth` on is hidden from an object at all samples of the block.
static bool hides_beyond(const tile_block *block, double depth, uint32_t object)
{
    const double slack = 1.0 + 1e-9; // a corner's depth and a ray's parameter differ by rounding
    if (depth > block->farthest * slack) return true;
    if (!(depth > block->farthest_nearest * slack)) return false;
    for (int i = 0; i < BLOCK * BLOCK; i++)
        if (block->owner[i / BLOCK][i % BLOCK] == (int64_t)object) return false;
    return true;
}

static uint32_t look_block(tile_block *block, const slabs *s, const truth_solid *solid,
                           const double x[BLOCK], const double y[BLOCK])
{
    if (hides_beyond(block, solid->outline.depth, solid->owner)) return 0;
    uint32_t seen = 0;
    for (int j = 0; j < BLOCK; j++) {
        double enter[BLOCK], leave[BLOCK];
        cross_row(s, x, y[j], enter, leave);
        for (int i = 0; i < BLOCK; i++) {
            bool is_own = block->owner[j][i] == (int64_t)solid->owner;
            double limit = is_own ? block->second[j][i] : block->nearest[j][i];
            double low = block->low[j][i], high = block->high[j][i];
            double at = enter[i] > low ? enter[i] : low;
            double last = leave[i] < high ? leave[i] : high;
            seen += enter[i] <= leave[i] && at <= last && at <= limit * (1.0 + TRUTH_SURFACE);
        }
    }
    return seen;
}

static int clamp(int value, int low, int high)
{
    return value < low ? low : value > high ? high : value;
}

static uint32_t visit(tile *t, const truth_solid *solid, visit_block *visitor)
{
    const truth_rect *rect = &solid->outline.rect;
    int x0 = clamp((rect->x0 - t->rect.x0) / BLOCK, 0, TILE_BLOCKS);
    int y0 = clamp((rect->y0 - t->rect.y0) / BLOCK, 0, TILE_BLOCKS);
    int x1 = clamp((rect->x1 - t->rect.x0 + BLOCK - 1) / BLOCK, 0, TILE_BLOCKS);
    int y1 = clamp((rect->y1 - t->rect.y0 + BLOCK - 1) / BLOCK, 0, TILE_BLOCKS);
    uint32_t seen = 0;
    slabs s;
    set_slabs(&s, t->view, solid);
    for (int by = y0; by < y1; by++)
        for (int bx = x0; bx < x1; bx++) {
            double x[BLOCK], y[BLOCK];
            for (int i = 0; i < BLOCK; i++) {
                x[i] = truth_at(t->rect.x0 + bx * BLOCK + i, t->view->width);
                y[i] = truth_at(t->rect.y0 + by * BLOCK + i, t->view->height);
            }
            seen += visitor(&t->block[by][bx], &s, solid, x, y);
        }
    return seen;
}

static bool overlaps(const truth_rect *a, const truth_rect *b)
{
    return a->x0 < b->x1 && b->x0 < a->x1 && a->y0 < b->y1 && b->y0 < a->y1;
}

static double farthest_of(const tile *t)
{
    double farthest = -INFINITY;
    for (int i = 0; i < TILE_BLOCKS * TILE_BLOCKS; i++)
        farthest = fmax(farthest, t->block[i / TILE_BLOCKS][i % TILE_BLOCKS].farthest);
    return farthest;
}

static void cover_tile(tile *t, const truth_set *occluders)
{
    uint32_t done = 0;
    double farthest = INFINITY;
    for (uint32_t i = 0; i < occluders->count; i++) {
        const truth_solid *solid = &occluders->solids[i];
        if (solid->outline.depth > farthest) break;
        if (!overlaps(&solid->outline.rect, &t->rect)) continue;
        visit(t, solid, cover_block);
        if (++done % 64 == 0) farthest = farthest_of(t);
    }
}

static void count_tile(tile *t, const truth_set *objects, uint32_t *samples)
{
    double farthest = farthest_of(t) * (1.0 + 1e-9);
    for (uint32_t i = 0; i < objects->count; i++) {
        const truth_solid *solid = &objects->solids[i];
        if (solid->outline.depth > farthest) break;
        if (!overlaps(&solid->outline.rect, &t->rect)) continue;
        uint32_t seen = visit(t, solid, look_block);
        if (seen == 0) continue;
#ifdef _OPENMP
#pragma omp atomic
#endif
        samples[solid->owner] += seen;
    }
}

static bool do_tile(const truth_view *view, const truth_set *occluders, const truth_set *objects,
                    uint32_t *samples, int number)
{
    int across = (view->width + TILE - 1) / TILE;
    int x0 = number % across * TILE, y0 = number / across * TILE;
    tile *t = malloc(sizeof *t);
    if (!t) return false;
    t->view = view;
    t->rect = (truth_rect){x0, y0, x0 + TILE, y0 + TILE};
    for (int by = 0; by < TILE_BLOCKS; by++)
        for (int bx = 0; bx < TILE_BLOCKS; bx++)
            clear_block(view, &t->block[by][bx], x0 + bx * BLOCK, y0 + by * BLOCK);
    cover_tile(t, occluders);
    count_tile(t, objects, samples);
    free(t);
    return true;
}

bool truth_count_samples(const truth_view *view, const truth_set *occluders,
                         const truth_set *objects, uint32_t *samples)
{
    int across = (view->width + TILE - 1) / TILE, down = (view->height + TILE - 1) / TILE;
    int tiles = across * down;
    bool good = true;
#ifdef _OPENMP
#pragma omp parallel for default(none) shared(view, occluders, objects, samples, tiles)            \
    schedule(dynamic, 1) reduction(&& : good)
#endif
    for (int i = 0; i < tiles; i++)
        good = do_tile(view, occluders, objects, samples, i) && good;
    return good;
}
