// SPDX-License-Identifier: Apache-2.0
#include "error_judge.h"

#include <stdio.h>

#ifdef OCC_BENCH_JUDGE
static const char *count(error_judge *judge, const vis_result *result, settle_limits limits,
                         compare_sums *sums, settle_sums *settled)
{
    truth_result truth;
    const char *complaint = settle_check(judge->scene, judge->truth);
    if (complaint) return complaint;
    if (!judge->settle) judge->settle = settle_create(judge->scene, judge->truth);
    if (!judge->settle) return "not enough memory";
    complaint = settle_result(judge->settle, result, limits, &truth, settled);
    if (complaint) return complaint;
    *sums = compare_count(&truth, result, NULL, NULL);
    truth_free(&truth);
    return NULL;
}

void error_judge_free(error_judge *judge)
{
    settle_destroy(judge->settle);
    judge->settle = NULL;
}
#else
static const char *count(error_judge *judge, const vis_result *result, settle_limits limits,
                         compare_sums *sums, settle_sums *settled)
{
    (void)limits;
    *settled = (settle_sums){0};
    *sums = compare_count(judge->truth, result, NULL, NULL);
    return NULL;
}

void error_judge_free(error_judge *judge)
{
    (void)judge;
}
#endif

bool error_judge_count(error_judge *judge, const vis_result *result, settle_limits limits,
                       compare_sums *sums, settle_sums *settled)
{
    const char *complaint = compare_check(judge->truth, result);
    if (!complaint) complaint = count(judge, result, limits, sums, settled);
    if (complaint) fprintf(stderr, "occlude-bench: a result cannot be judged: %s\n", complaint);
    return !complaint;
}
