// SPDX-License-Identifier: Apache-2.0
#define _POSIX_C_SOURCE 200809L

#include "kit.h"

#include <cglm/cglm.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// --- random numbers ------------------------------------------------------------------------------

uint64_t kit_next(kit_random *random)
{
    return steady_bits(random);
}

uint32_t kit_below(kit_random *random, uint32_t count)
{
    return (uint32_t)((kit_next(random) >> 32) * count >> 32);
}

float kit_between(kit_random *random, float low, float high)
{
    double part = (double)(kit_next(random) >> 40) * 0x1p-24;
    return (float)((double)low + part * ((double)high - (double)low));
}

occ_box kit_box(kit_random *random, float reach, float size)
{
    occ_box box;
    for (int j = 0; j < 3; j++) {
        box.center[j] = kit_between(random, -reach, reach);
        for (int k = 0; k < 3; k++)
            box.axis[k][j] = kit_between(random, -size, size);
    }
    return box;
}

occ_box kit_cube(float x, float y, float z, float half)
{
    return (occ_box){{x, y, z}, {{half, 0, 0}, {0, half, 0}, {0, 0, half}}};
}

// --- memory --------------------------------------------------------------------------------------

enum { MARGIN = 64 }; // before each block its size and owner, behind it bytes that must not change

typedef struct block_head {
    size_t size;
    kit_heap *heap;
    pthread_t thread;
} block_head;

static void *heap_alloc(size_t size, size_t alignment, void *user_data)
{
    kit_heap *heap = user_data;
    KIT_CHECK(size > 0, "0 bytes were asked for");
    KIT_CHECK(alignment == 64, "the alignment is %zu", alignment);
    heap->calls++;
    if (heap->fail_at &&
        (heap->calls == heap->fail_at || (heap->keeps_failing && heap->calls > heap->fail_at))) {
        heap->failures++;
        return NULL;
    }
    size_t room = (size + 2 * MARGIN + 63) / 64 * 64;
    char *memory = room > size ? aligned_alloc(64, room) : NULL;
    if (!memory) return NULL;
    block_head head = {size, heap, pthread_self()};
    memcpy(memory, &head, sizeof head);
    memset(memory + MARGIN, 0xa5, size);
    memset(memory + MARGIN + size, 0x5a, MARGIN);
    heap->blocks++;
    heap->bytes += size;
    return memory + MARGIN;
}

static void heap_free(void *pointer, size_t size, void *user_data)
{
    kit_heap *heap = user_data;
    KIT_CHECK(pointer, "NULL was freed");
    char *memory = (char *)pointer - MARGIN;
    block_head head;
    memcpy(&head, memory, sizeof head);
    KIT_CHECK(head.size == size, "%zu bytes came back as %zu", head.size, size);
    KIT_CHECK(head.heap == heap, "a block came back to another allocator");
    KIT_CHECK(pthread_equal(head.thread, pthread_self()), "another thread frees the block");
    for (int i = 0; i < MARGIN; i++)
        KIT_CHECK(memory[MARGIN + size + (size_t)i] == 0x5a, "byte %d behind a block", i);
    heap->blocks--;
    heap->bytes -= size;
    memset(pointer, 0xdd, size);
    free(memory);
}

occ_allocator kit_allocator(kit_heap *heap)
{
    return (occ_allocator){heap_alloc, heap_free, heap};
}

// --- log lines -----------------------------------------------------------------------------------

static void take_line(occ_log_level level, const char *line, void *user_data)
{
    kit_log *log = user_data;
    size_t length = strlen(line);
    KIT_CHECK(length > 0 && !strchr(line, '\n'), "a log line is one line");
    log->lines++;
    log->errors += level == OCC_LOG_ERROR;
    if (log->used + length + 2 > sizeof log->text) log->used = 0;
    if (length + 2 > sizeof log->text) return;
    memcpy(log->text + log->used, line, length);
    log->used += length;
    memcpy(log->text + log->used, "\n", 2);
    log->used++;
}

occ_logger kit_logger(kit_log *log)
{
    return (occ_logger){take_line, log};
}

void kit_forget(kit_log *log)
{
    *log = (kit_log){.lines = 0};
}

bool kit_logged(const kit_log *log, const char *part)
{
    return strstr(log->text, part) != NULL;
}

// --- scenes and cameras --------------------------------------------------------------------------

// A house: a turned box, with a smaller one inside that lets no light pass.
static occ_box house(kit_random *random)
{
    float x = kit_between(random, -100, 100), z = kit_between(random, -100, 100);
    float side = kit_between(random, 0.2f, 1.0f), height = kit_between(random, 0.5f, 8);
    float c = kit_between(random, -1, 1), s = kit_between(random, 0.1f, 1);
    return (occ_box){{x, height, z},
                     {{side * c, 0, side * s}, {0, height, 0}, {-side * s, 0, side * c}}};
}

void kit_fill(occ_scene *scene, uint32_t count, uint32_t per, uint64_t seed, occ_object *objects,
              occ_occluder *occluders)
{
    kit_random random = {seed};
    for (uint32_t i = 0, made = 0; i < count; i++) {
        occ_object object;
        occ_occluder occluder;
        occ_box box = house(&random);
        KIT_CHECK(!occ_scene_add(scene, &box, &object), "an object is refused");
        if (objects) objects[i] = object;
        if (!per || i % per) continue;
        for (int k = 0; k < 9; k++)
            box.axis[k / 3][k % 3] *= 0.9f;
        KIT_CHECK(!occ_scene_add_occluder(scene, &box, object, &occluder),
                  "an occluder is refused");
        if (occluders) occluders[made++] = occluder;
    }
}

occ_camera_desc kit_look(const float eye[3], const float target[3])
{
    vec3 from = {eye[0], eye[1], eye[2]}, to = {target[0], target[1], target[2]};
    vec3 up = {0.0f, 1.0f, 0.0f};
    mat4 view, projection, product;
    glm_lookat(from, to, up, view);
    glm_perspective(1.0471976f, 16.0f / 9.0f, 0.1f, 1000.0f, projection);
    glm_mat4_mul(projection, view, product);
    occ_camera_desc camera = {.depth = OCC_DEPTH_MINUS_ONE_TO_ONE};
    memcpy(camera.view_projection, product, sizeof camera.view_projection);
    return camera;
}

occ_camera_desc kit_path(uint32_t i)
{
    float angle = 0.37f * (float)i;
    float eye[3] = {90.0f * cosf(angle), 2.0f + (float)(i % 5), 90.0f * sinf(angle)};
    float target[3] = {-20.0f * sinf(2.0f * angle), 1.0f, 20.0f * cosf(angle)};
    return kit_look(eye, target);
}

void kit_cull(occ_view *view, const occ_scene *scene, const occ_camera_desc *camera,
              const occ_cull_desc *desc)
{
    occ_result result = occ_cull(view, scene, camera, desc);
    KIT_CHECK(result == OCC_SUCCESS, "%s", occ_result_name(result));
}

uint32_t *kit_mask(const occ_view *view, size_t *words)
{
    size_t needed = 0, count = 0;
    occ_result result = occ_view_read_mask(view, NULL, 0, &needed);
    KIT_CHECK(result == (needed ? OCC_ERROR_BUFFER_TOO_SMALL : OCC_SUCCESS), "%s for %zu words",
              occ_result_name(result), needed);
    uint32_t *mask = malloc((needed + 1) * sizeof *mask);
    KIT_CHECK(mask, "out of memory");
    result = occ_view_read_mask(view, mask, needed, &count);
    KIT_CHECK(result == OCC_SUCCESS && count == needed, "%s", occ_result_name(result));
    if (words) *words = needed;
    return mask;
}

bool kit_same_masks(const occ_view *a, const occ_view *b)
{
    size_t words[2];
    uint32_t *mask[2] = {kit_mask(a, &words[0]), kit_mask(b, &words[1])};
    bool same = words[0] == words[1] && !memcmp(mask[0], mask[1], words[0] * sizeof *mask[0]);
    free(mask[0]);
    free(mask[1]);
    return same;
}
