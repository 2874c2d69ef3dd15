// SPDX-License-Identifier: Apache-2.0
#include "names.h"

#include "library.h"
#include "outfile.h"

#include <stdlib.h>

static int ascending(const void *left, const void *right)
{
    const uint32_t *a = left, *b = right;
    return (*a > *b) - (*a < *b);
}

// A field of the table: in quotes, which are doubled within.
static void write_text(FILE *stream, const char *text)
{
    fputc('"', stream);
    for (; *text; text++) {
        if (*text == '"') fputc('"', stream);
        fputc(*text, stream);
    }
    fputc('"', stream);
}

static void write_row(FILE *stream, const model *m, uint32_t object, uint32_t place, uint32_t count)
{
    const model_mesh *mesh = &m->meshes[m->parts[place].mesh];
    fprintf(stream, "%u,%u,%u,", object, count, place);
    write_text(stream, mesh->name);
    fputc(',', stream);
    write_text(stream, mesh->material == UINT32_MAX ? "" : m->materials[mesh->material]);
    fputc('\n', stream);
}

// `places` has room for the object's triangles.
static void write_object(FILE *stream, const model *m, const division *d, uint32_t object,
                         uint32_t *places)
{
    uint32_t count = d->first[object + 1] - d->first[object];
    for (uint32_t i = 0; i < count; i++) {
        const model_part *part = model_part_of(m, d->triangles[d->first[object] + i]);
        places[i] = (uint32_t)(part - m->parts);
    }
    qsort(places, count, sizeof *places, ascending);
    for (uint32_t i = 0, end; i < count; i = end) {
        for (end = i + 1; end < count && places[end] == places[i];)
            end++;
        write_row(stream, m, object, places[i], end - i);
    }
}

bool names_write(const char *path, const model *m, const division *d)
{
    outfile file;
    uint32_t *places = malloc(((size_t)m->triangle_count + 1) * sizeof *places);
    if (!places) return library_out_of_memory();
    bool good = outfile_open(&file, path);
    if (good) {
        fputs("object,triangles,place,mesh,material\n", file.stream);
        for (uint32_t i = 0; i < d->count; i++)
            write_object(file.stream, m, d, i, places);
        good = outfile_commit(&file);
    }
    free(places);
    return good;
}
