// SPDX-License-Identifier: Apache-2.0
#include "lanes.h"

#include "fusion.h"

extern const occ_lanes occ_lanes_plain;
#if OCC_LANES_X86
extern const occ_lanes occ_lanes_avx2;
extern const occ_lanes occ_lanes_avx512;
#endif

const occ_lanes *occ_lanes_get(uint32_t index)
{
    const occ_lanes *present[3];
    uint32_t count = 0;
#if OCC_LANES_X86
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512bw")) {
        present[count++] = &occ_lanes_avx512;
    }
    if (__builtin_cpu_supports("avx2")) present[count++] = &occ_lanes_avx2;
#endif
    present[count++] = &occ_lanes_plain;
    return index < count ? present[index] : NULL;
}

const occ_lanes *occ_lanes_choose(void)
{
    return occ_lanes_get(0);
}

void occ_wide_shadow_set(occ_wide_shadow *wide, const occ_shadow *shadow)
{
    *wide = (occ_wide_shadow){.owner = shadow->owner};
    for (uint32_t l = 0; l < OCC_PLANE_LANES; l++)
        wide->plane[3][l] = OCC_NO_PLANE_AT;
    wide->last[3] = OCC_NO_PLANE_AT;
    uint32_t silhouettes = occ_shadow_silhouettes(shadow);
    uint32_t first_face = silhouettes > OCC_FACE_LANE ? OCC_PLANE_LANES : OCC_FACE_LANE;
    for (uint32_t p = 0; p < shadow->planes; p++) {
        uint32_t lane = p < silhouettes ? p : first_face + p - silhouettes;
        wide->planes |= 1u << lane;
        wide->faces |= p < silhouettes ? 0u : 1u << lane;
        for (uint32_t j = 0; j < 4; j++)
            *(lane < OCC_PLANE_LANES ? &wide->plane[j][lane] : &wide->last[j]) =
                shadow->plane[p][j];
    }
}
