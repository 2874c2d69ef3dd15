// SPDX-License-Identifier: Apache-2.0
/// @file
/// The sampling oracle: what of a scene can be seen in a frame, decided in double and without the
/// library. docs/truth.md says what its answers mean.
#ifndef OCC_BENCH_TRUTH_SAMPLE_H
#define OCC_BENCH_TRUTH_SAMPLE_H

#include "obs.h"
#include "truth_file.h"

/// Fills `verdicts`, one for each object. NULL, or what went wrong.
const char *truth_sample(const obs_scene *scene, uint32_t frame, uint32_t width, uint32_t height,
                         truth_verdict *verdicts);

#endif
