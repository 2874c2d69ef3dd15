// SPDX-License-Identifier: Apache-2.0
// A frame of a table: occluders are chosen here, by the walk over their octree, and all the rest is
// enqueued.
#include "cl_table.h"

#include "knobs.h"
#include "log.h"

#include <string.h>
#include <time.h>

#define FLAT_ITEMS 256 // as in kernels/flat.cl

static double now_ms(void)
{
    struct timespec time;
    (void)timespec_get(&time, TIME_UTC);
    return (double)time.tv_sec * 1e3 + (double)time.tv_nsec * 1e-6;
}

// --- occluders -----------------------------------------------------------------------------------

static occ_result set_camera(occ_cl_table *table, const occ_cl_frame *desc)
{
    occ_frame *frame = &table->frame;
    const char *reason = "";
    occ_result result = occ_knobs_init(&frame->knobs, desc->knobs, &table->hooks);
    if (result) return result;
    if (frame->knobs.method == OCC_METHOD_PAIRWISE) {
        return occ_fail(&table->hooks, OCC_ERROR_UNSUPPORTED, "a table does not do PAIRWISE");
    }
    if (frame->knobs.max_occluders > OCC_FLAT_SHADOWS)
        frame->knobs.max_occluders = OCC_FLAT_SHADOWS;
    result = occ_camera_init(&frame->camera, desc->camera, &reason);
    if (result) return occ_fail(&table->hooks, result, "%s", reason);
    frame->camera.tolerance = (double)frame->knobs.tolerance;
    frame->camera.constants.splits = frame->knobs.max_splits;
    return OCC_SUCCESS;
}

static occ_result choose_occluders(occ_cl_table *table, const occ_scene *scene)
{
    occ_frame *frame = &table->frame;
    frame->stats = (occ_view_stats){.objects = 0};
    occ_occluders_clear(frame);
    if (!scene || frame->knobs.method == OCC_METHOD_FRUSTUM) return OCC_SUCCESS;
    frame->scene = scene;
    occ_result result = occ_strips_choose(&table->strips, frame);
    frame->scene = NULL;
    if (result) return occ_fail(&table->hooks, result, "no memory for the walk");
    return OCC_SUCCESS;
}

static occ_result check(const occ_cl_table *table, const occ_cl_frame *desc)
{
    uint32_t draws = OCC_CL_DRAWS | OCC_CL_COMPACT;
    const char *reason = NULL;
    if (!desc->camera) reason = "the camera is NULL";
    if (desc->waits && !desc->wait_list) reason = "the wait list is NULL";
    if (desc->outputs & ~(OCC_CL_HOST_MASK | OCC_CL_LIST | draws)) reason = "an unknown output";
    if ((desc->outputs & draws) && !desc->draws) reason = "there are no draws";
    if (desc->outputs & OCC_CL_COMPACT) {
        if (!desc->compact) reason = "there is no room for compact draws";
        if (table->part_count > 1) reason = "compact draws need a table of one part";
    }
    if (reason) return occ_fail(&table->hooks, OCC_ERROR_INVALID_ARGUMENT, "%s", reason);
    if (desc->occluders && !occ_scene_is_committed(desc->occluders)) {
        return occ_fail(&table->hooks, OCC_ERROR_NOT_COMMITTED, "call occ_scene_commit() first");
    }
    return OCC_SUCCESS;
}

// --- what a part is sent -------------------------------------------------------------------------

// The row of a part that an occluder must not hide.
static uint32_t owner_of(const occ_cl_table *table, const occ_table_part *part,
                         const uint32_t *owners, uint32_t index)
{
    const occ_occluder *sources = table->frame.sources.data;
    uint32_t slot = owners ? owners[sources[index].index - 1] : OCC_NOBODY;
    if (slot >= table->capacity) return OCC_NOBODY;
    uint32_t row = table->row_of ? table->row_of[slot] : slot;
    return row - part->first < part->rows ? row - part->first : OCC_NOBODY;
}

static occ_result send_head(occ_cl_table *table, occ_table_part *part, const occ_cl_frame *desc)
{
    const occ_frame *frame = &table->frame;
    uint32_t turn = table->frames % OCC_FRAMES, count = frame->shadows.count;
    size_t room = sizeof(occ_flat_frame) + OCC_FLAT_SHADOWS * sizeof(occ_shadow);
    occ_flat_frame *head = (occ_flat_frame *)((char *)part->head + turn * room);
    occ_result result = occ_table_wait(table, &part->sent[turn]);
    if (result) return result;
    *head = (occ_flat_frame){.eye = frame->camera.constants,
                             .planes = frame->camera.planes,
                             .shadows = count,
                             .fused = frame->knobs.method == OCC_METHOD_FUSED,
                             .counts = table->frames & 1u};
    occ_shadow *shadows = (occ_shadow *)(head + 1);
    if (count) memcpy(shadows, frame->shadows.data, count * sizeof *shadows);
    for (uint32_t i = 0; i < count; i++)
        shadows[i].owner = owner_of(table, part, desc->owners, i);
    cl_int error =
        clEnqueueWriteBuffer(part->engine->device.queue, part->buffer[OCC_PART_FRAME], CL_FALSE, 0,
                             sizeof *head + count * sizeof *shadows, head, desc->waits,
                             desc->waits ? desc->wait_list : NULL, &part->sent[turn]);
    return error ? occ_cl_fail(&table->hooks, error, "clEnqueueWriteBuffer") : OCC_SUCCESS;
}

// --- kernels -------------------------------------------------------------------------------------

static occ_result test_blocks(const occ_cl_table *table, occ_table_part *part)
{
    const cl_mem *buffer = part->buffer;
    const occ_cl_argument arguments[] = {
        OCC_ARGUMENT(buffer[OCC_PART_FRAME]),
        OCC_ARGUMENT(buffer[OCC_PART_BOUNDS]),
        OCC_ARGUMENT(part->blocks),
        OCC_ARGUMENT(part->groups),
        OCC_ARGUMENT(buffer[OCC_PART_COUNTS]),
        OCC_ARGUMENT(buffer[OCC_PART_OPEN]),
        OCC_ARGUMENT(buffer[OCC_PART_STATES]),
        OCC_ARGUMENT(buffer[OCC_PART_LISTS]),
        OCC_ARGUMENT(buffer[OCC_PART_MASK]),
        OCC_ARGUMENT(part->words),
    };
    return occ_table_launch(table, part, OCC_KERNEL_BLOCKS, arguments, 10, part->groups, FLAT_ITEMS,
                            0, NULL, NULL);
}

static size_t at_most(size_t count, size_t most)
{
    return count < most ? count : most;
}

static occ_result test_objects(const occ_cl_table *table, occ_table_part *part)
{
    const cl_mem *buffer = part->buffer;
    cl_uint arranged = table->row_of != NULL;
    const cl_mem *slot_of = &buffer[arranged ? OCC_PART_SLOT_OF : OCC_PART_DIRTY];
    const occ_cl_argument arguments[] = {
        OCC_ARGUMENT(buffer[OCC_PART_FRAME]),
        OCC_ARGUMENT(buffer[OCC_PART_BOXES]),
        OCC_ARGUMENT(part->stride),
        OCC_ARGUMENT(part->rows),
        OCC_ARGUMENT(buffer[OCC_PART_COUNTS]),
        OCC_ARGUMENT(buffer[OCC_PART_OPEN]),
        OCC_ARGUMENT(buffer[OCC_PART_STATES]),
        OCC_ARGUMENT(buffer[OCC_PART_LISTS]),
        OCC_ARGUMENT(*slot_of),
        OCC_ARGUMENT(arranged),
        OCC_ARGUMENT(buffer[OCC_PART_UNRESOLVED]),
        OCC_ARGUMENT(buffer[OCC_PART_MASK]),
    };
    return occ_table_launch(table, part, OCC_KERNEL_OBJECTS, arguments, 12,
                            at_most(part->blocks, part->engine->busy), FLAT_ITEMS, 0, NULL, NULL);
}

static occ_result fuse_objects(const occ_cl_table *table, occ_table_part *part)
{
    const cl_mem *buffer = part->buffer;
    cl_uint arranged = table->row_of != NULL;
    const cl_mem *slot_of = &buffer[arranged ? OCC_PART_SLOT_OF : OCC_PART_DIRTY];
    const occ_cl_argument arguments[] = {
        OCC_ARGUMENT(buffer[OCC_PART_FRAME]),
        OCC_ARGUMENT(buffer[OCC_PART_BOXES]),
        OCC_ARGUMENT(part->stride),
        OCC_ARGUMENT(buffer[OCC_PART_COUNTS]),
        OCC_ARGUMENT(buffer[OCC_PART_STATES]),
        OCC_ARGUMENT(buffer[OCC_PART_LISTS]),
        OCC_ARGUMENT(*slot_of),
        OCC_ARGUMENT(arranged),
        OCC_ARGUMENT(buffer[OCC_PART_UNRESOLVED]),
        OCC_ARGUMENT(buffer[OCC_PART_MASK]),
    };
    const occ_cl_engine *engine = part->engine;
    size_t groups = at_most(part->rows, engine->busy);
    return occ_table_launch(table, part, OCC_KERNEL_FUSE, arguments, 10, groups,
                            engine->fusion_items, 0, NULL, NULL);
}

static occ_result cull_part(occ_cl_table *table, occ_table_part *part, const occ_cl_frame *desc)
{
    occ_result result = occ_table_refit(table, part);
    if (!result) result = send_head(table, part, desc);
    if (!result) result = test_blocks(table, part);
    if (!result) result = test_objects(table, part);
    if (!result && table->frame.knobs.method == OCC_METHOD_FUSED && table->frame.shadows.count) {
        result = fuse_objects(table, part);
    }
    if (!result) result = occ_table_hand_over(table, part, desc);
    return result;
}

// --- the end of a frame --------------------------------------------------------------------------

static occ_result mark_ends(occ_cl_table *table, cl_event *event)
{
    cl_event *ends = occ_alloc(&table->hooks, table->part_count * sizeof *ends);
    if (!ends) return OCC_ERROR_OUT_OF_MEMORY;
    cl_int error = CL_SUCCESS;
    for (uint32_t p = 0; p < table->part_count && !error; p++) {
        occ_table_part *part = &table->parts[p];
        if (part->done) (void)clReleaseEvent(part->done);
        part->done = NULL;
        error = clEnqueueMarkerWithWaitList(part->engine->device.queue, 0, NULL, &part->done);
        if (!error) error = clFlush(part->engine->device.queue);
        ends[p] = part->done;
    }
    if (!error && event) {
        cl_command_queue queue = table->engines[0].device.queue;
        error = clEnqueueMarkerWithWaitList(queue, table->part_count, ends, event);
        if (!error) error = clFlush(queue);
    }
    occ_free(&table->hooks, ends, table->part_count * sizeof *ends);
    return error ? occ_cl_fail(&table->hooks, error, "clEnqueueMarkerWithWaitList or clFlush")
                 : OCC_SUCCESS;
}

// What was enqueued may read the caller's buffers.
static occ_result give_up(occ_cl_table *table, occ_result result)
{
    for (uint32_t e = 0; e < table->engine_count; e++)
        (void)clFinish(table->engines[e].device.queue);
    table->outputs = 0;
    return result;
}

occ_result occ_cl_table_cull(occ_cl_table *table, const occ_cl_frame *desc, cl_event *event)
{
    if (event) *event = NULL;
    if (!table || !desc) return OCC_ERROR_INVALID_ARGUMENT;
    occ_result result = check(table, desc);
    if (!result) result = set_camera(table, desc);
    if (result) return result;
    double start = now_ms();
    result = choose_occluders(table, desc->occluders);
    if (result) return result;
    double walked = now_ms();
    table->outputs = desc->outputs;
    for (uint32_t p = 0; p < table->part_count && !result; p++)
        result = cull_part(table, &table->parts[p], desc);
    table->frames++;
    if (!result) result = mark_ends(table, event);
    if (result) {
        if (event && *event) (void)clReleaseEvent(*event);
        if (event) *event = NULL;
        return give_up(table, result);
    }
    table->stats.occluders_used = table->frame.shadows.count;
    table->stats.walk_ms = walked - start;
    table->stats.enqueue_ms = now_ms() - walked;
    return OCC_SUCCESS;
}
