// SPDX-License-Identifier: Apache-2.0
// Boxes on their way to a table: from pinned memory, in pieces, on a queue beside the kernels', so
// that the next piece travels while the last one is put in its rows.
#include "cl_table.h"

#include "box.h"
#include "log.h"
#include "tree_keys.h"
#include "tree_sort.h"

#include <string.h>

occ_result occ_table_refit(const occ_cl_table *table, occ_table_part *part)
{
    if (!part->dirty) return OCC_SUCCESS;
    const occ_cl_argument arguments[] = {
        OCC_ARGUMENT(part->buffer[OCC_PART_BOXES]),
        OCC_ARGUMENT(part->stride),
        OCC_ARGUMENT(part->rows),
        OCC_ARGUMENT(part->blocks),
        OCC_ARGUMENT(part->groups),
        OCC_ARGUMENT(part->buffer[OCC_PART_BOUNDS]),
        OCC_ARGUMENT(part->buffer[OCC_PART_DIRTY]),
    };
    occ_result result = occ_table_launch(table, part, OCC_KERNEL_BOUNDS, arguments, 7, part->groups,
                                         256, 0, NULL, NULL);
    if (!result) part->dirty = false;
    return result;
}

// Puts raw boxes, of slots [first, first + count), in their rows of a part.
static occ_result unpack(const occ_cl_table *table, occ_table_part *part, cl_uint first,
                         cl_uint count, cl_event arrived)
{
    occ_cl_engine *engine = part->engine;
    cl_uint arranged = table->row_of != NULL;
    cl_mem row_of = part->buffer[arranged ? OCC_PART_ROW_OF : OCC_PART_DIRTY];
    const occ_cl_argument arguments[] = {
        OCC_ARGUMENT(engine->raw[engine->turn]),
        OCC_ARGUMENT(first),
        OCC_ARGUMENT(count),
        OCC_ARGUMENT(row_of),
        OCC_ARGUMENT(arranged),
        OCC_ARGUMENT(part->first),
        OCC_ARGUMENT(part->rows),
        OCC_ARGUMENT(part->stride),
        OCC_ARGUMENT(part->buffer[OCC_PART_BOXES]),
        OCC_ARGUMENT(part->buffer[OCC_PART_DIRTY]),
    };
    cl_event *done = &engine->unpacked[engine->turn];
    if (*done) (void)clReleaseEvent(*done);
    *done = NULL;
    part->dirty = true;
    return occ_table_launch(table, part, OCC_KERNEL_UNPACK, arguments, 10, (count + 63) / 64, 64, 1,
                            &arrived, done);
}

static bool takes_part(const occ_cl_table *table, const occ_table_part *part, uint32_t first,
                       uint32_t count)
{
    return table->row_of || (part->first < first + count && first < part->first + part->rows);
}

// Sends one piece to an engine, whose parts take from it what is theirs.
static occ_result send_piece(occ_cl_table *table, uint32_t e, uint32_t first, uint32_t count,
                             const occ_box *boxes, cl_event *sent)
{
    occ_cl_engine *engine = &table->engines[e];
    engine->turn ^= 1u;
    const cl_event *last = &engine->unpacked[engine->turn];
    cl_event arrived;
    cl_int error = clEnqueueWriteBuffer(engine->copies, engine->raw[engine->turn], CL_FALSE, 0,
                                        count * sizeof *boxes, boxes, *last ? 1 : 0,
                                        *last ? last : NULL, &arrived);
    if (error) return occ_cl_fail(&table->hooks, error, "clEnqueueWriteBuffer");
    if (*sent) (void)clReleaseEvent(*sent);
    *sent = arrived;
    error = clFlush(engine->copies);
    if (error) return occ_cl_fail(&table->hooks, error, "clFlush");
    occ_result result = OCC_SUCCESS;
    for (uint32_t p = 0; p < table->part_count && !result; p++) {
        occ_table_part *part = &table->parts[p];
        if (part->engine != engine || !takes_part(table, part, first, count)) continue;
        result = unpack(table, part, first, count, arrived);
    }
    if (result) return result;
    error = clFlush(engine->device.queue);
    return error ? occ_cl_fail(&table->hooks, error, "clFlush") : OCC_SUCCESS;
}

// Whether any of an engine's parts takes some of these boxes.
static bool takes_engine(const occ_cl_table *table, uint32_t e, uint32_t first, uint32_t count)
{
    for (uint32_t p = 0; p < table->part_count; p++) {
        const occ_table_part *part = &table->parts[p];
        if (part->engine == &table->engines[e] && takes_part(table, part, first, count))
            return true;
    }
    return false;
}

// What a failed call has started reads memory that the caller gets back: wait for it.
static occ_result give_up(occ_cl_table *table, occ_result result)
{
    for (uint32_t e = 0; e < table->engine_count; e++) {
        (void)clFinish(table->engines[e].copies);
        (void)clFinish(table->engines[e].device.queue);
    }
    return result;
}

static bool fits(const occ_cl_table *table, uint32_t first, uint32_t count)
{
    return first <= table->capacity && count <= table->capacity - first;
}

occ_result occ_cl_table_stage(occ_cl_table *table, uint32_t count, occ_box **boxes)
{
    if (!table || !boxes) return OCC_ERROR_INVALID_ARGUMENT;
    *boxes = NULL;
    if (!count || count > table->capacity) {
        return occ_fail(&table->hooks, OCC_ERROR_INVALID_ARGUMENT, "%u boxes, %u slots", count,
                        table->capacity);
    }
    occ_cl_stage *stage = &table->stages[table->stage];
    occ_result result = OCC_SUCCESS;
    for (uint32_t e = 0; e < table->engine_count && !result; e++)
        result = occ_table_wait(table, &stage->sent[e]);
    if (!result) result = occ_table_pin(table, &stage->pinned, count * sizeof **boxes);
    if (result) return give_up(table, result);
    if (!stage->pinned.data) return give_up(table, OCC_ERROR_DEVICE);
    stage->boxes = count;
    *boxes = stage->pinned.data;
    return OCC_SUCCESS;
}

occ_result occ_cl_table_send(occ_cl_table *table, uint32_t first, uint32_t count)
{
    if (!table) return OCC_ERROR_INVALID_ARGUMENT;
    occ_cl_stage *stage = &table->stages[table->stage];
    if (!fits(table, first, count) || count > stage->boxes) {
        return occ_fail(&table->hooks, OCC_ERROR_INVALID_ARGUMENT,
                        "slots %u to %u of %u, %u boxes staged", first, first + count,
                        table->capacity, stage->boxes);
    }
    const occ_box *boxes = stage->pinned.data;
    occ_result result = OCC_SUCCESS;
    for (uint32_t i = 0; i < count && !result; i += OCC_STAGED_BOXES) {
        uint32_t piece = count - i < OCC_STAGED_BOXES ? count - i : OCC_STAGED_BOXES;
        for (uint32_t e = 0; e < table->engine_count && !result; e++)
            if (takes_engine(table, e, first + i, piece))
                result = send_piece(table, e, first + i, piece, boxes + i, &stage->sent[e]);
    }
    stage->boxes = 0;
    table->stage ^= 1u;
    return result ? give_up(table, result) : OCC_SUCCESS;
}

static occ_result check_boxes(const occ_cl_table *table, const occ_box *boxes, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        occ_result result = occ_box_check(&boxes[i]);
        if (result) return occ_fail(&table->hooks, result, "box %u", i);
    }
    return OCC_SUCCESS;
}

static occ_result write_checked(occ_cl_table *table, uint32_t first, uint32_t count,
                                const occ_box *boxes)
{
    occ_result result = OCC_SUCCESS;
    for (uint32_t i = 0; i < count && !result; i += OCC_STAGED_BOXES) {
        uint32_t piece = count - i < OCC_STAGED_BOXES ? count - i : OCC_STAGED_BOXES;
        occ_box *staged = NULL;
        result = occ_cl_table_stage(table, piece, &staged);
        if (result) return result;
        if (!staged) return OCC_ERROR_DEVICE;
        memcpy(staged, boxes + i, piece * sizeof *staged);
        result = occ_cl_table_send(table, first + i, piece);
    }
    return result;
}

occ_result occ_cl_table_write(occ_cl_table *table, uint32_t first, uint32_t count,
                              const occ_box *boxes)
{
    if (!table) return OCC_ERROR_INVALID_ARGUMENT;
    if (!boxes || !fits(table, first, count)) {
        return occ_fail(&table->hooks, OCC_ERROR_INVALID_ARGUMENT, "%u boxes from slot %u of %u",
                        count, first, table->capacity);
    }
    occ_result result = check_boxes(table, boxes, count);
    return result ? result : write_checked(table, first, count, boxes);
}

// --- arranging -----------------------------------------------------------------------------------

static void bounds_of(const void *boxes, const uint32_t *rows, uint32_t first, uint32_t count,
                      occ_block *block)
{
    occ_bounds_of_array(boxes, rows, first, count, block);
}

// Fills slot_of, row by row, along the octree's curve.
static occ_result choose_order(occ_cl_table *table, const occ_box *boxes, uint32_t *slot_of)
{
    uint32_t count = table->capacity;
    size_t room = occ_octree_room(count, count, NULL);
    void *memory = occ_alloc(&table->hooks, room);
    if (!memory) return OCC_ERROR_OUT_OF_MEMORY;
    occ_tree_items items = {boxes, bounds_of};
    occ_root root = occ_octree_root(&items, NULL, count, NULL);
    occ_tree_entry *entries = memory;
    uint64_t *keys = (uint64_t *)(entries + count);
    occ_octree_keys(&items, &root, count, keys, NULL);
    for (uint32_t i = 0; i < count; i++)
        entries[i] = (occ_tree_entry){keys[i], i};
    occ_tree_sort(entries, keys, count, NULL);
    for (uint32_t row = 0; row < count; row++)
        slot_of[row] = entries[row].row;
    occ_free(&table->hooks, memory, room);
    return OCC_SUCCESS;
}

static occ_result write_words(occ_cl_table *table, occ_table_part *part, int which, size_t words,
                              const uint32_t *from)
{
    occ_result result = occ_table_buffer(table, part, which, words * sizeof *from);
    if (result) return result;
    cl_int error = clEnqueueWriteBuffer(part->engine->device.queue, part->buffer[which], CL_TRUE, 0,
                                        words * sizeof *from, from, 0, NULL, NULL);
    return error ? occ_cl_fail(&table->hooks, error, "clEnqueueWriteBuffer") : OCC_SUCCESS;
}

// From here on each part's mask speaks of all slots.
static occ_result widen_parts(occ_cl_table *table, const uint32_t *slot_of)
{
    occ_result result = OCC_SUCCESS;
    size_t words = OCC_MASK_WORDS(table->capacity);
    if (table->part_count > 1) {
        result = occ_table_pin(table, &table->masks, table->part_count * words * sizeof(uint32_t));
    }
    for (uint32_t p = 0; p < table->part_count && !result; p++) {
        occ_table_part *part = &table->parts[p];
        result = write_words(table, part, OCC_PART_ROW_OF, table->capacity, table->row_of);
        if (!result) {
            result = write_words(table, part, OCC_PART_SLOT_OF, part->rows, slot_of + part->first);
        }
        if (!result) {
            result = occ_table_buffer(table, part, OCC_PART_MASK, words * sizeof(cl_uint));
        }
        part->slot_first = 0;
        part->slots = table->capacity;
        part->words = (cl_uint)words;
        part->host_mask = (uint32_t *)table->masks.data + p * words;
    }
    return result;
}

occ_result occ_cl_table_arrange(occ_cl_table *table, const occ_box *boxes)
{
    if (!table) return OCC_ERROR_INVALID_ARGUMENT;
    if (!boxes) return occ_fail(&table->hooks, OCC_ERROR_INVALID_ARGUMENT, "the boxes are NULL");
    occ_result result = check_boxes(table, boxes, table->capacity);
    if (result) return result;
    (void)give_up(table, OCC_SUCCESS); // nothing may be under way while buffers change
    size_t bytes = (size_t)table->capacity * sizeof(uint32_t);
    uint32_t *slot_of = occ_alloc(&table->hooks, bytes);
    uint32_t *row_of = table->row_of ? table->row_of : occ_alloc(&table->hooks, bytes);
    result = slot_of && row_of ? choose_order(table, boxes, slot_of) : OCC_ERROR_OUT_OF_MEMORY;
    if (result) {
        if (row_of != table->row_of) occ_free(&table->hooks, row_of, bytes);
        occ_free(&table->hooks, slot_of, bytes);
        return occ_fail(&table->hooks, result, "no memory to arrange %u boxes", table->capacity);
    }
    for (uint32_t row = 0; row < table->capacity; row++)
        row_of[slot_of[row]] = row;
    table->row_of = row_of;
    result = widen_parts(table, slot_of);
    occ_free(&table->hooks, slot_of, bytes);
    return result ? give_up(table, result) : write_checked(table, 0, table->capacity, boxes);
}
