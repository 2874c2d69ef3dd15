// SPDX-License-Identifier: Apache-2.0
/// @file
/// Files that appear whole or not at all: written beside their place, then renamed into it.
#ifndef OCC_BENCH_OUTFILE_H
#define OCC_BENCH_OUTFILE_H

#include <stdbool.h>
#include <stdio.h>

/// A file being written. Its final path stays untouched until outfile_commit().
typedef struct outfile {
    FILE *stream;    ///< Write here. NULL when nothing is open.
    char *path;      ///< Where it goes.
    char *temporary; ///< Where it is now; NULL for a device or pipe, which is written directly.
} outfile;

/// Opens `file` for `path`. On failure says why on standard error and returns false.
bool outfile_open(outfile *file, const char *path);

/// Closes and puts the file in its place. On failure says why and leaves nothing behind.
bool outfile_commit(outfile *file);

/// Closes and removes what was written. Does nothing to a file that is not open.
void outfile_abandon(outfile *file);

#endif
