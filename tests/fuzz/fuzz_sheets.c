// SPDX-License-Identifier: Apache-2.0
// Bytes as a soup: it is refused by name, or sheets are found in it that stand up to verification.
// Bytes as sheets: verification says of each what it is.
#include "bytes.h"

#include <occlude/occlude.h>

enum { VERTICES = 48, TRIANGLES = 48, SHEETS = 96 };

// Coordinates that meet each other now and then, and any floats.
static float read_coordinate(fuzz_bytes *from, uint8_t kind)
{
    if (kind == 0) return fuzz_float(from);
    int8_t step = (int8_t)fuzz_byte(from);
    if (kind == 3) return (float)(step % 3);
    return (float)step * (kind == 1 ? 0.25f : 1e-3f);
}

static void read_desc(fuzz_bytes *from, occ_sheets_desc *desc)
{
    static bool see_through[TRIANGLES];
    static uint32_t labels[TRIANGLES];
    uint8_t flags = fuzz_byte(from);
    desc->sides = flags & 1 ? OCC_SIDES_FRONT : OCC_SIDES_BOTH;
    desc->labels_apart = (flags & 2) != 0;
    if (flags & 4) desc->min_area = fuzz_float(from);
    if (flags & 8) desc->see_through = see_through;
    if (flags & 16) desc->labels = labels;
    for (int t = 0; t < TRIANGLES; t++) {
        uint8_t byte = flags & 24 ? fuzz_byte(from) : 0;
        see_through[t] = (byte & 7) == 7;
        labels[t] = byte >> 6;
    }
}

static void read_sheet(fuzz_bytes *from, uint8_t kind, const float (*positions)[3],
                       uint32_t vertices, occ_sheet *sheet)
{
    sheet->corner_count = fuzz_byte(from) % 10;
    sheet->sides = (occ_sides)(fuzz_byte(from) % 3);
    for (uint32_t i = 0; i < OCC_SHEET_CORNERS; i++) {
        uint8_t vertex = fuzz_byte(from);
        for (int k = 0; k < 3; k++)
            sheet->corner[i][k] =
                vertex & 128 ? read_coordinate(from, kind) : positions[vertex % vertices][k];
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static float positions[VERTICES][3];
    static uint32_t indices[3 * TRIANGLES];
    static occ_found_sheet sheets[SHEETS];
    fuzz_bytes from = {data, size};
    occ_sheets_desc desc = {0};
    read_desc(&from, &desc);
    uint8_t kind = fuzz_byte(&from) % 4;
    occ_soup soup = {&positions[0][0], 1 + fuzz_byte(&from) % VERTICES, 0, indices,
                     fuzz_byte(&from) % (TRIANGLES + 1)};
    for (uint32_t v = 0; v < soup.vertex_count; v++)
        for (int k = 0; k < 3; k++)
            positions[v][k] = read_coordinate(&from, kind);
    for (uint32_t i = 0; i < 3 * soup.triangle_count; i++)
        indices[i] = fuzz_byte(&from) % (soup.vertex_count + (kind == 0));
    size_t count = SHEETS + 1;
    occ_sheets_stats stats;
    occ_sheet_fault fault;
    occ_result result = occ_sheets_find(&soup, &desc, sheets, SHEETS, &count, &stats);
    FUZZ_CHECK(result ? count == 0 : count <= SHEETS);
    FUZZ_CHECK(occ_verify_sheets(&soup, sheets, count, &desc, &fault) == result);
    if (result) {
        FUZZ_CHECK(result == OCC_ERROR_NOT_FINITE || result == OCC_ERROR_OUT_OF_RANGE ||
                   result == OCC_ERROR_INVALID_ARGUMENT);
        return 0;
    }
    FUZZ_CHECK(fault.reason == OCC_SHEET_SOUND && stats.found >= count);
    for (size_t i = 0; i < count; i++)
        FUZZ_CHECK(sheets[i].triangle < soup.triangle_count && sheets[i].triangle_count > 0 &&
                   sheets[i].gain <= sheets[i].area * 1.0001f);
    occ_found_sheet made = {0};
    read_sheet(&from, kind, (const float(*)[3])positions, soup.vertex_count, &made.sheet);
    result = occ_verify_sheets(&soup, &made, 1, &desc, &fault);
    FUZZ_CHECK((result == OCC_ERROR_NOT_INSIDE) == (fault.reason != OCC_SHEET_SOUND));
    return 0;
}
