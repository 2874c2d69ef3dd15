// SPDX-License-Identifier: Apache-2.0
/// @file
/// Random numbers and elementary functions that give the same bits on every machine: made of
/// + - * / and sqrt on IEEE doubles alone, so that a named scene is the same file everywhere.
/// (Compile with contraction off and without x87 arithmetic.)
#ifndef OCC_BENCH_STEADY_H
#define OCC_BENCH_STEADY_H

#include <stdint.h>

/// A stream of random numbers (splitmix64).
typedef struct steady_random {
    uint64_t state;
} steady_random;

/// The stream of a seed. Different labels give streams that have nothing to do with each other.
steady_random steady_seed(uint64_t seed, const char *label);

/// 64 random bits.
uint64_t steady_bits(steady_random *random);

/// Uniform in [0, 1).
double steady_unit(steady_random *random);

/// Uniform in [low, high).
double steady_between(steady_random *random, double low, double high);

/// Uniform in 0 .. count - 1, for small counts.
uint32_t steady_below(steady_random *random, uint32_t count);

/// Sine and cosine, for |x| up to about 1e6, to 1e-15.
double steady_sin(double x);
double steady_cos(double x);

/// e to the x, for |x| up to 700, to a relative 1e-15.
double steady_exp(double x);

/// The natural logarithm of x > 0, normal and finite, to 1e-15 of it or of 1.
double steady_log(double x);

/// The cube root of x >= 0, to a relative 1e-15.
double steady_cbrt(double x);

#endif
