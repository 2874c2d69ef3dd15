// SPDX-License-Identifier: Apache-2.0
#ifndef OCC_KNOBS_H
#define OCC_KNOBS_H

#include "log.h"

#include <occlude/cull.h>

// The knobs of a frame: the caller's, and what its preset says for those that are left 0. `desc`
// may be NULL. On failure the log says which knob is wrong.
occ_result occ_knobs_init(occ_cull_desc *knobs, const occ_cull_desc *desc, const occ_hooks *hooks);

#endif
