// SPDX-License-Identifier: Apache-2.0
// Threads that help the one that calls, for as long as a scene or a view lives. What is done is cut
// into items; what an item does is a function of the item alone, so neither the number of threads
// nor their pace can show.
//
// The caller does items as well, and waits for those that others have begun, never for a thread
// that has none: on a busy machine a thread that does not run holds up nobody. (At the end of an
// OpenMP region all threads wait for each other, which there costs a time slice; so the helpers
// stay in one region of their own, and sleep when nothing has come for a while.)
#ifndef OCC_TEAM_H
#define OCC_TEAM_H

#include "memory.h"

#define OCC_MOST_THREADS 1024u
#define OCC_MOST_PARTS   64u
#define OCC_PART_ITEMS   8192u // at least: less is not worth a thread's while

typedef struct occ_team occ_team;

// How many threads `asked` stands for; 0 asks OpenMP.
uint32_t occ_threads_offered(uint32_t asked);

// Makes a team of so many threads, 1 at least. The others start when there is something to do.
occ_result occ_team_create(occ_hooks *hooks, uint32_t threads, occ_team **team);

// NULL is accepted.
void occ_team_destroy(occ_hooks *hooks, occ_team *team);

// Between these two calls the others look for items. What lies between must be worth a thread's
// while; without them the caller does all alone.
void occ_team_wake(occ_team *team);
void occ_team_rest(occ_team *team);

// Begins a list of items. work(context, i) will be called once for every item offered, in any order
// and perhaps at the same time.
void occ_team_begin(occ_team *team, void (*work)(void *context, uint32_t item), void *context);

// Says that items below `count` may be done. A team that is NULL is accepted, as below.
void occ_team_offer(occ_team *team, uint32_t count);

// Takes part until all that was offered is done. Until the next offer, what work() reads may be
// changed.
void occ_team_settle(occ_team *team);

// Does work(job, 0) to work(job, parts - 1).
void occ_do_parts(occ_team *team, uint32_t parts, void (*work)(void *job, uint32_t part),
                  void *job);

uint32_t occ_team_size(const occ_team *team);

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
