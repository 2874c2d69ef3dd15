// SPDX-License-Identifier: Apache-2.0
// The text of the OpenCL kernels, embedded at build time by kernels/embed.cmake.
#ifndef OCC_KERNEL_SOURCES_H
#define OCC_KERNEL_SOURCES_H

#include <stddef.h>

struct occ_kernel_source {
    const char *name; // the file's own name, such as "test.cl"
    const char *text; // starts with #line, includes of sibling files blanked; ends with a zero
    size_t size;      // bytes of text, the zero not counted
};

// In the order in which they are handed to clCreateProgramWithSource.
extern const struct occ_kernel_source occ_kernel_sources[];
extern const unsigned occ_kernel_source_count;

#endif
