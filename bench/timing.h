// SPDX-License-Identifier: Apache-2.0
/// @file
/// A clock, and what is said of many times.
#ifndef OCC_BENCH_TIMING_H
#define OCC_BENCH_TIMING_H

#include <stddef.h>

/// Milliseconds on a clock that never goes back.
double timing_now(void);

/// Sorts `values` and returns their median (of an even number, the mean of the middle two); 0 for
/// none.
double timing_median(double *values, size_t count);

/// Sorts `values` and returns the smallest that at least `percent` of them do not exceed; 0 for
/// none.
double timing_percentile(double *values, size_t count, unsigned percent);

#endif
