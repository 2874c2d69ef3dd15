// SPDX-License-Identifier: Apache-2.0
#include "cl_device.h"

#include "kernel_sources.h"
#include "log.h"
#include <string.h>

#define MOST_PLATFORMS 16u
#define MOST_DEVICES   16u
#define MOST_SOURCES   16u

// What a loader without any platform answers (cl_khr_icd).
#define PLATFORM_NOT_FOUND (-1001)

occ_result occ_cl_fail(const occ_hooks *hooks, cl_int error, const char *call)
{
    occ_result result = OCC_ERROR_DEVICE;
    if (error == CL_OUT_OF_RESOURCES || error == CL_OUT_OF_HOST_MEMORY ||
        error == CL_MEM_OBJECT_ALLOCATION_FAILURE) {
        result = OCC_ERROR_OUT_OF_MEMORY;
    }
    return occ_fail(hooks, result, "%s returned %d", call, (int)error);
}

// The first device of a type on any platform, or NULL. A platform that fails is passed over.
static cl_device_id find_device(const occ_hooks *hooks, const cl_platform_id *platforms,
                                cl_uint count, cl_device_type type)
{
    for (cl_uint p = 0; p < count; p++) {
        cl_device_id devices[MOST_DEVICES];
        cl_uint found = 0;
        cl_int error = clGetDeviceIDs(platforms[p], type, MOST_DEVICES, devices, &found);
        if (!error && found) return devices[0];
        if (error && error != CL_DEVICE_NOT_FOUND) {
            occ_log(hooks, OCC_LOG_WARNING, "platform %u: clGetDeviceIDs returned %d", p,
                    (int)error);
        }
    }
    return NULL;
}

static occ_result choose_device(occ_cl_device *device, const occ_hooks *hooks)
{
    cl_platform_id platforms[MOST_PLATFORMS];
    cl_uint count = 0;
    cl_int error = clGetPlatformIDs(MOST_PLATFORMS, platforms, &count);
    if (error && error != PLATFORM_NOT_FOUND) return occ_cl_fail(hooks, error, "clGetPlatformIDs");
    if (error || !count) return occ_fail(hooks, OCC_ERROR_NO_DEVICE, "no OpenCL platform is there");
    if (count > MOST_PLATFORMS) count = MOST_PLATFORMS;
    device->id = find_device(hooks, platforms, count, CL_DEVICE_TYPE_GPU);
    if (!device->id) device->id = find_device(hooks, platforms, count, CL_DEVICE_TYPE_ALL);
    if (device->id) return OCC_SUCCESS;
    return occ_fail(hooks, OCC_ERROR_NO_DEVICE, "%u OpenCL platforms, but none has a device",
                    count);
}

static occ_result use_queue(occ_cl_device *device, const occ_hooks *hooks, cl_command_queue queue)
{
    cl_int error = clRetainCommandQueue(queue);
    if (error) return occ_cl_fail(hooks, error, "clRetainCommandQueue");
    device->queue = queue;
    error = clGetCommandQueueInfo(queue, CL_QUEUE_DEVICE, sizeof device->id, &device->id, NULL);
    if (error) return occ_cl_fail(hooks, error, "clGetCommandQueueInfo");
    error =
        clGetCommandQueueInfo(queue, CL_QUEUE_CONTEXT, sizeof(cl_context), &device->context, NULL);
    if (!error) error = clRetainContext(device->context);
    if (!error) return OCC_SUCCESS;
    device->context = NULL;
    return occ_cl_fail(hooks, error, "clGetCommandQueueInfo or clRetainContext");
}

static occ_result use_context(occ_cl_device *device, const occ_hooks *hooks, cl_context context)
{
    cl_int error = CL_SUCCESS;
    if (context) {
        error = clRetainContext(context);
        if (error) return occ_cl_fail(hooks, error, "clRetainContext");
        device->context = context;
    } else {
        device->context = clCreateContext(NULL, 1, &device->id, NULL, NULL, &error);
        if (error) return occ_cl_fail(hooks, error, "clCreateContext");
    }
    device->queue = clCreateCommandQueue(device->context, device->id, 0, &error);
    return error ? occ_cl_fail(hooks, error, "clCreateCommandQueue") : OCC_SUCCESS;
}

// The compiler's own words, a line of the log at a time at most 1,000 characters long.
static void log_build(const occ_cl_device *device, occ_hooks *hooks)
{
    size_t size = 0;
    cl_int error =
        clGetProgramBuildInfo(device->program, device->id, CL_PROGRAM_BUILD_LOG, 0, NULL, &size);
    char *text = error || !size ? NULL : occ_alloc(hooks, size + 1);
    if (!text) return;
    text[size] = 0;
    error =
        clGetProgramBuildInfo(device->program, device->id, CL_PROGRAM_BUILD_LOG, size, text, NULL);
    for (char *line = text; !error && *line;) {
        size_t length = 0;
        while (line[length] && line[length] != '\n')
            length++;
        if (length) occ_log(hooks, OCC_LOG_ERROR, "%.*s", (int)length, line);
        line += length + (line[length] == '\n');
    }
    occ_free(hooks, text, size + 1);
}

// Whether a source is part of a program: all of the headers are.
static bool is_part(const char *name, const char *const *kernels)
{
    size_t length = strlen(name);
    if (length < 3 || strcmp(name + length - 3, ".cl") != 0) return true;
    for (; *kernels; kernels++)
        if (strcmp(name, *kernels) == 0) return true;
    return false;
}

occ_result occ_cl_device_build(occ_cl_device *device, occ_hooks *hooks, const char *const *kernels)
{
    const char *texts[MOST_SOURCES];
    size_t sizes[MOST_SOURCES];
    cl_uint count = 0;
    for (unsigned i = 0; i < occ_kernel_source_count && count < MOST_SOURCES; i++) {
        if (!is_part(occ_kernel_sources[i].name, kernels)) continue;
        texts[count] = occ_kernel_sources[i].text;
        sizes[count++] = occ_kernel_sources[i].size;
    }
    cl_int error;
    device->program = clCreateProgramWithSource(device->context, count, texts, sizes, &error);
    if (error) return occ_cl_fail(hooks, error, "clCreateProgramWithSource");
    error = clBuildProgram(device->program, 1, &device->id, "-cl-std=CL1.2", NULL, NULL);
    if (!error) return OCC_SUCCESS;
    log_build(device, hooks);
    return occ_fail(hooks, OCC_ERROR_KERNEL_BUILD, "clBuildProgram returned %d", (int)error);
}

occ_result occ_cl_kernel(const occ_cl_device *device, const occ_hooks *hooks, const char *name,
                         size_t group, cl_kernel *kernel)
{
    cl_int error;
    size_t most = 0;
    *kernel = clCreateKernel(device->program, name, &error);
    if (error) {
        *kernel = NULL;
        return occ_cl_fail(hooks, error, "clCreateKernel");
    }
    error = clGetKernelWorkGroupInfo(*kernel, device->id, CL_KERNEL_WORK_GROUP_SIZE, sizeof most,
                                     &most, NULL);
    if (error) return occ_cl_fail(hooks, error, "clGetKernelWorkGroupInfo");
    if (most >= group) return OCC_SUCCESS;
    return occ_fail(hooks, OCC_ERROR_UNSUPPORTED,
                    "%s: the device takes groups of %zu, %zu are needed", name, most, group);
}

// Says what the device is.
static occ_result inspect(occ_cl_device *device, const occ_hooks *hooks)
{
    char name[128] = "", driver[128] = "";
    cl_int error = clGetDeviceInfo(device->id, CL_DEVICE_NAME, sizeof name - 1, name, NULL);
    if (!error) {
        error = clGetDeviceInfo(device->id, CL_DRIVER_VERSION, sizeof driver - 1, driver, NULL);
    }
    if (!error) {
        error = clGetDeviceInfo(device->id, CL_DEVICE_MAX_MEM_ALLOC_SIZE,
                                sizeof device->largest_buffer, &device->largest_buffer, NULL);
    }
    if (!error) {
        error = clGetDeviceInfo(device->id, CL_DEVICE_MAX_COMPUTE_UNITS, sizeof device->units,
                                &device->units, NULL);
    }
    if (!error) {
        error =
            clGetDeviceInfo(device->id, CL_DEVICE_TYPE, sizeof device->type, &device->type, NULL);
    }
    if (error) return occ_cl_fail(hooks, error, "clGetDeviceInfo");
    occ_log(hooks, OCC_LOG_INFO, "OpenCL device: %s, driver %s", name, driver);
    return OCC_SUCCESS;
}

occ_result occ_cl_device_open(occ_cl_device *device, occ_hooks *hooks, const occ_cl_desc *desc)
{
    *device = (occ_cl_device){.id = desc->device};
    occ_result result = OCC_SUCCESS;
    if (desc->queue) {
        result = use_queue(device, hooks, desc->queue);
    } else {
        if (desc->context && !desc->device) {
            return occ_fail(hooks, OCC_ERROR_INVALID_ARGUMENT, "a context without a device");
        }
        if (!device->id) result = choose_device(device, hooks);
        if (!result) result = use_context(device, hooks, desc->context);
    }
    if (!result) result = inspect(device, hooks);
    if (result) occ_cl_device_close(device);
    return result;
}

bool occ_cl_is_cpu(const occ_cl_device *device)
{
    return (device->type & (CL_DEVICE_TYPE_CPU | CL_DEVICE_TYPE_GPU)) == CL_DEVICE_TYPE_CPU;
}

void occ_cl_unpin(const occ_cl_device *device, occ_cl_pinned *pinned)
{
    if (pinned->data) {
        (void)clEnqueueUnmapMemObject(device->queue, pinned->memory, pinned->data, 0, NULL, NULL);
        (void)clFinish(device->queue);
    }
    if (pinned->memory) (void)clReleaseMemObject(pinned->memory);
    *pinned = (occ_cl_pinned){NULL, NULL, 0};
}

occ_result occ_cl_pin(const occ_cl_device *device, const occ_hooks *hooks, occ_cl_pinned *pinned,
                      size_t bytes)
{
    if (pinned->bytes >= bytes) return OCC_SUCCESS;
    occ_cl_unpin(device, pinned);
    cl_int error;
    cl_mem_flags flags = CL_MEM_READ_WRITE | CL_MEM_ALLOC_HOST_PTR;
    cl_mem memory = clCreateBuffer(device->context, flags, bytes, NULL, &error);
    if (error) return occ_cl_fail(hooks, error, "clCreateBuffer");
    pinned->memory = memory;
    void *data = clEnqueueMapBuffer(device->queue, memory, CL_TRUE, CL_MAP_READ | CL_MAP_WRITE, 0,
                                    bytes, 0, NULL, NULL, &error);
    if (error) {
        occ_cl_unpin(device, pinned);
        return occ_cl_fail(hooks, error, "clEnqueueMapBuffer");
    }
    pinned->data = data;
    pinned->bytes = bytes;
    return OCC_SUCCESS;
}

void occ_cl_device_close(occ_cl_device *device)
{
    if (device->program) (void)clReleaseProgram(device->program);
    if (device->queue) (void)clReleaseCommandQueue(device->queue);
    if (device->context) (void)clReleaseContext(device->context);
    *device = (occ_cl_device){.id = NULL};
}
