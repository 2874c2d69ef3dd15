// SPDX-License-Identifier: Apache-2.0
/// @file
/// What is told of the pictures that were compared.
#ifndef OCC_BENCH_IMAGE_REPORT_H
#define OCC_BENCH_IMAGE_REPORT_H

#include "image_run.h"

#include <stdio.h>

/// The names that a report speaks of.
typedef struct image_names {
    const char *method, *backend;
    uint32_t occluders;
} image_names;

/// Prints a table of a frame, its counts means and its times medians over all of them, and a last
/// line for programs. `*differing` is the number of pixels that differ. Returns false when memory
/// runs out.
bool image_print(const image_names *names, const image_wish *wish, const image_parts *parts,
                 const image_result *result, uint64_t *differing);

/// Writes a row for each frame.
void image_write_rows(FILE *stream, const image_names *names, const image_wish *wish,
                      const image_result *result);

#endif
