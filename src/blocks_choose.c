// SPDX-License-Identifier: Apache-2.0
#include "blocks.h"

#include <stddef.h>

extern const occ_blocks occ_blocks_plain;
#if OCC_LANES_X86
extern const occ_blocks occ_blocks_avx2;
extern const occ_blocks occ_blocks_avx512;
#endif

const occ_blocks *occ_blocks_get(uint32_t index)
{
    const occ_blocks *present[3];
    uint32_t count = 0;
#if OCC_LANES_X86
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw")) {
        present[count++] = &occ_blocks_avx512;
    }
    if (__builtin_cpu_supports("avx2")) present[count++] = &occ_blocks_avx2;
#endif
    present[count++] = &occ_blocks_plain;
    return index < count ? present[index] : NULL;
}

const occ_blocks *occ_blocks_choose(void)
{
    return occ_blocks_get(0);
}
