// SPDX-License-Identifier: Apache-2.0
/// @file
/// Views on an OpenCL device that the caller chose. The only header that needs <CL/cl.h>.
#ifndef OCCLUDE_OPENCL_H
#define OCCLUDE_OPENCL_H

#ifndef CL_TARGET_OPENCL_VERSION
#define CL_TARGET_OPENCL_VERSION 120
#endif
#include <CL/cl.h>

#include "cull.h"

/// How work is laid out on a device. Speaks of speed alone: masks are the same bits.
typedef enum occ_cl_shape {
    OCC_CL_SHAPE_AUTO = 0,   ///< By the device's class: narrow on a CPU, wide on all else.
    OCC_CL_SHAPE_NARROW = 1, ///< Few, long work-groups; an object is cut up by one item.
    OCC_CL_SHAPE_WIDE = 2    ///< Many short ones; in a table 32 items cut up an object together.
} occ_cl_shape;

/// Which device a view works on, and how. All zero: the first GPU of any platform, else the first
/// device.
typedef struct occ_cl_desc {
    cl_device_id device;    ///< Default: chosen as said above, or the queue's if a queue is given.
    cl_context context;     ///< Default: one of our own for `device`. Retained.
    cl_command_queue queue; ///< In order, of `context`. Default: one of our own. Retained.
    occ_cl_shape shape;     ///< Default: automatic.
} occ_cl_desc;

/// Makes a view whose objects are tested on an OpenCL device. `view_desc` may be NULL; its backend
/// is taken as OpenCL whatever it says. `desc` may be NULL. The view keeps the scene's boxes on the
/// device from one call of occ_cull() to the next and sends only what commits have changed.
OCC_API OCC_NODISCARD occ_result occ_cl_view_create(const occ_view_desc *view_desc,
                                                    const occ_cl_desc *desc, occ_view **view);

/// The device of a view, or NULL if the view has none.
OCC_API cl_device_id occ_cl_view_device(const occ_view *view);

// --- tables: every object on the device, without an octree ---------------------------------------

/// Boxes that live on one device or several, for scenes in which everything may move in every
/// frame, and for those that are drawn by the device that culls them. No octree is kept: every
/// object is tested, 64 neighbours at a time where they fall together. Slots are numbers from 0 to
/// capacity - 1 that the caller gives out; neighbouring slots should be neighbours in space, or see
/// occ_cl_table_arrange(). A slot that was never written holds no object.
///
/// Nothing blocks but what says so. A table is used by one thread at a time. After an error
/// OCC_ERROR_DEVICE or OCC_ERROR_OUT_OF_MEMORY what is on the device is in doubt: destroy the
/// table; boxes and occluders are the caller's still, and a view of another backend can go on with
/// them.
typedef struct occ_cl_table occ_cl_table;

/// How a table is made. All zero but the capacity is a good default.
typedef struct occ_cl_table_desc {
    occ_allocator allocator; ///< Default: the C library.
    occ_logger logger;       ///< Default: silent.
    uint32_t capacity;       ///< Slots: at least 1, at most 2^31.
    /// In order, all of one context, each on a device or sub-device of its own. The rows are cut
    /// into as many equal parts, and each part into as many buffers as its device's largest one
    /// requires. Retained. Default NULL: one of our own, on the device that occ_cl_view_create()
    /// would choose.
    const cl_command_queue *queues;
    uint32_t queue_count;
    occ_cl_shape shape; ///< Default: automatic.
    /// Occluders are chosen for so many strips of the picture, side by side, by as many threads as
    /// there are processors for: 1 to 16. Which are chosen depends a little on it, and so what is
    /// missed, never what is hidden falsely. Worth it with idle processors. Default 1.
    uint32_t strips;
} occ_cl_table_desc;

/// Makes a table. `*table` is NULL on failure; OCC_ERROR_OUT_OF_MEMORY if the boxes do not fit on
/// the devices.
OCC_API OCC_NODISCARD occ_result occ_cl_table_create(const occ_cl_table_desc *desc,
                                                     occ_cl_table **table);

/// Waits for what is under way and frees the table. NULL is accepted.
OCC_API void occ_cl_table_destroy(occ_cl_table *table);

/// Writes the boxes of slots [first, first + count): checks them, copies them to pinned memory and
/// starts the transfer. Waits only for the transfer before the last one.
OCC_API OCC_NODISCARD occ_result occ_cl_table_write(occ_cl_table *table, uint32_t first,
                                                    uint32_t count, const occ_box *boxes);

/// Gives pinned memory for `count` boxes, to be filled in by the caller and then sent by
/// occ_cl_table_send(). There are two such pieces of memory, taken in turns: while one travels the
/// other can be filled. Waits only if the one whose turn it is has not arrived yet. Valid until it
/// is sent, another call asks for staging or writes, or the table is destroyed.
OCC_API OCC_NODISCARD occ_result occ_cl_table_stage(occ_cl_table *table, uint32_t count,
                                                    occ_box **boxes);

/// Starts the transfer of the staged boxes to slots [first, first + count). They are not checked: a
/// box with a number that is not finite, or whose numbers' magnitudes add up to more than
/// 4 OCC_MAX_COORDINATE, is no object, and never visible. This is also how objects are taken out.
OCC_API OCC_NODISCARD occ_result occ_cl_table_send(occ_cl_table *table, uint32_t first,
                                                   uint32_t count);

/// Writes the boxes of all slots, as occ_cl_table_write() does, and chooses the order in which they
/// lie on the device: along an octree's curve, so that neighbours in memory are neighbours in
/// space. Blocks; takes an octree's build. Slots keep their numbers, and boxes written later their
/// places.
OCC_API OCC_NODISCARD occ_result occ_cl_table_arrange(occ_cl_table *table, const occ_box *boxes);

/// What a frame leaves behind beside the mask on the device.
typedef enum occ_cl_output {
    OCC_CL_HOST_MASK = 1, ///< The mask in pinned host memory: see occ_cl_table_map_mask().
    OCC_CL_LIST = 2,      ///< The ascending list of visible slots and their number, on the device.
    OCC_CL_DRAWS = 4,     ///< `draws`: instance counts are set to 0 or 1.
    OCC_CL_COMPACT = 8    ///< `compact`: the visible slots' draws side by side. Implies the list.
} occ_cl_output;

/// One frame.
typedef struct occ_cl_frame {
    /// The occluders: a committed scene that is only read, and not after the call. Its own objects
    /// hide nothing and are not part of the table; occluders without owners suffice. NULL: none.
    const occ_scene *occluders;
    /// For each of the scene's occluder slots the slot of the table whose object it must not hide,
    /// or UINT32_MAX. Default NULL: none has an owner.
    const uint32_t *owners;
    const occ_camera_desc *camera;
    /// Default NULL. `method` PAIRWISE is not supported; of `max_occluders` 1024 at most are used;
    /// `grain` means nothing here.
    const occ_cull_desc *knobs;
    /// DrawElementsIndirectCommand records (5 words each: count, instance count, first index, base
    /// vertex, base instance), one per slot. Needed for DRAWS and COMPACT; with DRAWS the second
    /// word of each is written.
    cl_mem draws;
    cl_mem compact;            ///< Room for as many records. COMPACT needs a table of one part.
    const cl_event *wait_list; ///< Events that the frame waits for on the device.
    cl_uint waits;             ///< How many.
    uint32_t outputs; ///< occ_cl_output, added up. Default 0: the mask on the device alone.
} occ_cl_frame;

/// Starts a frame: chooses occluders on the calling thread, then enqueues all of the device's work.
/// `event` (may be NULL) receives an event that completes with it; the caller releases it. Waits
/// only if three frames are under way.
OCC_API OCC_NODISCARD occ_result occ_cl_table_cull(occ_cl_table *table, const occ_cl_frame *frame,
                                                   cl_event *event);

/// Blocks until the latest frame, which must have asked for OCC_CL_HOST_MASK, has ended, and gives
/// its mask: as occ_view_read_mask() does, in memory of the table that the next frame overwrites.
OCC_API OCC_NODISCARD occ_result occ_cl_table_map_mask(occ_cl_table *table, const uint32_t **words,
                                                       size_t *count);

/// What a part of a table holds on its device, for a renderer that shares the context. Valid until
/// the table is destroyed; written by each frame.
typedef struct occ_cl_part {
    cl_command_queue queue;
    uint32_t first, slots; ///< The mask and the list speak of these slots.
    cl_mem mask;           ///< Bit i % 32 of word i / 32 speaks of slot first + i.
    cl_mem list;           ///< Visible slots, ascending. NULL before a frame has asked for it.
    cl_mem count;          ///< One word: how many.
} occ_cl_part;

/// The number of parts: one for each queue, or more where a device's largest buffer is too small.
OCC_API uint32_t occ_cl_table_parts(const occ_cl_table *table);

/// Describes a part. In an arranged table of several parts each part's mask speaks of all slots,
/// and an object is visible if any of them says so.
OCC_API OCC_NODISCARD occ_result occ_cl_table_part(const occ_cl_table *table, uint32_t index,
                                                   occ_cl_part *part);

/// What the latest frame did on the host, and what the table holds.
typedef struct occ_cl_table_stats {
    uint32_t occluders_used;
    double walk_ms;    ///< Wall time of choosing occluders.
    double enqueue_ms; ///< Wall time of the rest of occ_cl_table_cull().
    /// Times of the device's three kernels, of the slowest part: 0 unless the queues were made with
    /// CL_QUEUE_PROFILING_ENABLE and the frame has ended.
    double blocks_ms, objects_ms, fusion_ms;
    uint64_t bytes;        ///< Host memory, pinned memory not counted.
    uint64_t pinned_bytes; ///< Of which part lies where is the driver's business.
    uint64_t device_bytes; ///< Buffers of all parts.
} occ_cl_table_stats;

/// Fills `stats`.
OCC_API OCC_NODISCARD occ_result occ_cl_table_get_stats(const occ_cl_table *table,
                                                        occ_cl_table_stats *stats);

#endif
