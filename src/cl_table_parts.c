// SPDX-License-Identifier: Apache-2.0
// The parts of a table: which rows each has, and its buffers.
#include "cl_table.h"

#include "log.h"

#include <string.h>

static void release(cl_event *event)
{
    if (*event) (void)clReleaseEvent(*event);
    *event = NULL;
}

occ_result occ_table_wait(const occ_cl_table *table, cl_event *event)
{
    if (!*event) return OCC_SUCCESS;
    cl_int error = clWaitForEvents(1, event);
    release(event);
    return error ? occ_cl_fail(&table->hooks, error, "clWaitForEvents") : OCC_SUCCESS;
}

occ_result occ_table_launch(const occ_cl_table *table, occ_table_part *part, int kernel,
                            const occ_cl_argument *arguments, cl_uint count, size_t groups,
                            size_t items, cl_uint waits, const cl_event *wait_list, cl_event *event)
{
    cl_kernel made = part->engine->kernel[kernel];
    size_t all = groups * items;
    for (cl_uint i = 0; i < count; i++) {
        cl_int error = clSetKernelArg(made, i, arguments[i].size, arguments[i].value);
        if (error) return occ_cl_fail(&table->hooks, error, "clSetKernelArg");
    }
    cl_event *timed = part->engine->takes_times ? &part->timed[kernel] : NULL;
    if (timed) release(timed);
    cl_int error = clEnqueueNDRangeKernel(part->engine->device.queue, made, 1, NULL, &all, &items,
                                          waits, waits ? wait_list : NULL, event ? event : timed);
    return error ? occ_cl_fail(&table->hooks, error, "clEnqueueNDRangeKernel") : OCC_SUCCESS;
}

// --- memory --------------------------------------------------------------------------------------

void occ_table_unpin(occ_cl_table *table, occ_cl_pinned *pinned)
{
    table->stats.pinned_bytes -= pinned->bytes;
    occ_cl_unpin(&table->engines[0].device, pinned);
}

occ_result occ_table_pin(occ_cl_table *table, occ_cl_pinned *pinned, size_t bytes)
{
    table->stats.pinned_bytes -= pinned->bytes;
    occ_result result = occ_cl_pin(&table->engines[0].device, &table->hooks, pinned, bytes);
    table->stats.pinned_bytes += pinned->bytes;
    return result;
}

occ_result occ_table_buffer(occ_cl_table *table, occ_table_part *part, int which, size_t bytes)
{
    if (part->bytes[which] >= bytes) return OCC_SUCCESS;
    cl_int error;
    cl_mem memory =
        clCreateBuffer(part->engine->device.context, CL_MEM_READ_WRITE, bytes, NULL, &error);
    if (error) return occ_cl_fail(&table->hooks, error, "clCreateBuffer");
    if (part->buffer[which]) (void)clReleaseMemObject(part->buffer[which]);
    table->stats.device_bytes += bytes - part->bytes[which];
    part->buffer[which] = memory;
    part->bytes[which] = bytes;
    return OCC_SUCCESS;
}

// --- parts ---------------------------------------------------------------------------------------

static occ_result fill(const occ_cl_table *table, occ_table_part *part, int which, cl_uint pattern,
                       size_t bytes)
{
    cl_int error = clEnqueueFillBuffer(part->engine->device.queue, part->buffer[which], &pattern,
                                       sizeof pattern, 0, bytes, 0, NULL, NULL);
    return error ? occ_cl_fail(&table->hooks, error, "clEnqueueFillBuffer") : OCC_SUCCESS;
}

// A part without objects: all rows are dirty and have a center of NaN.
static occ_result open_part(occ_cl_table *table, occ_table_part *part)
{
    size_t word = sizeof(cl_uint), rows = part->stride;
    const size_t bytes[OCC_PART_ROW_OF] = {
        [OCC_PART_BOXES] = rows * sizeof(occ_box),
        [OCC_PART_BOUNDS] = OCC_FLAT_BOUNDS * ((size_t)part->blocks + part->groups) * word,
        [OCC_PART_DIRTY] = part->groups * word,
        [OCC_PART_FRAME] = sizeof(occ_flat_frame) + OCC_FLAT_SHADOWS * sizeof(occ_shadow),
        [OCC_PART_COUNTS] = 2 * OCC_COUNTS * word,
        [OCC_PART_OPEN] = part->blocks * word,
        [OCC_PART_STATES] = part->blocks * word,
        [OCC_PART_LISTS] = (size_t)part->blocks * OCC_FLAT_LIST * word,
        [OCC_PART_UNRESOLVED] = rows * word,
        [OCC_PART_MASK] = part->words * word,
        [OCC_PART_VISIBLE] = word};
    occ_result result = OCC_SUCCESS;
    for (int i = 0; i < OCC_PART_ROW_OF && !result; i++)
        if (bytes[i]) result = occ_table_buffer(table, part, i, bytes[i]);
    if (!result) result = fill(table, part, OCC_PART_BOXES, 0x7fc00000u, rows * word);
    if (!result) result = fill(table, part, OCC_PART_DIRTY, 1, bytes[OCC_PART_DIRTY]);
    if (!result) result = fill(table, part, OCC_PART_COUNTS, 0, bytes[OCC_PART_COUNTS]);
    part->dirty = true;
    return result;
}

static uint32_t divide_up(uint32_t count, uint32_t by)
{
    return (uint32_t)(((uint64_t)count + by - 1) / by);
}

// The most rows of a part: what the largest buffer holds, in whole groups.
static occ_result most_rows(const occ_cl_table *table, const occ_cl_engine *engine, uint32_t *most)
{
    uint64_t rows = engine->device.largest_buffer / sizeof(occ_box) / OCC_GROUP_ROWS;
    *most = rows > 0x80000u ? 0x80000000u : (uint32_t)rows * OCC_GROUP_ROWS;
    if (rows) return OCC_SUCCESS;
    return occ_fail(&table->hooks, OCC_ERROR_OUT_OF_MEMORY,
                    "the device's largest buffer is of %llu bytes, %u boxes need %zu",
                    (unsigned long long)engine->device.largest_buffer, OCC_GROUP_ROWS,
                    OCC_GROUP_ROWS * sizeof(occ_box));
}

// Where engine e's rows begin.
static uint32_t engine_first(const occ_cl_table *table, uint32_t e)
{
    uint64_t groups = divide_up(table->capacity, OCC_GROUP_ROWS);
    uint64_t row = groups * e / table->engine_count * OCC_GROUP_ROWS;
    return row < table->capacity ? (uint32_t)row : table->capacity;
}

// Lays out engine e's parts from `parts` on, or counts them if that is NULL.
static occ_result lay_out(const occ_cl_table *table, uint32_t e, occ_table_part *parts,
                          uint32_t *count)
{
    uint32_t row = engine_first(table, e), end = engine_first(table, e + 1), most;
    occ_result result = most_rows(table, &table->engines[e], &most);
    if (result) return result;
    for (; row < end; (*count)++) {
        uint32_t rows = end - row < most ? end - row : most;
        if (parts) {
            occ_table_part *part = &parts[*count];
            *part = (occ_table_part){.engine = &table->engines[e], .first = row, .rows = rows};
            part->blocks = divide_up(rows, OCC_FLAT_ROWS);
            part->groups = divide_up(part->blocks, OCC_FLAT_BLOCKS);
            part->stride = part->blocks * OCC_FLAT_ROWS;
            part->slot_first = row;
            part->slots = rows;
            part->words = divide_up(rows, 32);
        }
        row += rows;
    }
    return OCC_SUCCESS;
}

// Pinned memory for what the parts send and receive each frame.
static occ_result pin_parts(occ_cl_table *table)
{
    size_t head = sizeof(occ_flat_frame) + OCC_FLAT_SHADOWS * sizeof(occ_shadow), words = 0;
    for (uint32_t p = 0; p < table->part_count; p++)
        words += table->parts[p].words;
    occ_result result = occ_table_pin(table, &table->masks, words * sizeof(uint32_t));
    if (!result) {
        result = occ_table_pin(table, &table->heads, table->part_count * OCC_FRAMES * head);
    }
    if (result) return result;
    words = 0;
    for (uint32_t p = 0; p < table->part_count; p++) {
        table->parts[p].host_mask = (uint32_t *)table->masks.data + words;
        table->parts[p].head =
            (occ_flat_frame *)((char *)table->heads.data + p * OCC_FRAMES * head);
        words += table->parts[p].words;
    }
    return OCC_SUCCESS;
}

occ_result occ_table_open_parts(occ_cl_table *table)
{
    uint32_t count = 0, made = 0;
    occ_result result = OCC_SUCCESS;
    for (uint32_t e = 0; e < table->engine_count && !result; e++)
        result = lay_out(table, e, NULL, &count);
    if (result) return result;
    table->parts = occ_alloc(&table->hooks, count * sizeof *table->parts);
    if (!table->parts) return OCC_ERROR_OUT_OF_MEMORY;
    table->part_count = count;
    for (uint32_t e = 0; e < table->engine_count && !result; e++)
        result = lay_out(table, e, table->parts, &made);
    for (uint32_t p = 0; p < count && !result; p++)
        result = open_part(table, &table->parts[p]);
    return result ? result : pin_parts(table);
}

void occ_table_close_parts(occ_cl_table *table)
{
    for (uint32_t p = 0; p < table->part_count; p++) {
        occ_table_part *part = &table->parts[p];
        release(&part->done);
        for (int k = 0; k < OCC_KERNELS; k++)
            release(&part->timed[k]);
        for (uint32_t f = 0; f < OCC_FRAMES; f++)
            release(&part->sent[f]);
        for (int i = 0; i < OCC_PART_BUFFERS; i++)
            if (part->buffer[i]) (void)clReleaseMemObject(part->buffer[i]);
    }
    occ_free(&table->hooks, table->parts, table->part_count * sizeof *table->parts);
    if (!table->engine_count || !table->engines[0].device.queue) return;
    occ_table_unpin(table, &table->masks);
    occ_table_unpin(table, &table->heads);
}

uint32_t occ_cl_table_parts(const occ_cl_table *table)
{
    return table ? table->part_count : 0;
}

occ_result occ_cl_table_part(const occ_cl_table *table, uint32_t index, occ_cl_part *part)
{
    if (!table || !part || index >= table->part_count) return OCC_ERROR_INVALID_ARGUMENT;
    const occ_table_part *from = &table->parts[index];
    *part = (occ_cl_part){from->engine->device.queue,
                          from->slot_first,
                          from->slots,
                          from->buffer[OCC_PART_MASK],
                          from->buffer[OCC_PART_LIST],
                          from->buffer[OCC_PART_VISIBLE]};
    return OCC_SUCCESS;
}
