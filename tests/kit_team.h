// SPDX-License-Identifier: Apache-2.0
// A team of threads for the length of a call.
#ifndef OCC_TEST_KIT_TEAM_H
#define OCC_TEST_KIT_TEAM_H

#include "kit.h"
#include "team.h"

static inline void kit_with_team(uint32_t threads, void (*body)(occ_team *team, void *context),
                                 void *context)
{
    occ_hooks hooks;
    occ_team *team;
    KIT_CHECK(!occ_hooks_init(&hooks, &(occ_allocator){0}, &(occ_logger){0}), "no hooks");
    KIT_CHECK(!occ_team_create(&hooks, threads, &team), "no team");
    occ_team_wake(team);
    body(team, context);
    occ_team_rest(team);
    occ_team_destroy(&hooks, team);
}

#endif
