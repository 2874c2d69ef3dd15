// SPDX-License-Identifier: Apache-2.0
#define _XOPEN_SOURCE 700
#include "kit_group.h"

#include <check.h>
#include <ucontext.h>

enum { STACK_BYTES = 64 * 1024 };

static struct {
    ucontext_t host, item[KIT_GROUP_ITEMS];
    unsigned char stack[KIT_GROUP_ITEMS][STACK_BYTES];
    void (*body)(uint32_t item, void *context);
    void *context;
    uint32_t running;
    int line[KIT_GROUP_ITEMS]; // of the barrier that it waits at; 0 once it has ended
} group;

void kit_group_barrier(int line)
{
    uint32_t item = group.running;
    group.line[item] = line;
    (void)swapcontext(&group.item[item], &group.host);
}

static void run_item(void)
{
    uint32_t item = group.running;
    group.body(item, group.context);
    group.line[item] = 0;
}

static void start_item(uint32_t item)
{
    ck_assert_int_eq(getcontext(&group.item[item]), 0);
    group.item[item].uc_stack.ss_sp = group.stack[item];
    group.item[item].uc_stack.ss_size = STACK_BYTES;
    group.item[item].uc_link = &group.host;
    makecontext(&group.item[item], run_item, 0);
}

// Lets every item run to its next barrier. Whether there is one.
static bool run_round(bool backwards)
{
    for (uint32_t i = 0; i < KIT_GROUP_ITEMS; i++) {
        group.running = backwards ? KIT_GROUP_ITEMS - 1 - i : i;
        ck_assert_int_eq(swapcontext(&group.host, &group.item[group.running]), 0);
    }
    for (uint32_t i = 1; i < KIT_GROUP_ITEMS; i++)
        ck_assert_msg(group.line[i] == group.line[0],
                      "item %u is at line %d, and the first at line %d", i, group.line[i],
                      group.line[0]);
    return group.line[0] != 0;
}

void kit_group_run(void (*body)(uint32_t item, void *context), void *context, bool backwards)
{
    group.body = body;
    group.context = context;
    for (uint32_t i = 0; i < KIT_GROUP_ITEMS; i++)
        start_item(i);
    while (run_round(backwards)) {
        // the order changes from barrier to barrier in neither run
    }
}
