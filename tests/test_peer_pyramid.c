// SPDX-License-Identifier: Apache-2.0
// labels: unit property
// The mip chain of the peers' depth buffer (peer_pyramid.h), against the buffer alone.
#include "kit.h"
#include "peer_pyramid.h"
#include "support.h"

// -----------------------------------------------------------------

// Whether the pixels around a rectangle are all as near as `depth`, without the chain.
static bool is_covered(const peer_level *level, const float rectangle[4], float depth)
{
    for (int y = 0; y < level->height; y++)
        for (int x = 0; x < level->width; x++) {
            float left = rectangle[0] * (float)level->width - 1,
                  low = rectangle[1] * (float)level->height - 1;
            float right = rectangle[2] * (float)level->width + 1,
                  high = rectangle[3] * (float)level->height + 1;
            bool within = (float)(x + 1) > left && (float)x <= right && (float)(y + 1) > low &&
                          (float)y <= high;
            if (within && level->depth[y * level->width + x] > depth) return false;
        }
    return true;
}

START_TEST(the_mip_chain_answers_as_the_buffer_alone_would)
{
    static const uint32_t sizes[][2] = {{13, 7},  {16, 8}, {1, 9}, {10, 1},
                                        {15, 11}, {1, 1},  {3, 14}};
    peer_pyramid pyramid;
    kit_random random = {.state = (uint64_t)_i + 1};
    ck_assert(peer_pyramid_open(&pyramid, sizes[_i][0], sizes[_i][1]));
    uint32_t counts[2] = {0, 0};
    for (int round = 0; round < 4000; round++) {
        peer_level *level = &pyramid.levels[0];
        for (int i = 0; i < level->width * level->height; i++)
            level->depth[i] = kit_below(&random, 50) == 0 ? 9 : 1;
        peer_pyramid_update(&pyramid);
        float rectangle[4];
        for (int k = 0; k < 2; k++) {
            float a = kit_between(&random, 0, 1), b = kit_between(&random, 0, 1);
            rectangle[k] = a < b ? a : b;
            rectangle[2 + k] = a < b ? b : a;
        }
        const float depth = round % 5 == 0 ? 9.0f : round % 5 == 1 ? 0.99f : 1.0f;
        bool expected = is_covered(level, rectangle, depth);
        counts[expected]++;
        ck_assert_int_eq(peer_pyramid_covers(&pyramid, rectangle, depth), expected);
    }
    ck_assert(counts[0] > 400 && counts[1] > 400);
    peer_pyramid_close(&pyramid);
}
END_TEST

int main(void)
{
    Suite *suite = suite_create("peer_pyramid");
    TCase *chain = tcase_create("chain");
    tcase_add_loop_test(chain, the_mip_chain_answers_as_the_buffer_alone_would, 0, 7);
    suite_add_tcase(suite, chain);
    return test_run_suite(suite);
}
