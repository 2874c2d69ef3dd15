// SPDX-License-Identifier: Apache-2.0
#include "canvas_png.h"
#include "image_compare.h"
#include "outfile.h"

#include <stdlib.h>

// A colour for each number; 0 is the background.
static canvas_color color_of(uint32_t front, uint32_t veil)
{
    if (front == 0 && veil == 0) return (canvas_color){24, 26, 30};
    uint32_t h = (front ^ veil) * 0x9e3779b1u;
    h = (h ^ h >> 15) * 0x85ebca77u;
    h ^= h >> 13;
    return (canvas_color){(uint8_t)(64 + (h & 127u)), (uint8_t)(64 + (h >> 8 & 127u)),
                          (uint8_t)(64 + (h >> 16 & 127u))};
}

bool image_write_png(const image_pixels *p, const char *path)
{
    canvas_color *rows = malloc(((size_t)p->width * p->height + 1) * sizeof *rows);
    if (!rows) {
        fputs("occlude-bench: not enough memory\n", stderr);
        return false;
    }
    for (uint32_t y = 0; y < p->height; y++)
        for (uint32_t x = 0; x < p->width; x++) {
            size_t from = (size_t)(p->height - 1 - y) * p->width + x;
            rows[(size_t)y * p->width + x] = color_of(p->front[from], p->veil[from]);
        }
    outfile file;
    bool opened = outfile_open(&file, path);
    bool good = opened && canvas_encode_png(file.stream, (int)p->width, (int)p->height, rows);
    if (opened && !good) {
        fprintf(stderr, "occlude-bench: %s: not enough memory to write it\n", path);
        outfile_abandon(&file);
    }
    free(rows);
    return good && outfile_commit(&file);
}
