// SPDX-License-Identifier: Apache-2.0
#define _POSIX_C_SOURCE 200809L
#include "team.h"

#include <stdatomic.h>
#include <stdbool.h>
#ifdef _OPENMP
#include <omp.h>
#include <pthread.h>
#include <sched.h>
#include <signal.h>
#include <unistd.h>
#endif

#define LIST  ((uint64_t)1 << 32)
#define SPINS 200u  // looks before a thread that waits lets others run
#define LOOKS 8000u // looks before one sleeps: some 50 us

#ifdef _OPENMP
// The threads beside the caller's, and where they sleep.
typedef struct helpers {
    pthread_t first; // leads the region in which all of them are
    pthread_mutex_t lock;
    pthread_cond_t wake;
    uint32_t asleep; // under the lock
    pid_t process;   // whose threads they are: a fork leaves them behind
    bool started;
} helpers;
#endif

struct occ_team {
    // Which list of items this is, and in the low half how many of it are taken. Who takes one may
    // read what it needs until the item is done.
    _Alignas(64) atomic_uint_least64_t ticket;
    _Alignas(64) atomic_uint_least32_t offered; // items that may be done
    _Alignas(64) atomic_uint_least32_t done;
    void (*work)(void *context, uint32_t item);
    void *context;
    uint32_t size;     // threads, the caller's included
    atomic_bool awake; // more may come at any time
    atomic_bool over;
#ifdef _OPENMP
    helpers others;
#endif
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

// Lets other threads run now and then.
static void wait_a_little(uint32_t *looks)
{
    ++*looks;
#ifdef _OPENMP
    if (*looks % SPINS == 0) sched_yield();
#endif
}

// Takes an item and does it. False if none is there. (A list that ends between two of these lines
// leaves another ticket behind.)
static bool do_item(occ_team *team)
{
    uint64_t ticket = atomic_load_explicit(&team->ticket, memory_order_acquire);
    do {
        if ((uint32_t)ticket >= atomic_load_explicit(&team->offered, memory_order_acquire)) {
            return false;
        }
    } while (!atomic_compare_exchange_weak_explicit(&team->ticket, &ticket, ticket + 1,
                                                    memory_order_acq_rel, memory_order_acquire));
    team->work(team->context, (uint32_t)ticket);
    atomic_fetch_add_explicit(&team->done, 1, memory_order_release);
    return true;
}

void occ_team_begin(occ_team *team, void (*work)(void *context, uint32_t item), void *context)
{
    uint64_t ticket = atomic_load_explicit(&team->ticket, memory_order_relaxed);
    atomic_store_explicit(&team->offered, 0, memory_order_relaxed);
    atomic_store_explicit(&team->done, 0, memory_order_relaxed);
    team->work = work;
    team->context = context;
    atomic_store_explicit(&team->ticket, (ticket & ~(LIST - 1)) + LIST, memory_order_release);
}

void occ_team_offer(occ_team *team, uint32_t count)
{
    if (team) atomic_store_explicit(&team->offered, count, memory_order_release);
}

void occ_team_settle(occ_team *team)
{
    if (!team) return;
    uint32_t looks = 0, offered = atomic_load_explicit(&team->offered, memory_order_relaxed);
    while (do_item(team))
        ;
    while (atomic_load_explicit(&team->done, memory_order_acquire) != offered)
        wait_a_little(&looks);
}

void occ_do_parts(occ_team *team, uint32_t parts, void (*work)(void *job, uint32_t part), void *job)
{
    if (team && team->size > 1 && parts > 1) {
        occ_team_begin(team, work, job);
        occ_team_offer(team, parts);
        occ_team_settle(team);
        return;
    }
    for (uint32_t part = 0; part < parts; part++)
        work(job, part);
}

#ifdef _OPENMP

// Until work comes, or the end. False: the end.
static bool sleep_until_called(occ_team *team)
{
    helpers *others = &team->others;
    pthread_mutex_lock(&others->lock);
    others->asleep++;
    while (!atomic_load(&team->awake) && !atomic_load(&team->over))
        pthread_cond_wait(&others->wake, &others->lock);
    others->asleep--;
    pthread_mutex_unlock(&others->lock);
    return !atomic_load(&team->over);
}

static void help(occ_team *team)
{
    uint32_t looks = 0;
    do {
        for (uint32_t idle = 0; idle < LOOKS; idle++) {
            if (do_item(team) || atomic_load_explicit(&team->awake, memory_order_relaxed)) idle = 0;
            wait_a_little(&looks);
        }
    } while (sleep_until_called(team));
}

static void *lead_others(void *context)
{
    occ_team *team = context;
#pragma omp parallel default(none) shared(team) num_threads((int)team->size - 1)
    help(team);
    return NULL;
}

// They get no signals: those are the program's.
static bool start_others(occ_team *team)
{
    helpers *others = &team->others;
    sigset_t all, before;
    *others = (helpers){.process = getpid()};
    if (pthread_mutex_init(&others->lock, NULL)) return false;
    if (pthread_cond_init(&others->wake, NULL)) {
        pthread_mutex_destroy(&others->lock);
        return false;
    }
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    others->started = !pthread_create(&others->first, NULL, lead_others, team);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (others->started) return true;
    pthread_cond_destroy(&others->wake);
    pthread_mutex_destroy(&others->lock);
    return false;
}

static void call_others(helpers *others)
{
    pthread_mutex_lock(&others->lock);
    if (others->asleep) pthread_cond_broadcast(&others->wake);
    pthread_mutex_unlock(&others->lock);
}

static bool has_others(const occ_team *team)
{
    return team->others.started && team->others.process == getpid();
}

static void end_others(occ_team *team)
{
    helpers *others = &team->others;
    if (!has_others(team)) return;
    atomic_store(&team->awake, false);
    atomic_store(&team->over, true);
    call_others(others);
    pthread_join(others->first, NULL);
    pthread_cond_destroy(&others->wake);
    pthread_mutex_destroy(&others->lock);
}

void occ_team_wake(occ_team *team)
{
    if (team->size < 2) return;
    atomic_store(&team->awake, true);
    if (has_others(team)) {
        call_others(&team->others);
    } else if (!start_others(team)) {
        team->size = 1; // alone, then
    }
}

#else

static void end_others(occ_team *team)
{
    (void)team;
}

void occ_team_wake(occ_team *team)
{
    (void)team;
}

#endif

void occ_team_rest(occ_team *team)
{
    atomic_store(&team->awake, false);
}

occ_result occ_team_create(occ_hooks *hooks, uint32_t threads, occ_team **team)
{
    *team = occ_alloc(hooks, sizeof **team);
    if (!*team) return OCC_ERROR_OUT_OF_MEMORY;
    **team = (occ_team){.size = threads};
    return OCC_SUCCESS;
}

void occ_team_destroy(occ_hooks *hooks, occ_team *team)
{
    if (!team) return;
    end_others(team);
    occ_free(hooks, team, sizeof *team);
}
