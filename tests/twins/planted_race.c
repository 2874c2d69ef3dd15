// SPDX-License-Identifier: Apache-2.0
// Threads that add to one number without a reduction, for ThreadSanitizer to find. The clean half
// shows that OpenMP's own synchronisation raises no alarm.

#include <stdio.h>
#include <string.h>

static long sum_clean(long count)
{
    long sum = 0;
#pragma omp parallel for num_threads(4) default(none) shared(count) reduction(+ : sum)
    for (long i = 0; i < count; i++) {
        sum += i;
    }
    return sum;
}

static long sum_racing(long count)
{
    long sum = 0;
#pragma omp parallel for num_threads(4) default(none) shared(count, sum)
    for (long i = 0; i < count; i++) {
        sum += i;
    }
    return sum;
}

int main(int argc, char **argv)
{
    int planted = argc > 1 && strcmp(argv[1], "race") == 0;
    printf("%ld\n", planted ? sum_racing(1000) : sum_clean(1000));
    return 0;
}
