// SPDX-License-Identifier: Apache-2.0
#include "log.h"

#include <stdarg.h>
#include <stdio.h>

#define OCC_LOG_LENGTH 1000

void occ_log(const occ_hooks *hooks, occ_log_level level, const char *format, ...)
{
    if (!hooks->logger.log) return;
    char line[OCC_LOG_LENGTH];
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    hooks->logger.log(level, line, hooks->logger.user_data);
}

occ_result occ_fail(const occ_hooks *hooks, occ_result result, const char *format, ...)
{
    if (!hooks->logger.log) return result;
    char reason[OCC_LOG_LENGTH];
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(reason, sizeof reason, format, arguments);
    va_end(arguments);
    occ_log(hooks, OCC_LOG_ERROR, "%s: %s", occ_result_name(result), reason);
    return result;
}
