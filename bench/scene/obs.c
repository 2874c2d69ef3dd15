// SPDX-License-Identifier: Apache-2.0
#define _POSIX_C_SOURCE 200809L
#include "obs.h"

#include "outfile.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    HEADER_BYTES = 16,
    HEADER_2_BYTES = 20,
    OBJECT_BYTES = 48,
    OCCLUDER_BYTES = 52,
    SHEET_BYTES = 108,
    FRAME_BYTES = 152
};

typedef char obs_frame_is_packed[sizeof(obs_frame) == FRAME_BYTES ? 1 : -1];
typedef char obs_box_is_packed[sizeof(occ_box) == OBJECT_BYTES ? 1 : -1];
typedef char obs_sheet_is_packed[sizeof(obs_sheet) == SHEET_BYTES ? 1 : -1];

static uint32_t load_u32(const uint8_t *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static void store_u32(uint8_t *p, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        p[i] = (uint8_t)(value >> (8 * i));
}

// Returns how many of the `count` floats were finite from the start; stops at the first that isn't.
static size_t load_floats(float *out, const uint8_t *p, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        uint32_t bits = load_u32(p + 4 * i);
        if ((bits & 0x7f800000u) == 0x7f800000u) return i;
        memcpy(&out[i], &bits, sizeof bits);
    }
    return count;
}

static void store_floats(uint8_t *p, const float *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, &values[i], sizeof bits);
        store_u32(p + 4 * i, bits);
    }
}

// --- reading -------------------------------------------------------------------------------------

typedef struct obs_cursor {
    const uint8_t *bytes;
    size_t size, at;
    const char *name;
} obs_cursor;

#ifdef __GNUC__
__attribute__((format(printf, 3, 4)))
#endif
static bool
refuse(const obs_cursor *cursor, size_t at, const char *format, ...)
{
    if (!cursor->name) return false;
    va_list arguments;
    va_start(arguments, format);
    fprintf(stderr, "occlude-bench: %s: byte %zu: ", cursor->name, at);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
    return false;
}

static bool read_floats(obs_cursor *cursor, float *out, size_t count, const char *what, uint32_t i)
{
    size_t good = load_floats(out, cursor->bytes + cursor->at, count);
    if (good < count)
        return refuse(cursor, cursor->at + 4 * good, "expected a finite number in %s %u", what, i);
    cursor->at += 4 * count;
    return true;
}

static bool read_header(obs_cursor *cursor, obs_scene *scene)
{
    static const char magic[4] = {'O', 'B', 'S', '1'};
    for (size_t i = 0; i < sizeof magic; i++) {
        bool is_version_2 = i == 3 && cursor->size > i && cursor->bytes[i] == '2';
        if (i >= cursor->size || (cursor->bytes[i] != (uint8_t)magic[i] && !is_version_2))
            return refuse(cursor, i, "expected the magic \"OBS1\" or \"OBS2\"");
    }
    bool has_sheets = cursor->bytes[3] == '2';
    cursor->at = has_sheets ? HEADER_2_BYTES : HEADER_BYTES;
    if (cursor->size < cursor->at)
        return refuse(cursor, cursor->size, "expected a header of %zu bytes, the file ends",
                      cursor->at);
    scene->object_count = load_u32(cursor->bytes + 4);
    scene->occluder_count = load_u32(cursor->bytes + 8);
    if (has_sheets) scene->sheet_count = load_u32(cursor->bytes + 12);
    scene->frame_count = load_u32(cursor->bytes + cursor->at - 4);
    return true;
}

// Before anything is allocated: a short file with huge counts must not ask for their memory. Boxes
// and sheets have one row of numbers, which must have an end.
static bool check_size(const obs_cursor *cursor, const obs_scene *scene)
{
    uint64_t expected = cursor->at + (uint64_t)OBJECT_BYTES * scene->object_count +
                        (uint64_t)OCCLUDER_BYTES * scene->occluder_count +
                        (uint64_t)SHEET_BYTES * scene->sheet_count +
                        (uint64_t)FRAME_BYTES * scene->frame_count;
    if (scene->sheet_count > UINT32_MAX - scene->occluder_count)
        return refuse(cursor, 8, "expected %u boxes and sheets that hide at most, found %u and %u",
                      UINT32_MAX, scene->occluder_count, scene->sheet_count);
    if (cursor->size == expected) return true;
    bool is_short = cursor->size < expected;
    return refuse(
        cursor, is_short ? cursor->size : (size_t)expected,
        "expected a file of %llu bytes (%u objects, %u occluders, %u sheets, %u frames), %s",
        (unsigned long long)expected, scene->object_count, scene->occluder_count,
        scene->sheet_count, scene->frame_count, is_short ? "the file ends" : "the file goes on");
}

static bool allocate(obs_scene *scene)
{
    scene->object_capacity = scene->object_count;
    scene->occluder_capacity = scene->occluder_count;
    scene->sheet_capacity = scene->sheet_count;
    scene->frame_capacity = scene->frame_count;
    scene->objects = calloc((size_t)scene->object_count + 1, sizeof *scene->objects);
    scene->occluders = calloc((size_t)scene->occluder_count + 1, sizeof *scene->occluders);
    scene->sheets = calloc((size_t)scene->sheet_count + 1, sizeof *scene->sheets);
    scene->frames = calloc((size_t)scene->frame_count + 1, sizeof *scene->frames);
    return scene->objects && scene->occluders && scene->sheets && scene->frames;
}

static bool read_owner(obs_cursor *cursor, const obs_scene *scene, uint32_t *owner,
                       const char *what, uint32_t i)
{
    *owner = load_u32(cursor->bytes + cursor->at);
    bool is_none = *owner == OBS_NO_OWNER && cursor->bytes[3] == '2';
    if (*owner >= scene->object_count && !is_none)
        return refuse(cursor, cursor->at,
                      "expected the owner of %s %u to be below %u objects, found %u", what, i,
                      scene->object_count, *owner);
    cursor->at += 4;
    return true;
}

static bool read_occluders(obs_cursor *cursor, obs_scene *scene)
{
    for (uint32_t i = 0; i < scene->occluder_count; i++) {
        obs_occluder *occluder = &scene->occluders[i];
        if (!read_floats(cursor, (float *)&occluder->box, 12, "occluder", i) ||
            !read_owner(cursor, scene, &occluder->owner, "occluder", i))
            return false;
    }
    return true;
}

// One scene has one file: what is not used is 0.
static bool check_unused(const obs_cursor *cursor, const occ_sheet *sheet, uint32_t i)
{
    size_t unused = 12u * (OCC_SHEET_CORNERS - sheet->corner_count);
    for (size_t k = 0; k < unused; k++)
        if (cursor->bytes[cursor->at - unused + k] != 0)
            return refuse(cursor, cursor->at - unused + k,
                          "expected 0 beyond the %u corners of sheet %u", sheet->corner_count, i);
    return true;
}

static bool read_sheet(obs_cursor *cursor, obs_scene *scene, uint32_t i)
{
    occ_sheet *sheet = &scene->sheets[i].sheet;
    const uint8_t *bytes = cursor->bytes + cursor->at;
    sheet->corner_count = load_u32(bytes);
    if (sheet->corner_count < 3 || sheet->corner_count > OCC_SHEET_CORNERS)
        return refuse(cursor, cursor->at, "expected 3 to %d corners in sheet %u, found %u",
                      OCC_SHEET_CORNERS, i, sheet->corner_count);
    uint32_t sides = load_u32(bytes + 4);
    if (sides != OCC_SIDES_BOTH && sides != OCC_SIDES_FRONT)
        return refuse(cursor, cursor->at + 4,
                      "expected sheet %u to hide from both sides (0) or from its front (1), found "
                      "%u",
                      i, sides);
    sheet->sides = (occ_sides)sides;
    cursor->at += 8;
    return read_floats(cursor, sheet->corner[0], 3u * OCC_SHEET_CORNERS, "sheet", i) &&
           check_unused(cursor, sheet, i) &&
           read_owner(cursor, scene, &scene->sheets[i].owner, "sheet", i);
}

static bool read_body(obs_cursor *cursor, obs_scene *scene)
{
    for (uint32_t i = 0; i < scene->object_count; i++)
        if (!read_floats(cursor, (float *)&scene->objects[i], 12, "object", i)) return false;
    if (!read_occluders(cursor, scene)) return false;
    for (uint32_t i = 0; i < scene->sheet_count; i++)
        if (!read_sheet(cursor, scene, i)) return false;
    for (uint32_t i = 0; i < scene->frame_count; i++)
        if (!read_floats(cursor, (float *)&scene->frames[i], 38, "frame", i)) return false;
    return true;
}

bool obs_parse(const void *bytes, size_t size, const char *name, obs_scene *scene)
{
    *scene = (obs_scene){0};
    obs_cursor cursor = {bytes, size, 0, name};
    if (!read_header(&cursor, scene) || !check_size(&cursor, scene)) {
        *scene = (obs_scene){0};
        return false;
    }
    bool good = allocate(scene) || refuse(&cursor, cursor.at, "expected enough memory for it");
    good = good && read_body(&cursor, scene);
    if (!good) obs_free(scene);
    return good;
}

static void *read_stream(FILE *stream, size_t *size)
{
    size_t capacity = (size_t)1 << 16, used = 0;
    uint8_t *bytes = malloc(capacity);
    while (bytes) {
        used += fread(bytes + used, 1, capacity - used, stream);
        if (used < capacity) break;
        uint8_t *larger = capacity <= SIZE_MAX / 2 ? realloc(bytes, 2 * capacity) : NULL;
        if (!larger) free(bytes);
        bytes = larger;
        capacity *= 2;
    }
    if (!bytes) errno = ENOMEM;
    if (bytes && ferror(stream)) {
        free(bytes);
        bytes = NULL;
    }
    *size = used;
    return bytes;
}

void *obs_read_bytes(const char *path, size_t *size)
{
    errno = 0;
    *size = 0;
    FILE *stream = fopen(path, "rb");
    void *bytes = stream ? read_stream(stream, size) : NULL;
    if (!bytes)
        fprintf(stderr, "occlude-bench: %s: byte %zu: expected a readable file: %s\n", path, *size,
                strerror(errno));
    if (stream) fclose(stream);
    return bytes;
}

bool obs_read(const char *path, obs_scene *scene)
{
    *scene = (obs_scene){0};
    size_t size;
    void *bytes = obs_read_bytes(path, &size);
    bool good = bytes && obs_parse(bytes, size, path, scene);
    free(bytes);
    return good;
}

// --- writing -------------------------------------------------------------------------------------

static bool needs_version_2(const obs_scene *scene)
{
    for (uint32_t i = 0; i < scene->occluder_count; i++)
        if (scene->occluders[i].owner == OBS_NO_OWNER) return true;
    return scene->sheet_count > 0;
}

static void write_header(FILE *stream, const obs_scene *scene)
{
    uint8_t record[HEADER_2_BYTES] = {'O', 'B', 'S', '1'};
    bool version_2 = needs_version_2(scene);
    size_t size = version_2 ? HEADER_2_BYTES : HEADER_BYTES;
    store_u32(record + 4, scene->object_count);
    store_u32(record + 8, scene->occluder_count);
    if (version_2) {
        record[3] = '2';
        store_u32(record + 12, scene->sheet_count);
    }
    store_u32(record + size - 4, scene->frame_count);
    fwrite(record, 1, size, stream);
}

static void write_sheet(FILE *stream, const obs_sheet *sheet)
{
    uint8_t record[SHEET_BYTES] = {0};
    store_u32(record, sheet->sheet.corner_count);
    store_u32(record + 4, (uint32_t)sheet->sheet.sides);
    store_floats(record + 8, sheet->sheet.corner[0], 3u * sheet->sheet.corner_count);
    store_u32(record + SHEET_BYTES - 4, sheet->owner);
    fwrite(record, 1, SHEET_BYTES, stream);
}

static void write_scene(FILE *stream, const obs_scene *scene)
{
    uint8_t record[FRAME_BYTES];
    write_header(stream, scene);
    for (uint32_t i = 0; i < scene->object_count; i++) {
        store_floats(record, (const float *)&scene->objects[i], 12);
        fwrite(record, 1, OBJECT_BYTES, stream);
    }
    for (uint32_t i = 0; i < scene->occluder_count; i++) {
        store_floats(record, (const float *)&scene->occluders[i].box, 12);
        store_u32(record + OBJECT_BYTES, scene->occluders[i].owner);
        fwrite(record, 1, OCCLUDER_BYTES, stream);
    }
    for (uint32_t i = 0; i < scene->sheet_count; i++)
        write_sheet(stream, &scene->sheets[i]);
    for (uint32_t i = 0; i < scene->frame_count; i++) {
        store_floats(record, (const float *)&scene->frames[i], 38);
        fwrite(record, 1, FRAME_BYTES, stream);
    }
}

bool obs_write(const char *path, const obs_scene *scene)
{
    if (scene->out_of_memory) {
        fprintf(stderr, "occlude-bench: %s: not enough memory for the scene\n", path);
        return false;
    }
    outfile file;
    if (!outfile_open(&file, path)) return false;
    write_scene(file.stream, scene);
    return outfile_commit(&file);
}

// --- building ------------------------------------------------------------------------------------

void obs_free(obs_scene *scene)
{
    free(scene->objects);
    free(scene->occluders);
    free(scene->sheets);
    free(scene->frames);
    *scene = (obs_scene){0};
}

// Makes room for one more element; false (and sticky) when there is none.
static bool make_room(obs_scene *scene, void **array, uint32_t count, uint32_t *capacity,
                      size_t size)
{
    if (count < *capacity) return true;
    uint32_t wanted = count < 16 ? 16 : count < UINT32_MAX / 2 ? 2 * count : UINT32_MAX;
    void *larger = wanted > count ? realloc(*array, wanted * size) : NULL;
    if (!larger) {
        scene->out_of_memory = true;
        return false;
    }
    *array = larger;
    *capacity = wanted;
    return true;
}

uint32_t obs_add_object(obs_scene *scene, const occ_box *box)
{
    void *array = scene->objects;
    if (!make_room(scene, &array, scene->object_count, &scene->object_capacity, sizeof *box))
        return UINT32_MAX;
    scene->objects = array;
    scene->objects[scene->object_count] = *box;
    return scene->object_count++;
}

uint32_t obs_add_occluder(obs_scene *scene, const occ_box *box, uint32_t owner)
{
    void *array = scene->occluders;
    if (!make_room(scene, &array, scene->occluder_count, &scene->occluder_capacity,
                   sizeof *scene->occluders))
        return UINT32_MAX;
    scene->occluders = array;
    scene->occluders[scene->occluder_count] = (obs_occluder){*box, owner};
    return scene->occluder_count++;
}

uint32_t obs_add_sheet(obs_scene *scene, const occ_sheet *sheet, uint32_t owner)
{
    void *array = scene->sheets;
    if (!make_room(scene, &array, scene->sheet_count, &scene->sheet_capacity,
                   sizeof *scene->sheets))
        return UINT32_MAX;
    scene->sheets = array;
    obs_sheet *added = &scene->sheets[scene->sheet_count];
    *added = (obs_sheet){*sheet, owner};
    for (uint32_t c = sheet->corner_count; c < OCC_SHEET_CORNERS; c++)
        memset(added->sheet.corner[c], 0, sizeof added->sheet.corner[c]);
    return scene->sheet_count++;
}

uint32_t obs_add_frame(obs_scene *scene, const obs_frame *frame)
{
    void *array = scene->frames;
    if (!make_room(scene, &array, scene->frame_count, &scene->frame_capacity, sizeof *frame))
        return UINT32_MAX;
    scene->frames = array;
    scene->frames[scene->frame_count] = *frame;
    return scene->frame_count++;
}
