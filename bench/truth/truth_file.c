// SPDX-License-Identifier: Apache-2.0
#include "truth_file.h"

#include "obs.h"
#include "outfile.h"

#include <stdio.h>
#include <stdlib.h>

enum { TRUTH_HEADER_BYTES = 20, TRUTH_INDEX_BYTES = 4, TRUTH_VERDICT_BYTES = 8 };

static const char truth_magic[4] = {'T', 'R', 'U', '1'};

bool truth_create(truth_result *result, uint32_t object_count, uint32_t frame_count)
{
    *result = (truth_result){.object_count = object_count, .frame_count = frame_count};
    result->frames = calloc((size_t)frame_count + 1, sizeof *result->frames);
    result->verdicts = calloc((size_t)object_count * frame_count + 1, sizeof *result->verdicts);
    if (result->frames && result->verdicts) return true;
    truth_free(result);
    return false;
}

void truth_free(truth_result *result)
{
    free(result->frames);
    free(result->verdicts);
    *result = (truth_result){0};
}

// --- reading -------------------------------------------------------------------------------------

typedef struct truth_cursor {
    const uint8_t *bytes;
    size_t size, at;
    const char *name;
} truth_cursor;

static uint32_t truth_load(const uint8_t *p, int bytes)
{
    uint32_t value = 0;
    for (int i = 0; i < bytes; i++)
        value |= (uint32_t)p[i] << (8 * i);
    return value;
}

static bool truth_refuse(const truth_cursor *cursor, size_t at, const char *expected)
{
    if (cursor->name)
        fprintf(stderr, "occlude-bench: %s: byte %zu: expected %s\n", cursor->name, at, expected);
    return false;
}

static bool read_header(truth_cursor *cursor, truth_result *header)
{
    for (size_t i = 0; i < sizeof truth_magic; i++)
        if (i >= cursor->size || cursor->bytes[i] != (uint8_t)truth_magic[i])
            return truth_refuse(cursor, i, "the magic \"TRU1\"");
    if (cursor->size < TRUTH_HEADER_BYTES)
        return truth_refuse(cursor, cursor->size, "a header of 20 bytes, the file ends");
    header->width = truth_load(cursor->bytes + 4, 4);
    header->height = truth_load(cursor->bytes + 8, 4);
    header->object_count = truth_load(cursor->bytes + 12, 4);
    header->frame_count = truth_load(cursor->bytes + 16, 4);
    for (size_t i = 0; i < 2; i++) {
        uint32_t side = i == 0 ? header->width : header->height;
        if (side < 1 || side > TRUTH_MAX_SIDE)
            return truth_refuse(cursor, 4 + 4 * i, "a number of samples from 1 to 16384");
    }
    cursor->at = TRUTH_HEADER_BYTES;
    return true;
}

// Before anything is allocated: a short file with huge counts must not ask for their memory. Counts
// that multiply to more than 2^64 are more than any file has.
static bool check_size(const truth_cursor *cursor, const truth_result *header)
{
    uint64_t row = TRUTH_INDEX_BYTES + (uint64_t)TRUTH_VERDICT_BYTES * header->object_count;
    bool is_huge = header->frame_count > (UINT64_MAX - TRUTH_HEADER_BYTES) / row;
    uint64_t expected = is_huge ? UINT64_MAX : TRUTH_HEADER_BYTES + row * header->frame_count;
    if (cursor->size == expected) return true;
    bool is_short = cursor->size < expected;
    char what[128];
    snprintf(what, sizeof what, "a file of %llu bytes (%u objects, %u frames), the file %s",
             (unsigned long long)expected, header->object_count, header->frame_count,
             is_short ? "ends" : "goes on");
    return truth_refuse(cursor, is_short ? cursor->size : (size_t)expected, what);
}

static bool read_verdict(truth_cursor *cursor, uint64_t most_samples, truth_verdict *verdict)
{
    const uint8_t *p = cursor->bytes + cursor->at;
    verdict->samples = truth_load(p, 4);
    verdict->rays = (uint16_t)truth_load(p + 4, 2);
    verdict->flags = (uint16_t)truth_load(p + 6, 2);
    if (verdict->samples > most_samples)
        return truth_refuse(cursor, cursor->at, "no more samples than the viewport has");
    if (verdict->flags > TRUTH_IN_FRUSTUM)
        return truth_refuse(cursor, cursor->at + 6, "flags of 0 or 1");
    if (truth_is_visible(verdict) && !verdict->flags)
        return truth_refuse(cursor, cursor->at + 6, "a visible object to be in the frustum");
    cursor->at += TRUTH_VERDICT_BYTES;
    return true;
}

static bool read_frames(truth_cursor *cursor, truth_result *result)
{
    truth_verdict *verdict = result->verdicts;
    for (uint32_t f = 0; f < result->frame_count; f++) {
        result->frames[f] = truth_load(cursor->bytes + cursor->at, 4);
        if (f > 0 && result->frames[f] <= result->frames[f - 1])
            return truth_refuse(cursor, cursor->at, "ascending frames");
        cursor->at += TRUTH_INDEX_BYTES;
        for (uint32_t i = 0; i < result->object_count; i++)
            if (!read_verdict(cursor, (uint64_t)result->width * result->height, verdict++))
                return false;
    }
    return true;
}

bool truth_parse(const void *bytes, size_t size, const char *name, truth_result *result)
{
    *result = (truth_result){0};
    truth_cursor cursor = {bytes, size, 0, name};
    truth_result header = {0};
    if (!read_header(&cursor, &header) || !check_size(&cursor, &header)) return false;
    if (!truth_create(result, header.object_count, header.frame_count))
        return truth_refuse(&cursor, cursor.at, "enough memory for it");
    result->width = header.width;
    result->height = header.height;
    bool good = read_frames(&cursor, result);
    if (!good) truth_free(result);
    return good;
}

bool truth_read(const char *path, truth_result *result)
{
    *result = (truth_result){0};
    size_t size;
    void *bytes = obs_read_bytes(path, &size);
    bool good = bytes && truth_parse(bytes, size, path, result);
    free(bytes);
    return good;
}

// --- writing -------------------------------------------------------------------------------------

static void write_number(FILE *stream, uint32_t value, int bytes)
{
    for (int i = 0; i < bytes; i++)
        fputc((int)(value >> (8 * i) & 0xffu), stream);
}

bool truth_write(const char *path, const truth_result *result)
{
    outfile file;
    if (!outfile_open(&file, path)) return false;
    fwrite(truth_magic, 1, sizeof truth_magic, file.stream);
    write_number(file.stream, result->width, 4);
    write_number(file.stream, result->height, 4);
    write_number(file.stream, result->object_count, 4);
    write_number(file.stream, result->frame_count, 4);
    const truth_verdict *verdict = result->verdicts;
    for (uint32_t f = 0; f < result->frame_count; f++) {
        write_number(file.stream, result->frames[f], 4);
        for (uint32_t i = 0; i < result->object_count; i++, verdict++) {
            write_number(file.stream, verdict->samples, 4);
            write_number(file.stream, verdict->rays, 2);
            write_number(file.stream, verdict->flags, 2);
        }
    }
    return outfile_commit(&file);
}
