// SPDX-License-Identifier: Apache-2.0
#define _POSIX_C_SOURCE 200809L
#include "progress.h"

#include "timing.h"

#include <stdbool.h>
#include <stdio.h>
#include <unistd.h>

static struct progress_state {
    const char *label;
    size_t total;
    double drawn; // when
    bool shown, is_terminal;
} progress;

void progress_begin(const char *label, size_t total)
{
    progress.label = label;
    progress.total = total;
    progress.drawn = timing_now();
    progress.shown = false;
    progress.is_terminal = isatty(STDERR_FILENO) == 1;
}

void progress_step(size_t done)
{
    if (!progress.is_terminal) return;
    double now = timing_now();
    if (now - progress.drawn < 100) return;
    progress.drawn = now;
    progress.shown = true;
    fprintf(stderr, "\r\033[K%s: %zu of %zu", progress.label, done, progress.total);
    fflush(stderr);
}

void progress_end(void)
{
    if (progress.shown) fputs("\r\033[K", stderr);
    progress.shown = false;
}
