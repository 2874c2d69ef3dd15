// SPDX-License-Identifier: Apache-2.0
#include "vis.h"

#include "obs.h"
#include "outfile.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { VIS_HEADER_BYTES = 8 };

size_t vis_row_bytes(uint32_t object_count)
{
    return ((size_t)object_count + 7) / 8;
}

bool vis_create(vis_result *result, uint32_t object_count, uint32_t frame_count)
{
    *result = (vis_result){object_count, frame_count, NULL};
    result->bits = calloc((size_t)frame_count + 1, vis_row_bytes(object_count) + 1);
    if (!result->bits) *result = (vis_result){0};
    return result->bits != NULL;
}

void vis_free(vis_result *result)
{
    free(result->bits);
    *result = (vis_result){0};
}

void vis_set_frame(vis_result *result, uint32_t frame, const uint32_t *words)
{
    size_t count = vis_row_bytes(result->object_count);
    uint8_t *row = result->bits + frame * count;
    for (size_t i = 0; i < count; i++)
        row[i] = (uint8_t)(words[i / 4] >> (8 * (i % 4)));
}

uint32_t vis_differences(const vis_result *result, uint32_t frame, const uint32_t *words)
{
    size_t count = vis_row_bytes(result->object_count);
    const uint8_t *row = result->bits + frame * count;
    uint32_t different = 0;
    for (size_t i = 0; i < count; i++) {
        uint32_t bits = (words[i / 4] >> (8 * (i % 4)) ^ row[i]) & 0xffu;
        for (; bits; bits &= bits - 1)
            different++;
    }
    return different;
}

bool vis_is_visible(const vis_result *result, uint32_t frame, uint32_t object)
{
    const uint8_t *row = result->bits + frame * vis_row_bytes(result->object_count);
    return (row[object >> 3] >> (object & 7) & 1) != 0;
}

static uint32_t vis_load(const uint8_t *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static bool vis_refuse(const char *name, uint64_t at, const char *what)
{
    if (name)
        fprintf(stderr, "occlude-bench: %s: byte %llu: expected %s\n", name, (unsigned long long)at,
                what);
    return false;
}

bool vis_parse(const void *bytes, size_t size, const char *name, vis_result *result)
{
    *result = (vis_result){0};
    const uint8_t *p = bytes;
    if (size < VIS_HEADER_BYTES)
        return vis_refuse(name, size, "a header of 8 bytes, the file ends");
    uint32_t objects = vis_load(p), frames = vis_load(p + 4);
    uint64_t expected = VIS_HEADER_BYTES + (uint64_t)vis_row_bytes(objects) * frames;
    if (size != expected) {
        char what[128];
        snprintf(what, sizeof what, "a file of %llu bytes (%u objects, %u frames), the file %s",
                 (unsigned long long)expected, objects, frames,
                 size < expected ? "ends" : "goes on");
        return vis_refuse(name, size < expected ? size : expected, what);
    }
    if (!vis_create(result, objects, frames))
        return vis_refuse(name, VIS_HEADER_BYTES, "enough memory for it");
    memcpy(result->bits, p + VIS_HEADER_BYTES, size - VIS_HEADER_BYTES);
    return true;
}

bool vis_read(const char *path, vis_result *result)
{
    *result = (vis_result){0};
    size_t size;
    void *bytes = obs_read_bytes(path, &size);
    bool good = bytes && vis_parse(bytes, size, path, result);
    free(bytes);
    return good;
}

bool vis_write(const char *path, const vis_result *result)
{
    outfile file;
    if (!outfile_open(&file, path)) return false;
    uint8_t header[VIS_HEADER_BYTES];
    for (int i = 0; i < 4; i++) {
        header[i] = (uint8_t)(result->object_count >> (8 * i));
        header[4 + i] = (uint8_t)(result->frame_count >> (8 * i));
    }
    fwrite(header, 1, sizeof header, file.stream);
    fwrite(result->bits, 1, vis_row_bytes(result->object_count) * result->frame_count, file.stream);
    return outfile_commit(&file);
}
