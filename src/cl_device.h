// SPDX-License-Identifier: Apache-2.0
// An OpenCL device with a queue and the built kernels.
#ifndef OCC_CL_DEVICE_H
#define OCC_CL_DEVICE_H

#include "backend.h"

#include <occlude/opencl.h>

typedef struct occ_cl_device {
    cl_device_id id;
    cl_context context;
    cl_command_queue queue;
    cl_program program;
    cl_ulong largest_buffer; // bytes
    cl_uint units;           // multiprocessors, or cores
    cl_device_type type;
} occ_cl_device;

// Finds the device, or takes the caller's. On failure nothing is left open.
occ_result occ_cl_device_open(occ_cl_device *device, occ_hooks *hooks, const occ_cl_desc *desc);

// Builds the files of kernels that are named, a list that ends with NULL, with all headers.
occ_result occ_cl_device_build(occ_cl_device *device, occ_hooks *hooks, const char *const *kernels);

// Makes a kernel; fails if the device cannot run it in groups of so many. `*kernel` is the caller's
// to release even then, or NULL.
occ_result occ_cl_kernel(const occ_cl_device *device, const occ_hooks *hooks, const char *name,
                         size_t group, cl_kernel *kernel);

// Host memory that transfers run from at full speed.
typedef struct occ_cl_pinned {
    cl_mem memory;
    void *data;
    size_t bytes;
} occ_cl_pinned;

// Makes sure that there are so many bytes; what was there is lost if there were fewer. Blocks then.
occ_result occ_cl_pin(const occ_cl_device *device, const occ_hooks *hooks, occ_cl_pinned *pinned,
                      size_t bytes);
void occ_cl_unpin(const occ_cl_device *device, occ_cl_pinned *pinned);

void occ_cl_device_close(occ_cl_device *device);

// A CPU and nothing else: its items have vectors of their own, and little to gain from neighbours.
bool occ_cl_is_cpu(const occ_cl_device *device);

// The device of an OpenCL backend, or NULL if it is another.
cl_device_id occ_backend_opencl_device(const occ_tester *backend);

// Logs a failed call and returns the result that it amounts to.
occ_result occ_cl_fail(const occ_hooks *hooks, cl_int error, const char *call);

#endif
