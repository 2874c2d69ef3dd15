// SPDX-License-Identifier: Apache-2.0
// labels: property
// timeout: 120
// Which points are closed off, against a flood of cells whose walls are known: models made of unit
// squares of a lattice, some of them missing, halved, doubled, or joined into longer rectangles.
#include "kit.h"
#include "soup/closed.h"
#include "support.h"

#include <stdlib.h>
#include <string.h>

// Cells 0 and SIDE + 1 along each axis are outside.
enum { SIDE = 4, CELLS = SIDE + 2, MOST = 12 * (SIDE + 1) * SIDE * SIDE };

typedef struct lattice {
    // wall[k][x][y][z]: between the cell and the one before it along k. 0 nothing, 1 a wall,
    // 2 half of one, 3 the second half of a rectangle of two.
    uint8_t wall[3][CELLS][CELLS][CELLS];
    bool outside[CELLS][CELLS][CELLS];
    bool taken[CELLS][CELLS][CELLS];
    bool whole;  // the walls are those between taken and free cells
    bool joined; // some may be
    float positions[3 * MOST][3];
    uint32_t triangles;
    float scale, shift[3];
    int order[3]; // of the axes in the model
} lattice;

static lattice *grid;
static occ_hooks hooks;
static kit_heap heap;

static void set_up(void)
{
    grid = calloc(1, sizeof *grid);
    ck_assert_ptr_nonnull(grid);
    heap = (kit_heap){0};
    occ_allocator allocator = kit_allocator(&heap);
    occ_logger silent = {NULL, NULL};
    ck_assert_int_eq(occ_hooks_init(&hooks, &allocator, &silent), OCC_SUCCESS);
}

static void tear_down(void)
{
    free(grid);
    ck_assert_uint_eq(heap.blocks, 0);
}

static uint8_t *wall_at(int k, const int at[3])
{
    return &grid->wall[k][at[0]][at[1]][at[2]];
}

// A point of the lattice in the model; cell (1, 1, 1) begins at (0, 0, 0).
static void place(const double at[3], float out[3])
{
    for (int j = 0; j < 3; j++)
        out[grid->order[j]] = grid->shift[j] + grid->scale * (float)(at[j] - 1.0);
}

static void add_triangle(double p[4][3], int a, int b, int c)
{
    const int corner[3] = {a, b, c};
    for (int i = 0; i < 3; i++)
        place(p[corner[i]], grid->positions[3 * grid->triangles + (uint32_t)i]);
    grid->triangles++;
}

// The rectangle of a wall, `length` cells long along the axis after its normal.
static void add_wall(kit_random *random, int k, const int at[3], int length, bool half)
{
    double p[4][3];
    int u = (k + 1) % 3, v = (k + 2) % 3, turn = (int)kit_below(random, 4);
    for (int i = 0; i < 4; i++) {
        int corner = (i + turn) % 4;
        for (int j = 0; j < 3; j++)
            p[i][j] = at[j];
        p[i][u] += corner == 1 || corner == 2 ? length : 0;
        p[i][v] += corner >= 2 ? 1 : 0;
    }
    add_triangle(p, 0, 1, 2);
    if (!half) add_triangle(p, 2, 0, 3);
}

// Around cells taken at random, all walls between taken and free ones; then some changes.
static void choose_walls(kit_random *random)
{
    uint32_t share = 1 + kit_below(random, 9);
    for (int i = 0; i < SIDE * SIDE * SIDE; i++)
        grid->taken[1 + i % SIDE][1 + i / SIDE % SIDE][1 + i / SIDE / SIDE] =
            kit_below(random, 10) < share;
    uint32_t damage = kit_below(random, 3) ? kit_below(random, 60) : 0; // of a thousand
    uint32_t extra = kit_below(random, 2) ? kit_below(random, 300) : 0;
    grid->whole = !damage && !extra;
    memset(grid->wall, 0, sizeof grid->wall);
    for (int i = 0; i < 3 * CELLS * CELLS * CELLS; i++) {
        int k = i % 3, at[3] = {i / 3 % CELLS, i / 3 / CELLS % CELLS, i / 3 / CELLS / CELLS};
        int u = (k + 1) % 3, v = (k + 2) % 3;
        if (!at[k] || !at[u] || !at[v] || at[u] > SIDE || at[v] > SIDE) continue;
        bool here = grid->taken[at[0]][at[1]][at[2]];
        at[k]--;
        bool before = grid->taken[at[0]][at[1]][at[2]];
        at[k]++;
        bool wall = here != before || (here && before && kit_below(random, 1000) < extra);
        if (wall) *wall_at(k, at) = 1;
        if (wall && kit_below(random, 1000) < damage)
            *wall_at(k, at) = (uint8_t)(2 * kit_below(random, 2));
    }
}

// Draws the walls; two in a row may be one rectangle, whose neighbours then meet it in mid-edge.
static void draw_walls(kit_random *random)
{
    uint32_t joined = kit_below(random, 4) * 250, twice = kit_below(random, 2) * 100;
    grid->triangles = 0;
    grid->joined = joined > 0;
    for (int i = 0; i < 3 * CELLS * CELLS * CELLS; i++) {
        int k = i % 3, at[3] = {i / 3 % CELLS, i / 3 / CELLS % CELLS, i / 3 / CELLS / CELLS};
        uint8_t *wall = wall_at(k, at);
        if (*wall == 0 || *wall == 3) continue;
        int next[3] = {at[0], at[1], at[2]};
        next[(k + 1) % 3]++;
        bool both = *wall == 1 && next[(k + 1) % 3] < CELLS && *wall_at(k, next) == 1;
        both = both && kit_below(random, 1000) < joined;
        // Not what was drawn before: loops go through x first.
        if (both && (k + 1) % 3 == 0) *wall_at(k, next) = 3;
        both = both && (k + 1) % 3 == 0;
        add_wall(random, k, at, both ? 2 : 1, *wall == 2);
        if (*wall == 1 && !both && kit_below(random, 1000) < twice)
            add_wall(random, k, at, 1, false);
    }
}

static void flood_from(int x, int y, int z)
{
    static const int steps[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    if (grid->outside[x][y][z]) return;
    grid->outside[x][y][z] = true;
    for (int k = 0; k < 3; k++) {
        const int *s = steps[k];
        int at[3] = {x, y, z}, to[3] = {x + s[0], y + s[1], z + s[2]};
        uint8_t before = *wall_at(k, at);
        if (at[k] > 0 && (before == 0 || before == 2)) flood_from(x - s[0], y - s[1], z - s[2]);
        if (to[k] >= CELLS) continue;
        uint8_t after = *wall_at(k, to);
        if (after == 0 || after == 2) flood_from(to[0], to[1], to[2]);
    }
}

static occ_soup lattice_soup(void)
{
    return (occ_soup){.positions = &grid->positions[0][0],
                      .vertex_count = 3 * grid->triangles,
                      .triangle_count = grid->triangles};
}

static void make_lattice(kit_random *random)
{
    static const int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1},
                                     {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    memcpy(grid->order, orders[kit_below(random, 6)], sizeof grid->order);
    grid->scale = (float)(1 + kit_below(random, 9)) * 0.125f;
    for (int j = 0; j < 3; j++)
        grid->shift[j] = (float)kit_below(random, 4000) * 0.25f - 500.0f;
    choose_walls(random);
    draw_walls(random);
    memset(grid->outside, 0, sizeof grid->outside);
    flood_from(0, 0, 0);
}

// Whether what closes a cell off is made of whole triangles. A rectangle of two walls may be half
// outside; then a closed set that holds it need not be around the cell. But all walls between taken
// and free cells are a closed set, and around each taken cell.
static bool can_be_proven(const int at[3])
{
    return !grid->joined || (grid->whole && grid->taken[at[0]][at[1]][at[2]]);
}

// A cell that the flood gets to is not closed off by its mark; one that it does not get to is.
static void check_cells(const occ_closed *closed, int round, uint32_t *inside)
{
    occ_mark mark = OCC_MARK;
    for (int i = 0; i < SIDE * SIDE * SIDE; i++) {
        int at[3] = {1 + i % SIDE, 1 + i / SIDE % SIDE, 1 + i / SIDE / SIDE};
        double middle[3] = {at[0] + 0.5, at[1] + 0.4375, at[2] + 0.53125};
        float point[3];
        bool outside = grid->outside[at[0]][at[1]][at[2]];
        place(middle, point);
        KIT_CHECK(!occ_mark_point(&hooks, closed, NULL, closed->mesh->triangles, point, &mark),
                  "no memory");
        KIT_CHECK(mark.known, "lattice %d: cell %d is on a triangle", round, i);
        KIT_CHECK(!outside || !mark.bits.count, "lattice %d: cell %d is outside, but marked", round,
                  i);
        KIT_CHECK(outside || mark.bits.count || !can_be_proven(at),
                  "lattice %d: cell %d is closed off, but not marked", round, i);
        *inside += !outside;
    }
    occ_mark_free(&hooks, &mark);
}

START_TEST(cells_are_closed_off_exactly_if_no_way_leads_there)
{
    kit_random random = {77};
    uint32_t inside = 0, open = 0, ruled = 0;
    for (int round = 0; round < 1500; round++) {
        make_lattice(&random);
        if (!grid->triangles) continue;
        occ_soup soup = lattice_soup();
        occ_mesh mesh;
        occ_closed closed;
        ck_assert_int_eq(occ_mesh_build(&hooks, &soup, &mesh), OCC_SUCCESS);
        ck_assert_int_eq(occ_closed_build(&hooks, &mesh, &closed), OCC_SUCCESS);
        check_cells(&closed, round, &inside);
        open += closed.open_triangles != 0;
        ruled += closed.rules.count != 0;
        occ_closed_free(&hooks, &closed);
        occ_mesh_free(&hooks, &mesh);
    }
    // What the random choice must not lack.
    ck_assert_uint_gt(inside, 10000);
    ck_assert_uint_gt(open, 300);
    ck_assert_uint_gt(ruled, 300);
}
END_TEST

static uint64_t few_bits(kit_random *random)
{
    uint64_t bits = kit_next(random);
    bits &= kit_next(random);
    return bits & kit_next(random);
}

START_TEST(rules_that_are_sums_of_others_are_dropped)
{
    kit_random random = {5};
    for (int round = 0; round < 2000; round++) {
        uint32_t words = 1 + kit_below(&random, 3), count = 1 + kit_below(&random, 12),
                 left = count;
        uint64_t rows[12 * 3] = {0}, kept[12 * 3] = {0}, sum[3] = {0};
        for (uint32_t i = 0; i < count * words; i++)
            rows[i] = kept[i] = few_bits(&random);
        for (uint32_t r = 2; r < count; r += 3) // the sum of the two before it
            for (uint32_t w = 0; w < words; w++)
                rows[r * words + w] = kept[r * words + w] =
                    kept[(r - 1) * words + w] ^ kept[(r - 2) * words + w];
        occ_reduce_rules(rows, &left, words);
        KIT_CHECK(left <= count - count / 3, "%u of %u rows are left", left, count);
        for (uint32_t r = 0; r < count; r++) // any sum of the old rows is one of the new
            if (kit_below(&random, 2))
                for (uint32_t w = 0; w < words; w++)
                    sum[w] ^= kept[r * words + w];
        occ_take_out_rules(rows, left, words, sum);
        for (uint32_t w = 0; w < words; w++)
            KIT_CHECK(sum[w] == 0, "round %d: a sum of rules is none", round);
    }
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("closed");
    TCase *lattices = tcase_create("lattices");
    tcase_add_checked_fixture(lattices, set_up, tear_down);
    tcase_add_test(lattices, cells_are_closed_off_exactly_if_no_way_leads_there);
    suite_add_tcase(suite, lattices);
    TCase *rules = tcase_create("rules");
    tcase_add_test(rules, rules_that_are_sums_of_others_are_dropped);
    suite_add_tcase(suite, rules);
    return test_run_suite(suite);
}
