// SPDX-License-Identifier: Apache-2.0
// Linked in front of the library's own choice of an instruction set (the linker's --wrap): views
// take the one that OCC_BENCH_LANES names. For comparing them; what they answer is the same.
#include "lanes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const occ_lanes *__wrap_occ_lanes_choose(void);

const occ_lanes *__wrap_occ_lanes_choose(void)
{
    const occ_lanes *lanes;
    for (uint32_t i = 0; (lanes = occ_lanes_get(i)) != NULL; i++)
        if (strcmp(lanes->name, OCC_BENCH_LANES) == 0) return lanes;
    fputs("occlude-bench: this processor has no " OCC_BENCH_LANES "\n", stderr);
    exit(1);
}
