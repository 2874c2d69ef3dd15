// SPDX-License-Identifier: Apache-2.0
#include "tree_sort.h"

#include <string.h>

#define DIGIT_BITS 11u
#define DIGITS     6u // 66 bits, of which 62 are used
#define BUCKETS    (1u << DIGIT_BITS)

static uint32_t digit_of(uint64_t key, uint32_t digit)
{
    return (uint32_t)(key >> (digit * DIGIT_BITS)) & (BUCKETS - 1u);
}

// One stable counting pass from `from` to `to`. False, and nothing moved, if all have one digit.
static int pass(const occ_tree_entry *from, occ_tree_entry *to, uint32_t count, uint32_t digit)
{
    uint32_t place[BUCKETS] = {0};
    for (uint32_t i = 0; i < count; i++)
        place[digit_of(from[i].key, digit)]++;
    if (place[digit_of(from[0].key, digit)] == count) return 0;
    uint32_t sum = 0;
    for (uint32_t b = 0; b < BUCKETS; b++) {
        uint32_t here = place[b];
        place[b] = sum;
        sum += here;
    }
    for (uint32_t i = 0; i < count; i++)
        to[place[digit_of(from[i].key, digit)]++] = from[i];
    return 1;
}

// For few entries the counting passes cost more than they save.
static void insertion_sort(occ_tree_entry *entries, uint32_t count)
{
    for (uint32_t i = 1; i < count; i++) {
        occ_tree_entry entry = entries[i];
        uint32_t j = i;
        for (; j > 0 && entries[j - 1].key > entry.key; j--)
            entries[j] = entries[j - 1];
        entries[j] = entry;
    }
}

void occ_tree_sort(occ_tree_entry *entries, occ_tree_entry *spare, uint32_t count)
{
    if (count <= 64) {
        insertion_sort(entries, count);
        return;
    }
    occ_tree_entry *from = entries, *to = spare;
    for (uint32_t digit = 0; digit < DIGITS; digit++) {
        if (!pass(from, to, count, digit)) continue;
        occ_tree_entry *swap = from;
        from = to;
        to = swap;
    }
    if (from != entries) memcpy(entries, from, (size_t)count * sizeof *entries);
}
