// SPDX-License-Identifier: Apache-2.0
// Making and unmaking tables.
#include "cl_table.h"

#include "log.h"

#define MOST_SLOTS     0x80000000u
#define DEFAULT_STRIPS 1u

static const char *const kernel_names[OCC_KERNELS] = {
    "occ_flat_unpack", "occ_flat_bounds", "occ_flat_blocks", "occ_flat_objects", "occ_flat_fuse",
    "occ_list_tiles",  "occ_list_places", "occ_list_write",  "occ_draw_counts",  "occ_draw_compact",
};
static const size_t kernel_items[OCC_KERNELS] = {64, 256, 256, 256, 1, 256, 256, 256, 64, 64};

// The tuner: work-groups to a multiprocessor that hide each other's waiting, or to a core that
// share out the work evenly; and by how many items an object is cut up.
static void tune(occ_cl_engine *engine, occ_cl_shape shape)
{
    bool wide = shape == OCC_CL_SHAPE_WIDE;
    if (shape == OCC_CL_SHAPE_AUTO) wide = !occ_cl_is_cpu(&engine->device);
    size_t units = engine->device.units ? engine->device.units : 1;
    engine->busy = units * (wide ? 32 : 8);
    engine->fusion_items = wide ? 32 : 1;
}

static occ_result open_kernels(const occ_cl_table *table, occ_cl_engine *engine)
{
    occ_result result = OCC_SUCCESS;
    for (int k = 0; k < OCC_KERNELS && !result; k++) {
        bool group = k == OCC_KERNEL_FUSE && engine->fusion_items > 1;
        result = occ_cl_kernel(&engine->device, &table->hooks,
                               group ? "occ_flat_fuse_group" : kernel_names[k],
                               group ? engine->fusion_items : kernel_items[k], &engine->kernel[k]);
    }
    return result;
}

// The queue for boxes on their way. A CPU copies with the cores that run the kernels: there one
// queue does both.
static occ_result open_copies(const occ_cl_table *table, occ_cl_engine *engine)
{
    const occ_cl_device *device = &engine->device;
    cl_int error = CL_SUCCESS;
    if (occ_cl_is_cpu(device)) {
        error = clRetainCommandQueue(device->queue);
        if (error) return occ_cl_fail(&table->hooks, error, "clRetainCommandQueue");
        engine->copies = device->queue;
        return OCC_SUCCESS;
    }
    engine->copies = clCreateCommandQueue(device->context, device->id, 0, &error);
    if (!error) return OCC_SUCCESS;
    engine->copies = NULL;
    return occ_cl_fail(&table->hooks, error, "clCreateCommandQueue");
}

static occ_result open_engine(occ_cl_table *table, occ_cl_engine *engine, cl_command_queue queue,
                              occ_cl_shape shape)
{
    static const char *const narrow[] = {"flat.cl", "list.cl", NULL};
    static const char *const wide[] = {"flat.cl", "fuse.cl", "list.cl", NULL};
    occ_cl_desc desc = {.queue = queue};
    occ_cl_device *device = &engine->device;
    occ_result result = occ_cl_device_open(device, &table->hooks, &desc);
    if (result) return result;
    tune(engine, shape);
    result = occ_cl_device_build(device, &table->hooks, engine->fusion_items > 1 ? wide : narrow);
    if (result) return result;
    cl_command_queue_properties properties = 0;
    cl_int error = clGetCommandQueueInfo(device->queue, CL_QUEUE_PROPERTIES, sizeof properties,
                                         &properties, NULL);
    if (error) return occ_cl_fail(&table->hooks, error, "clGetCommandQueueInfo");
    engine->takes_times = properties & CL_QUEUE_PROFILING_ENABLE;
    result = open_kernels(table, engine);
    if (result) return result;
    result = open_copies(table, engine);
    if (result) return result;
    for (int i = 0; i < 2; i++) {
        size_t bytes = OCC_STAGED_BOXES * sizeof(occ_box);
        engine->raw[i] = clCreateBuffer(device->context, CL_MEM_READ_ONLY, bytes, NULL, &error);
        if (error) {
            engine->raw[i] = NULL;
            return occ_cl_fail(&table->hooks, error, "clCreateBuffer");
        }
        table->stats.device_bytes += bytes;
    }
    return OCC_SUCCESS;
}

static void close_engine(occ_cl_engine *engine)
{
    for (int i = 0; i < 2; i++) {
        if (engine->unpacked[i]) (void)clReleaseEvent(engine->unpacked[i]);
        if (engine->raw[i]) (void)clReleaseMemObject(engine->raw[i]);
    }
    if (engine->copies) (void)clReleaseCommandQueue(engine->copies);
    for (int k = 0; k < OCC_KERNELS; k++)
        if (engine->kernel[k]) (void)clReleaseKernel(engine->kernel[k]);
    occ_cl_device_close(&engine->device);
}

static occ_result open_engines(occ_cl_table *table, const occ_cl_table_desc *desc)
{
    uint32_t count = desc->queues ? desc->queue_count : 1;
    table->engines = occ_alloc(&table->hooks, count * sizeof *table->engines);
    if (!table->engines) return OCC_ERROR_OUT_OF_MEMORY;
    table->engine_count = count;
    for (uint32_t i = 0; i < count; i++)
        table->engines[i] = (occ_cl_engine){.turn = 0};
    occ_result result = OCC_SUCCESS;
    for (uint32_t i = 0; i < count && !result; i++)
        result = open_engine(table, &table->engines[i], desc->queues ? desc->queues[i] : NULL,
                             desc->shape);
    if (result) return result;
    for (uint32_t i = 1; i < count; i++) {
        if (table->engines[i].device.context != table->engines[0].device.context) {
            return occ_fail(&table->hooks, OCC_ERROR_INVALID_ARGUMENT,
                            "queue %u is of another context", i);
        }
    }
    return OCC_SUCCESS;
}

static occ_result check(const occ_hooks *hooks, const occ_cl_table_desc *desc)
{
    if (!desc->capacity || desc->capacity > MOST_SLOTS) {
        return occ_fail(hooks, OCC_ERROR_INVALID_ARGUMENT, "a table of %u slots", desc->capacity);
    }
    if ((unsigned)desc->shape > OCC_CL_SHAPE_WIDE) {
        return occ_fail(hooks, OCC_ERROR_INVALID_ARGUMENT, "there is no shape %d",
                        (int)desc->shape);
    }
    if (desc->strips > OCC_MOST_STRIPS) {
        return occ_fail(hooks, OCC_ERROR_INVALID_ARGUMENT, "%u strips, at most %u", desc->strips,
                        OCC_MOST_STRIPS);
    }
    if (!desc->queues) return OCC_SUCCESS;
    if (!desc->queue_count || desc->queue_count > OCC_MOST_QUEUES) {
        return occ_fail(hooks, OCC_ERROR_INVALID_ARGUMENT, "%u queues, from 1 to %u are taken",
                        desc->queue_count, OCC_MOST_QUEUES);
    }
    for (uint32_t i = 0; i < desc->queue_count; i++) {
        if (!desc->queues[i]) {
            return occ_fail(hooks, OCC_ERROR_INVALID_ARGUMENT, "queue %u is NULL", i);
        }
    }
    return OCC_SUCCESS;
}

static occ_result open_stages(occ_cl_table *table)
{
    size_t bytes = table->engine_count * sizeof(cl_event);
    for (int i = 0; i < 2; i++) {
        table->stages[i].sent = occ_alloc(&table->hooks, bytes);
        if (!table->stages[i].sent) return OCC_ERROR_OUT_OF_MEMORY;
        for (uint32_t e = 0; e < table->engine_count; e++)
            table->stages[i].sent[e] = NULL;
    }
    return OCC_SUCCESS;
}

occ_result occ_cl_table_create(const occ_cl_table_desc *desc, occ_cl_table **table)
{
    if (!table) return OCC_ERROR_INVALID_ARGUMENT;
    *table = NULL;
    if (!desc) return OCC_ERROR_INVALID_ARGUMENT;
    occ_hooks hooks;
    occ_result result = occ_hooks_init(&hooks, &desc->allocator, &desc->logger);
    if (result) return occ_fail(&hooks, result, "an allocator needs both of its functions");
    result = check(&hooks, desc);
    if (result) return result;
    occ_cl_table *made = occ_alloc(&hooks, sizeof *made);
    if (!made) return occ_fail(&hooks, OCC_ERROR_OUT_OF_MEMORY, "no memory for a table");
    *made = (occ_cl_table){.hooks = hooks, .capacity = desc->capacity};
    occ_frame_init(&made->frame, &made->hooks, occ_lanes_choose());
    result = occ_strips_open(&made->strips, &made->hooks, occ_lanes_choose(),
                             desc->strips ? desc->strips : DEFAULT_STRIPS);
    if (!result) result = open_engines(made, desc);
    if (!result) result = open_stages(made);
    if (!result) result = occ_table_open_parts(made);
    if (result) {
        occ_log(&hooks, OCC_LOG_ERROR, "%s: no table was made", occ_result_name(result));
        occ_cl_table_destroy(made);
        return result;
    }
    *table = made;
    return OCC_SUCCESS;
}

static void close_stage(occ_cl_table *table, occ_cl_stage *stage)
{
    if (!stage->sent) return;
    for (uint32_t e = 0; e < table->engine_count; e++)
        if (stage->sent[e]) (void)clReleaseEvent(stage->sent[e]);
    occ_free(&table->hooks, stage->sent, table->engine_count * sizeof(cl_event));
    occ_table_unpin(table, &stage->pinned);
}

void occ_cl_table_destroy(occ_cl_table *table)
{
    if (!table) return;
    for (uint32_t e = 0; e < table->engine_count; e++) {
        occ_cl_engine *engine = &table->engines[e];
        if (engine->copies) (void)clFinish(engine->copies);
        if (engine->device.queue) (void)clFinish(engine->device.queue);
    }
    close_stage(table, &table->stages[0]);
    close_stage(table, &table->stages[1]);
    occ_table_close_parts(table);
    for (uint32_t e = 0; e < table->engine_count; e++)
        close_engine(&table->engines[e]);
    occ_free(&table->hooks, table->engines, table->engine_count * sizeof *table->engines);
    occ_free(&table->hooks, table->row_of, (size_t)table->capacity * sizeof *table->row_of);
    occ_strips_close(&table->strips);
    occ_frame_free(&table->frame);
    occ_hooks hooks = table->hooks;
    occ_free(&hooks, table, sizeof *table);
}
