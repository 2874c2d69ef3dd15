// SPDX-License-Identifier: Apache-2.0
// Work in parts, on threads where there are any. The parts, and what each does, are a function of
// the work alone, so the number of threads cannot show.
//
// One OpenMP region holds a whole commit. Its first thread, the caller's, runs the body and hands
// out parts; the others only take parts. It waits for parts that are taken, never for a thread that
// has none: on a busy machine a thread that is not running holds up nobody.
#ifndef OCC_TEAM_H
#define OCC_TEAM_H

#include <stdint.h>

#define OCC_MOST_THREADS 1024u
#define OCC_MOST_PARTS   64u
#define OCC_PART_ITEMS   8192u // at least: less is not worth a thread's while

typedef struct occ_team occ_team;

// How many threads `asked` stands for; 0 asks OpenMP.
uint32_t occ_threads_offered(uint32_t asked);

// Runs body(team, context) in this thread, with `threads` - 1 others at hand. For one thread the
// team is NULL.
void occ_with_team(uint32_t threads, void (*body)(occ_team *team, void *context), void *context);

uint32_t occ_team_size(const occ_team *team);

// Does work(job, 0) to work(job, parts - 1), in any order and perhaps at the same time.
void occ_do_parts(occ_team *team, uint32_t parts, void (*work)(void *job, uint32_t part),
                  void *job);

// Runs first(context) in this thread and others(context) in `threads` - 1 more. Where there are
// none, only the first: it may not count on the others.
void occ_first_and_others(uint32_t threads, void (*first)(void *context),
                          void (*others)(void *context), void *context);

// For loops that wait: lets other threads run now and then.
void occ_wait_a_little(uint32_t *looks);

// Into how many parts `count` items are cut: 1 to OCC_MOST_PARTS.
static inline uint32_t occ_parts_of(uint32_t count)
{
    uint32_t parts = count / OCC_PART_ITEMS;
    return parts < 1 ? 1 : parts > OCC_MOST_PARTS ? OCC_MOST_PARTS : parts;
}

// Where a part of `count` items begins; it ends where the next one begins.
static inline uint32_t occ_part_first(uint32_t count, uint32_t parts, uint32_t part)
{
    return (uint32_t)((uint64_t)count * part / parts);
}

#endif
