// SPDX-License-Identifier: Apache-2.0
// Tables of boxes on devices. The rows of a table are cut into parts; a part has its own buffers on
// the device of its engine, which several parts may share. A part begins with a group of blocks
// (flat.h), so that no word of a mask belongs to two.
#ifndef OCC_CL_TABLE_H
#define OCC_CL_TABLE_H

#include "cl_device.h"
#include "flat.h"
#include "strips.h"

#define OCC_GROUP_ROWS   (OCC_FLAT_ROWS * OCC_FLAT_BLOCKS)
#define OCC_STAGED_BOXES (256u * 1024u) // that travel at a time
#define OCC_FRAMES       3u             // that may be under way
#define OCC_MOST_QUEUES  64u

enum {
    OCC_KERNEL_UNPACK,
    OCC_KERNEL_BOUNDS,
    OCC_KERNEL_BLOCKS,
    OCC_KERNEL_OBJECTS,
    OCC_KERNEL_FUSE,
    OCC_KERNEL_TILES,
    OCC_KERNEL_PLACES,
    OCC_KERNEL_WRITE,
    OCC_KERNEL_DRAWS,
    OCC_KERNEL_COMPACT,
    OCC_KERNELS
};

// A queue of the caller's or ours, and what belongs to its device.
typedef struct occ_cl_engine {
    occ_cl_device device;
    cl_command_queue copies; // for boxes on their way, beside the kernels
    cl_kernel kernel[OCC_KERNELS];
    bool takes_times;     // the queue does
    size_t busy;          // work-groups that keep the device busy
    size_t fusion_items;  // of a work-group of the last kernel
    cl_mem raw[2];        // boxes as they came, taken in turns
    cl_event unpacked[2]; // until when they are needed
    uint32_t turn;
} occ_cl_engine;

enum {
    OCC_PART_BOXES,
    OCC_PART_BOUNDS,
    OCC_PART_DIRTY,
    OCC_PART_FRAME,
    OCC_PART_COUNTS,
    OCC_PART_OPEN,
    OCC_PART_STATES,
    OCC_PART_LISTS,
    OCC_PART_UNRESOLVED,
    OCC_PART_MASK,
    OCC_PART_TILES,
    OCC_PART_LIST,
    OCC_PART_VISIBLE,
    OCC_PART_ROW_OF,
    OCC_PART_SLOT_OF,
    OCC_PART_BUFFERS
};

typedef struct occ_table_part {
    occ_cl_engine *engine;
    cl_uint first, rows; // of the table
    cl_uint stride;
    cl_uint blocks, groups;
    cl_uint slot_first, slots; // what the mask speaks of
    cl_uint words;
    cl_mem buffer[OCC_PART_BUFFERS];
    size_t bytes[OCC_PART_BUFFERS];
    cl_event timed[OCC_KERNELS]; // the latest launches, where the queue takes times
    bool dirty;                  // boxes came since the latest bounds
    cl_event done;               // the latest frame
    uint32_t *host_mask;         // pinned
    occ_flat_frame *head;        // pinned, OCC_FRAMES of them, each with room for the shadows
    cl_event sent[OCC_FRAMES];
} occ_table_part;

// Boxes on their way out of pinned memory.
typedef struct occ_cl_stage {
    occ_cl_pinned pinned;
    uint32_t boxes; // how many the caller was promised
    cl_event *sent; // one per engine: the last transfer out of it
} occ_cl_stage;

struct occ_cl_table {
    occ_hooks hooks;
    uint32_t capacity;
    occ_cl_engine *engines;
    uint32_t engine_count;
    occ_table_part *parts;
    uint32_t part_count;
    uint32_t *row_of; // slot by slot, once arranged; else NULL
    occ_cl_stage stages[2];
    uint32_t stage; // whose turn it is
    occ_cl_pinned masks, heads;
    occ_frame frame;   // the occluders chosen
    occ_strips strips; // by whom
    uint32_t frames;   // so far
    uint32_t outputs;
    occ_cl_table_stats stats;
};

// cl_table_parts.c
occ_result occ_table_open_parts(occ_cl_table *table);
void occ_table_close_parts(occ_cl_table *table);

// Makes a buffer of a part, if it is not there.
occ_result occ_table_buffer(occ_cl_table *table, occ_table_part *part, int which, size_t bytes);

// Makes sure that pinned memory holds so many bytes.
occ_result occ_table_pin(occ_cl_table *table, occ_cl_pinned *pinned, size_t bytes);
void occ_table_unpin(occ_cl_table *table, occ_cl_pinned *pinned);

// Waits for an event, if there is one, and lets go of it.
occ_result occ_table_wait(const occ_cl_table *table, cl_event *event);

// One argument of a kernel.
typedef struct occ_cl_argument {
    size_t size;
    const void *value;
} occ_cl_argument;

#define OCC_ARGUMENT(x) ((occ_cl_argument){sizeof(x), &(x)})

// Enqueues a kernel with `groups` groups of `items` items.
occ_result occ_table_launch(const occ_cl_table *table, occ_table_part *part, int kernel,
                            const occ_cl_argument *arguments, cl_uint count, size_t groups,
                            size_t items, cl_uint waits, const cl_event *wait_list,
                            cl_event *event);

// cl_table_write.c: brings the bounds of a part up to date with its boxes.
occ_result occ_table_refit(const occ_cl_table *table, occ_table_part *part);

// cl_table_read.c: what a frame was asked for beside the mask on the device.
occ_result occ_table_hand_over(occ_cl_table *table, occ_table_part *part, const occ_cl_frame *desc);

#endif
