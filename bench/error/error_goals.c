// SPDX-License-Identifier: Apache-2.0
#include "error_goals.h"

#include <inttypes.h>
#include <stdio.h>

const error_goal error_goals[] = {
    {{"seedscene_1000", "seedscene", 1, 1000, true, false}, 0.09, 0.3},
    {{"seedscene_10000", "seedscene", 1, 10000, true, false}, 0.07, 0.2},
    {{"seedscene_100000", "seedscene", 1, 100000, false, false}, 0.06, 0.02},
    {{"city_1000", "city", 2, 1000, true, false}, 0.02, 1.9},
    {{"city_10000", "city", 2, 10000, true, false}, 0.06, 1.4},
    {{"city_100000", "city", 2, 100000, false, false}, 0.27, 1.0},
    {{"city_1000000", "city", 2, 1000000, false, false}, 0.5, 0.8},
    {{"forest_100000", "forest", 3, 100000, false, false}, 0.45, 0.1},
    {{"soup_100000", "soup", 4, 100000, false, false}, 0.85, 0.35},
    {{"interior_10000", "interior", 5, 10000, true, false}, 0, 0},
    {{NULL, NULL, 0, 0, false, false}, 0, 0}};

const struct error_limits error_limits = {.worst_frame = 4,
                                          .speed_up = 1.35,
                                          .speed_up_above_ms = 0.25,
                                          .city_growth = 10,
                                          .city_build_ms = 80};

// Settings may have been chosen on the scenes with goals: these are of no scene they were chosen
// on.
static const uint64_t other_seeds[ERROR_VARIANTS - 1] = {11, 12};

error_source error_goal_source(const error_goal *goal, int variant, char name[64])
{
    error_source source = goal->source;
    if (variant == 0) {
        snprintf(name, 64, "%s", source.name);
    } else {
        source.seed = other_seeds[variant - 1];
        snprintf(name, 64, "%s_seed%" PRIu64, source.name, source.seed);
    }
    source.name = name;
    return source;
}
