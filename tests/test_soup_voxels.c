// SPDX-License-Identifier: Apache-2.0
// labels: property oracle
// Grids: which cells triangles touch, against GMP; and what the flood, the distances and the sums
// make of them, against plain counting.
#include "kit.h"
#include "soup/cuboids.h"
#include "soup_judge.h"
#include "support.h"

#include <gmp.h>
#include <math.h>
#include <stdlib.h>

static occ_hooks hooks;
static kit_heap heap;

static void set_up(void)
{
    heap = (kit_heap){0};
    occ_allocator allocator = kit_allocator(&heap);
    occ_logger silent = {NULL, NULL};
    ck_assert_int_eq(occ_hooks_init(&hooks, &allocator, &silent), OCC_SUCCESS);
}

static void tear_down(void)
{
    ck_assert_uint_eq(heap.blocks, 0);
}

// Triangles as a mesh, made by hand.
typedef struct few {
    float at[64][3];
    uint32_t corner[32][3];
    occ_mesh mesh;
} few;

static occ_triangles few_triangles(few *f, uint32_t count)
{
    f->mesh = (occ_mesh){.at = f->at,
                         .corner = f->corner,
                         .vertices = 3 * count,
                         .triangles = count,
                         .min = {INFINITY, INFINITY, INFINITY},
                         .max = {-INFINITY, -INFINITY, -INFINITY}};
    for (uint32_t i = 0; i < 3 * count; i++) {
        f->corner[i / 3][i % 3] = i;
        for (int k = 0; k < 3; k++) {
            f->mesh.min[k] = fminf(f->mesh.min[k], f->at[i][k]);
            f->mesh.max[k] = fmaxf(f->mesh.max[k], f->at[i][k]);
        }
    }
    return (occ_triangles){&f->mesh, NULL, count};
}

static const float straight[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

// Coordinates on cell boundaries, near them, and anywhere.
static float nasty_coordinate(kit_random *random, float scale, float shift)
{
    uint32_t kind = kit_below(random, 4);
    float at = (float)kit_below(random, 9) - 4.0f;
    if (kind == 1) at = nextafterf(at, kit_below(random, 2) ? 9.0f : -9.0f);
    if (kind > 1) at = kit_between(random, -4, 4);
    return at * scale + shift;
}

// The six sides of a cell in its own axes, moved outward by a share of the cell.
static void cell_sides(const occ_inner_grid *g, const uint32_t at[3], double grow,
                       judge_side side[6])
{
    for (int f = 0; f < 6; f++) {
        int k = f / 2;
        double place = (double)g->origin[k] + (double)at[k];
        mpq_t cell;
        mpq_init(cell);
        mpq_set_d(cell, (double)g->cell[k]);
        for (int j = 0; j < 3; j++)
            mpq_set_d(side[f].normal[j], (f % 2 ? 1.0 : -1.0) * (double)g->axis[k][j]);
        mpq_set_d(side[f].offset, f % 2 ? place + 1.0 + grow : -place + grow);
        mpq_mul(side[f].offset, side[f].offset, cell);
        mpq_clear(cell);
    }
}

// Touched is what a triangle touches; and nothing that it does not come near.
static uint32_t check_touched(const occ_voxels *v, const occ_triangles *t)
{
    judge_side side[6];
    uint32_t touched = 0, at[3];
    judge_sides_init(side);
    for (uint32_t c = 0; c < v->count; c++) {
        bool near = false, touching = false;
        occ_cell_place(v, c, at);
        for (uint32_t i = 0; i < t->count; i++) {
            const float *corner[3];
            for (int j = 0; j < 3; j++)
                corner[j] = occ_mesh_corner(t->mesh, i, j);
            cell_sides(&v->grid, at, 0.0, side);
            touching = touching || judge_meets(side, corner) != JUDGE_APART;
            cell_sides(&v->grid, at, 0x1p-12, side);
            near = near || judge_meets(side, corner) != JUDGE_APART;
        }
        KIT_CHECK(!touching || v->state[c], "cell %u %u %u is touched, but not marked", at[0],
                  at[1], at[2]);
        KIT_CHECK(near || !v->state[c], "cell %u %u %u is marked, but not near", at[0], at[1],
                  at[2]);
        touched += touching;
    }
    judge_sides_clear(side);
    return touched;
}

START_TEST(what_a_triangle_touches_is_touched)
{
    kit_random random = {11};
    few f;
    uint32_t touched = 0;
    for (int round = 0; round < 60; round++) {
        float scale = ldexpf(1.0f, (int)kit_below(&random, 40) - 20);
        float shift = kit_below(&random, 2) ? 0.0f : scale * 1024.0f, axis[3][3];
        uint32_t count = 1 + kit_below(&random, 2);
        for (uint32_t i = 0; i < 3 * count; i++)
            for (int k = 0; k < 3; k++)
                f.at[i][k] = nasty_coordinate(&random, scale, shift);
        if (round % 5 == 0) memcpy(f.at[2], f.at[1], sizeof f.at[2]); // a segment
        memcpy(axis, straight, sizeof axis);
        if (round % 2) {
            float turn = kit_between(&random, -1, 1), other = sqrtf(1.0f - turn * turn);
            memcpy(axis, (float[3][3]){{turn, other, 0}, {-other, turn, 0}, {0, 0, 1}},
                   sizeof axis);
        }
        occ_triangles t = few_triangles(&f, count);
        occ_voxels v = {0};
        occ_inner_grid grid;
        if (!occ_grid_plan(&t, (const float(*)[3])axis, 2000, 0.0f, &grid)) continue;
        ck_assert(occ_voxels_set(&v, &grid));
        ck_assert_int_eq(occ_voxels_reserve(&hooks, &v), OCC_SUCCESS);
        occ_voxels_mark(&v, &t, NULL);
        touched += check_touched(&v, &t);
        occ_voxels_free(&hooks, &v);
    }
    ck_assert_uint_gt(touched, 1000);
}
END_TEST

START_TEST(numbers_of_cells_along_the_axes_are_floats)
{
    kit_random random = {3};
    few f;
    for (int round = 0; round < 3000; round++) {
        float scale = ldexpf(1.0f, (int)kit_below(&random, 80) - 40);
        float shift =
            scale * ldexpf(1.0f, (int)kit_below(&random, 24)) * kit_between(&random, -1, 1);
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++)
                f.at[i][k] = scale * kit_between(&random, -1, 1) + shift;
        occ_triangles t = few_triangles(&f, 1);
        occ_inner_grid g;
        uint32_t most = 4096u << kit_below(&random, 10);
        if (!occ_grid_plan(&t, straight, most, 0.0f, &g)) continue;
        KIT_CHECK((uint64_t)g.size[0] * g.size[1] * g.size[2] <= most, "too many cells");
        for (int k = 0; k < 3; k++) {
            double low = (double)g.origin[k] * (double)g.cell[k];
            double high = low + (double)g.size[k] * (double)g.cell[k];
            KIT_CHECK((double)(float)(0.5 * (low + high)) == 0.5 * (low + high),
                      "the middle is no float");
            KIT_CHECK((double)(float)low == low && (double)(float)high == high,
                      "an end is no float");
            KIT_CHECK(low + (double)g.cell[k] < (double)f.mesh.min[k] &&
                          high - (double)g.cell[k] > (double)f.mesh.max[k],
                      "nothing is left free around the triangle");
        }
    }
}
END_TEST

// --- floods, distances, sums ---------------------------------------------------------------------

static void random_grid(kit_random *random, occ_voxels *v, uint32_t closing)
{
    occ_inner_grid g = {.cell = {1, 1, 1}, .closing = closing};
    memcpy(g.axis, straight, sizeof g.axis);
    for (int k = 0; k < 3; k++)
        g.size[k] = 3 + kit_below(random, 9);
    ck_assert(occ_voxels_set(v, &g));
    ck_assert_int_eq(occ_voxels_reserve(&hooks, v), OCC_SUCCESS);
    uint32_t share = 1 + kit_below(random, 9);
    for (uint32_t c = 0; c < v->count; c++)
        v->state[c] = kit_below(random, 10) < share ? OCC_CELL_TOUCHED : 0;
}

static bool is_outermost(const occ_voxels *v, uint32_t c)
{
    uint32_t at[3];
    occ_cell_place(v, c, at);
    return !at[0] || !at[1] || !at[2] || at[0] + 1 == v->grid.size[0] ||
           at[1] + 1 == v->grid.size[1] || at[2] + 1 == v->grid.size[2];
}

// Cells next to a reached one, again and again until nothing changes, or so many times.
static void slow_spread(const occ_voxels *v, const uint8_t *walls, uint8_t *reached, uint32_t times)
{
    bool changed = true;
    while (changed && times--) {
        uint8_t *old = malloc(v->count);
        ck_assert_ptr_nonnull(old);
        memcpy(old, reached, v->count);
        changed = false;
        for (uint32_t c = 0; c < v->count; c++) {
            uint32_t at[3];
            occ_cell_place(v, c, at);
            for (int k = 0; k < 6 && !reached[c] && !walls[c]; k++) {
                bool can = k % 2 ? at[k / 2] + 1 < v->grid.size[k / 2] : at[k / 2] > 0;
                size_t step = v->step[k / 2];
                if (can && old[k % 2 ? c + step : c - step]) reached[c] = changed = true;
            }
        }
        free(old);
    }
}

static void slow_flood(const occ_voxels *v, const uint8_t *touched, uint8_t *reached)
{
    uint8_t *walls = malloc(v->count);
    int32_t reach = (int32_t)v->grid.closing;
    ck_assert_ptr_nonnull(walls);
    memcpy(walls, touched, v->count);
    for (uint32_t c = 0; c < v->count; c++)
        for (uint32_t d = 0; d < v->count && touched[c]; d++) {
            uint32_t a[3], b[3];
            int32_t far = 0;
            occ_cell_place(v, c, a);
            occ_cell_place(v, d, b);
            for (int k = 0; k < 3; k++) {
                int32_t off = abs((int32_t)a[k] - (int32_t)b[k]);
                far = off > far ? off : far;
            }
            if (far <= reach) walls[d] = 1;
        }
    for (uint32_t c = 0; c < v->count; c++)
        reached[c] = is_outermost(v, c);
    slow_spread(v, walls, reached, UINT32_MAX);
    if (reach) slow_spread(v, touched, reached, v->grid.closing + 1);
    free(walls);
}

START_TEST(flood_reaches_what_it_can)
{
    kit_random random = {19};
    occ_voxels v = {0};
    few f;
    occ_triangles none = few_triangles(&f, 0);
    uint32_t dry = 0;
    for (int round = 0; round < 400; round++) {
        random_grid(&random, &v, round % 3 ? 0 : 1 + kit_below(&random, 3));
        uint8_t *touched = malloc(v.count), *reached = calloc(v.count, 1);
        ck_assert(touched && reached);
        memcpy(touched, v.state, v.count);
        slow_flood(&v, touched, reached);
        occ_solid_flood(&v, &none, false, NULL, 0);
        for (uint32_t c = 0; c < v.count; c++) {
            bool wet = (v.state[c] & OCC_CELL_REACHED) != 0;
            KIT_CHECK(wet == (reached[c] != 0), "round %d: cell %u is %s", round, c,
                      wet ? "reached" : "not reached");
            dry += !wet && !touched[c];
        }
        free(touched);
        free(reached);
    }
    occ_voxels_free(&hooks, &v);
    ck_assert_uint_gt(dry, 200);
}
END_TEST

// Keeps groups whose first cell has an even number.
static occ_result keep_even(void *context, const occ_voxels *voxels, uint32_t cell, bool *kept)
{
    uint32_t *asked = context;
    KIT_CHECK(!(voxels->state[cell] & (OCC_CELL_TOUCHED | OCC_CELL_REACHED)), "no solid cell");
    ++*asked;
    *kept = cell % 2 == 0;
    return OCC_SUCCESS;
}

static uint32_t slow_distance(const occ_voxels *v, uint32_t c)
{
    uint32_t a[3], b[3], least = UINT8_MAX;
    occ_cell_place(v, c, a);
    for (uint32_t d = 0; d < v->count; d++) {
        uint32_t far = 0;
        if (v->state[d]) continue;
        occ_cell_place(v, d, b);
        for (int k = 0; k < 3; k++) {
            uint32_t off = a[k] > b[k] ? a[k] - b[k] : b[k] - a[k];
            far = off > far ? off : far;
        }
        least = far < least ? far : least;
    }
    return least;
}

static void check_maximal(const occ_voxels *v, const occ_cuboid *c)
{
    for (int face = -1; face < 6; face++) {
        occ_cuboid larger = *c;
        uint32_t at[3];
        bool solid = true;
        if (face >= 0 && face % 2) larger.high[face / 2]++;
        if (face >= 0 && face % 2 == 0) larger.low[face / 2]--;
        for (at[0] = larger.low[0]; at[0] < larger.high[0]; at[0]++)
            for (at[1] = larger.low[1]; at[1] < larger.high[1]; at[1]++)
                for (at[2] = larger.low[2]; at[2] < larger.high[2]; at[2]++)
                    solid = solid && v->state[occ_cell_at(v, at)];
        KIT_CHECK(solid == (face < 0), "face %d: the box of cells is %s", face,
                  solid ? "not the largest" : "not solid");
    }
}

START_TEST(boxes_of_cells_are_solid_and_as_large_as_can_be)
{
    kit_random random = {23};
    occ_voxels v = {0};
    few f;
    occ_triangles none = few_triangles(&f, 0);
    uint32_t boxes = 0;
    for (int round = 0; round < 300; round++) {
        uint32_t asked = 0, sum = 0;
        random_grid(&random, &v, 0);
        // Fewer holes, and a layer of walls, so that much is solid.
        for (uint32_t c = 0; c < v.count; c++) {
            uint32_t at[3];
            occ_cell_place(&v, c, at);
            if (round % 2) v.state[c] &= kit_below(&random, 12) == 0;
            for (int k = 0; k < 3; k++)
                if (at[k] == 1 || at[k] + 2 == v.grid.size[k]) v.state[c] = OCC_CELL_TOUCHED;
        }
        occ_solid_flood(&v, &none, false, NULL, 0);
        ck_assert_int_eq(occ_solid_settle(&hooks, &v, keep_even, &asked), OCC_SUCCESS);
        for (uint32_t c = 0; c < v.count; c++) {
            sum += v.state[c] != 0;
            if (v.state[c]) KIT_CHECK(v.state[c] == slow_distance(&v, c), "another distance");
        }
        ck_assert_uint_eq(occ_solid_sum(&v), sum);
        occ_array cuboids = OCC_ARRAY(occ_cuboid);
        ck_assert_int_eq(occ_cuboids_find(&hooks, &v, 20, NULL, &cuboids), OCC_SUCCESS);
        ck_assert_int_eq(cuboids.count > 0, sum > 0);
        for (uint32_t i = 0; i < cuboids.count; i++)
            check_maximal(&v, (occ_cuboid *)cuboids.data + i);
        boxes += cuboids.count;
        occ_array_free(&hooks, &cuboids);
    }
    occ_voxels_free(&hooks, &v);
    ck_assert_uint_gt(boxes, 500);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("soup_voxels");
    TCase *touched = tcase_create("touched");
    tcase_add_checked_fixture(touched, set_up, tear_down);
    tcase_add_test(touched, what_a_triangle_touches_is_touched);
    tcase_add_test(touched, numbers_of_cells_along_the_axes_are_floats);
    suite_add_tcase(suite, touched);
    TCase *solid = tcase_create("solid");
    tcase_add_checked_fixture(solid, set_up, tear_down);
    tcase_add_test(solid, flood_reaches_what_it_can);
    tcase_add_test(solid, boxes_of_cells_are_solid_and_as_large_as_can_be);
    suite_add_tcase(suite, solid);
    return test_run_suite(suite);
}
