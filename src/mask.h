// SPDX-License-Identifier: Apache-2.0
// A mask of visible objects and a mark for each of its words that is not 0: of a million objects a
// thousand may show, and neither clearing nor listing them has to look at all words.
#ifndef OCC_MASK_H
#define OCC_MASK_H

#include "memory.h"

#include <string.h>

typedef struct occ_mask {
    occ_array words; // uint32_t: bit slot % 32 of word slot / 32
    occ_array marks; // uint64_t: bit w % 64 of mark w / 64 speaks of word w
} occ_mask;

#define OCC_MASK ((occ_mask){OCC_ARRAY(uint32_t), OCC_ARRAY(uint64_t)})

static inline void occ_mask_free(occ_hooks *hooks, occ_mask *mask)
{
    occ_array_free(hooks, &mask->words);
    occ_array_free(hooks, &mask->marks);
}

// Makes it a mask of so many words, all 0.
static inline occ_result occ_mask_start(occ_hooks *hooks, occ_mask *mask, uint32_t count)
{
    uint32_t marks = count / 64 + 1;
    if (mask->words.count == count && mask->marks.count == marks) {
        uint32_t *words = mask->words.data;
        uint64_t *mark = mask->marks.data;
        for (uint32_t m = 0; m < marks; m++) {
            for (uint64_t bits = mark[m]; bits; bits &= bits - 1)
                words[64 * m + (uint32_t)__builtin_ctzll(bits)] = 0;
            mark[m] = 0;
        }
        return OCC_SUCCESS;
    }
    mask->words.count = mask->marks.count = 0;
    uint32_t *words = occ_array_extend(hooks, &mask->words, (size_t)count + 1);
    uint64_t *mark = occ_array_extend(hooks, &mask->marks, marks);
    if (!words || !mark) return OCC_ERROR_OUT_OF_MEMORY;
    memset(words, 0, (size_t)count * sizeof *words);
    memset(mark, 0, (size_t)marks * sizeof *mark);
    mask->words.count = count;
    mask->marks.count = marks;
    return OCC_SUCCESS;
}

static inline void occ_mask_set(occ_mask *mask, uint32_t slot)
{
    uint32_t word = slot / 32;
    ((uint32_t *)mask->words.data)[word] |= 1u << slot % 32;
    ((uint64_t *)mask->marks.data)[word / 64] |= (uint64_t)1 << word % 64;
}

// Lists the slots, ascending, for all of which there is room.
static inline void occ_mask_list(const occ_mask *mask, uint32_t *slots)
{
    const uint32_t *words = mask->words.data;
    const uint64_t *marks = mask->marks.data;
    for (uint32_t m = 0; m < mask->marks.count; m++)
        for (uint64_t left = marks[m]; left; left &= left - 1) {
            uint32_t w = 64 * m + (uint32_t)__builtin_ctzll(left);
            for (uint32_t bits = words[w]; bits; bits &= bits - 1)
                *slots++ = 32 * w + (uint32_t)__builtin_ctz(bits);
        }
}

#endif
