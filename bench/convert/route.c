// SPDX-License-Identifier: Apache-2.0
// The longest of all shortest ways is the diameter of a region; the farthest cell from the farthest
// cell from anywhere comes close to it (and is it, in a tree of corridors).
#include "route.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// A cell with the room around it to be a step of the way: its 26 neighbours are free.
enum { MIN_ROOM = 2 };

// Regions that are looked at more closely, largest first.
enum { REGIONS = 16 };

// Cells that hang together, in search.members.
typedef struct region {
    size_t first, count;
} region;

typedef struct heap_entry {
    float cost;
    size_t cell;
} heap_entry;

typedef struct search {
    const voxel_grid *grid;
    const bool *allowed;
    int max_above;
    float *cost;
    size_t *parent;
    heap_entry *heap;
    size_t heap_count, heap_room;
    size_t *members; // the region's cells
    size_t member_count;
} search;

static bool obeys(const voxel_grid *g, const route_rule *rule, size_t cell)
{
    if (g->room[cell] < MIN_ROOM) return false;
    if (g->hits[cell] < rule->hits || g->facing[cell] < rule->facing) return false;
    return rule->max_above == 0 || g->height[cell] <= rule->max_above;
}

// The neighbour number n of 27, counting the cell itself. A cell with room is never at the border.
static size_t neighbour(const voxel_grid *g, size_t cell, int n)
{
    ptrdiff_t row = g->size[0], layer = (ptrdiff_t)g->size[0] * g->size[2];
    return (size_t)((ptrdiff_t)cell + (n % 3 - 1) + (n / 3 % 3 - 1) * row + (n / 9 - 1) * layer);
}

static bool is_border(const voxel_grid *g, size_t cell)
{
    size_t row = cell / (size_t)g->size[0];
    const size_t at[3] = {cell % (size_t)g->size[0], row / (size_t)g->size[2],
                          row % (size_t)g->size[2]};
    for (int k = 0; k < 3; k++)
        if (at[k] == 0 || at[k] == (size_t)g->size[k] - 1) return true;
    return false;
}

static float step_length(int n)
{
    int away = (n % 3 != 1) + (n / 3 % 3 != 1) + (n / 9 != 1);
    return away == 1 ? 1.0f : away == 2 ? 1.41421356f : 1.73205081f;
}

// A step costs more close to walls, and off the height to keep.
static float step_cost(const search *s, size_t to, int n)
{
    float factor = 1.0f + 3.0f / (float)s->grid->room[to];
    if (s->max_above) {
        float keep = 0.75f * (float)s->max_above;
        factor += fabsf((float)s->grid->height[to] - keep) / keep;
    }
    return step_length(n) * factor;
}

static bool push(search *s, float cost, size_t cell)
{
    if (s->heap_count == s->heap_room) {
        s->heap_room = s->heap_room ? 2 * s->heap_room : 4096;
        heap_entry *grown = realloc(s->heap, s->heap_room * sizeof *grown);
        if (!grown) return false;
        s->heap = grown;
    }
    size_t i = s->heap_count++;
    for (; i > 0 && s->heap[(i - 1) / 2].cost > cost; i = (i - 1) / 2)
        s->heap[i] = s->heap[(i - 1) / 2];
    s->heap[i] = (heap_entry){cost, cell};
    return true;
}

static heap_entry pop(search *s)
{
    heap_entry top = s->heap[0], last = s->heap[--s->heap_count];
    size_t i = 0;
    for (;;) {
        size_t child = 2 * i + 1;
        if (child >= s->heap_count) break;
        if (child + 1 < s->heap_count && s->heap[child + 1].cost < s->heap[child].cost) child++;
        if (s->heap[child].cost >= last.cost) break;
        s->heap[i] = s->heap[child];
        i = child;
    }
    s->heap[i] = last;
    return top;
}

// Dijkstra's search over the region from one cell. `*farthest` is the costliest cell to get to.
static bool spread(search *s, size_t from, size_t *farthest)
{
    for (size_t i = 0; i < s->member_count; i++)
        s->cost[s->members[i]] = INFINITY;
    s->heap_count = 0;
    s->cost[from] = 0;
    s->parent[from] = SIZE_MAX;
    *farthest = from;
    if (!push(s, 0, from)) return false;
    while (s->heap_count) {
        heap_entry top = pop(s);
        if (top.cost > s->cost[top.cell]) continue;
        if (top.cost > s->cost[*farthest]) *farthest = top.cell;
        for (int n = 0; n < 27; n++) {
            size_t to = neighbour(s->grid, top.cell, n);
            if (n == 13 || !s->allowed[to]) continue;
            float cost = top.cost + step_cost(s, to, n);
            if (cost >= s->cost[to]) continue;
            s->cost[to] = cost;
            s->parent[to] = top.cell;
            if (!push(s, cost, to)) return false;
        }
    }
    return true;
}

// Collects the cells connected with `first` into `members` from `place` on; marks them.
static size_t flood(const search *s, size_t first, bool *seen, size_t place)
{
    size_t end = place;
    s->members[end++] = first;
    seen[first] = true;
    for (size_t next = place; next < end; next++)
        for (int n = 0; n < 27; n++) {
            size_t to = neighbour(s->grid, s->members[next], n);
            if (!s->allowed[to] || seen[to]) continue;
            seen[to] = true;
            s->members[end++] = to;
        }
    return end;
}

// The triangles met by spreading from a region through free cells, not farther than an eighth of
// the grid. `reached` is marked with the region's number.
static size_t detail_around(const search *s, const region *r, uint8_t mark, uint8_t *reached,
                            size_t *queue)
{
    const voxel_grid *g = s->grid;
    int limit = (g->size[0] > g->size[2] ? g->size[0] : g->size[2]) / 8;
    size_t end = 0, detail = 0;
    for (size_t i = 0; i < r->count; i++) {
        queue[end++] = s->members[r->first + i];
        reached[queue[i]] = mark;
    }
    for (size_t next = 0, ring = end; next < end && limit > 0; next++) {
        if (next == ring) {
            ring = end;
            limit--;
        }
        if (g->solid[queue[next]] || is_border(g, queue[next])) continue;
        for (int n = 0; n < 27; n++) {
            size_t to = neighbour(g, queue[next], n);
            if (reached[to] == mark) continue;
            reached[to] = mark;
            detail += g->detail[to];
            queue[end++] = to;
        }
    }
    return detail;
}

// Collects the connected regions, the cells of each one after another in `members`; keeps the
// largest REGIONS of them in order of size. Returns how many.
static size_t list_regions(const search *s, bool *seen, region *regions)
{
    size_t place = 0, count = 0;
    for (size_t i = 0; i < s->grid->count; i++) {
        if (!s->allowed[i] || seen[i]) continue;
        region r = {place, flood(s, i, seen, place) - place};
        place += r.count;
        size_t at = count < REGIONS ? count++ : count;
        for (; at > 0 && regions[at - 1].count < r.count; at--)
            if (at < REGIONS) regions[at] = regions[at - 1];
        if (at < REGIONS) regions[at] = r;
    }
    return count;
}

// Leaves the cells of the region to walk in at the start of `members`.
static bool choose_region(search *s)
{
    region regions[REGIONS];
    bool *seen = calloc(s->grid->count, sizeof *seen);
    uint8_t *reached = calloc(s->grid->count, sizeof *reached);
    size_t *queue = malloc(s->grid->count * sizeof *queue);
    size_t best = 0, most = 0, count = 0;
    bool good = seen && reached && queue;
    if (good) count = list_regions(s, seen, regions);
    for (size_t i = 0; i < count && regions[i].count >= regions[0].count / 16; i++) {
        size_t detail = detail_around(s, &regions[i], (uint8_t)(i + 1), reached, queue);
        if (detail <= most) continue;
        most = detail;
        best = i;
    }
    if (count) {
        s->member_count = regions[best].count;
        memmove(s->members, s->members + regions[best].first, s->member_count * sizeof *s->members);
    }
    free(seen);
    free(reached);
    free(queue);
    return good;
}

static bool trace(const search *s, size_t end, route *out)
{
    for (size_t c = end; c != SIZE_MAX; c = s->parent[c])
        out->count++;
    out->cells = calloc(out->count, sizeof *out->cells);
    if (!out->cells) return false;
    size_t place = out->count;
    for (size_t c = end; c != SIZE_MAX; c = s->parent[c])
        out->cells[--place] = c;
    for (size_t i = 1; i < out->count; i++) {
        double a[3], b[3], sum = 0;
        voxels_center(s->grid, out->cells[i - 1], a);
        voxels_center(s->grid, out->cells[i], b);
        for (int k = 0; k < 3; k++)
            sum += (b[k] - a[k]) * (b[k] - a[k]);
        out->length += sqrt(sum) / s->grid->cell;
    }
    return true;
}

static bool find_in(search *s, route *out)
{
    size_t a, b;
    if (!s->cost || !s->parent || !s->members || !choose_region(s)) return false;
    if (s->member_count == 0) return true;
    return spread(s, s->members[0], &a) && spread(s, a, &b) && trace(s, b, out);
}

bool route_find(const voxel_grid *grid, const route_rule *rule, route *out)
{
    *out = (route){0};
    out->allowed = malloc(grid->count * sizeof *out->allowed);
    if (!out->allowed) return false;
    for (size_t i = 0; i < grid->count; i++)
        out->allowed[i] = obeys(grid, rule, i);
    search s = {.grid = grid,
                .allowed = out->allowed,
                .max_above = rule->max_above,
                .cost = malloc(grid->count * sizeof(float)),
                .parent = malloc(grid->count * sizeof(size_t)),
                .members = malloc(grid->count * sizeof(size_t))};
    bool done = find_in(&s, out);
    free(s.cost);
    free(s.parent);
    free(s.members);
    free(s.heap);
    if (!done) route_free(out);
    return done;
}

void route_free(route *r)
{
    free(r->cells);
    free(r->allowed);
    *r = (route){0};
}
