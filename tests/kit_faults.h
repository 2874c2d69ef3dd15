// SPDX-License-Identifier: Apache-2.0
// Allocations that fail, and frames that make none, for any backend.
#ifndef OCC_TEST_KIT_FAULTS_H
#define OCC_TEST_KIT_FAULTS_H

#include "kit.h"

// Runs a script of edits, commits and culls again and again; in each run another allocation fails,
// and if `keeps_failing` so do those after it until the call that they hit has returned. That call
// must say so, and go through when it is made again; what comes out must not differ. `step` 1 hits
// every allocation.
void kit_fail_every_allocation(occ_backend backend, bool keeps_failing, uint64_t step);

// Fails the test if a frame allocates whose like the view has seen before.
void kit_frames_allocate_nothing(occ_backend backend);

#endif
