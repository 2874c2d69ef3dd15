// SPDX-License-Identifier: Apache-2.0
#include "unrounded.h"

#include <math.h>

static void trim(unrounded *a)
{
    while (a->used && a->limb[a->used - 1] == 0)
        a->used--;
    if (a->used == 0) a->sign = 0;
}

unrounded unrounded_from(float value)
{
    unrounded out = {0};
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
    out.used = first + 2;
    trim(&out);
    return out;
}

int unrounded_compare_magnitude(const unrounded *a, const unrounded *b)
{
    if (a->used != b->used) return a->used < b->used ? -1 : 1;
    for (uint32_t i = a->used; i-- > 0;)
        if (a->limb[i] != b->limb[i]) return a->limb[i] < b->limb[i] ? -1 : 1;
    return 0;
}

static unrounded add_magnitudes(const unrounded *large, const unrounded *small)
{
    unrounded out = {.sign = large->sign, .used = large->used};
    uint64_t carry = 0;
    for (uint32_t i = 0; i < large->used; i++) {
        carry += (uint64_t)large->limb[i] + (i < small->used ? small->limb[i] : 0);
        out.limb[i] = (uint32_t)carry;
        carry >>= 32;
    }
    if (carry) out.limb[out.used++] = (uint32_t)carry;
    return out;
}

static unrounded subtract_magnitudes(const unrounded *large, const unrounded *small)
{
    unrounded out = {.sign = large->sign, .used = large->used};
    uint64_t borrow = 0;
    for (uint32_t i = 0; i < large->used; i++) {
        uint64_t take = borrow + (i < small->used ? small->limb[i] : 0);
        borrow = take > large->limb[i];
        out.limb[i] = (uint32_t)((borrow << 32) + large->limb[i] - take);
    }
    trim(&out);
    return out;
}

unrounded unrounded_add(const unrounded *a, const unrounded *b)
{
    if (a->sign == 0) return *b;
    if (b->sign == 0) return *a;
    const unrounded *large = a, *small = b;
    if (unrounded_compare_magnitude(a, b) < 0) {
        large = b;
        small = a;
    }
    if (a->sign == b->sign) return add_magnitudes(large, small);
    return subtract_magnitudes(large, small);
}

unrounded unrounded_subtract(const unrounded *a, const unrounded *b)
{
    unrounded minus = *b;
    minus.sign = -minus.sign;
    return unrounded_add(a, &minus);
}

unrounded unrounded_multiply(const unrounded *a, const unrounded *b)
{
    unrounded out = {0};
    if (a->sign == 0 || b->sign == 0) return out;
    out.sign = a->sign * b->sign;
    out.used = a->used + b->used;
    for (uint32_t i = 0; i < a->used; i++) {
        if (a->limb[i] == 0) continue; // The low limbs of most floats are empty.
        uint64_t carry = 0;
        for (uint32_t j = 0; j < b->used; j++) {
            carry += (uint64_t)a->limb[i] * b->limb[j] + out.limb[i + j];
            out.limb[i + j] = (uint32_t)carry;
            carry >>= 32;
        }
        out.limb[i + b->used] = (uint32_t)carry;
    }
    trim(&out);
    return out;
}

unrounded_vector unrounded_vector_from(const float v[3])
{
    return (unrounded_vector){{unrounded_from(v[0]), unrounded_from(v[1]), unrounded_from(v[2])}};
}

unrounded_vector unrounded_vector_add(const unrounded_vector *a, const unrounded_vector *b)
{
    unrounded_vector out;
    for (int k = 0; k < 3; k++)
        out.at[k] = unrounded_add(&a->at[k], &b->at[k]);
    return out;
}

unrounded_vector unrounded_vector_subtract(const unrounded_vector *a, const unrounded_vector *b)
{
    unrounded_vector out;
    for (int k = 0; k < 3; k++)
        out.at[k] = unrounded_subtract(&a->at[k], &b->at[k]);
    return out;
}

unrounded unrounded_minor(const unrounded_vector *a, const unrounded_vector *b, int i, int j)
{
    unrounded left = unrounded_multiply(&a->at[i], &b->at[j]);
    unrounded right = unrounded_multiply(&a->at[j], &b->at[i]);
    return unrounded_subtract(&left, &right);
}

unrounded unrounded_determinant(const unrounded_vector *a, const unrounded_vector *b,
                                const unrounded_vector *c)
{
    unrounded sum = {0};
    for (int k = 0; k < 3; k++) {
        unrounded minor = unrounded_minor(b, c, (k + 1) % 3, (k + 2) % 3);
        unrounded term = unrounded_multiply(&a->at[k], &minor);
        sum = unrounded_add(&sum, &term);
    }
    return sum;
}
