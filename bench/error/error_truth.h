// SPDX-License-Identifier: Apache-2.0
/// @file
/// The truth of a scene for `occlude-bench error`: sampled once, then kept in a file.
#ifndef OCC_BENCH_ERROR_TRUTH_H
#define OCC_BENCH_ERROR_TRUTH_H

#include "obs.h"
#include "truth_file.h"

/// Where truths are kept, and how many samples wide and high they are.
typedef struct error_truths {
    const char *folder;
    uint32_t width, height;
} error_truths;

/// The truth at frames 0, 20 and 40, as far as the scene has them. Taken from
/// FOLDER/NAME-IDENTITY.tru if that is there, else sampled and put there. False after a message.
bool error_truth(const error_truths *truths, const char *name, const obs_scene *scene,
                 truth_result *truth);

/// The same verdicts for a scene that was cut down to the truth's frames. It borrows the verdicts:
/// free its `frames`, nothing else. False when memory runs out.
bool error_truth_cut(const truth_result *truth, truth_result *part);

#endif
