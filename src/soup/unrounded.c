// SPDX-License-Identifier: Apache-2.0
#include "soup/unrounded.h"

#include <math.h>

static void trim(occ_unrounded *a)
{
    while (a->used && a->limb[a->used - 1] == 0)
        a->used--;
    if (a->used == 0) *a = (occ_unrounded){0};
}

occ_unrounded occ_unrounded_from(float value)
{
    occ_unrounded out = {0};
    if (value == 0.0f) return out;
    int exponent;
    float fraction = frexpf(fabsf(value), &exponent);
    // |value| = mantissa * 2^(exponent - 24); a denormal's missing bits make the shift negative.
    uint64_t mantissa = (uint64_t)ldexpf(fraction, 24);
    int shift = exponent - 24 + 149;
    if (shift < 0) {
        mantissa >>= -shift;
        shift = 0;
    }
    uint32_t first = (uint32_t)shift / 32;
    uint64_t bits = mantissa << (shift % 32);
    out.sign = value < 0.0f ? -1 : 1;
    out.limb[first] = (uint32_t)bits;
    out.limb[first + 1] = (uint32_t)(bits >> 32);
    out.low = first;
    out.used = first + 2;
    trim(&out);
    return out;
}

int occ_unrounded_compare_magnitude(const occ_unrounded *a, const occ_unrounded *b)
{
    if (a->used != b->used) return a->used < b->used ? -1 : 1;
    for (uint32_t i = a->used; i-- > 0;)
        if (a->limb[i] != b->limb[i]) return a->limb[i] < b->limb[i] ? -1 : 1;
    return 0;
}

static uint32_t least(const occ_unrounded *a, const occ_unrounded *b)
{
    return a->low < b->low ? a->low : b->low;
}

static occ_unrounded add_magnitudes(const occ_unrounded *large, const occ_unrounded *small)
{
    occ_unrounded out = {.sign = large->sign, .low = least(large, small), .used = large->used};
    uint64_t carry = 0;
    for (uint32_t i = out.low; i < large->used; i++) {
        carry += (uint64_t)large->limb[i] + (i < small->used ? small->limb[i] : 0);
        out.limb[i] = (uint32_t)carry;
        carry >>= 32;
    }
    if (carry) out.limb[out.used++] = (uint32_t)carry;
    return out;
}

static occ_unrounded subtract_magnitudes(const occ_unrounded *large, const occ_unrounded *small)
{
    occ_unrounded out = {.sign = large->sign, .low = least(large, small), .used = large->used};
    uint64_t borrow = 0;
    for (uint32_t i = out.low; i < large->used; i++) {
        uint64_t take = borrow + (i < small->used ? small->limb[i] : 0);
        borrow = take > large->limb[i];
        out.limb[i] = (uint32_t)((borrow << 32) + large->limb[i] - take);
    }
    trim(&out);
    return out;
}

occ_unrounded occ_unrounded_add(const occ_unrounded *a, const occ_unrounded *b)
{
    if (a->sign == 0) return *b;
    if (b->sign == 0) return *a;
    const occ_unrounded *large = a, *small = b;
    if (occ_unrounded_compare_magnitude(a, b) < 0) {
        large = b;
        small = a;
    }
    if (a->sign == b->sign) return add_magnitudes(large, small);
    return subtract_magnitudes(large, small);
}

occ_unrounded occ_unrounded_subtract(const occ_unrounded *a, const occ_unrounded *b)
{
    occ_unrounded minus = *b;
    minus.sign = -minus.sign;
    return occ_unrounded_add(a, &minus);
}

occ_unrounded occ_unrounded_multiply(const occ_unrounded *a, const occ_unrounded *b)
{
    occ_unrounded out = {0};
    if (a->sign == 0 || b->sign == 0) return out;
    out.sign = a->sign * b->sign;
    out.low = a->low + b->low;
    out.used = a->used + b->used;
    for (uint32_t i = a->low; i < a->used; i++) {
        uint64_t carry = 0;
        for (uint32_t j = b->low; j < b->used; j++) {
            carry += (uint64_t)a->limb[i] * b->limb[j] + out.limb[i + j];
            out.limb[i + j] = (uint32_t)carry;
            carry >>= 32;
        }
        out.limb[i + b->used] = (uint32_t)carry;
    }
    trim(&out);
    return out;
}

occ_unrounded_vector occ_unrounded_vector_from(const float v[3])
{
    return (occ_unrounded_vector){
        {occ_unrounded_from(v[0]), occ_unrounded_from(v[1]), occ_unrounded_from(v[2])}};
}

occ_unrounded_vector occ_unrounded_vector_add(const occ_unrounded_vector *a,
                                              const occ_unrounded_vector *b)
{
    occ_unrounded_vector out;
    for (int k = 0; k < 3; k++)
        out.at[k] = occ_unrounded_add(&a->at[k], &b->at[k]);
    return out;
}

occ_unrounded_vector occ_unrounded_vector_subtract(const occ_unrounded_vector *a,
                                                   const occ_unrounded_vector *b)
{
    occ_unrounded_vector out;
    for (int k = 0; k < 3; k++)
        out.at[k] = occ_unrounded_subtract(&a->at[k], &b->at[k]);
    return out;
}

occ_unrounded occ_unrounded_minor(const occ_unrounded_vector *a, const occ_unrounded_vector *b,
                                  int i, int j)
{
    occ_unrounded left = occ_unrounded_multiply(&a->at[i], &b->at[j]);
    occ_unrounded right = occ_unrounded_multiply(&a->at[j], &b->at[i]);
    return occ_unrounded_subtract(&left, &right);
}

occ_unrounded_vector occ_unrounded_cross(const occ_unrounded_vector *a,
                                         const occ_unrounded_vector *b)
{
    occ_unrounded_vector out;
    for (int k = 0; k < 3; k++)
        out.at[k] = occ_unrounded_minor(a, b, (k + 1) % 3, (k + 2) % 3);
    return out;
}

occ_unrounded occ_unrounded_dot(const occ_unrounded_vector *a, const occ_unrounded_vector *b)
{
    occ_unrounded sum = {0};
    for (int k = 0; k < 3; k++) {
        occ_unrounded term = occ_unrounded_multiply(&a->at[k], &b->at[k]);
        sum = occ_unrounded_add(&sum, &term);
    }
    return sum;
}

occ_unrounded occ_unrounded_determinant(const occ_unrounded_vector *a,
                                        const occ_unrounded_vector *b,
                                        const occ_unrounded_vector *c)
{
    occ_unrounded_vector normal = occ_unrounded_cross(b, c);
    return occ_unrounded_dot(a, &normal);
}
