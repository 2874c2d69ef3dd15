// SPDX-License-Identifier: Apache-2.0
// What the main function of a test program needs.
#ifndef OCC_TEST_SUPPORT_H
#define OCC_TEST_SUPPORT_H

#include <check.h>
#include <stdbool.h>

// Runs the suite, or the case of it that CK_RUN_CASE names. Returns what main is to return.
int test_run_suite(Suite *suite);

// Whether OCC_REQUIRE_OPENCL=1 or CI is set.
bool test_must_have_device(void);

// 0 if present() holds; otherwise says that there is no such thing and returns what main is to
// return: 77, which ctest counts as skipped, or 1 where the variable or CI is set to 1 and a skip
// would hide that nothing was tested. The look happens in a process of its own: a driver that has
// started its threads does not survive the fork that Check makes for every test.
int test_skip_unless(bool (*present)(void), const char *what, const char *variable);

// The same for an OpenCL device, with OCC_REQUIRE_OPENCL.
int test_skip_without_device(void);

#endif
