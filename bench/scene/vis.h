// SPDX-License-Identifier: Apache-2.0
/// @file
/// Result files (.vis, version 1): u32 objects, u32 frames, then for each frame a bit per object.
#ifndef OCC_BENCH_VIS_H
#define OCC_BENCH_VIS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/// Verdicts of every frame. All zero is empty; vis_free() it when done.
typedef struct vis_result {
    uint32_t object_count, frame_count;
    uint8_t *bits; ///< vis_row_bytes() bytes for each frame.
} vis_result;

/// Bytes of one frame.
size_t vis_row_bytes(uint32_t object_count);

/// Makes a result with every bit 0. Returns false when memory runs out.
bool vis_create(vis_result *result, uint32_t object_count, uint32_t frame_count);

/// Takes over a frame's mask from 32-bit words, as occ_view_read_mask() gives them.
void vis_set_frame(vis_result *result, uint32_t frame, const uint32_t *words);

/// The number of objects whose verdict in a frame differs from the mask's.
uint32_t vis_differences(const vis_result *result, uint32_t frame, const uint32_t *words);

/// Whether an object may be visible in a frame.
bool vis_is_visible(const vis_result *result, uint32_t frame, uint32_t object);

/// Reads a result file. On failure says on standard error which file, at which byte, and what was
/// expected, zeroes `result` and returns false.
bool vis_read(const char *path, vis_result *result);

/// The same from memory. `name` stands for the file in messages; NULL: no messages.
bool vis_parse(const void *bytes, size_t size, const char *name, vis_result *result);

/// Writes a result whole or not at all. On failure says why and returns false.
bool vis_write(const char *path, const vis_result *result);

/// Frees what a result holds and zeroes it.
void vis_free(vis_result *result);

#endif
