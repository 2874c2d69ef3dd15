// SPDX-License-Identifier: Apache-2.0
/// @file
/// What device a view works on, and what this program was built with: for the first lines of
/// result tables.
#ifndef OCC_BENCH_BUILD_INFO_H
#define OCC_BENCH_BUILD_INFO_H

#include <occlude/cull.h>

#include <stdio.h>

/// Writes the name of the view's OpenCL device and its driver's version, or "none".
void build_info_device(const occ_view *view, char *text, size_t size);

/// Writes lines `# key=value`: cpu, compiler, flags, driver, commit.
void build_info_write(FILE *stream, const char *driver);

#endif
