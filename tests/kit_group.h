// SPDX-License-Identifier: Apache-2.0
// A work-group on the host: its items are contexts of one thread, and each runs until it meets a
// barrier. What a kernel does then depends on nothing but the order of the items, which can be
// turned round: text that needs a barrier it lacks gives other answers.
#ifndef OCC_TEST_KIT_GROUP_H
#define OCC_TEST_KIT_GROUP_H

#include <stdbool.h>
#include <stdint.h>

enum { KIT_GROUP_ITEMS = 32 };

// Runs body(item, context) for all items. Fails the test if some meet a barrier that others do not.
void kit_group_run(void (*body)(uint32_t item, void *context), void *context, bool backwards);

// Where all items meet; `line` says which place that is.
void kit_group_barrier(int line);

#endif
