// SPDX-License-Identifier: Apache-2.0
// From a mini world that fails to a smaller and simpler one that fails too.
#ifndef OCC_TEST_MINI_SHRINK_H
#define OCC_TEST_MINI_SHRINK_H

#include "mini.h"

typedef bool mini_predicate(const mini *m, void *context);

// Every step that is taken lowers it: objects and occluders weigh most, then whatever of the camera
// is out of the ordinary, then the digits of all numbers.
uint64_t mini_cost(const mini *m);

// Shrinks a world for which `fails` is true, until no single step is left that keeps it so. Returns
// how often `fails` was asked.
unsigned mini_shrink(mini *m, mini_predicate *fails, void *context);

// Turns what fails into what a scene file can hold, as far as it still fails then. NULL, or what of
// it no file can hold.
const char *mini_shrink_for_file(mini *m, mini_predicate *fails, void *context);

#endif
