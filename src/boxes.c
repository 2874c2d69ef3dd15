// SPDX-License-Identifier: Apache-2.0
#include "boxes.h"

#include "box.h"

#include <string.h>

static size_t bytes_of(const occ_boxes *boxes)
{
    return (size_t)boxes->stride * OCC_BOX_COLUMNS * sizeof(float);
}

occ_result occ_boxes_reserve(occ_hooks *hooks, occ_boxes *boxes, size_t capacity)
{
    if (boxes->data && capacity <= boxes->stride - OCC_BOX_PADDING) return OCC_SUCCESS;
    if (!capacity) return OCC_SUCCESS;
    size_t stride = (capacity + OCC_BOX_PADDING + OCC_BOX_LANES - 1) / OCC_BOX_LANES;
    stride *= OCC_BOX_LANES;
    if (stride > UINT32_MAX || stride > SIZE_MAX / (OCC_BOX_COLUMNS * sizeof(float))) {
        return OCC_ERROR_LIMIT;
    }
    occ_boxes grown = {NULL, boxes->count, (uint32_t)stride};
    grown.data = occ_alloc(hooks, bytes_of(&grown));
    if (!grown.data) return OCC_ERROR_OUT_OF_MEMORY;
    size_t used = (size_t)boxes->count * sizeof(float), room = stride * sizeof(float);
    for (uint32_t c = 0; c < OCC_BOX_COLUMNS; c++) {
        float *column = occ_boxes_column(&grown, c);
        if (used) memcpy(column, occ_boxes_column(boxes, c), used);
        memset((char *)column + used, 0, room - used);
    }
    occ_boxes_free(hooks, boxes);
    *boxes = grown;
    return OCC_SUCCESS;
}

void occ_boxes_free(occ_hooks *hooks, occ_boxes *boxes)
{
    occ_free(hooks, boxes->data, bytes_of(boxes));
    *boxes = (occ_boxes){NULL, 0, 0};
}

occ_box occ_boxes_get(const occ_boxes *boxes, uint32_t row)
{
    occ_box box;
    for (uint32_t j = 0; j < 3; j++)
        box.center[j] = occ_boxes_column(boxes, j)[row];
    for (uint32_t k = 0; k < 3; k++)
        for (uint32_t j = 0; j < 3; j++)
            box.axis[k][j] = occ_boxes_column(boxes, 3 + 3 * k + j)[row];
    return box;
}

void occ_boxes_set(occ_boxes *boxes, uint32_t row, const occ_box *box)
{
    for (uint32_t j = 0; j < 3; j++)
        occ_boxes_column(boxes, j)[row] = box->center[j];
    for (uint32_t k = 0; k < 3; k++)
        for (uint32_t j = 0; j < 3; j++)
            occ_boxes_column(boxes, 3 + 3 * k + j)[row] = box->axis[k][j];
}

// --- many at once --------------------------------------------------------------------------------

// Boxes that come in from outside.
typedef struct incoming_job {
    occ_boxes *boxes;
    const occ_box *from;
    uint32_t first, count, parts;
    uint32_t bad[OCC_MOST_PARTS]; // the first in each part, or `count`
} incoming_job;

static void put_incoming(void *context, uint32_t part)
{
    const incoming_job *job = context;
    uint32_t end = occ_part_first(job->count, job->parts, part + 1);
    for (uint32_t i = occ_part_first(job->count, job->parts, part); i < end; i++)
        occ_boxes_set(job->boxes, job->first + i, &job->from[i]);
}

static void check_incoming(void *context, uint32_t part)
{
    incoming_job *job = context;
    uint32_t end = occ_part_first(job->count, job->parts, part + 1);
    uint32_t i = occ_part_first(job->count, job->parts, part);
    while (i < end && !occ_box_check(&job->from[i]))
        i++;
    job->bad[part] = i < end ? i : job->count;
}

static void do_incoming(occ_team *team, void (*work)(void *job, uint32_t part), incoming_job *job)
{
    job->parts = occ_parts_of(job->count);
    if (job->parts < 2) team = NULL;
    if (team) occ_team_wake(team);
    occ_do_parts(team, job->parts, work, job);
    if (team) occ_team_rest(team);
}

void occ_boxes_put(occ_boxes *boxes, uint32_t first, const occ_box *from, uint32_t count,
                   occ_team *team)
{
    incoming_job job = {.boxes = boxes, .from = from, .first = first, .count = count};
    do_incoming(team, put_incoming, &job);
}

uint32_t occ_boxes_first_bad(const occ_box *boxes, uint32_t count, occ_team *team)
{
    incoming_job job = {.from = boxes, .count = count};
    do_incoming(team, check_incoming, &job);
    uint32_t first = count;
    for (uint32_t part = job.parts; part-- > 0;)
        if (job.bad[part] < count) first = job.bad[part];
    return first;
}

// A few columns, picked into the scratch columns and then copied back.
typedef struct gather_job {
    occ_boxes *boxes;
    const uint32_t *source;
    float *scratch;
    uint32_t count, parts;
    uint32_t column, columns; // the first, and how many
} gather_job;

static void pick_part(void *context, uint32_t part)
{
    const gather_job *job = context;
    uint32_t first = occ_part_first(job->count, job->parts, part);
    uint32_t end = occ_part_first(job->count, job->parts, part + 1);
    for (uint32_t c = 0; c < job->columns; c++) {
        const float *column = occ_boxes_column(job->boxes, job->column + c);
        float *picked = job->scratch + (size_t)c * job->count;
        for (uint32_t i = first; i < end; i++)
            picked[i] = column[job->source[i]];
    }
}

static void put_part(void *context, uint32_t part)
{
    const gather_job *job = context;
    uint32_t first = occ_part_first(job->count, job->parts, part);
    size_t bytes = (occ_part_first(job->count, job->parts, part + 1) - first) * sizeof(float);
    for (uint32_t c = 0; c < job->columns; c++) {
        const float *picked = job->scratch + (size_t)c * job->count;
        memcpy(occ_boxes_column(job->boxes, job->column + c) + first, picked + first, bytes);
    }
}

void occ_boxes_gather(occ_boxes *boxes, const uint32_t *source, uint32_t count, float *scratch,
                      uint32_t scratch_columns, occ_team *team)
{
    gather_job job = {.boxes = boxes, .source = source, .count = count};
    job.scratch = scratch;
    job.parts = occ_parts_of(count);
    job.columns = scratch_columns;
    for (; count && job.column < OCC_BOX_COLUMNS; job.column += job.columns) {
        uint32_t left = OCC_BOX_COLUMNS - job.column;
        if (job.columns > left) job.columns = left;
        occ_do_parts(team, job.parts, pick_part, &job);
        occ_do_parts(team, job.parts, put_part, &job);
    }
    boxes->count = count;
}
