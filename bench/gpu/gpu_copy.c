// SPDX-License-Identifier: Apache-2.0
// The ceilings: what a plain copy reaches on this device, in this process.
#include "gpu.h"

#include "timing.h"

#include <string.h>

enum { TRIES = 20 };
#define COPY_BYTES   ((size_t)1 << 30)
#define PINNED_BYTES ((size_t)48 * 1000 * 1000)

// Gigabytes a second of the median of several tries; `copy` makes one.
static double rate(cl_command_queue queue, cl_mem from, cl_mem to, const void *host, size_t bytes)
{
    double times[TRIES];
    for (int i = -2; i < TRIES; i++) { // the first two are to warm up
        (void)clFinish(queue);
        double start = timing_now();
        cl_int error =
            host ? clEnqueueWriteBuffer(queue, to, CL_FALSE, 0, bytes, host, 0, NULL, NULL)
                 : clEnqueueCopyBuffer(queue, from, to, 0, 0, bytes, 0, NULL, NULL);
        if (error || clFinish(queue)) return 0.0;
        if (i >= 0) times[i] = timing_now() - start;
    }
    return (double)bytes * 1e-6 / timing_median(times, TRIES);
}

static double copy_rate(cl_command_queue queue, cl_context context, size_t bytes)
{
    cl_mem from = clCreateBuffer(context, CL_MEM_READ_WRITE, bytes, NULL, NULL);
    cl_mem to = clCreateBuffer(context, CL_MEM_READ_WRITE, bytes, NULL, NULL);
    cl_uint pattern = 0x9e3779b9u;
    double found = 0.0;
    if (from && to && !clEnqueueFillBuffer(queue, from, &pattern, 4, 0, bytes, 0, NULL, NULL)) {
        found = 2.0 * rate(queue, from, to, NULL, bytes);
    }
    if (from) (void)clReleaseMemObject(from);
    if (to) (void)clReleaseMemObject(to);
    return found;
}

static double pinned_rate(cl_command_queue queue, cl_context context)
{
    cl_mem_flags flags = CL_MEM_READ_WRITE | CL_MEM_ALLOC_HOST_PTR;
    cl_mem pinned = clCreateBuffer(context, flags, PINNED_BYTES, NULL, NULL);
    cl_mem to = clCreateBuffer(context, CL_MEM_READ_WRITE, PINNED_BYTES, NULL, NULL);
    double found = 0.0;
    void *host = pinned && to ? clEnqueueMapBuffer(queue, pinned, CL_TRUE, CL_MAP_WRITE, 0,
                                                   PINNED_BYTES, 0, NULL, NULL, NULL)
                              : NULL;
    if (host) {
        memset(host, 1, PINNED_BYTES);
        found = rate(queue, NULL, to, host, PINNED_BYTES);
        (void)clEnqueueUnmapMemObject(queue, pinned, host, 0, NULL, NULL);
        (void)clFinish(queue);
    }
    if (pinned) (void)clReleaseMemObject(pinned);
    if (to) (void)clReleaseMemObject(to);
    return found;
}

void gpu_copy_rates(cl_command_queue queue, double *copy, double *pinned)
{
    cl_context context = NULL;
    cl_device_id device = NULL;
    cl_device_type type = 0;
    *copy = *pinned = 0.0;
    if (clGetCommandQueueInfo(queue, CL_QUEUE_CONTEXT, sizeof(cl_context), &context, NULL)) return;
    if (clGetCommandQueueInfo(queue, CL_QUEUE_DEVICE, sizeof(cl_device_id), &device, NULL)) return;
    (void)clGetDeviceInfo(device, CL_DEVICE_TYPE, sizeof type, &type, NULL);
    *copy = copy_rate(queue, context, type & CL_DEVICE_TYPE_GPU ? COPY_BYTES : COPY_BYTES / 16);
    *pinned = pinned_rate(queue, context);
}
