// SPDX-License-Identifier: Apache-2.0
// A null pointer that is followed, and a size taken of a pointer, for clang-tidy to find.

#include <stdlib.h>
#include <string.h>

int *planted_tidy(const int *from);

int *planted_tidy(const int *from)
{
    int *copy = malloc(4 * sizeof *copy);
#ifdef twin_planted
    memcpy(copy, from, sizeof copy);
    copy[0] = 1;
#else
    if (copy != NULL) {
        memcpy(copy, from, 4 * sizeof *copy);
    }
#endif
    return copy;
}
