// SPDX-License-Identifier: Apache-2.0
#include "soup/tally.h"

static void *tally_alloc(size_t size, size_t alignment, void *user_data)
{
    occ_tally *t = user_data;
    void *pointer = t->allocator.alloc(size, alignment, t->allocator.user_data);
    if (!pointer) return NULL;
    t->bytes += size;
    if (t->bytes > t->peak) t->peak = t->bytes;
    return pointer;
}

static void tally_free(void *pointer, size_t size, void *user_data)
{
    occ_tally *t = user_data;
    t->bytes -= size;
    t->allocator.free(pointer, size, t->allocator.user_data);
}

void occ_tally_start(occ_tally *tally, occ_hooks *hooks)
{
    *tally = (occ_tally){.allocator = hooks->allocator};
    hooks->allocator = (occ_allocator){tally_alloc, tally_free, tally};
}
