// SPDX-License-Identifier: Apache-2.0
#include "build_info.h"

#include "commit_id.h"

#ifdef OCC_BENCH_OPENCL
#include <occlude/opencl.h>
#endif

#include <string.h>

void build_info_device(const occ_view *view, char *text, size_t size)
{
    snprintf(text, size, "none");
#ifdef OCC_BENCH_OPENCL
    cl_device_id device = occ_cl_view_device(view);
    char name[128] = "", driver[64] = "";
    if (!device) return;
    clGetDeviceInfo(device, CL_DEVICE_NAME, sizeof name, name, NULL);
    clGetDeviceInfo(device, CL_DRIVER_VERSION, sizeof driver, driver, NULL);
    name[sizeof name - 1] = driver[sizeof driver - 1] = '\0';
    snprintf(text, size, "%s, driver %s", name, driver);
#else
    (void)view;
#endif
}

static void find_cpu(char *text, size_t size)
{
    snprintf(text, size, "unknown");
    FILE *info = fopen("/proc/cpuinfo", "r");
    char line[256];
    while (info && fgets(line, sizeof line, info)) {
        char *value = strstr(line, ": ");
        if (strncmp(line, "model name", 10) != 0 || !value) continue;
        value[strcspn(value, "\n")] = '\0';
        snprintf(text, size, "%s", value + 2);
        break;
    }
    if (info) fclose(info);
}

void build_info_write(FILE *stream, const char *driver)
{
    char cpu[256];
    find_cpu(cpu, sizeof cpu);
#if defined(__clang__)
    const char *compiler = __VERSION__;
#elif defined(__GNUC__)
    const char *compiler = "gcc " __VERSION__;
#else
    const char *compiler = "unknown";
#endif
    fprintf(stream, "# cpu=%s\n# compiler=%s\n# flags=%s\n# driver=%s\n# commit=%s\n", cpu,
            compiler, OCC_BENCH_FLAGS, driver, OCC_BENCH_COMMIT);
}
