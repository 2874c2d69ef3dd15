// SPDX-License-Identifier: Apache-2.0
/// @file
/// The first frame: how long a view that has seen nothing takes for a scene that nobody has culled.
#ifndef OCC_BENCH_MEASURE_FIRST_H
#define OCC_BENCH_MEASURE_FIRST_H

#include "measure.h"

/// The time of the first frame of the file in milliseconds, what is allocated for it included: the
/// median over so many scenes built one after the other, each culled once by a view of its own.
/// `settings` must be complete and of the library's own methods. False after a message.
bool measure_first_frame(const measure_settings *settings, const obs_scene *file, uint32_t scenes,
                         double *ms);

#endif
