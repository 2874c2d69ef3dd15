// SPDX-License-Identifier: Apache-2.0
/// @file
/// Counts a result's errors: by the sampled truth, and where the two do not agree by the exact
/// judge, if the build has one.
#ifndef OCC_BENCH_ERROR_JUDGE_H
#define OCC_BENCH_ERROR_JUDGE_H

#include "compare_count.h"
#include "settle.h"

/// A truth to judge by. Scene and truth must outlive it. All zero but these two: nothing asked yet.
typedef struct error_judge {
    const obs_scene *scene;
    const truth_result *truth;
    settle *settle; ///< Made when first needed. Remembers what it was asked.
} error_judge;

/// Up to `limits` objects go to the exact judge. False after a message.
bool error_judge_count(error_judge *judge, const vis_result *result, settle_limits limits,
                       compare_sums *sums, settle_sums *settled);

void error_judge_free(error_judge *judge);

#endif
