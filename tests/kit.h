// SPDX-License-Identifier: Apache-2.0
// What several tests share: numbers that are random yet the same everywhere, an allocator that
// counts and fails on demand, a logger that remembers, scenes, cameras, and masks that compare.
#ifndef OCC_TEST_KIT_H
#define OCC_TEST_KIT_H

#include "steady.h"

#include <check.h>
#include <occlude/occlude.h>
#include <string.h>

// For loops: ck_assert() writes to a pipe even when it holds, this does not.
#define KIT_CHECK(condition, ...)                                                                  \
    do {                                                                                           \
        if (!(condition)) ck_abort_msg(__VA_ARGS__);                                               \
    } while (0)

// Bit for bit: -0 is not 0 here, and a NaN is itself.
static inline bool kit_same_bits(const void *a, const void *b, size_t size)
{
    return memcmp(a, b, size) == 0;
}

typedef steady_random kit_random;

uint64_t kit_next(kit_random *random);
uint32_t kit_below(kit_random *random, uint32_t count);
float kit_between(kit_random *random, float low, float high);

// A sheared, turned or mirrored box with its center within ±reach and axes of up to `size`.
occ_box kit_box(kit_random *random, float reach, float size);

// An axis-aligned box.
occ_box kit_cube(float x, float y, float z, float half);

// An allocator that counts. It checks what the library promises of its calls: sizes that agree,
// alignment, nothing written beyond the end, and one thread.
typedef struct kit_heap {
    uint64_t calls;     // of alloc
    uint64_t blocks;    // given out and not yet taken back
    uint64_t bytes;     // in them
    uint64_t fail_at;   // the number of the call that gets NULL; 0: none
    bool keeps_failing; // and so do all after it
    uint64_t failures;
} kit_heap;

occ_allocator kit_allocator(kit_heap *heap);

// A logger that remembers.
typedef struct kit_log {
    unsigned lines;
    unsigned errors;
    size_t used;
    char text[8000]; // the latest lines, each with a newline
} kit_log;

occ_logger kit_logger(kit_log *log);
void kit_forget(kit_log *log);
bool kit_logged(const kit_log *log, const char *part);

// Adds `count` objects scattered over ±100, the first of every `per` with an occluder inside it
// (per 0: none). The arrays may be NULL.
void kit_fill(occ_scene *scene, uint32_t count, uint32_t per, uint64_t seed, occ_object *objects,
              occ_occluder *occluders);

// A camera with a field of view of 60 degrees, near 0.1, far 1000.
occ_camera_desc kit_look(const float eye[3], const float target[3]);

// The i-th of a path of cameras through what kit_fill() makes.
occ_camera_desc kit_path(uint32_t i);

// Culls and fails the test unless that succeeds.
void kit_cull(occ_view *view, const occ_scene *scene, const occ_camera_desc *camera,
              const occ_cull_desc *desc);

// The mask, to be freed. `*words` may be NULL.
uint32_t *kit_mask(const occ_view *view, size_t *words);

bool kit_same_masks(const occ_view *a, const occ_view *b);

#endif
