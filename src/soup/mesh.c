// SPDX-License-Identifier: Apache-2.0
#include "soup/mesh.h"

#include "log.h"

#include <math.h>
#include <string.h>

#define NOTHING UINT32_MAX

// Open addressing: a slot holds an index, or NOTHING.
typedef struct table {
    uint32_t *slot;
    size_t size; // a power of two
} table;

static uint32_t mix(uint32_t a, uint32_t b, uint32_t c)
{
    uint64_t h = a * 0x9e3779b97f4a7c15u + b;
    h = (h ^ (h >> 29)) * 0xbf58476d1ce4e5b9u + c;
    h = (h ^ (h >> 32)) * 0x94d049bb133111ebu;
    return (uint32_t)(h >> 32);
}

static bool table_make(occ_hooks *hooks, table *t, size_t items)
{
    t->size = 16;
    while (t->size < 2 * items)
        t->size *= 2;
    t->slot = occ_alloc(hooks, t->size * sizeof *t->slot);
    if (t->slot) memset(t->slot, 0xff, t->size * sizeof *t->slot);
    return t->slot != NULL;
}

static void table_free(occ_hooks *hooks, table *t)
{
    occ_free(hooks, t->slot, t->size * sizeof *t->slot);
    t->slot = NULL;
}

static void read_position(const occ_soup *soup, uint32_t vertex, float p[3])
{
    size_t stride = soup->stride ? soup->stride : 3 * sizeof(float);
    memcpy(p, (const char *)soup->positions + vertex * stride, 3 * sizeof *p);
    for (int k = 0; k < 3; k++)
        p[k] += 0.0f; // -0 becomes 0
}

// The mesh's vertex at a position, added if it is new.
static uint32_t weld(occ_mesh *mesh, table *t, const float p[3])
{
    uint32_t bits[3];
    memcpy(bits, p, sizeof bits);
    size_t i = mix(bits[0], bits[1], bits[2]) & (t->size - 1);
    for (; t->slot[i] != NOTHING; i = (i + 1) & (t->size - 1)) {
        const float *q = mesh->at[t->slot[i]];
        if (q[0] == p[0] && q[1] == p[1] && q[2] == p[2]) return t->slot[i];
    }
    memcpy(mesh->at[mesh->vertices], p, sizeof bits);
    for (int k = 0; k < 3; k++) {
        mesh->min[k] = fminf(mesh->min[k], p[k]);
        mesh->max[k] = fmaxf(mesh->max[k], p[k]);
    }
    return t->slot[i] = mesh->vertices++;
}

static void sort_corners(const uint32_t from[3], uint32_t to[3])
{
    uint32_t a = from[0], b = from[1], c = from[2];
    to[0] = a < b ? (a < c ? a : c) : (b < c ? b : c);
    to[2] = a > b ? (a > c ? a : c) : (b > c ? b : c);
    to[1] = a ^ b ^ c ^ to[0] ^ to[2];
}

// Whether a triangle of these corners, in any order, is there; else takes a slot for the next one.
static bool is_known(const occ_mesh *mesh, table *t, const uint32_t corner[3])
{
    uint32_t sorted[3], other[3];
    sort_corners(corner, sorted);
    size_t i = mix(sorted[0], sorted[1], sorted[2]) & (t->size - 1);
    for (; t->slot[i] != NOTHING; i = (i + 1) & (t->size - 1)) {
        sort_corners(mesh->corner[t->slot[i]], other);
        if (!memcmp(sorted, other, sizeof other)) return true;
    }
    t->slot[i] = mesh->triangles;
    return false;
}

static void read_corners(const occ_soup *soup, occ_mesh *mesh, table *t, uint32_t triangle,
                         uint32_t corner[3])
{
    for (uint32_t i = 0; i < 3; i++) {
        size_t place = 3 * (size_t)triangle + i;
        float p[3];
        read_position(soup, soup->indices ? soup->indices[place] : (uint32_t)place, p);
        corner[i] = weld(mesh, t, p);
    }
}

static bool reserve(occ_hooks *hooks, const occ_soup *soup, occ_mesh *mesh)
{
    size_t named = 3 * (size_t)soup->triangle_count;
    mesh->vertex_room = named < soup->vertex_count ? (uint32_t)named : soup->vertex_count;
    mesh->triangle_room = soup->triangle_count;
    mesh->at = occ_alloc(hooks, mesh->vertex_room * sizeof *mesh->at);
    mesh->corner = occ_alloc(hooks, mesh->triangle_room * sizeof *mesh->corner);
    mesh->source = occ_alloc(hooks, mesh->triangle_room * sizeof *mesh->source);
    return mesh->at && mesh->corner && mesh->source;
}

occ_result occ_mesh_build(occ_hooks *hooks, const occ_soup *soup, occ_mesh *mesh)
{
    *mesh =
        (occ_mesh){.min = {INFINITY, INFINITY, INFINITY}, .max = {-INFINITY, -INFINITY, -INFINITY}};
    table positions = {0}, corners = {0};
    bool made = reserve(hooks, soup, mesh) && table_make(hooks, &positions, mesh->vertex_room) &&
                table_make(hooks, &corners, mesh->triangle_room);
    for (uint32_t i = 0; made && i < soup->triangle_count; i++) {
        uint32_t corner[3];
        read_corners(soup, mesh, &positions, i, corner);
        if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0]) continue;
        if (is_known(mesh, &corners, corner)) continue;
        mesh->source[mesh->triangles] = i;
        memcpy(mesh->corner[mesh->triangles++], corner, sizeof corner);
    }
    table_free(hooks, &positions);
    table_free(hooks, &corners);
    if (made) return OCC_SUCCESS;
    occ_mesh_free(hooks, mesh);
    return occ_fail(hooks, OCC_ERROR_OUT_OF_MEMORY, "no memory for %u triangles",
                    (unsigned)soup->triangle_count);
}

void occ_mesh_free(occ_hooks *hooks, occ_mesh *mesh)
{
    occ_free(hooks, mesh->at, mesh->vertex_room * sizeof *mesh->at);
    occ_free(hooks, mesh->corner, mesh->triangle_room * sizeof *mesh->corner);
    occ_free(hooks, mesh->source, mesh->triangle_room * sizeof *mesh->source);
    *mesh = (occ_mesh){0};
}
