// SPDX-License-Identifier: Apache-2.0
// The property of every mini world: no method on any backend leaves out what can be seen, and all
// backends leave out the same.
#ifndef OCC_TEST_MINI_CHECK_H
#define OCC_TEST_MINI_CHECK_H

#include "mini.h"

enum { MINI_VIEWS = 3 };

// Those that are not to be asked are NULL.
typedef struct mini_views {
    occ_view *view[MINI_VIEWS]; // plain, OpenMP, OpenCL
    // What was asked so far, so that a test can demand that it was asked enough.
    struct {
        uint64_t worlds, refused; // refused: the library finds no eye in the matrix
        uint64_t objects, outside, hidden, judged;
    } count;
} mini_views;

// Plain and OpenMP, and OpenCL if `device` and there is one.
mini_views mini_open_views(bool device);
void mini_close_views(mini_views *views);

typedef struct mini_fault {
    char text[160]; // empty: none
} mini_fault;

// Whether the world breaks the property, and how. `fault` may be NULL.
bool mini_breaks(const mini *m, mini_views *views, mini_fault *fault);

#endif
