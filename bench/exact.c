// SPDX-License-Identifier: Apache-2.0
#include "exact.h"

#include <math.h>

static void trim(exact *a)
{
    while (a->used && a->limb[a->used - 1] == 0)
        a->used--;
    if (a->used == 0) a->sign = 0;
}

exact exact_from(float value)
{
    exact out = {0};
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

int exact_compare_magnitude(const exact *a, const exact *b)
{
    if (a->used != b->used) return a->used < b->used ? -1 : 1;
    for (uint32_t i = a->used; i-- > 0;)
        if (a->limb[i] != b->limb[i]) return a->limb[i] < b->limb[i] ? -1 : 1;
    return 0;
}

static exact add_magnitudes(const exact *large, const exact *small)
{
    exact out = {.sign = large->sign, .used = large->used};
    uint64_t carry = 0;
    for (uint32_t i = 0; i < large->used; i++) {
        carry += (uint64_t)large->limb[i] + (i < small->used ? small->limb[i] : 0);
        out.limb[i] = (uint32_t)carry;
        carry >>= 32;
    }
    if (carry) out.limb[out.used++] = (uint32_t)carry;
    return out;
}

static exact subtract_magnitudes(const exact *large, const exact *small)
{
    exact out = {.sign = large->sign, .used = large->used};
    uint64_t borrow = 0;
    for (uint32_t i = 0; i < large->used; i++) {
        uint64_t take = borrow + (i < small->used ? small->limb[i] : 0);
        borrow = take > large->limb[i];
        out.limb[i] = (uint32_t)((borrow << 32) + large->limb[i] - take);
    }
    trim(&out);
    return out;
}

exact exact_add(const exact *a, const exact *b)
{
    if (a->sign == 0) return *b;
    if (b->sign == 0) return *a;
    const exact *large = a, *small = b;
    if (exact_compare_magnitude(a, b) < 0) {
        large = b;
        small = a;
    }
    if (a->sign == b->sign) return add_magnitudes(large, small);
    return subtract_magnitudes(large, small);
}

exact exact_subtract(const exact *a, const exact *b)
{
    exact minus = *b;
    minus.sign = -minus.sign;
    return exact_add(a, &minus);
}

exact exact_multiply(const exact *a, const exact *b)
{
    exact out = {0};
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

exact_vector exact_vector_from(const float v[3])
{
    return (exact_vector){{exact_from(v[0]), exact_from(v[1]), exact_from(v[2])}};
}

exact_vector exact_vector_add(const exact_vector *a, const exact_vector *b)
{
    exact_vector out;
    for (int k = 0; k < 3; k++)
        out.at[k] = exact_add(&a->at[k], &b->at[k]);
    return out;
}

exact_vector exact_vector_subtract(const exact_vector *a, const exact_vector *b)
{
    exact_vector out;
    for (int k = 0; k < 3; k++)
        out.at[k] = exact_subtract(&a->at[k], &b->at[k]);
    return out;
}

exact exact_minor(const exact_vector *a, const exact_vector *b, int i, int j)
{
    exact left = exact_multiply(&a->at[i], &b->at[j]);
    exact right = exact_multiply(&a->at[j], &b->at[i]);
    return exact_subtract(&left, &right);
}

exact exact_determinant(const exact_vector *a, const exact_vector *b, const exact_vector *c)
{
    exact sum = {0};
    for (int k = 0; k < 3; k++) {
        exact minor = exact_minor(b, c, (k + 1) % 3, (k + 2) % 3);
        exact term = exact_multiply(&a->at[k], &minor);
        sum = exact_add(&sum, &term);
    }
    return sum;
}
