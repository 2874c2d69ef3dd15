// SPDX-License-Identifier: Apache-2.0
// Compiled several times, each time with OCC_LANES_NAME set to the name of an instruction set.
// Written so that a compiler makes vectors of it: no branches in a loop, comparisons as arithmetic
// on bits, and no conversion of a double to float and back (rounding.h).
#include "blocks.h"

#include "box.h"
#include "rounding.h"

#include <math.h>
#include <string.h>

#ifndef OCC_LANES_NAME
#define OCC_LANES_NAME plain
#endif
#define OCC_PASTE2(a, b) a##b
#define OCC_PASTE(a, b)  OCC_PASTE2(a, b)
#define OCC_TEXT2(a)     #a
#define OCC_TEXT(a)      OCC_TEXT2(a)
#define OCC_BLOCKS_TABLE OCC_PASTE(occ_blocks_, OCC_LANES_NAME)

#define LOST_BITS      0x1fffffffu         // of a double, those that a float has no room for
#define LEAST_NORMAL   0x3810000000000000u // of floats, 2^-126, as a double
#define FRACTION_BITS  0xfffffffffffffu    // of a double
#define MAGNITUDE_BITS 0x7fffffffffffffffu

static inline uint64_t bits_of(double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static inline double double_of(uint64_t bits)
{
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

// The float next to `value` toward +infinity if `up` is 1, toward -infinity if it is 0: the bits
// that a float lacks are cut off, after a carry into its last one if the value's sign points that
// way. For 0 and for what is no smaller than a normal float.
static inline float round_toward(double value, uint64_t up)
{
    uint64_t bits = bits_of(value);
    bits += (0u - ((bits >> 63) ^ up)) & LOST_BITS;
    return (float)double_of(bits & ~(uint64_t)LOST_BITS);
}

// The highest bit is set if a value is neither 0 nor as large as a normal float.
static inline uint64_t is_denormal(double value)
{
    uint64_t magnitude = bits_of(value) & MAGNITUDE_BITS;
    return (magnitude - LEAST_NORMAL) & (0u - magnitude);
}

// --- bounds --------------------------------------------------------------------------------------

// The bounds along axis j, by the formula of occ_box_bounds(). Returns whether a number was too
// small for round_toward().
static uint64_t bound_axis(occ_block_columns from, uint32_t j, uint32_t count, float *restrict min,
                           float *restrict max)
{
    const float *restrict center = from[j], *restrict a = from[3 + j];
    const float *restrict b = from[6 + j], *restrict c = from[9 + j];
    uint64_t small = 0;
    for (uint32_t i = 0; i < count; i++) {
        double half = fabs((double)a[i]) + fabs((double)b[i]) + fabs((double)c[i]);
        double middle = (double)center[i];
        double slack = (fabs(middle) + half) * 0x1p-50;
        slack = double_of(bits_of(slack) & (0u - ((0u - bits_of(half)) >> 63)));
        double low = middle - half - slack, high = middle + half + slack;
        small |= is_denormal(low) | is_denormal(high);
        min[i] = round_toward(low, 0);
        max[i] = round_toward(high, 1);
    }
    return small >> 63;
}

static occ_box box_of(occ_block_columns from, uint32_t i)
{
    occ_box box;
    for (uint32_t j = 0; j < 3; j++) {
        box.center[j] = from[j][i];
        for (uint32_t k = 0; k < 3; k++)
            box.axis[k][j] = from[3 + 3 * k + j][i];
    }
    return box;
}

// The slow way, for any numbers.
static void bound_one_by_one(occ_block_columns from, uint32_t count, occ_block *block)
{
    for (uint32_t i = 0; i < count; i++) {
        float min[3], max[3];
        occ_box box = box_of(from, i);
        occ_box_bounds(&box, min, max);
        for (int j = 0; j < 3; j++) {
            block->min[j][i] = min[j];
            block->max[j][i] = max[j];
        }
    }
}

static void make_bounds(occ_block_columns from, uint32_t count, occ_block *block)
{
    uint64_t small = 0;
    for (uint32_t j = 0; j < 3; j++)
        small |= bound_axis(from, j, count, block->min[j], block->max[j]);
    if (small) bound_one_by_one(from, count, block);
}

// --- keys ----------------------------------------------------------------------------------------

// Spreads the low 19 bits so that two zeros follow each.
static inline uint64_t spread(uint64_t x)
{
    x = (x | x << 32) & 0x001f00000000ffffu;
    x = (x | x << 16) & 0x001f0000ff0000ffu;
    x = (x | x << 8) & 0x100f00f00f00f00fu;
    x = (x | x << 4) & 0x10c30c30c30c30c3u;
    return (x | x << 2) & 0x1249249249249249u;
}

// Adds axis j to the cells' codes, and to the items' widths.
static void code_axis(const occ_root *root, const occ_block *block, int j, uint32_t count,
                      uint64_t *restrict code, double *restrict width)
{
    const double cells = (double)(1u << OCC_TREE_BITS), scale = cells / root->size;
    const double origin = root->origin[j];
    const float *restrict min = block->min[j], *restrict max = block->max[j];
    for (uint32_t i = 0; i < count; i++) {
        double low = (double)min[i], high = (double)max[i];
        double place = (0.5 * (low + high) - origin) * scale;
        place = place < 0.0 ? 0.0 : place;
        place = place > cells - 1.0 ? cells - 1.0 : place;
        code[i] |= spread((uint32_t)(int32_t)place) << j;
        width[i] = high - low > width[i] ? high - low : width[i];
    }
}

// The least e with 2^e >= width, but far below any cell's for 0.
static inline int32_t exponent_of(double width)
{
    return (int32_t)((bits_of(width) + FRACTION_BITS) >> 52) - 1023;
}

static void make_keys(const occ_root *root, const occ_block *block, uint32_t count,
                      uint64_t *restrict keys)
{
    double width[OCC_BLOCK];
    const int32_t most = (int32_t)OCC_TREE_BITS, smallest = exponent_of(root->size) - most;
    memset(keys, 0, count * sizeof *keys);
    memset(width, 0, count * sizeof *width);
    for (int j = 0; j < 3; j++)
        code_axis(root, block, j, count, keys, width);
    for (uint32_t i = 0; i < count; i++) {
        // Levels from the smallest cells up to those that are half as wide as the item.
        int32_t above = exponent_of(width[i]) - 1 - smallest;
        above = above < 0 ? 0 : above;
        above = above > most ? most : above;
        uint64_t kept = ~(uint64_t)0 << (3 * above);
        keys[i] = (keys[i] & kept) << OCC_LEVEL_BITS | (uint64_t)(most - above);
    }
}

// --- reaches -------------------------------------------------------------------------------------

// The area of the face that axes k and l of a box span.
static inline double face_area(occ_block_columns from, uint32_t k, uint32_t l, uint32_t i)
{
    const float *const *a = from + 3 + 3 * k, *const *b = from + 3 + 3 * l;
    double x = (double)a[1][i] * (double)b[2][i] - (double)a[2][i] * (double)b[1][i];
    double y = (double)a[2][i] * (double)b[0][i] - (double)a[0][i] * (double)b[2][i];
    double z = (double)a[0][i] * (double)b[1][i] - (double)a[1][i] * (double)b[0][i];
    return 4.0 * sqrt(x * x + y * y + z * z);
}

static void make_reaches(occ_block_columns from, uint32_t count, float *restrict reaches)
{
    uint64_t odd = 0;
    for (uint32_t i = 0; i < count; i++) {
        double area =
            face_area(from, 0, 1, i) + face_area(from, 1, 2, i) + face_area(from, 2, 0, i);
        double more = area * (1.0 + 0x1p-40);
        odd |= is_denormal(more) | (bits_of(1e38) - 1u - bits_of(area)); // the latter: area >= 1e38
        reaches[i] = round_toward(more, 1);
    }
    for (uint32_t i = 0; odd >> 63 && i < count; i++) {
        occ_box box = box_of(from, i);
        reaches[i] = occ_occluder_reach(&box);
    }
}

extern const occ_blocks OCC_BLOCKS_TABLE;
const occ_blocks OCC_BLOCKS_TABLE = {OCC_TEXT(OCC_LANES_NAME), make_bounds, make_keys,
                                     make_reaches};
