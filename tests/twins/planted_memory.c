// SPDX-License-Identifier: Apache-2.0
// A heap overflow, a leak and an undefined shift, for AddressSanitizer and
// UndefinedBehaviorSanitizer to find.

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int main(int argc, char **argv)
{
    const char *bug = argc > 1 ? argv[1] : "";
    volatile size_t index = strcmp(bug, "overflow") == 0 ? 4 : 3;
    volatile int shift = strcmp(bug, "shift") == 0 ? 32 : 31;
    int *numbers = calloc(4, sizeof *numbers);
    if (numbers == NULL) {
        return EXIT_FAILURE;
    }
    numbers[index] = 7;
    unsigned bit = 1u << shift;
    printf("%d %u\n", numbers[3], bit);
    if (strcmp(bug, "leak") == 0) {
        numbers = NULL;
    }
    free(numbers);
    return EXIT_SUCCESS;
}
