// SPDX-License-Identifier: Apache-2.0
#ifndef OCC_LOG_H
#define OCC_LOG_H

#include "memory.h"

#ifdef __GNUC__
#define OCC_PRINTF(at, first) __attribute__((format(printf, at, first)))
#else
#define OCC_PRINTF(at, first)
#endif

// One line to the logger, if there is one; cut off at 1,000 characters.
OCC_PRINTF(3, 4) void occ_log(const occ_hooks *hooks, occ_log_level level, const char *format, ...);

// Logs the reason of a failure as "NAME: reason" and returns `result`.
OCC_PRINTF(3, 4)
occ_result occ_fail(const occ_hooks *hooks, occ_result result, const char *format, ...);

#endif
