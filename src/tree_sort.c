// SPDX-License-Identifier: Apache-2.0
// Many entries are first split by the highest bits in which their keys differ, then the buckets are
// sorted one by one, in a cache's reach, from the lowest digit up. Each part of the entries is
// counted on its own and knows from the counts of all where its entries go, so the parts move at
// the same time and the order of equal keys stays.
#include "tree_sort.h"

#include <string.h>

#define FEW_ENTRIES  64u    // not worth counting
#define MANY_ENTRIES 16384u // worth splitting
#define SPLIT_BITS   11u    // of those that differ, that many split
#define MOST_BITS    14u    // with those between them that do not differ
#define MOST_BUCKETS (1u << MOST_BITS)
#define DIGIT_BITS   11u // at most, in a bucket
#define DIGITS       (1u << DIGIT_BITS)

// Some bits of a key: two runs of them, so that a stretch that all keys share can be left out.
typedef struct digit {
    uint64_t low_mask, high_mask; // of the shifted key
    uint32_t low_shift, high_shift;
} digit;

typedef struct sort_job {
    occ_tree_entry *entries, *spare;
    uint32_t (*places)[MOST_BUCKETS]; // for each part: where its next entry of a bucket goes
    uint64_t differ[OCC_MOST_PARTS];
    uint32_t count, parts;
    uint32_t shift, buckets; // of the highest bits
    uint32_t runs;           // of buckets
} sort_job;

static inline uint32_t digit_of(uint64_t key, digit d)
{
    return (uint32_t)((key >> d.low_shift & d.low_mask) | (key >> d.high_shift & d.high_mask));
}

static uint64_t differences(const occ_tree_entry *entries, uint32_t count, uint64_t key)
{
    uint64_t differ = 0;
    for (uint32_t i = 0; i < count; i++)
        differ |= entries[i].key ^ key;
    return differ;
}

// --- a bucket ------------------------------------------------------------------------------------

// Of bits that are not all 0.
static uint32_t lowest_bit(uint64_t bits)
{
    uint32_t bit = 0;
    while (bit < 63 && !(bits >> bit & 1u))
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
    *differ &= ~((d.high_mask >> low) << next);
    return d;
}

// One stable counting pass.
static void pass(const occ_tree_entry *from, occ_tree_entry *to, uint32_t count, digit d,
                 uint32_t digits)
{
    uint32_t place[DIGITS], sum = 0;
    memset(place, 0, digits * sizeof *place);
    for (uint32_t i = 0; i < count; i++)
        place[digit_of(from[i].key, d)]++;
    for (uint32_t b = 0; b < digits; b++) {
        uint32_t here = place[b];
        place[b] = sum;
        sum += here;
    }
    for (uint32_t i = 0; i < count; i++)
        to[place[digit_of(from[i].key, d)]++] = from[i];
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

// Sorts what lies in `from` into `result`, which is either `from` or `to`.
static void sort_bucket(occ_tree_entry *from, occ_tree_entry *to, occ_tree_entry *result,
                        uint32_t count)
{
    uint64_t differ = count > FEW_ENTRIES ? differences(from, count, from[0].key) : 0;
    uint32_t width = count < 8 * DIGITS ? DIGIT_BITS - 3 : DIGIT_BITS; // counting has a price too
    while (differ) {
        digit d = next_digit(&differ, width);
        pass(from, to, count, d, 1u << width);
        occ_tree_entry *swap = from;
        from = to;
        to = swap;
    }
    if (from != result) memcpy(result, from, (size_t)count * sizeof *result);
    if (count <= FEW_ENTRIES) insertion_sort(result, count);
}

// --- many entries --------------------------------------------------------------------------------

// One part to a thread: more would only be more to count.
static uint32_t parts_of(uint32_t count, const occ_team *team)
{
    uint32_t parts = occ_parts_of(count);
    return occ_team_size(team) < parts ? occ_team_size(team) : parts;
}

static void find_differences(void *context, uint32_t part)
{
    sort_job *job = context;
    uint32_t first = occ_part_first(job->count, job->parts, part);
    uint32_t end = occ_part_first(job->count, job->parts, part + 1);
    job->differ[part] = differences(job->entries + first, end - first, job->entries[0].key);
}

static inline uint32_t bucket_of(const sort_job *job, uint64_t key)
{
    return (uint32_t)(key >> job->shift) & (job->buckets - 1u);
}

static void count_part(void *context, uint32_t part)
{
    const sort_job *job = context;
    uint32_t *count = job->places[part];
    memset(count, 0, job->buckets * sizeof *count);
    uint32_t end = occ_part_first(job->count, job->parts, part + 1);
    for (uint32_t i = occ_part_first(job->count, job->parts, part); i < end; i++)
        count[bucket_of(job, job->entries[i].key)]++;
}

static void move_part(void *context, uint32_t part)
{
    const sort_job job = *(const sort_job *)context;
    uint32_t *place = job.places[part];
    uint32_t end = occ_part_first(job.count, job.parts, part + 1);
    for (uint32_t i = occ_part_first(job.count, job.parts, part); i < end; i++)
        job.spare[place[bucket_of(&job, job.entries[i].key)]++] = job.entries[i];
}

// Turns the counts into the places where each part's entries of each bucket begin.
static void find_places(const sort_job *job)
{
    uint32_t sum = 0;
    for (uint32_t b = 0; b < job->buckets; b++)
        for (uint32_t part = 0; part < job->parts; part++) {
            uint32_t here = job->places[part][b];
            job->places[part][b] = sum;
            sum += here;
        }
}

// Chooses the highest bits in which the keys differ.
static void choose_buckets(sort_job *job, uint64_t differ)
{
    uint32_t top = 0, bits = 0, taken = 0;
    while (top < 64 && differ >> top)
        top++;
    while (bits < top && bits < MOST_BITS && taken < SPLIT_BITS)
        taken += (uint32_t)(differ >> (top - ++bits)) & 1u;
    job->shift = top - bits;
    job->buckets = 1u << bits;
}

// Sorts the buckets that begin in a run. After the move, the last part's place for a bucket is
// where the bucket ends.
static void sort_part(void *context, uint32_t part)
{
    const sort_job *job = context;
    const uint32_t *ends = job->places[job->parts - 1];
    uint32_t first = occ_part_first(job->count, job->runs, part);
    uint32_t last = occ_part_first(job->count, job->runs, part + 1);
    for (uint32_t b = 0, begin = 0; b < job->buckets && begin < last; begin = ends[b++])
        if (begin >= first && ends[b] > begin) {
            sort_bucket(job->spare + begin, job->entries + begin, job->entries + begin,
                        ends[b] - begin);
        }
}

size_t occ_tree_sort_room(uint32_t count, const occ_team *team)
{
    size_t places = (size_t)parts_of(count, team) * MOST_BUCKETS * sizeof(uint32_t);
    size_t spare = count <= FEW_ENTRIES ? 0 : (size_t)count * sizeof(occ_tree_entry);
    return count < MANY_ENTRIES ? spare : spare + places;
}

void occ_tree_sort(occ_tree_entry *entries, void *room, uint32_t count, occ_team *team)
{
    if (count < MANY_ENTRIES) {
        sort_bucket(entries, room, entries, count);
        return;
    }
    sort_job job = {.entries = entries, .spare = room, .count = count};
    job.parts = parts_of(count, team);
    job.places = (void *)(job.spare + count);
    occ_do_parts(team, job.parts, find_differences, &job);
    uint64_t differ = 0;
    for (uint32_t part = 0; part < job.parts; part++)
        differ |= job.differ[part];
    choose_buckets(&job, differ);
    occ_do_parts(team, job.parts, count_part, &job);
    find_places(&job);
    occ_do_parts(team, job.parts, move_part, &job);
    job.runs = team ? occ_parts_of(count) : 1;
    occ_do_parts(team, job.runs, sort_part, &job);
}
