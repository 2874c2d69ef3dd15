// SPDX-License-Identifier: Apache-2.0
// What a frame of a table leaves behind: lists and draws on the device, and the mask on the host.
#include "cl_table.h"

#include "log.h"

#define TILE_WORDS 2048u // as in kernels/list.cl

static occ_result make_list(occ_cl_table *table, occ_table_part *part)
{
    cl_uint tiles = (part->words + TILE_WORDS - 1) / TILE_WORDS;
    occ_result result = occ_table_buffer(table, part, OCC_PART_TILES, tiles * sizeof(cl_uint));
    if (!result) {
        result =
            occ_table_buffer(table, part, OCC_PART_LIST, (size_t)part->slots * sizeof(cl_uint));
    }
    if (result) return result;
    const cl_mem *buffer = part->buffer;
    const occ_cl_argument count[] = {OCC_ARGUMENT(buffer[OCC_PART_MASK]), OCC_ARGUMENT(part->words),
                                     OCC_ARGUMENT(buffer[OCC_PART_TILES])};
    const occ_cl_argument place[] = {OCC_ARGUMENT(buffer[OCC_PART_TILES]), OCC_ARGUMENT(tiles),
                                     OCC_ARGUMENT(buffer[OCC_PART_VISIBLE])};
    const occ_cl_argument write[] = {OCC_ARGUMENT(buffer[OCC_PART_MASK]), OCC_ARGUMENT(part->words),
                                     OCC_ARGUMENT(buffer[OCC_PART_TILES]),
                                     OCC_ARGUMENT(part->slot_first),
                                     OCC_ARGUMENT(buffer[OCC_PART_LIST])};
    result = occ_table_launch(table, part, OCC_KERNEL_TILES, count, 3, tiles, 256, 0, NULL, NULL);
    if (!result) {
        result = occ_table_launch(table, part, OCC_KERNEL_PLACES, place, 3, 1, 256, 0, NULL, NULL);
    }
    if (result) return result;
    return occ_table_launch(table, part, OCC_KERNEL_WRITE, write, 5, tiles, 256, 0, NULL, NULL);
}

static occ_result set_draws(const occ_cl_table *table, occ_table_part *part, cl_mem draws)
{
    const occ_cl_argument arguments[] = {OCC_ARGUMENT(part->buffer[OCC_PART_MASK]),
                                         OCC_ARGUMENT(part->slots), OCC_ARGUMENT(part->slot_first),
                                         OCC_ARGUMENT(draws)};
    return occ_table_launch(table, part, OCC_KERNEL_DRAWS, arguments, 4, (part->slots + 63) / 64,
                            64, 0, NULL, NULL);
}

static occ_result compact_draws(const occ_cl_table *table, occ_table_part *part, cl_mem draws,
                                cl_mem compact)
{
    const occ_cl_argument arguments[] = {OCC_ARGUMENT(part->buffer[OCC_PART_LIST]),
                                         OCC_ARGUMENT(part->buffer[OCC_PART_VISIBLE]),
                                         OCC_ARGUMENT(draws), OCC_ARGUMENT(compact)};
    return occ_table_launch(table, part, OCC_KERNEL_COMPACT, arguments, 4, part->engine->busy, 64,
                            0, NULL, NULL);
}

occ_result occ_table_hand_over(occ_cl_table *table, occ_table_part *part, const occ_cl_frame *desc)
{
    uint32_t outputs = desc->outputs;
    occ_result result = OCC_SUCCESS;
    if (outputs & (OCC_CL_LIST | OCC_CL_COMPACT)) result = make_list(table, part);
    if (!result && (outputs & OCC_CL_DRAWS)) result = set_draws(table, part, desc->draws);
    if (!result && (outputs & OCC_CL_COMPACT)) {
        result = compact_draws(table, part, desc->draws, desc->compact);
    }
    if (result || !(outputs & OCC_CL_HOST_MASK)) return result;
    cl_int error =
        clEnqueueReadBuffer(part->engine->device.queue, part->buffer[OCC_PART_MASK], CL_FALSE, 0,
                            part->words * sizeof(uint32_t), part->host_mask, 0, NULL, NULL);
    return error ? occ_cl_fail(&table->hooks, error, "clEnqueueReadBuffer") : OCC_SUCCESS;
}

// In an arranged table every part has an opinion of every slot.
static void merge_masks(const occ_cl_table *table)
{
    uint32_t *words = table->parts[0].host_mask;
    for (uint32_t p = 1; p < table->part_count; p++)
        for (uint32_t w = 0; w < table->parts[p].words; w++)
            words[w] |= table->parts[p].host_mask[w];
}

occ_result occ_cl_table_map_mask(occ_cl_table *table, const uint32_t **words, size_t *count)
{
    if (!table || !words || !count) return OCC_ERROR_INVALID_ARGUMENT;
    *words = NULL;
    *count = 0;
    if (!(table->outputs & OCC_CL_HOST_MASK)) {
        return occ_fail(&table->hooks, OCC_ERROR_NO_RESULT, "no frame has asked for the mask");
    }
    occ_result result = OCC_SUCCESS;
    bool waited = false;
    for (uint32_t p = 0; p < table->part_count && !result; p++) {
        waited = waited || table->parts[p].done;
        result = occ_table_wait(table, &table->parts[p].done);
    }
    if (result) {
        table->outputs = 0;
        return result;
    }
    if (waited && table->row_of) merge_masks(table);
    *words = table->parts[0].host_mask;
    *count = OCC_MASK_WORDS(table->capacity);
    return OCC_SUCCESS;
}

// Milliseconds that the latest launches of a kernel took, the longest of all parts.
static double time_of(const occ_cl_table *table, int kernel)
{
    double most = 0.0;
    for (uint32_t p = 0; p < table->part_count; p++) {
        cl_event event = table->parts[p].timed[kernel];
        cl_ulong start, end;
        if (!event ||
            clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_START, sizeof start, &start,
                                    NULL) ||
            clGetEventProfilingInfo(event, CL_PROFILING_COMMAND_END, sizeof end, &end, NULL)) {
            continue;
        }
        double time = (double)(end - start) * 1e-6;
        most = time > most ? time : most;
    }
    return most;
}

occ_result occ_cl_table_get_stats(const occ_cl_table *table, occ_cl_table_stats *stats)
{
    if (!table || !stats) return OCC_ERROR_INVALID_ARGUMENT;
    *stats = table->stats;
    stats->bytes = table->hooks.bytes;
    stats->blocks_ms = time_of(table, OCC_KERNEL_BLOCKS);
    stats->objects_ms = time_of(table, OCC_KERNEL_OBJECTS);
    stats->fusion_ms = time_of(table, OCC_KERNEL_FUSE);
    return OCC_SUCCESS;
}
