// SPDX-License-Identifier: Apache-2.0
/// @file
/// What can truly be seen, per object and frame. In files (version 1, little-endian, packed):
///
///     "TRU1"  u32 width  u32 height  u32 objects  u32 frames
///     frames x ( u32 index in the scene file
///                objects x ( u32 samples  u16 rays  u16 flags: bit 0 in frustum ) )
#ifndef OCC_BENCH_TRUTH_FILE_H
#define OCC_BENCH_TRUTH_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { TRUTH_IN_FRUSTUM = 1, TRUTH_MAX_SIDE = 16384 };

/// What is known about an object in a frame.
typedef struct truth_verdict {
    uint32_t samples; ///< Samples of the viewport at which it is visible.
    uint16_t rays;    ///< Of the rays sent to it where no sample shows it: those that arrive.
    uint16_t flags;   ///< TRUTH_IN_FRUSTUM or 0. Without it the others are 0.
} truth_verdict;

/// All zero is empty; truth_free() it when done.
typedef struct truth_result {
    uint32_t width, height; ///< Samples.
    uint32_t object_count, frame_count;
    uint32_t *frames;        ///< Which frames of the scene, ascending.
    truth_verdict *verdicts; ///< object_count for each frame.
} truth_result;

static inline bool truth_is_visible(const truth_verdict *verdict)
{
    return verdict->samples > 0 || verdict->rays > 0;
}

/// Makes a result of zeros. Returns false when memory runs out.
bool truth_create(truth_result *result, uint32_t object_count, uint32_t frame_count);

/// Reads a file. On failure says on standard error which file, at which byte, and what was
/// expected, zeroes `result` and returns false.
bool truth_read(const char *path, truth_result *result);

/// The same from memory. `name` stands for the file in messages; NULL: no messages.
bool truth_parse(const void *bytes, size_t size, const char *name, truth_result *result);

/// Writes a result whole or not at all. On failure says why and returns false.
bool truth_write(const char *path, const truth_result *result);

void truth_free(truth_result *result);

#endif
