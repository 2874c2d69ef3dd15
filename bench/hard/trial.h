// SPDX-License-Identifier: Apache-2.0
/// @file
/// The exact truth of a family's world, and the library's answers held against it.
#ifndef OCC_HARD_TRIAL_H
#define OCC_HARD_TRIAL_H

#include "family.h"

/// What the exact judge says of an object.
typedef enum trial_fate {
    TRIAL_OUTSIDE, ///< No part of it is inside the clip planes.
    TRIAL_HIDDEN,  ///< The occluders of others hide together all that is inside.
    TRIAL_SEEN
} trial_fate;

/// How many signs the judge asked for, and how many of them needed exact integers.
typedef struct trial_effort {
    uint64_t signs, exact;
} trial_effort;

/// Judges every object of the world. `effort` is added to and may be NULL. False if the camera's
/// matrix is singular: then the library must refuse it too, and there is nothing to judge.
bool trial_judge(const family_world *world, trial_fate fates[FAMILY_OBJECTS], trial_effort *effort);

/// Answers, by what is true. A verdict is one object's answer by one method on one backend, judged
/// exactly. verdicts = outside + hidden + seen.
typedef struct trial_tally {
    uint64_t worlds, verdicts;
    uint64_t outside, hidden, seen; ///< What is true of them.
    uint64_t false_hidden;          ///< Seen, but reported hidden or outside: must stay 0.
    uint64_t missed;                ///< Hidden, but reported visible.
    uint64_t generous;              ///< Outside, but reported visible.
} trial_tally;

/// Adds `more` to `sum`.
void trial_add(trial_tally *sum, const trial_tally *more);

/// A backend that worlds are put before, one after the other. Like a view it belongs to one thread
/// at a time.
typedef struct trial_bench trial_bench;

/// NULL if there is no such backend or device. `threads` as in occ_view_desc.
trial_bench *trial_open(occ_backend backend, uint32_t threads);
void trial_close(trial_bench *bench);

/// Its view, to ask what device it is on.
const occ_view *trial_view(const trial_bench *bench);

/// Culls the world as `desc` says and adds to `tally`. False if the library refuses any of it or
/// memory runs out; trial_error() says what. With method FRUSTUM all that is hidden counts as
/// missed.
bool trial_run(trial_bench *bench, const family_world *world, const trial_fate *fates,
               const occ_cull_desc *desc, trial_tally *tally);

/// The latest answer: bit i is set where object i may be visible.
uint64_t trial_mask(const trial_bench *bench);

/// What the latest failure was, or OCC_SUCCESS.
occ_result trial_error(const trial_bench *bench);

/// Knobs that leave out no occluder, however small, and let the octree work on small worlds.
occ_cull_desc trial_knobs(occ_method method);

#endif
