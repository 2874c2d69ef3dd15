// SPDX-License-Identifier: Apache-2.0
// Bytes as a soup: it is refused by name, or boxes are found in it that stand up to verification.
#include "bytes.h"

#include <occlude/occlude.h>

enum { VERTICES = 48, TRIANGLES = 48, BOXES = 6 };

// Coordinates that meet each other now and then, and any floats.
static float read_coordinate(fuzz_bytes *from, uint8_t kind)
{
    if (kind == 0) return fuzz_float(from);
    int8_t step = (int8_t)fuzz_byte(from);
    return (float)step * (kind == 1 ? 0.25f : 1e-3f) + (kind == 3 ? 1000.0f : 0.0f);
}

static void read_desc(fuzz_bytes *from, occ_inner_desc *desc, float points[6])
{
    uint8_t flags = fuzz_byte(from);
    desc->max_cells = 4096;
    desc->threads = flags & 1 ? 2 : 1;
    desc->facing = flags & 2 ? OCC_FACING_OUT : OCC_FACING_ANY;
    desc->aligned_only = (flags & 4) != 0;
    if (flags & 8) desc->max_hole = (float)fuzz_byte(from) * 0.125f;
    if (flags & 16) desc->coverage = fuzz_float(from);
    if (flags & 32) {
        desc->free_count = 2;
        desc->free_points = points;
        desc->outside_solid = (flags & 16) != 0;
    }
    for (int i = 0; i < 6 && (flags & 32); i++)
        points[i] = read_coordinate(from, flags >> 6);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static float positions[VERTICES][3];
    static uint32_t indices[3 * TRIANGLES];
    static occ_inner_box boxes[BOXES];
    float points[6] = {0};
    fuzz_bytes from = {data, size};
    occ_inner_desc desc = {0};
    read_desc(&from, &desc, points);
    uint8_t kind = fuzz_byte(&from) % 4;
    occ_soup soup = {&positions[0][0], 1 + fuzz_byte(&from) % VERTICES, 0, indices,
                     fuzz_byte(&from) % (TRIANGLES + 1)};
    for (uint32_t v = 0; v < soup.vertex_count; v++)
        for (int k = 0; k < 3; k++)
            positions[v][k] = read_coordinate(&from, kind);
    for (uint32_t i = 0; i < 3 * soup.triangle_count; i++)
        indices[i] = fuzz_byte(&from) % (soup.vertex_count + (kind == 0));
    size_t count = BOXES + 1;
    occ_inner_stats stats;
    occ_inner_fault fault;
    occ_result result = occ_inner_find(&soup, &desc, boxes, BOXES, &count, &stats);
    FUZZ_CHECK(result ? count == 0 : count <= BOXES);
    FUZZ_CHECK(occ_verify_inner(&soup, boxes, count, &desc, &fault) == result);
    if (result) {
        FUZZ_CHECK(result == OCC_ERROR_NOT_FINITE || result == OCC_ERROR_OUT_OF_RANGE ||
                   result == OCC_ERROR_INVALID_ARGUMENT);
        return 0;
    }
    FUZZ_CHECK(fault.reason == OCC_INNER_SOUND);
    FUZZ_CHECK(stats.counts.triangles <= soup.triangle_count && stats.coverage <= 1.0f);
    for (size_t i = 0; i < count; i++)
        FUZZ_CHECK(boxes[i].closed || desc.max_hole > 0.0f);
    return 0;
}
