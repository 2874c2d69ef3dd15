// SPDX-License-Identifier: Apache-2.0
// The test on an OpenCL device. The boxes stay there from frame to frame; a frame sends the eye,
// the shadows, the ranges and their lists in one piece, and reads four words per range. Only that
// read blocks.
#include "backend.h"

#include "cl_device.h"
#include "fusion.h"
#include "log.h"

#include <string.h>

#define NO_PLANE_AT         1e30f // everything is inside
#define COLUMN_BYTES(boxes) ((size_t)(boxes)->stride * sizeof(float))

// A device buffer that grows.
typedef struct cl_array {
    cl_mem memory;
    size_t bytes;
} cl_array;

enum { BOXES, SENT, VERDICTS, ARRAYS };

typedef struct opencl_backend {
    occ_tester base;
    occ_cl_device device;
    cl_kernel kernel;
    cl_array array[ARRAYS];
    occ_cl_pinned pinned; // what is sent
    bool wide;            // an item to an object, not to a range
    uint64_t scene;       // whose boxes are on the device, 0: nobody's
    uint64_t revision;    // as of which commit
    uint32_t stride;
    bool sending; // boxes, that nobody has waited for
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
    backend->sending = false;
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
    backend->sending = true;
    cl_int error = clFlush(backend->device.queue); // the walk goes on meanwhile
    if (error) return give_up(backend, occ_cl_fail(base->hooks, error, "clFlush"));
    backend->scene = scene->id;
    backend->revision = scene->revision;
    backend->stride = boxes->stride;
    return OCC_SUCCESS;
}

// (A shadow has at most one plane more than there are sides.)
static void set_sides(occ_side_shadow *to, const occ_shadow *from)
{
    uint32_t silhouettes = occ_shadow_silhouettes(from);
    *to = (occ_side_shadow){.owner = from->owner, .planes = (1u << from->planes) - 1u};
    to->sides = from->planes < OCC_SIDES ? from->planes : OCC_SIDES;
    to->faces = to->planes & ~((1u << silhouettes) - 1u);
    for (uint32_t p = 0; p < OCC_SIDES; p++)
        for (uint32_t j = 0; j < 4; j++)
            to->plane[j][p] = p < from->planes ? from->plane[p][j] : j < 3 ? 0.0f : NO_PLANE_AT;
    if (from->planes > OCC_SIDES) memcpy(to->last, from->plane[OCC_SIDES], sizeof to->last);
}

// Shadows take as much room in either form.
static void pack_shadows(const opencl_backend *backend, void *to, const occ_shadow_set *set)
{
    _Static_assert(sizeof(occ_side_shadow) == sizeof(occ_shadow), "a shadow in either form");
    if (backend->wide) {
        if (set->count) memcpy(to, set->shadows, set->count * sizeof(occ_shadow));
        return;
    }
    for (uint32_t i = 0; i < set->count; i++)
        set_sides((occ_side_shadow *)to + i, &set->shadows[i]);
}

static size_t aligned(size_t bytes)
{
    return (bytes + 15) & ~(size_t)15;
}

// Puts a frame in one piece. The last one has been read: nothing is under way.
static occ_result pack_job(opencl_backend *backend, const occ_test_job *job, size_t *bytes)
{
    size_t shadows = job->set->count * sizeof(occ_shadow);
    size_t ranges = job->range_count * sizeof(occ_range);
    size_t candidates = job->candidate_count * sizeof(cl_uint);
    size_t shadows_at = sizeof(occ_sent), ranges_at = shadows_at + shadows;
    size_t candidates_at = aligned(ranges_at + ranges), end = candidates_at + candidates;
    *bytes = end;
    if (end > backend->pinned.bytes) {
        backend->base.device_bytes -= backend->pinned.bytes;
        occ_result result =
            occ_cl_pin(&backend->device, backend->base.hooks, &backend->pinned, end + end / 2);
        backend->base.device_bytes += backend->pinned.bytes;
        if (result) return result;
    }
    char *to = backend->pinned.data;
    *(occ_sent *)to =
        (occ_sent){*job->eye, (cl_uint)shadows_at, (cl_uint)ranges_at, (cl_uint)candidates_at, 0};
    pack_shadows(backend, to + shadows_at, job->set);
    memcpy(to + ranges_at, job->ranges, ranges);
    if (candidates) memcpy(to + candidates_at, job->candidates, candidates);
    return OCC_SUCCESS;
}

static occ_result send_job(opencl_backend *backend, const occ_test_job *job)
{
    size_t bytes;
    occ_result result = pack_job(backend, job, &bytes);
    if (!result) result = send(backend, SENT, backend->pinned.data, bytes);
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
    size_t group = backend->wide ? OCC_RANGE_OBJECTS : 1;
    size_t items = (backend->wide ? group : 2) * job->range_count; // a range is two words
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
    const char *call = "clFinish";
    cl_int error = CL_SUCCESS;
    if (job->range_count) {
        call = "clEnqueueReadBuffer";
        error = clEnqueueReadBuffer(backend->device.queue, backend->array[VERDICTS].memory, CL_TRUE,
                                    0, job->range_count * sizeof *job->verdicts, job->verdicts, 0,
                                    NULL, NULL);
    } else if (backend->sending) {
        error = clFinish(backend->device.queue);
    }
    if (error) return give_up(backend, occ_cl_fail(base->hooks, error, call));
    backend->sending = false;
    return OCC_SUCCESS;
}

static void destroy(occ_tester *base)
{
    opencl_backend *backend = (opencl_backend *)base;
    if (backend->device.queue) (void)clFinish(backend->device.queue);
    for (int which = 0; which < ARRAYS; which++)
        if (backend->array[which].memory) (void)clReleaseMemObject(backend->array[which].memory);
    if (backend->kernel) (void)clReleaseKernel(backend->kernel);
    if (backend->device.queue) occ_cl_unpin(&backend->device, &backend->pinned);
    occ_cl_device_close(&backend->device);
    occ_free(base->hooks, backend, sizeof *backend);
}

static const occ_backend_ops opencl_ops = {"opencl", upload, test, NULL, read_verdicts, destroy};

static occ_result open_kernel(opencl_backend *backend, occ_cl_shape shape)
{
    static const char *const wide[] = {"test.cl", NULL}, *const narrow[] = {"sides.cl", "range.cl",
                                                                            NULL};
    occ_cl_device *device = &backend->device;
    occ_hooks *hooks = backend->base.hooks;
    backend->wide = shape == OCC_CL_SHAPE_WIDE;
    if (shape == OCC_CL_SHAPE_AUTO) backend->wide = !occ_cl_is_cpu(device);
    occ_result result = occ_cl_device_build(device, hooks, backend->wide ? wide : narrow);
    if (result) return result;
    return occ_cl_kernel(device, hooks, backend->wide ? "occ_test" : "occ_test_range",
                         backend->wide ? OCC_RANGE_OBJECTS : 1, &backend->kernel);
}

occ_result occ_backend_opencl_create(occ_hooks *hooks, const void *desc, occ_tester **backend)
{
    static const occ_cl_desc defaults;
    const occ_cl_desc *wanted = desc ? desc : &defaults;
    *backend = NULL;
    if ((unsigned)wanted->shape > OCC_CL_SHAPE_WIDE) {
        return occ_fail(hooks, OCC_ERROR_INVALID_ARGUMENT, "there is no shape %d",
                        (int)wanted->shape);
    }
    opencl_backend *made = occ_alloc(hooks, sizeof *made);
    if (!made) return OCC_ERROR_OUT_OF_MEMORY;
    *made = (opencl_backend){.base = {&opencl_ops, hooks, 0}};
    occ_result result = occ_cl_device_open(&made->device, hooks, wanted);
    if (!result) result = open_kernel(made, wanted->shape);
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
