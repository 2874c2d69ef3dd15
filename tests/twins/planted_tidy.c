// SPDX-License-Identifier: Apache-2.0
// A null pointer that is followed, for clang-tidy to find.

#include <stdlib.h>

#ifdef twin_planted
#define MISSING(pointer) ((pointer) != NULL)
#else
#define MISSING(pointer) ((pointer) == NULL)
#endif

int planted_tidy(void);

int planted_tidy(void)
{
    int *numbers = calloc(4, sizeof *numbers);
    if (MISSING(numbers)) {
        free(numbers);
        return -1;
    }
    int first = numbers[0];
    free(numbers);
    return first;
}
