// SPDX-License-Identifier: Apache-2.0
/// @file
/// How a result differs from the truth.
#ifndef OCC_BENCH_COMPARE_COUNT_H
#define OCC_BENCH_COMPARE_COUNT_H

#include "truth_file.h"
#include "vis.h"

/// Sums over the frames that the truth has.
typedef struct compare_sums {
    uint64_t in_frustum, visible; ///< In truth.
    uint64_t false_hidden;        ///< Visible in truth, hidden in the result.
    uint64_t missed;              ///< In the frustum and hidden in truth, visible in the result.
    uint32_t largest_px;          ///< Most samples of one false-hidden object.
} compare_sums;

/// Told of each false-hidden object, in the order of frames and objects.
typedef void compare_report(void *user_data, uint32_t frame, uint32_t object,
                            const truth_verdict *verdict);

/// NULL if the two speak of the same objects and the result has all of the truth's frames. Else
/// what is wrong.
const char *compare_check(const truth_result *truth, const vis_result *result);

/// Compares. `report` may be NULL.
compare_sums compare_count(const truth_result *truth, const vis_result *result,
                           compare_report *report, void *user_data);

/// `missed` in per cent of the objects that are in the frustum and hidden; 0 if there are none.
double compare_missed_percent(const compare_sums *sums);

#endif
