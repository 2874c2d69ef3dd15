// SPDX-License-Identifier: Apache-2.0
// Handing a view's result to the caller's arrays.
#include "view_data.h"

#include "log.h"

#include <string.h>

occ_result occ_view_fits(const occ_view *view, const void *array, size_t capacity, size_t needed,
                         size_t *count)
{
    if (count) *count = needed;
    if (needed <= capacity && (array || !needed)) return OCC_SUCCESS;
    if (!array && capacity) {
        return occ_fail(&view->hooks, OCC_ERROR_INVALID_ARGUMENT, "the array is NULL");
    }
    // Asking for the size with capacity 0 is no mistake, so it is not logged.
    if (!capacity) return OCC_ERROR_BUFFER_TOO_SMALL;
    return occ_fail(&view->hooks, OCC_ERROR_BUFFER_TOO_SMALL, "%zu elements, %zu are needed",
                    capacity, needed);
}

occ_result occ_view_check(const occ_view *view, size_t *count)
{
    if (count) *count = 0;
    if (!view) return OCC_ERROR_INVALID_ARGUMENT;
    if (view->has_result) return OCC_SUCCESS;
    return occ_fail(&view->hooks, OCC_ERROR_NO_RESULT, "call occ_cull() first");
}

occ_result occ_view_read_mask(const occ_view *view, uint32_t *words, size_t capacity, size_t *count)
{
    occ_result result = occ_view_check(view, count);
    if (!result) result = occ_view_fits(view, words, capacity, view->mask.words.count, count);
    if (!result && view->mask.words.count) {
        memcpy(words, view->mask.words.data, (size_t)view->mask.words.count * sizeof *words);
    }
    return result;
}

occ_result occ_view_read_visible(const occ_view *view, uint32_t *slots, size_t capacity,
                                 size_t *count)
{
    occ_result result = occ_view_check(view, count);
    if (!result) result = occ_view_fits(view, slots, capacity, view->frame.stats.visible, count);
    if (!result && slots) occ_mask_list(&view->mask, slots);
    return result;
}

occ_result occ_view_read_occluders(const occ_view *view, occ_occluder *occluders, size_t capacity,
                                   size_t *count)
{
    occ_result result = occ_view_check(view, count);
    if (!result)
        result = occ_view_fits(view, occluders, capacity, view->frame.sources.count, count);
    if (!result && view->frame.sources.count) {
        memcpy(occluders, view->frame.sources.data,
               (size_t)view->frame.sources.count * sizeof *occluders);
    }
    return result;
}

bool occ_view_is_visible(const occ_view *view, occ_object object)
{
    uint32_t slot = object.index - 1u;
    if (!view || !view->has_result || slot / 32 >= view->mask.words.count) return false;
    return ((const uint32_t *)view->mask.words.data)[slot / 32] >> slot % 32 & 1u;
}

occ_result occ_view_get_stats(const occ_view *view, occ_view_stats *stats)
{
    if (!view) return OCC_ERROR_INVALID_ARGUMENT;
    if (!stats) return occ_fail(&view->hooks, OCC_ERROR_INVALID_ARGUMENT, "the stats are NULL");
    occ_result result = occ_view_check(view, NULL);
    if (!result) *stats = view->frame.stats;
    return result;
}
