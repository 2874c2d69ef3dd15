// SPDX-License-Identifier: Apache-2.0
// A radix sort from the lowest digit up. Each part of the entries is counted on its own, and knows
// from the counts of all where its entries go, so the parts move at the same time and the order of
// equal keys stays.
#include "tree_sort.h"

#include "threads.h"

#include <string.h>

#define DIGIT_BITS  11u
#define BUCKETS     (1u << DIGIT_BITS)
#define FEW_ENTRIES 64u

// Some bits of a key: two runs of them, so that a stretch that all keys share can be left out.
typedef struct digit {
    uint64_t low_mask, high_mask; // of the shifted key
    uint32_t low_shift, high_shift;
} digit;

typedef struct sort_job {
    occ_tree_entry *from, *to;
    uint32_t (*places)[BUCKETS]; // for each part
    uint64_t differ[OCC_MOST_PARTS];
    uint32_t count, parts;
    digit digit;
} sort_job;

static inline uint32_t digit_of(uint64_t key, digit d)
{
    return (uint32_t)((key >> d.low_shift & d.low_mask) | (key >> d.high_shift & d.high_mask));
}

// One part to a thread: more would only be more to count.
static uint32_t parts_of(uint32_t count, uint32_t threads)
{
    uint32_t parts = occ_parts_of(count);
    return threads < parts ? threads : parts;
}

// --- what the digits are -------------------------------------------------------------------------

static void find_differences(void *context, uint32_t part)
{
    sort_job *job = context;
    uint64_t differ = 0, first = job->from[0].key;
    uint32_t end = occ_part_first(job->count, job->parts, part + 1);
    for (uint32_t i = occ_part_first(job->count, job->parts, part); i < end; i++)
        differ |= job->from[i].key ^ first;
    job->differ[part] = differ;
}

static uint32_t lowest_bit(uint64_t bits)
{
    uint32_t bit = 0;
    while (!(bits >> bit & 1u))
        bit++;
    return bit;
}

// The lowest `width` bits of those that differ, or more where the bits that do not are few. Takes
// them out of `differ`.
static digit next_digit(uint64_t *differ, uint32_t width)
{
    digit d = {.low_shift = lowest_bit(*differ)};
    uint32_t low = 0;
    while (low < width && *differ >> d.low_shift >> low & 1u)
        low++;
    d.low_mask = ((uint64_t)1 << low) - 1u;
    *differ &= ~(d.low_mask << d.low_shift);
    if (low == width || !*differ) return d;
    uint32_t next = lowest_bit(*differ); // above the low run, and not right above it
    d.high_shift = next - low;
    d.high_mask = (((uint64_t)1 << width) - 1u) & ~d.low_mask;
    *differ &= ~(d.high_mask << d.high_shift);
    return d;
}

// --- a pass --------------------------------------------------------------------------------------

static void count_part(void *context, uint32_t part)
{
    const sort_job *job = context;
    const occ_tree_entry *from = job->from;
    const digit d = job->digit;
    uint32_t *count = job->places[part];
    memset(count, 0, sizeof job->places[part]);
    uint32_t end = occ_part_first(job->count, job->parts, part + 1);
    for (uint32_t i = occ_part_first(job->count, job->parts, part); i < end; i++)
        count[digit_of(from[i].key, d)]++;
}

static void move_part(void *context, uint32_t part)
{
    const sort_job *job = context;
    const occ_tree_entry *from = job->from;
    const digit d = job->digit;
    occ_tree_entry *to = job->to;
    uint32_t *place = job->places[part];
    uint32_t end = occ_part_first(job->count, job->parts, part + 1);
    for (uint32_t i = occ_part_first(job->count, job->parts, part); i < end; i++)
        to[place[digit_of(from[i].key, d)]++] = from[i];
}

// Turns the counts into the places where each part's entries of each digit begin.
static void find_places(const sort_job *job)
{
    uint32_t sum = 0;
    for (uint32_t b = 0; b < BUCKETS; b++)
        for (uint32_t part = 0; part < job->parts; part++) {
            uint32_t here = job->places[part][b];
            job->places[part][b] = sum;
            sum += here;
        }
}

static void pass(sort_job *job, uint32_t threads)
{
    occ_do_parts(threads, job->parts, count_part, job);
    find_places(job);
    occ_do_parts(threads, job->parts, move_part, job);
    occ_tree_entry *swap = job->from;
    job->from = job->to;
    job->to = swap;
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

size_t occ_tree_sort_room(uint32_t count, uint32_t threads)
{
    size_t places = (size_t)parts_of(count, threads) * BUCKETS * sizeof(uint32_t);
    return count <= FEW_ENTRIES ? 0 : (size_t)count * sizeof(occ_tree_entry) + places;
}

void occ_tree_sort(occ_tree_entry *entries, void *room, uint32_t count, uint32_t threads)
{
    if (count <= FEW_ENTRIES) {
        insertion_sort(entries, count);
        return;
    }
    sort_job job = {.from = entries, .to = room, .count = count};
    job.parts = parts_of(count, threads);
    job.places = (void *)(job.to + count);
    occ_do_parts(threads, job.parts, find_differences, &job);
    uint64_t differ = 0;
    for (uint32_t part = 0; part < job.parts; part++)
        differ |= job.differ[part];
    uint32_t bits = 0;
    for (uint64_t left = differ; left; left &= left - 1)
        bits++;
    uint32_t digits = (bits + DIGIT_BITS - 1) / DIGIT_BITS;
    while (differ) {
        job.digit = next_digit(&differ, (bits + digits - 1) / digits);
        pass(&job, threads);
    }
    if (job.from != entries) memcpy(entries, job.from, (size_t)count * sizeof *entries);
}
