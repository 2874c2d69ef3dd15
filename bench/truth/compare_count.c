// SPDX-License-Identifier: Apache-2.0
#include "compare_count.h"

const char *compare_check(const truth_result *truth, const vis_result *result)
{
    if (truth->object_count != result->object_count) return "another number of objects";
    if (truth->frame_count == 0) return "a truth without frames";
    if (truth->frames[truth->frame_count - 1] >= result->frame_count) return "too few frames";
    return NULL;
}

static void count_frame(compare_sums *sums, const truth_result *truth, uint32_t row,
                        const vis_result *result, compare_report *report, void *user_data)
{
    uint32_t frame = truth->frames[row];
    const truth_verdict *verdicts = truth->verdicts + (size_t)row * truth->object_count;
    for (uint32_t i = 0; i < truth->object_count; i++) {
        const truth_verdict *verdict = &verdicts[i];
        if (!(verdict->flags & TRUTH_IN_FRUSTUM)) continue;
        bool is_shown = vis_is_visible(result, frame, i);
        sums->in_frustum++;
        if (!truth_is_visible(verdict)) {
            sums->missed += is_shown;
            continue;
        }
        sums->visible++;
        if (is_shown) continue;
        sums->false_hidden++;
        if (verdict->samples > sums->largest_px) sums->largest_px = verdict->samples;
        if (report) report(user_data, frame, i, verdict);
    }
}

compare_sums compare_count(const truth_result *truth, const vis_result *result,
                           compare_report *report, void *user_data)
{
    compare_sums sums = {0};
    for (uint32_t row = 0; row < truth->frame_count; row++)
        count_frame(&sums, truth, row, result, report, user_data);
    return sums;
}

double compare_missed_percent(const compare_sums *sums)
{
    uint64_t hidden = sums->in_frustum - sums->visible;
    return hidden > 0 ? 100.0 * (double)sums->missed / (double)hidden : 0.0;
}
