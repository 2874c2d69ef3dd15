// SPDX-License-Identifier: Apache-2.0
// Bytes as a soup: it is refused for a reason that is there, or its bounds hold every vertex; and
// how its triangles meet a box does not depend on how either is told. It is split into clusters
// too.
#include "bytes.h"
#include "soup/overlap.h"

#include <occlude/occlude.h>

#include <math.h>

enum { VERTICES = 48, TRIANGLES = 48 };

typedef struct read_soup {
    float position[VERTICES][4];
    uint32_t index[3 * TRIANGLES];
    occ_soup soup;
} read_soup;

// Small whole numbers times a power of two, which meet and tie; or any float at all.
static float read_number(fuzz_bytes *from, uint8_t kind)
{
    if ((kind & 0xc0) == 0xc0) return fuzz_float(from);
    return ldexpf((float)(int8_t)fuzz_byte(from), (kind & 0x40) ? 40 - (kind & 0x3f) * 3 : 0);
}

static void read_shape(fuzz_bytes *from, read_soup *read)
{
    uint32_t vertices = fuzz_byte(from) % (VERTICES + 1);
    uint32_t triangles = fuzz_byte(from) % (TRIANGLES + 1);
    uint8_t told = fuzz_byte(from), kind = fuzz_byte(from);
    for (uint32_t v = 0; v < vertices; v++)
        for (int k = 0; k < 4; k++)
            read->position[v][k] = k < 3 ? read_number(from, kind) : NAN;
    for (uint32_t i = 0; i < 3 * triangles; i++)
        read->index[i] = vertices ? fuzz_byte(from) % (vertices + (told & 1u)) : 0;
    read->soup = (occ_soup){read->position[0], vertices, sizeof read->position[0],
                            told & 2 ? NULL : read->index, triangles};
}

static uint32_t index_at(const occ_soup *soup, uint32_t i)
{
    return soup->indices ? soup->indices[i] : i;
}

// What the library should say, from the header's words.
static occ_result judge(const read_soup *read)
{
    const occ_soup *soup = &read->soup;
    if (!soup->triangle_count) return OCC_ERROR_INVALID_ARGUMENT;
    for (uint32_t i = 0; i < 3 * soup->triangle_count; i++) {
        uint32_t v = index_at(soup, i);
        if (v >= soup->vertex_count) return OCC_ERROR_INVALID_ARGUMENT;
        for (int k = 0; k < 3; k++) {
            float x = read->position[v][k];
            if (!isfinite(x)) return OCC_ERROR_NOT_FINITE;
            if (fabsf(x) > OCC_MAX_COORDINATE) return OCC_ERROR_OUT_OF_RANGE;
        }
    }
    return OCC_SUCCESS;
}

static void check_counts(const read_soup *read)
{
    occ_soup_counts counts;
    const occ_soup *soup = &read->soup;
    uint32_t named = 0;
    FUZZ_CHECK(!occ_soup_check(soup, NULL, &counts));
    FUZZ_CHECK(counts.triangles + counts.degenerate + counts.duplicate == soup->triangle_count);
    for (uint32_t v = 0; v < soup->vertex_count; v++) {
        uint32_t i = 0;
        while (i < 3 * soup->triangle_count && index_at(soup, i) != v)
            i++;
        named += i < 3 * soup->triangle_count;
    }
    FUZZ_CHECK(counts.vertices == named);
}

// The same triangle and the same box in other words.
static void check_contact(const occ_box *box, const float *const corner[3])
{
    occ_ready_box ready;
    occ_ready_box_make(box, &ready);
    occ_contact contact = occ_ready_box_meets(&ready, corner);
    FUZZ_CHECK(occ_ready_box_entered(&ready, corner) == (contact == OCC_ENTERING));
    for (int c = 0; c < 3; c++)
        FUZZ_CHECK(contact != OCC_APART || !occ_ready_box_holds(&ready, corner[c]));
    occ_box other = *box;
    for (int j = 0; j < 3; j++) {
        other.axis[0][j] = -box->axis[1][j];
        other.axis[1][j] = box->axis[2][j];
        other.axis[2][j] = -box->axis[0][j];
    }
    const float *const turned[3] = {corner[2], corner[1], corner[0]};
    occ_ready_box_make(&other, &ready);
    FUZZ_CHECK(occ_ready_box_meets(&ready, turned) == contact);
}

static void check_bounds(fuzz_bytes *from, const read_soup *read)
{
    const occ_soup *soup = &read->soup;
    occ_box box;
    uint32_t vertex;
    occ_result result = occ_bounds_of_soup(soup, NULL, &box);
    if (result) { // its corners alone may be out of range
        FUZZ_CHECK(result == OCC_ERROR_OUT_OF_RANGE);
        return;
    }
    FUZZ_CHECK(!occ_verify_bounds(soup, &box, NULL, &vertex));
    // A box that is smaller or elsewhere: contacts of every kind.
    for (int k = 0; k < 12; k++) {
        uint8_t byte = fuzz_byte(from);
        float *number = k < 3 ? &box.center[k] : &box.axis[k / 3 - 1][k % 3];
        if (byte) *number *= (float)byte * 0x1p-8f;
    }
    for (uint32_t t = 0; t < soup->triangle_count; t++) {
        const float *const corner[3] = {read->position[index_at(soup, 3 * t)],
                                        read->position[index_at(soup, 3 * t + 1)],
                                        read->position[index_at(soup, 3 * t + 2)]};
        check_contact(&box, corner);
        for (int c = 0; c < 3; c++) {
            occ_ready_box ready;
            occ_ready_box_make(&box, &ready);
            if (!occ_ready_box_holds(&ready, corner[c]))
                FUZZ_CHECK(occ_verify_bounds(soup, &box, NULL, &vertex) == OCC_ERROR_NOT_INSIDE);
        }
    }
}

// Split by what the next bytes ask for: each triangle is in one cluster, which has one label and is
// not too large, and its bounds hold.
static void check_clusters(fuzz_bytes *from, const read_soup *read)
{
    const occ_soup *soup = &read->soup;
    uint32_t label[TRIANGLES], order[TRIANGLES], first[TRIANGLES + 1], count, index[3 * TRIANGLES];
    occ_clusters_desc desc = {.max_triangles = fuzz_byte(from) % 9, .labels = label};
    uint32_t most = desc.max_triangles ? desc.max_triangles : 32;
    uint64_t seen = 0;
    for (uint32_t t = 0; t < soup->triangle_count; t++)
        label[t] = fuzz_byte(from) % 3;
    FUZZ_CHECK(!occ_clusters_find(soup, &desc, order, first, &count));
    FUZZ_CHECK(first[0] == 0 && first[count] == soup->triangle_count);
    for (uint32_t i = 0; i < count; i++) {
        occ_soup part = *soup;
        part.indices = index;
        part.triangle_count = first[i + 1] - first[i];
        FUZZ_CHECK(first[i] < first[i + 1] && part.triangle_count <= most);
        for (uint32_t k = 0; k < 3 * part.triangle_count; k++) {
            uint32_t t = order[first[i] + k / 3];
            FUZZ_CHECK(t < soup->triangle_count && label[t] == label[order[first[i]]]);
            seen |= UINT64_C(1) << t;
            index[k] = index_at(soup, 3 * t + k % 3);
        }
        occ_box box;
        occ_result result = occ_clusters_bounds(soup, order, first + i, 1, NULL, &box);
        FUZZ_CHECK(result == OCC_ERROR_OUT_OF_RANGE ||
                   (!result && !occ_verify_bounds(&part, &box, NULL, NULL)));
    }
    FUZZ_CHECK(seen + 1 == UINT64_C(1) << soup->triangle_count);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fuzz_bytes from = {data, size};
    static read_soup read;
    read_shape(&from, &read);
    occ_result want = judge(&read);
    FUZZ_CHECK(occ_soup_check(&read.soup, NULL, NULL) == want);
    if (want) {
        occ_box box;
        FUZZ_CHECK(occ_bounds_of_soup(&read.soup, NULL, &box) == want);
        return 0;
    }
    check_counts(&read);
    check_bounds(&from, &read);
    check_clusters(&from, &read);
    return 0;
}
