// SPDX-License-Identifier: Apache-2.0
// The test on an OpenCL device. The boxes stay there from frame to frame; a frame sends the
// shadows, the ranges and their lists, and reads four words per range. Only that read blocks.
#include "backend.h"

#include "cl_device.h"
#include "log.h"

#define COLUMN_BYTES(boxes) ((size_t)(boxes)->stride * sizeof(float))

// A device buffer that grows.
typedef struct cl_array {
    cl_mem memory;
    size_t bytes;
} cl_array;

enum { BOXES, EYE, SHADOWS, RANGES, CANDIDATES, VERDICTS, ARRAYS };

typedef struct opencl_backend {
    occ_tester base;
    occ_cl_device device;
    cl_kernel kernel;
    cl_array array[ARRAYS];
    uint64_t scene;    // whose boxes are on the device, 0: nobody's
    uint64_t revision; // as of which commit
    uint32_t stride;
} opencl_backend;

static occ_result grow(opencl_backend *backend, int which, size_t bytes)
{
    cl_array *array = &backend->array[which];
    if (bytes <= array->bytes) return OCC_SUCCESS;
    size_t wanted = which == BOXES ? bytes : bytes + bytes / 2;
    if (wanted > backend->device.largest_buffer) wanted = bytes;
    if (wanted > backend->device.largest_buffer) {
        return occ_fail(backend->base.hooks, OCC_ERROR_OUT_OF_MEMORY,
                        "a buffer of %zu bytes, the device's largest is %llu", bytes,
                        (unsigned long long)backend->device.largest_buffer);
    }
    if (array->memory) (void)clReleaseMemObject(array->memory);
    backend->base.device_bytes -= array->bytes;
    *array = (cl_array){NULL, 0};
    cl_int error;
    cl_mem_flags flags = which == VERDICTS ? CL_MEM_WRITE_ONLY : CL_MEM_READ_ONLY;
    cl_mem memory = clCreateBuffer(backend->device.context, flags, wanted, NULL, &error);
    if (error) return occ_cl_fail(backend->base.hooks, error, "clCreateBuffer");
    *array = (cl_array){memory, wanted};
    backend->base.device_bytes += wanted;
    return OCC_SUCCESS;
}

// Starts a copy to the device. `from` stays valid until the frame's read.
static occ_result send(opencl_backend *backend, int which, const void *from, size_t bytes)
{
    occ_result result = grow(backend, which, bytes ? bytes : 1);
    if (result || !bytes) return result;
    cl_int error = clEnqueueWriteBuffer(backend->device.queue, backend->array[which].memory,
                                        CL_FALSE, 0, bytes, from, 0, NULL, NULL);
    return error ? occ_cl_fail(backend->base.hooks, error, "clEnqueueWriteBuffer") : OCC_SUCCESS;
}

// Starts the copy of rows [first, end) of all twelve columns.
static occ_result send_rows(opencl_backend *backend, const occ_boxes *boxes, uint32_t first,
                            uint32_t end)
{
    size_t origin[3] = {first * sizeof(float), 0, 0};
    size_t region[3] = {(end - first) * sizeof(float), OCC_BOX_COLUMNS, 1};
    cl_int error = clEnqueueWriteBufferRect(backend->device.queue, backend->array[BOXES].memory,
                                            CL_FALSE, origin, origin, region, COLUMN_BYTES(boxes),
                                            0, COLUMN_BYTES(boxes), 0, boxes->data, 0, NULL, NULL);
    return error ? occ_cl_fail(backend->base.hooks, error, "clEnqueueWriteBufferRect")
                 : OCC_SUCCESS;
}

static bool is_changed(const occ_scene *scene, uint32_t block)
{
    return ((const uint32_t *)scene->changed.data)[block / 32] >> block % 32 & 1u;
}

// Sends each run of rows that the latest commit changed.
static occ_result send_changes(opencl_backend *backend, const occ_scene *scene)
{
    const occ_boxes *boxes = &scene->boxes;
    uint32_t blocks = (boxes->count + OCC_CHANGE_ROWS - 1) / OCC_CHANGE_ROWS;
    occ_result result = OCC_SUCCESS;
    for (uint32_t b = 0; b < blocks && !result; b++) {
        if (!is_changed(scene, b)) continue;
        uint32_t first = b * OCC_CHANGE_ROWS;
        while (b + 1 < blocks && is_changed(scene, b + 1))
            b++;
        uint32_t end = (b + 1) * OCC_CHANGE_ROWS;
        result = send_rows(backend, boxes, first, end < boxes->count ? end : boxes->count);
    }
    return result;
}

// A copy that a failed frame started reads the caller's memory: wait for it before giving up.
static occ_result give_up(opencl_backend *backend, occ_result result)
{
    backend->scene = 0; // what is on the device is in doubt
    (void)clFinish(backend->device.queue);
    return result;
}

static occ_result upload(occ_tester *base, const occ_scene *scene)
{
    opencl_backend *backend = (opencl_backend *)base;
    const occ_boxes *boxes = &scene->boxes;
    bool same = backend->scene == scene->id && backend->stride == boxes->stride;
    if (same && backend->revision == scene->revision) return OCC_SUCCESS;
    occ_result result;
    if (same && backend->revision + 1 == scene->revision && !scene->all_changed) {
        result = send_changes(backend, scene);
    } else {
        result = send(backend, BOXES, boxes->data, COLUMN_BYTES(boxes) * OCC_BOX_COLUMNS);
    }
    if (result) return give_up(backend, result);
    backend->scene = scene->id;
    backend->revision = scene->revision;
    backend->stride = boxes->stride;
    return OCC_SUCCESS;
}

static occ_result send_job(opencl_backend *backend, const occ_test_job *job)
{
    occ_result result = send(backend, EYE, job->eye, sizeof *job->eye);
    if (!result) {
        result = send(backend, SHADOWS, job->set->shadows, job->set->count * sizeof(occ_shadow));
    }
    if (!result) result = send(backend, RANGES, job->ranges, job->range_count * sizeof(occ_range));
    if (!result) {
        result = send(backend, CANDIDATES, job->candidates, job->candidate_count * sizeof(cl_uint));
    }
    if (!result) result = grow(backend, VERDICTS, job->range_count * sizeof(occ_verdict));
    return result;
}

static occ_result set_arguments(opencl_backend *backend)
{
    cl_kernel kernel = backend->kernel;
    cl_uint argument = 0;
    cl_int error = CL_SUCCESS;
    for (int which = BOXES; which < ARRAYS && !error; which++) {
        error = clSetKernelArg(kernel, argument++, sizeof(cl_mem), &backend->array[which].memory);
        if (error || which != BOXES) continue;
        error = clSetKernelArg(kernel, argument++, sizeof(cl_uint), &backend->stride);
    }
    return error ? occ_cl_fail(backend->base.hooks, error, "clSetKernelArg") : OCC_SUCCESS;
}

static occ_result test(occ_tester *base, const occ_test_job *job)
{
    opencl_backend *backend = (opencl_backend *)base;
    occ_result result = send_job(backend, job);
    if (!result) result = set_arguments(backend);
    if (result) return give_up(backend, result);
    size_t group = OCC_RANGE_OBJECTS, items = group * job->range_count;
    cl_int error = clEnqueueNDRangeKernel(backend->device.queue, backend->kernel, 1, NULL, &items,
                                          &group, 0, NULL, NULL);
    if (error) {
        return give_up(backend, occ_cl_fail(base->hooks, error, "clEnqueueNDRangeKernel"));
    }
    return OCC_SUCCESS;
}

static occ_result read_verdicts(occ_tester *base, const occ_test_job *job)
{
    opencl_backend *backend = (opencl_backend *)base;
    cl_int error =
        clEnqueueReadBuffer(backend->device.queue, backend->array[VERDICTS].memory, CL_TRUE, 0,
                            job->range_count * sizeof *job->verdicts, job->verdicts, 0, NULL, NULL);
    if (!error) return OCC_SUCCESS;
    return give_up(backend, occ_cl_fail(base->hooks, error, "clEnqueueReadBuffer"));
}

static void destroy(occ_tester *base)
{
    opencl_backend *backend = (opencl_backend *)base;
    if (backend->device.queue) (void)clFinish(backend->device.queue);
    for (int which = 0; which < ARRAYS; which++)
        if (backend->array[which].memory) (void)clReleaseMemObject(backend->array[which].memory);
    if (backend->kernel) (void)clReleaseKernel(backend->kernel);
    occ_cl_device_close(&backend->device);
    occ_free(base->hooks, backend, sizeof *backend);
}

static const occ_backend_ops opencl_ops = {"opencl", upload, test, NULL, read_verdicts, destroy};

occ_result occ_backend_opencl_create(occ_hooks *hooks, const void *desc, occ_tester **backend)
{
    static const occ_cl_desc defaults;
    static const char *const files[] = {"test.cl", NULL};
    opencl_backend *made = occ_alloc(hooks, sizeof *made);
    *backend = NULL;
    if (!made) return OCC_ERROR_OUT_OF_MEMORY;
    *made = (opencl_backend){.base = {&opencl_ops, hooks, 0}};
    occ_result result = occ_cl_device_open(&made->device, hooks, desc ? desc : &defaults);
    if (!result) result = occ_cl_device_build(&made->device, hooks, files);
    if (!result) {
        result = occ_cl_kernel(&made->device, hooks, "occ_test", OCC_RANGE_OBJECTS, &made->kernel);
    }
    if (result) {
        destroy(&made->base);
        return result;
    }
    *backend = &made->base;
    return OCC_SUCCESS;
}

cl_device_id occ_backend_opencl_device(const occ_tester *backend)
{
    return backend->ops == &opencl_ops ? ((const opencl_backend *)backend)->device.id : NULL;
}
