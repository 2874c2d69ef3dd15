// SPDX-License-Identifier: Apache-2.0
#include "threads.h"

#ifdef _OPENMP
#include <omp.h>
#endif

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

void occ_do_parts(uint32_t threads, uint32_t parts, void (*work)(void *job, uint32_t part),
                  void *job)
{
#ifdef _OPENMP
    int team = (int)(threads < parts ? threads : parts);
#pragma omp parallel for default(none) shared(parts, work, job) num_threads(team)                  \
    schedule(dynamic, 1) if (team > 1)
#else
    (void)threads;
#endif
    for (uint32_t part = 0; part < parts; part++)
        work(job, part);
}
