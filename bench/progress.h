// SPDX-License-Identifier: Apache-2.0
/// @file
/// One line on standard error that tells how far long work has come, when that is a terminal.
#ifndef OCC_BENCH_PROGRESS_H
#define OCC_BENCH_PROGRESS_H

#include <stddef.h>

/// Begins a piece of work of `total` steps. `label` must outlive it.
void progress_begin(const char *label, size_t total);

/// Says that `done` steps are done. Cheap: redraws ten times a second at most.
void progress_step(size_t done);

/// Ends the work and clears the line.
void progress_end(void);

#endif
