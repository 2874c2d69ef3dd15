// SPDX-License-Identifier: Apache-2.0
#include "inner_rounds.h"

#include "soup_judge.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_SOLIDS = 8, MOST_BOXES = 12 };

typedef struct round_state {
    shapes world;
    bool whole[MOST_SOLIDS]; // no triangle of it is missing
} round_state;

// --- soups ---------------------------------------------------------------------------------------

static void random_turn(kit_random *random, shapes *s)
{
    uint32_t kind = kit_below(random, 4);
    for (int j = 0; j < 3; j++) {
        s->shift[j] = kind ? kit_between(random, -1, 1) : (float)kit_below(random, 3) - 1.0f;
        for (int k = 0; k < 3; k++) {
            s->turn[j][k] = j == k ? 1.0f : 0.0f;
            if (kind > 1) s->turn[j][k] = kit_between(random, -1, 1); // sheared, mirrored, flat
        }
    }
    if (kind == 1) { // at right angles
        float a = kit_between(random, 0, 6), c = cosf(a), d = sinf(a);
        memcpy(s->turn, (float[3][3]){{c, 0, -d}, {0, 1, 0}, {d, 0, c}}, sizeof s->turn);
    }
}

static void random_point(kit_random *random, float out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = kit_between(random, -1, 1);
}

static void add_solid(kit_random *random, shapes *s)
{
    float p[4][3];
    uint32_t kind = kit_below(random, 4);
    random_turn(random, s);
    if (kind == 0) {
        for (int i = 0; i < 4; i++)
            random_point(random, p[i]);
        shapes_tetrahedron(s, (const float(*)[3])p);
    } else if (kind == 1) {
        shapes_round(s, 4 + (int)kit_below(random, 4), kit_below(random, 2) ? 0.3f : 0.0f);
    } else {
        for (int k = 0; k < 3; k++) {
            p[0][k] = -0.25f * (float)(1 + kit_below(random, 4));
            p[1][k] =
                kit_below(random, 8) ? 0.25f * (float)(1 + kit_below(random, 4)) : p[0][k] + 0.001f;
        }
        shapes_box(s, p[0], p[1]);
    }
}

// Two of the same: they share all triangles, faces that touch, or nothing.
static void add_neighbour(shapes *s)
{
    float step[3] = {0.0f, 0.0f, 0.0f};
    step[s->triangles % 3] = 1.0f;
    for (int j = 0; j < 3; j++)
        s->shift[j] += s->turn[j][0] * step[0] + s->turn[j][1] * step[1] + s->turn[j][2] * step[2];
    shapes_box(s, (float[3]){-0.5f, -0.5f, -0.5f}, (float[3]){0.5f, 0.5f, 0.5f});
}

// Whether another triangle has the same corners, in any order.
static bool has_twin(const shapes *s, uint32_t triangle)
{
    for (uint32_t t = 0; t < s->triangles; t++) {
        int same = 0;
        for (uint32_t i = 0; i < 9 && t != triangle; i++)
            same +=
                kit_same_bits(s->at[3 * t + i / 3], s->at[3 * triangle + i % 3], sizeof s->at[0]);
        if (same >= 3) return true;
    }
    return false;
}

// But not where solids share a face: without it the two may be one solid that is whole.
static void remove_triangles(kit_random *random, round_state *r)
{
    shapes *s = &r->world;
    for (uint32_t i = 0; i < MOST_SOLIDS; i++)
        r->whole[i] = true;
    uint32_t damaged = kit_below(random, 3) ? kit_below(random, s->solids + 1) : 0;
    for (uint32_t i = 0; i < damaged; i++) {
        uint32_t t = kit_below(random, s->triangles);
        if (has_twin(s, t)) continue;
        r->whole[s->solid[t]] = false;
        s->triangles--;
        memcpy(s->at[3 * t], s->at[3 * s->triangles], sizeof s->at[0] * 3);
        s->solid[t] = s->solid[s->triangles];
    }
}

// Triangles that are of no solid: loose ones, some without area, and copies.
static void add_loose(kit_random *random, round_state *r)
{
    shapes *s = &r->world;
    uint32_t loose = kit_below(random, 2) ? kit_below(random, 6) : 0;
    uint32_t of_solids = s->triangles;
    random_turn(random, s);
    s->solids++;
    r->whole[s->solids - 1] = false;
    for (uint32_t i = 0; i < loose; i++) {
        float p[3][3];
        for (int c = 0; c < 3; c++)
            random_point(random, p[c]);
        uint32_t kind = kit_below(random, 4);
        if (kind == 0) memcpy(p[2], p[0], sizeof p[2]);
        uint32_t copied = kit_below(random, of_solids);
        shapes_triangle(s, p[0], p[1], p[2]);
        if (kind == 1) memcpy(s->at[3 * s->triangles - 3], s->at[3 * copied], sizeof p);
    }
    s->solids--;
}

static void make_soup(kit_random *random, round_state *r)
{
    shapes_reset(&r->world);
    uint32_t solids = 1 + kit_below(random, MOST_SOLIDS - 2);
    while (r->world.solids < solids) {
        add_solid(random, &r->world);
        if (r->world.solids < solids && kit_below(random, 3) == 0) add_neighbour(&r->world);
    }
    remove_triangles(random, r);
    add_loose(random, r);
    float scale = ldexpf(1.0f, (int)kit_below(random, 60) - 30);
    float shift = kit_below(random, 3) ? 0.0f : scale * kit_between(random, -300, 300);
    for (uint32_t i = 0; i < 3 * r->world.triangles; i++)
        for (int k = 0; k < 3; k++)
            r->world.at[i][k] = r->world.at[i][k] * scale + shift;
}

// --- judgement -----------------------------------------------------------------------------------

// A quick look before the slow one: bounds with room for rounding.
static bool bounds_apart(const occ_box *box, const float *const corner[3])
{
    for (int k = 0; k < 3; k++) {
        double reach = fabs((double)box->axis[0][k]) + fabs((double)box->axis[1][k]) +
                       fabs((double)box->axis[2][k]);
        double slack = 1e-9 * (fabs((double)box->center[k]) + reach);
        double low = (double)box->center[k] - reach - slack,
               high = (double)box->center[k] + reach + slack;
        bool below = true, above = true;
        for (int c = 0; c < 3; c++) {
            below = below && (double)corner[c][k] < low;
            above = above && (double)corner[c][k] > high;
        }
        if (below || above) return true;
    }
    return false;
}

// Triangles with two corners alike count as none, as the library says.
static bool has_equal_corners(const float *const corner[3])
{
    for (int c = 0; c < 3; c++) {
        const float *a = corner[c], *b = corner[(c + 1) % 3];
        if (a[0] == b[0] && a[1] == b[1] && a[2] == b[2]) return true;
    }
    return false;
}

static void judge_triangles(const shapes *s, const occ_box *box, uint32_t soup, size_t which)
{
    judge_side side[6];
    const float *corner[3];
    judge_sides_init(side);
    KIT_CHECK(judge_box_sides(box, side), "soup %u: box %zu is flat", soup, which);
    for (uint32_t t = 0; t < s->triangles; t++) {
        shapes_corner(s, t, corner);
        if (bounds_apart(box, corner) || has_equal_corners(corner)) continue;
        KIT_CHECK(judge_meets(side, corner) != JUDGE_ENTERING,
                  "soup %u: triangle %u enters box %zu", soup, t, which);
    }
    judge_sides_clear(side);
}

// How often a ray from the box's middle leaves a solid: odd, even, or -1 if a ray met an edge.
static int parity(const shapes *s, uint32_t solid, const float p[3], long turn)
{
    int sum = 0;
    for (uint32_t t = 0; t < s->triangles; t++) {
        const float *corner[3];
        if (s->solid[t] != solid) continue;
        shapes_corner(s, t, corner);
        if (has_equal_corners(corner)) continue;
        int crossing = judge_ray(p, turn, corner);
        if (crossing < 0) return -1;
        sum += crossing;
    }
    return sum % 2;
}

static bool is_in_whole_solid(const round_state *r, const float p[3])
{
    for (uint32_t i = 0; i < r->world.solids; i++) {
        int odd = -1;
        for (long turn = 0; r->whole[i] && odd < 0 && turn < 20; turn++)
            odd = parity(&r->world, i, p, turn);
        if (odd == 1) return true;
    }
    return false;
}

static void run_one(kit_random *random, round_state *r, uint32_t number, rounds_report *report)
{
    occ_inner_box boxes[MOST_BOXES];
    occ_inner_fault fault;
    size_t count;
    make_soup(random, r);
    occ_soup soup = shapes_soup(&r->world);
    occ_inner_desc desc = {.max_cells = 4096u << kit_below(random, 3), .threads = 1};
    occ_result result = occ_inner_find(&soup, &desc, boxes, MOST_BOXES, &count, NULL);
    KIT_CHECK(!result, "soup %u: %s", number, occ_result_name(result));
    KIT_CHECK(!occ_verify_inner(&soup, boxes, count, &desc, &fault), "soup %u: box %u, reason %d",
              number, fault.box, fault.reason);
    for (size_t i = 0; i < count; i++) {
        KIT_CHECK(boxes[i].closed, "soup %u: box %zu is not closed off", number, i);
        judge_triangles(&r->world, &boxes[i].box, number, i);
        KIT_CHECK(is_in_whole_solid(r, boxes[i].box.center), "soup %u: box %zu is in no solid",
                  number, i);
        report->turned += boxes[i].grid.axis[0][0] != 1.0f;
    }
    report->soups++;
    report->boxes += (uint32_t)count;
    report->barren += count == 0;
}

void rounds_run(uint64_t seed, uint32_t soups, rounds_report *report)
{
    round_state *r = calloc(1, sizeof *r);
    kit_random random = {seed};
    KIT_CHECK(r, "no memory");
    for (uint32_t i = 0; i < soups; i++)
        run_one(&random, r, i, report);
    free(r);
}
