// SPDX-License-Identifier: Apache-2.0
// What stb has for us: letters made of bars, and a PNG writer.
#include "canvas.h"

#include "canvas_stb.h"

#include <string.h>

// Both headers define functions that are not used here.
#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_easy_font.h>
#include <stb/stb_image_write.h>

enum { CANVAS_LINE_LENGTH = 240 };

// A corner as stb_easy_font writes it; four of them make a bar.
typedef struct bar_corner {
    float x, y, z;
    unsigned char color[4];
} bar_corner;

// stb's tables end with the tilde.
static void keep_printable(const char *text, char *out)
{
    size_t i = 0;
    for (; text[i] && i + 1 < CANVAS_LINE_LENGTH; i++)
        out[i] = text[i] >= ' ' && text[i] <= '~' ? text[i] : '?';
    out[i] = '\0';
}

void canvas_text(canvas *c, int x, int y, int size, canvas_color color, const char *text)
{
    char line[CANVAS_LINE_LENGTH];
    bar_corner corners[CANVAS_LINE_LENGTH * 16 * 4];
    keep_printable(text, line);
    int bars = stb_easy_font_print(0, 0, line, NULL, corners, (int)sizeof corners);
    for (int i = 0; i < bars; i++) {
        const bar_corner *a = &corners[4 * i], *b = &corners[4 * i + 2];
        canvas_rect bar = {x + (int)(a->x * (float)size), y + (int)(a->y * (float)size),
                           (int)((b->x - a->x) * (float)size), (int)((b->y - a->y) * (float)size)};
        canvas_fill(c, bar, color);
    }
}

int canvas_text_width(const char *text, int size)
{
    char line[CANVAS_LINE_LENGTH];
    keep_printable(text, line);
    return stb_easy_font_width(line) * size;
}

static void write_bytes(void *context, void *bytes, int size)
{
    fwrite(bytes, 1, (size_t)size, context);
}

bool canvas_encode_png(FILE *stream, int width, int height, const canvas_color *pixels)
{
    return stbi_write_png_to_func(write_bytes, stream, width, height, 3, pixels, 3 * width) != 0;
}
