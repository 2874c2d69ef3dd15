// SPDX-License-Identifier: Apache-2.0
/// @file
/// The version of the library. These three numbers are the only place it is written; CMake reads
/// them.
#ifndef OCCLUDE_VERSION_H
#define OCCLUDE_VERSION_H

#define OCC_VERSION_MAJOR 0
#define OCC_VERSION_MINOR 1
#define OCC_VERSION_PATCH 0

/// The version as one number that compares: 10000 * major + 100 * minor + patch.
#define OCC_VERSION (10000 * OCC_VERSION_MAJOR + 100 * OCC_VERSION_MINOR + OCC_VERSION_PATCH)

#endif
