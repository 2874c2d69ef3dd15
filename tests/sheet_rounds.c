// SPDX-License-Identifier: Apache-2.0
#include "sheet_rounds.h"

#include "sheet_judge.h"

#include <stdlib.h>

enum { MOST_SHEETS = 256, WIDE = 5, SIGHTS = 6, DRAWS = 12, FORGERIES = 6 };

typedef struct round_state {
    shapes world;
    bool see_through[SHAPES_MOST];
    occ_found_sheet sheets[MOST_SHEETS];
    sight_judge judge;
} round_state;

// --- soups ---------------------------------------------------------------------------------------

static void add_triangle(kit_random *random, shapes *s, const float *a, const float *b,
                         const float *c)
{
    if (kit_below(random, 24) == 0) return; // missing
    bool flipped = kit_below(random, 12) == 0;
    shapes_triangle(s, a, flipped ? c : b, flipped ? b : c);
    if (kit_below(random, 24) == 0) shapes_triangle(s, b, c, a);
}

// A rectangle of a wall, cut along either diagonal or into a fan around a point within.
static void add_rectangle(kit_random *random, shapes *s, float x0, float y0, float x1, float y1)
{
    const float p[4][3] = {{x0, y0, 0}, {x1, y0, 0}, {x1, y1, 0}, {x0, y1, 0}};
    uint32_t kind = kit_below(random, 5);
    if (kind < 4) {
        add_triangle(random, s, p[kind], p[(kind + 1) % 4], p[(kind + 2) % 4]);
        add_triangle(random, s, p[kind], p[(kind + 2) % 4], p[(kind + 3) % 4]);
        return;
    }
    const float middle[3] = {x0 + (x1 - x0) * kit_between(random, 0.1f, 0.9f), (y0 + y1) / 2, 0};
    for (int i = 0; i < 4; i++)
        add_triangle(random, s, p[i], p[(i + 1) % 4], middle);
}

// Cells with openings, joined to rectangles of any size: their corners meet others' edges.
static void add_wall(kit_random *random, shapes *s)
{
    bool filled[WIDE][WIDE];
    uint32_t openings = kit_below(random, 4);
    for (int i = 0; i < WIDE * WIDE; i++)
        filled[i / WIDE][i % WIDE] = kit_below(random, 8) >= openings;
    for (int y = 0; y < WIDE; y++)
        for (int x = 0; x < WIDE; x++) {
            int wide = 0, high = 1, most = 1 + (int)kit_below(random, WIDE);
            while (x + wide < WIDE && wide < most && filled[y][x + wide])
                filled[y][x + wide++] = false;
            if (!wide) continue;
            for (bool more = kit_below(random, 2) == 0; more && y + high < WIDE; high += more) {
                for (int i = 0; i < wide; i++)
                    more = more && filled[y + high][x + i];
                for (int i = 0; i < wide && more; i++)
                    filled[y + high][x + i] = false;
            }
            add_rectangle(random, s, (float)x, (float)y, (float)(x + wide), (float)(y + high));
        }
}

static void add_disc(kit_random *random, shapes *s)
{
    int corners = 5 + (int)kit_below(random, 8), hub = (int)kit_below(random, 2);
    float p[13][3] = {{2, 2, 0}};
    for (int i = 1; i <= corners; i++) {
        float a = 6.2831853f * (float)i / (float)corners;
        p[i][0] = 2 + 2 * cosf(a);
        p[i][1] = 2 + 2 * sinf(a);
        p[i][2] = kit_below(random, 4) ? 0.0f : kit_between(random, -1e-5f, 1e-5f);
    }
    for (int i = hub ? 1 : 2; i <= corners - (hub ? 0 : 1); i++)
        add_triangle(random, s, p[hub ? 0 : 1], p[i], p[i % corners + 1]);
}

// Between a few points, so that much is in one plane, crosses, is flat or is there twice.
static void add_tangle(kit_random *random, shapes *s)
{
    float p[9][3];
    bool level = kit_below(random, 2) == 0;
    for (int i = 0; i < 27; i++)
        p[i / 3][i % 3] = level && i % 3 == 2 ? 0.0f : (float)kit_below(random, 4);
    for (uint32_t i = 4 + kit_below(random, 16); i > 0; i--)
        shapes_triangle(s, p[kit_below(random, 9)], p[kit_below(random, 9)],
                        p[kit_below(random, 9)]);
}

static void random_turn(kit_random *random, shapes *s)
{
    uint32_t kind = kit_below(random, 6);
    float a = kit_between(random, 0, 6), c = cosf(a), d = sinf(a);
    for (int i = 0; i < 9; i++) {
        s->turn[i / 3][i % 3] = i % 4 == 0 ? 1.0f : 0.0f;
        if (kind == 3) s->turn[i / 3][i % 3] = (float)kit_below(random, 7) - 3.0f; // exact
        if (kind == 4) s->turn[i / 3][i % 3] = kit_between(random, -1, 1);
    }
    if (kind == 1) memcpy(s->turn, (float[3][3]){{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}, sizeof s->turn);
    if (kind == 2) memcpy(s->turn, (float[3][3]){{3, 0, 1}, {0, 1, 0}, {4, 0, 5}}, sizeof s->turn);
    if (kind == 5) memcpy(s->turn, (float[3][3]){{c, 0, -d}, {0, 1, 0}, {d, 0, c}}, sizeof s->turn);
    for (int k = 0; k < 3; k++)
        s->shift[k] = (float)kit_below(random, 5) - 2.0f;
}

static void make_soup(kit_random *random, round_state *r)
{
    shapes *s = &r->world;
    shapes_reset(s);
    for (uint32_t i = 1 + kit_below(random, 3); i > 0; i--) {
        if (kit_below(random, 4) || i == 1) random_turn(random, s); // else beside the one before
        uint32_t kind = kit_below(random, 8);
        if (kind < 4) add_wall(random, s);
        if (kind == 4) add_disc(random, s);
        if (kind == 5 || kind == 6) add_tangle(random, s);
        if (kind == 7) shapes_box(s, (float[3]){0, 0, 0}, (float[3]){2, 1, 3});
    }
    if (!s->triangles) shapes_box(s, (float[3]){0, 0, 0}, (float[3]){2, 1, 3});
    float scale = kit_below(random, 3) ? ldexpf(1.0f, (int)kit_below(random, 60) - 30) : 0.3f;
    float shift = kit_below(random, 3) ? 0.0f : scale * kit_between(random, -300, 300);
    for (uint32_t i = 0; i < 3 * s->triangles; i++)
        for (int k = 0; k < 3; k++)
            s->at[i][k] = s->at[i][k] * scale + shift;
    bool any = kit_below(random, 3) == 0;
    for (uint32_t t = 0; t < s->triangles; t++)
        r->see_through[t] = any && kit_below(random, 8) == 0;
}

// --- judgement -----------------------------------------------------------------------------------

static void judge_sheet(kit_random *random, round_state *r, const occ_sheet *sheet, bool one_sided,
                        const char *what, sheet_report *report)
{
    uint32_t seen = 0;
    for (uint32_t i = 0; i < DRAWS && seen < SIGHTS; i++) {
        if (!sight_draw(&r->judge, sheet, random)) continue;
        seen++;
        report->sights++;
        KIT_CHECK(sight_is_blocked(&r->judge, &r->world, r->see_through, one_sided),
                  "soup %u: a sight passes a sheet that was %s", report->soups, what);
    }
}

static bool is_bent(const occ_sheet *sheet)
{
    for (uint32_t i = 3; i < sheet->corner_count; i++) {
        double e[3][3];
        for (int k = 0; k < 3; k++) {
            e[0][k] = (double)sheet->corner[1][k] - (double)sheet->corner[0][k];
            e[1][k] = (double)sheet->corner[2][k] - (double)sheet->corner[0][k];
            e[2][k] = (double)sheet->corner[i][k] - (double)sheet->corner[0][k];
        }
        double det = 0.0;
        for (int k = 0; k < 3; k++)
            det += e[2][k] *
                   (e[0][(k + 1) % 3] * e[1][(k + 2) % 3] - e[0][(k + 2) % 3] * e[1][(k + 1) % 3]);
        if (det != 0.0) return true;
    }
    return false;
}

// What a careless tool might make of a sheet, or of the soup's corners.
static void forge(kit_random *random, const round_state *r, occ_sheet *sheet)
{
    const shapes *s = &r->world;
    uint32_t kind = kit_below(random, 5), at = kit_below(random, sheet->corner_count);
    const float *other = s->at[kit_below(random, 3 * s->triangles)];
    if (kind == 0) memcpy(sheet->corner[at], other, 12);
    if (kind == 1 && sheet->corner_count < OCC_SHEET_CORNERS)
        memcpy(sheet->corner[sheet->corner_count++], other, 12);
    if (kind == 2)
        for (uint32_t i = 0; i < sheet->corner_count; i++)
            memcpy(sheet->corner[i], s->at[kit_below(random, 3 * s->triangles)], 12);
    for (int k = 0; k < 3 && kind == 3; k++)
        sheet->corner[at][k] = nextafterf(sheet->corner[at][k], kit_between(random, -1, 1) * 1e30f);
    for (int k = 0; k < 3 && kind == 4; k++)
        sheet->corner[at][k] += (sheet->corner[at][k] - sheet->corner[(at + 1) % 3][k]) * 0.25f;
}

static void judge_forgeries(kit_random *random, round_state *r, const occ_soup *soup,
                            const occ_sheets_desc *desc, size_t count, sheet_report *report)
{
    for (uint32_t i = 0; i < FORGERIES && count; i++) {
        occ_found_sheet one = r->sheets[kit_below(random, (uint32_t)count)];
        for (uint32_t times = 1 + kit_below(random, 2); times > 0; times--)
            forge(random, r, &one.sheet);
        report->forged++;
        if (occ_verify_sheets(soup, &one, 1, desc, NULL)) continue;
        report->passed++;
        judge_sheet(random, r, &one.sheet, desc->sides == OCC_SIDES_FRONT, "forged", report);
    }
}

static void run_one(kit_random *random, round_state *r, sheet_report *report)
{
    size_t count;
    occ_sheet_fault fault;
    make_soup(random, r);
    occ_soup soup = shapes_soup(&r->world);
    occ_sheets_desc desc = {.sides = kit_below(random, 2) ? OCC_SIDES_FRONT : OCC_SIDES_BOTH,
                            .labels = r->world.solid,
                            .labels_apart = kit_below(random, 4) == 0,
                            .see_through = r->see_through};
    occ_result result = occ_sheets_find(&soup, &desc, r->sheets, MOST_SHEETS, &count, NULL);
    KIT_CHECK(!result, "soup %u: %s", report->soups, occ_result_name(result));
    result = occ_verify_sheets(&soup, r->sheets, count, &desc, &fault);
    KIT_CHECK(!result, "soup %u: sheet %u, reason %d", report->soups, fault.sheet, fault.reason);
    for (size_t i = 0; i < count; i++) {
        const occ_found_sheet *found = &r->sheets[i];
        KIT_CHECK(i == 0 || found->gain <= found[-1].gain, "gains do not fall");
        judge_sheet(random, r, &found->sheet, desc.sides == OCC_SIDES_FRONT, "found", report);
        report->merged += found->triangle_count > 1;
        report->bent += found->triangle_count > 1 && is_bent(&found->sheet);
    }
    judge_forgeries(random, r, &soup, &desc, count, report);
    report->sheets += (uint32_t)count;
    report->soups++;
}

void sheet_rounds_run(uint64_t seed, uint32_t soups, sheet_report *report)
{
    round_state *r = calloc(1, sizeof *r);
    kit_random random = {seed};
    KIT_CHECK(r, "no memory");
    sight_judge_init(&r->judge);
    for (uint32_t i = 0; i < soups; i++)
        run_one(&random, r, report);
    sight_judge_clear(&r->judge);
    free(r);
}
