// SPDX-License-Identifier: Apache-2.0
#include "soup/closed.h"
#include "soup/sides.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST_TRIES 12

static uint32_t lowest_bit(const uint64_t *row, uint32_t words)
{
    for (uint32_t w = 0; w < words; w++)
        if (row[w]) return 64 * w + (uint32_t)__builtin_ctzll(row[w]);
    return UINT32_MAX;
}

static void add_row(uint64_t *to, const uint64_t *row, uint32_t words)
{
    for (uint32_t w = 0; w < words; w++)
        to[w] ^= row[w];
}

static void swap_rows(uint64_t *a, uint64_t *b, uint32_t words)
{
    for (uint32_t w = 0; w < words; w++) {
        uint64_t held = a[w];
        a[w] = b[w];
        b[w] = held;
    }
}

// One row at a time: what is left of it when those before it are taken out is put in its place.
void occ_reduce_rules(uint64_t *rows, uint32_t *count, uint32_t words)
{
    uint32_t kept = 0;
    for (uint32_t r = 0; r < *count; r++) {
        uint64_t *row = rows + (size_t)r * words;
        occ_take_out_rules(rows, kept, words, row);
        uint32_t low = lowest_bit(row, words);
        if (low == UINT32_MAX) continue;
        uint32_t place = kept++;
        if (row != rows + (size_t)place * words)
            memcpy(rows + (size_t)place * words, row, words * sizeof *row);
        for (; place; place--) {
            uint64_t *own = rows + (size_t)place * words, *before = own - words;
            if (lowest_bit(before, words) < low) break;
            swap_rows(own, before, words);
        }
    }
    *count = kept;
}

void occ_take_out_rules(const uint64_t *rows, uint32_t count, uint32_t words, uint64_t *row)
{
    for (uint32_t r = 0; r < count; r++) {
        const uint64_t *rule = rows + (size_t)r * words;
        uint32_t low = lowest_bit(rule, words);
        if (row[low / 64] >> low % 64 & 1u) add_row(row, rule, words);
    }
}

// How a line from p to q meets a triangle.
typedef enum meeting { MISSES, CROSSES, UNCLEAR, HOLDS_POINT } meeting;

static bool bounds_apart(const occ_mesh *mesh, uint32_t triangle, const float p[3],
                         const float q[3])
{
    const float *a = occ_mesh_corner(mesh, triangle, 0), *b = occ_mesh_corner(mesh, triangle, 1),
                *c = occ_mesh_corner(mesh, triangle, 2);
    for (int k = 0; k < 3; k++) {
        float low = p[k] < q[k] ? p[k] : q[k], high = p[k] < q[k] ? q[k] : p[k];
        if (a[k] < low && b[k] < low && c[k] < low) return true;
        if (a[k] > high && b[k] > high && c[k] > high) return true;
    }
    return false;
}

// `side` becomes which side of the triangle p is on.
static meeting meet(const occ_mesh *mesh, uint32_t triangle, const float p[3], const float q[3],
                    int *side)
{
    int round[3];
    bool plus = false, minus = false, zero = false;
    for (int i = 0; i < 3; i++) {
        round[i] = occ_side_of_plane(p, q, occ_mesh_corner(mesh, triangle, i),
                                     occ_mesh_corner(mesh, triangle, (i + 1) % 3));
        plus |= round[i] > 0;
        minus |= round[i] < 0;
        zero |= round[i] == 0;
    }
    if (plus && minus) return MISSES;
    const float *a = occ_mesh_corner(mesh, triangle, 0), *b = occ_mesh_corner(mesh, triangle, 1),
                *c = occ_mesh_corner(mesh, triangle, 2);
    *side = occ_side_of_plane(a, b, c, p);
    int other = occ_side_of_plane(a, b, c, q);
    if (*side && *side == other) return MISSES;
    if (zero) return UNCLEAR;
    return *side ? CROSSES : HOLDS_POINT;
}

// The end of a line from a point: outside the mesh, and off whatever is regular.
static void choose_end(const occ_mesh *mesh, const float p[3], int attempt, float q[3])
{
    static const float lean[2] = {0.000713f, 0.000377f};
    int axis = attempt % 3;
    float size = 0.0f, scale = ldexpf(1.0f, 2 * (attempt / 3));
    for (int k = 0; k < 3; k++) {
        size = fmaxf(size, mesh->max[k] - mesh->min[k]);
        size = fmaxf(size, 0x1p-18f * fmaxf(fabsf(mesh->min[k]), fabsf(mesh->max[k])));
    }
    for (int k = 0; k < 2; k++) {
        int other = (axis + 1 + k) % 3;
        q[other] = p[other] + size * scale * lean[k] * (1.0f + 0.37f * (float)attempt);
    }
    q[axis] = fmaxf(mesh->max[axis], p[axis]) + size * 0.5f;
}

static bool add_crossing(occ_hooks *hooks, const occ_closed *closed, uint32_t triangle, int side,
                         occ_mark *mark)
{
    int32_t turn = side < 0 ? 1 : -1; // behind the triangle, it turns its back
    mark->all_winding += turn;
    if (closed->patch[triangle] == OCC_OPEN) return true;
    mark->winding += turn;
    uint32_t *bit = occ_array_push(hooks, &mark->bits);
    if (bit) *bit = closed->patch[triangle];
    return bit != NULL;
}

static occ_result cross(occ_hooks *hooks, const occ_closed *closed, const uint32_t *triangles,
                        uint32_t count, const float p[3], const float q[3], occ_mark *mark)
{
    mark->bits.count = 0;
    mark->winding = mark->all_winding = 0;
    mark->known = true;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t t = triangles ? triangles[i] : i;
        int side = 0;
        bool open = closed->patch[t] == OCC_OPEN;
        if (bounds_apart(closed->mesh, t, p, q)) continue;
        meeting how = meet(closed->mesh, t, p, q, &side);
        if (how == MISSES || (open && how != CROSSES)) continue;
        if (how != CROSSES) {
            mark->known = false;
            return OCC_SUCCESS;
        }
        if (!add_crossing(hooks, closed, t, side, mark)) return OCC_ERROR_OUT_OF_MEMORY;
    }
    return OCC_SUCCESS;
}

static int by_bit(const void *a, const void *b)
{
    uint32_t p = *(const uint32_t *)a, q = *(const uint32_t *)b;
    return p < q ? -1 : p > q;
}

static void drop_pairs(occ_array *bits)
{
    uint32_t *bit = bits->data, kept = 0;
    if (bits->count) qsort(bit, bits->count, sizeof *bit, by_bit);
    for (uint32_t i = 0; i < bits->count; i++) {
        if (kept && bit[kept - 1] == bit[i]) {
            kept--;
        } else {
            bit[kept++] = bit[i];
        }
    }
    bits->count = kept;
}

// Appends the bits of a cluster's row to a list.
static occ_result append_row(occ_hooks *hooks, const occ_cluster *cluster, const uint64_t *row,
                             occ_array *list)
{
    for (uint32_t p = 0; p < cluster->count; p++) {
        if (!(row[p / 64] >> p % 64 & 1u)) continue;
        uint32_t *bit = occ_array_push(hooks, list);
        if (!bit) return OCC_ERROR_OUT_OF_MEMORY;
        *bit = cluster->first + p;
    }
    return OCC_SUCCESS;
}

// Takes the rules of all clusters out of a sorted list of bits.
static occ_result take_out_all(occ_hooks *hooks, const occ_closed *closed, occ_array *bits)
{
    occ_array left = OCC_ARRAY(uint32_t);
    const uint32_t *bit = bits->data;
    occ_result result = OCC_SUCCESS;
    for (uint32_t i = 0; !result && i < bits->count;) {
        const occ_cluster *cluster =
            (const occ_cluster *)closed->clusters.data + closed->cluster_of[bit[i]];
        uint64_t row[OCC_PATCH_WORDS] = {0};
        for (; i < bits->count && bit[i] - cluster->first < cluster->count; i++) {
            uint32_t p = bit[i] - cluster->first;
            row[p / 64] |= (uint64_t)1 << p % 64;
        }
        const uint64_t *rules = closed->rules.data;
        if (cluster->rule_count)
            occ_take_out_rules(rules + cluster->rules, cluster->rule_count, cluster->words, row);
        result = append_row(hooks, cluster, row, &left);
    }
    occ_array_free(hooks, bits);
    *bits = left;
    return result;
}

occ_result occ_mark_point(occ_hooks *hooks, const occ_closed *closed, const uint32_t *triangles,
                          uint32_t count, const float point[3], occ_mark *mark)
{
    mark->known = false;
    for (int attempt = 0; attempt < MOST_TRIES && !mark->known; attempt++) {
        float end[3];
        choose_end(closed->mesh, point, attempt, end);
        occ_result result = cross(hooks, closed, triangles, count, point, end, mark);
        if (result) return result;
    }
    drop_pairs(&mark->bits);
    return take_out_all(hooks, closed, &mark->bits);
}

bool occ_marks_differ(const occ_mark *a, const occ_mark *b)
{
    if (!a->known || !b->known) return false;
    if (a->bits.count != b->bits.count) return true;
    return a->bits.count &&
           memcmp(a->bits.data, b->bits.data, a->bits.count * sizeof(uint32_t)) != 0;
}

void occ_mark_free(occ_hooks *hooks, occ_mark *mark)
{
    occ_array_free(hooks, &mark->bits);
}
