// SPDX-License-Identifier: Apache-2.0
#include "team.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>
#ifdef _OPENMP
#include <omp.h>
#ifndef __STDC_NO_THREADS__
#include <threads.h>
#else
#define thrd_yield() ((void)0)
#endif
#endif

#define STEP  ((uint64_t)1 << 32)
#define SPINS 200u // looks before a thread that waits lets others run

struct occ_team {
    // Steps so far, and in the low half how many parts of this one nobody has taken. Who takes one
    // may read `work` and `job` until it is done: they change only when all are.
    _Alignas(64) atomic_uint_least64_t ticket;
    _Alignas(64) atomic_uint_least32_t done; // parts of this step
    atomic_bool over;
    void (*work)(void *job, uint32_t part);
    void *job;
    uint32_t size;
};

uint32_t occ_team_size(const occ_team *team)
{
    return team ? team->size : 1;
}

uint32_t occ_threads_offered(uint32_t asked)
{
#ifdef _OPENMP
    if (!asked) asked = (uint32_t)omp_get_max_threads();
    return asked < OCC_MOST_THREADS ? asked : OCC_MOST_THREADS;
#else
    (void)asked;
    return 1;
#endif
}

#ifdef _OPENMP

// Takes a part and does it. False if none is left.
static bool do_one(occ_team *team)
{
    uint64_t ticket = atomic_load_explicit(&team->ticket, memory_order_acquire);
    do {
        if (!(uint32_t)ticket) return false;
    } while (!atomic_compare_exchange_weak_explicit(&team->ticket, &ticket, ticket - 1,
                                                    memory_order_acquire, memory_order_acquire));
    team->work(team->job, (uint32_t)ticket - 1);
    atomic_fetch_add_explicit(&team->done, 1, memory_order_release);
    return true;
}

void occ_wait_a_little(uint32_t *looks)
{
    if (++*looks % SPINS == 0) thrd_yield();
}

void occ_first_and_others(uint32_t threads, void (*first)(void *context),
                          void (*others)(void *context), void *context)
{
    if (threads < 2) {
        first(context);
        return;
    }
#pragma omp parallel default(none) shared(first, others, context) num_threads((int)threads)
    if (omp_get_thread_num()) {
        others(context);
    } else {
        first(context);
    }
}

typedef struct team_call {
    occ_team *team;
    void (*body)(occ_team *team, void *context);
    void *context;
} team_call;

static void take_parts(void *context)
{
    occ_team *team = ((team_call *)context)->team;
    uint32_t looks = 0;
    while (!atomic_load_explicit(&team->over, memory_order_acquire))
        if (!do_one(team)) occ_wait_a_little(&looks);
}

static void run_body(void *context)
{
    team_call *call = context;
    call->body(call->team, call->context);
    atomic_store_explicit(&call->team->over, true, memory_order_release);
}

void occ_with_team(uint32_t threads, void (*body)(occ_team *team, void *context), void *context)
{
    if (threads < 2) {
        body(NULL, context);
        return;
    }
    occ_team team = {.size = threads};
    team_call call = {&team, body, context};
    occ_first_and_others(threads, run_body, take_parts, &call);
}

// Hands out a step and takes part in it.
static void do_step(occ_team *team, uint32_t parts, void (*work)(void *job, uint32_t part),
                    void *job)
{
    uint64_t step = atomic_load_explicit(&team->ticket, memory_order_relaxed) + STEP;
    team->work = work;
    team->job = job;
    atomic_store_explicit(&team->done, 0, memory_order_relaxed);
    atomic_store_explicit(&team->ticket, step + parts, memory_order_release);
    while (do_one(team))
        ;
    uint32_t looks = 0;
    while (atomic_load_explicit(&team->done, memory_order_acquire) != parts)
        occ_wait_a_little(&looks);
}

#else

void occ_wait_a_little(uint32_t *looks)
{
    ++*looks;
}

void occ_first_and_others(uint32_t threads, void (*first)(void *context),
                          void (*others)(void *context), void *context)
{
    (void)threads;
    (void)others;
    first(context);
}

void occ_with_team(uint32_t threads, void (*body)(occ_team *team, void *context), void *context)
{
    (void)threads;
    body(NULL, context);
}

static void do_step(occ_team *team, uint32_t parts, void (*work)(void *job, uint32_t part),
                    void *job)
{
    (void)team;
    for (uint32_t part = 0; part < parts; part++)
        work(job, part);
}

#endif

void occ_do_parts(occ_team *team, uint32_t parts, void (*work)(void *job, uint32_t part), void *job)
{
    if (team && parts > 1) {
        do_step(team, parts, work, job);
        return;
    }
    for (uint32_t part = 0; part < parts; part++)
        work(job, part);
}
