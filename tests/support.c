// SPDX-License-Identifier: Apache-2.0
#define _POSIX_C_SOURCE 200809L

#include "support.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#ifdef OCC_HAVE_OPENCL
#define CL_TARGET_OPENCL_VERSION 120
#include <CL/cl.h>
#endif

// PoCL keeps its compiler's memory to the end of a process that compiled something, which it does
// once for each kernel and machine: the first run would leak, and the second would not.
__attribute__((visibility("default"))) const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void)
{
    return "leak:libpocl\nleak:libLLVM\n";
}

int test_run_suite(Suite *suite)
{
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}

#ifdef OCC_HAVE_OPENCL
static bool has_device(void)
{
    cl_platform_id platforms[16];
    cl_uint count = 0;
    if (clGetPlatformIDs(16, platforms, &count) != CL_SUCCESS) {
        return false;
    }
    for (cl_uint i = 0; i < count && i < 16; i++) {
        cl_uint devices = 0;
        if (clGetDeviceIDs(platforms[i], CL_DEVICE_TYPE_ALL, 0, NULL, &devices) == CL_SUCCESS &&
            devices > 0) {
            return true;
        }
    }
    return false;
}
#else
static bool has_device(void)
{
    return false;
}
#endif

static bool is_set(const char *name)
{
    const char *value = getenv(name);
    return value != NULL && value[0] != '\0' && strcmp(value, "0") != 0 &&
           strcmp(value, "false") != 0;
}

bool test_must_have_device(void)
{
    return is_set("CI") || is_set("OCC_REQUIRE_OPENCL");
}

int test_skip_unless(bool (*present)(void), const char *what, const char *variable)
{
    pid_t child = fork();
    if (child == 0) {
        _exit(present() ? 0 : 1);
    }
    int status = 0;
    if (child > 0 && waitpid(child, &status, 0) == child && status == 0) {
        return 0;
    }
    fprintf(stderr, "no %s\n", what);
    return is_set("CI") || is_set(variable) ? EXIT_FAILURE : 77;
}

int test_skip_without_device(void)
{
    return test_skip_unless(has_device, "OpenCL device", "OCC_REQUIRE_OPENCL");
}
