// SPDX-License-Identifier: Apache-2.0
// Directed rounding from double to float, and exact differences. Needs contraction off.
#ifndef OCC_ROUNDING_H
#define OCC_ROUNDING_H

#include <stdint.h>
#include <string.h>

// The float nearest to `value`, for good. Without the detour through memory gcc 12 (12.2, x86-64,
// -O3), where it vectorises neighbouring statements, takes (double)(float)value for value: two
// conversions of vectors that it thinks undo each other.
static inline float occ_nearest(double value)
{
    volatile float nearest = (float)value;
    return nearest;
}

// The float next to a finite one, away from zero or toward it by the sign of `step`.
static inline float occ_float_step(float value, int32_t step)
{
    int32_t bits;
    memcpy(&bits, &value, sizeof bits);
    bits += step;
    memcpy(&value, &bits, sizeof value);
    return value;
}

// The least float that is not below `value`, for |value| well within float's range.
static inline float occ_round_up(double value)
{
    float nearest = occ_nearest(value);
    if ((double)nearest >= value) return nearest;
    if (nearest == 0.0f) return 0x1p-149f;
    return occ_float_step(nearest, nearest > 0.0f ? 1 : -1);
}

// The greatest float that is not above `value`, for |value| well within float's range.
static inline float occ_round_down(double value)
{
    return -occ_round_up(-value);
}

// An upper bound on a - b that is exact whenever a - b is a double (Knuth's two-sum gives the
// rounding error of the difference; only its sign is needed).
static inline double occ_difference_up(double a, double b)
{
    double difference = a - b;
    double part = a - difference;
    double error = (a - (difference + part)) + (part - b);
    return error > 0.0 ? difference * (difference > 0.0 ? 1.0 + 0x1p-52 : 1.0 - 0x1p-52) + 0x1p-1074
                       : difference;
}

#endif
