// SPDX-License-Identifier: Apache-2.0
#include "measure.h"

#include "timing.h"

#include <stdlib.h>

bool measure_summarize(const measure_result *result, measure_summary *summary)
{
    size_t count = result->frame_count;
    *summary = (measure_summary){0};
    double *times = calloc(count + 1, 4 * sizeof *times);
    if (!times) return false;
    for (size_t i = 0; i < count; i++) {
        const measure_frame *frame = &result->frames[i];
        times[i] = frame->ms;
        times[count + i] = frame->walk_ms;
        times[2 * count + i] = frame->test_ms;
        times[3 * count + i] = frame->moved_ms;
        summary->in_frustum += (double)frame->in_frustum / (double)count;
        summary->visible += (double)frame->stats.visible / (double)count;
        summary->tested += (double)frame->stats.tested / (double)count;
    }
    summary->median_ms = timing_median(times, count);
    summary->p99_ms = timing_percentile(times, count, 99);
    summary->max_ms = timing_percentile(times, count, 100);
    summary->walk_ms = timing_median(times + count, count);
    summary->test_ms = timing_median(times + 2 * count, count);
    summary->moved_ms = timing_median(times + 3 * count, count);
    free(times);
    return true;
}
