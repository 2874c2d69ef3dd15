// SPDX-License-Identifier: Apache-2.0
// Letters of 5 x 9 dots: 7 above the baseline, which capitals fill, and 2 below.
#include "canvas.h"

enum { GLYPH_WIDTH = 5, GLYPH_ROWS = 9, GLYPH_SPACE = 3 };

// From the space to the tilde. Bit 5 * row + column is a dot, from the upper left.
static const uint64_t glyphs[95] = {
    0x000000000000, 0x000100421084, 0x00000000014a, 0x000295f57d4a, 0x00011f4717c4, 0x000672222273,
    0x000593511526, 0x000000000084, 0x000208210888, 0x000088842082, 0x000009575480, 0x0000084f9080,
    0x02218c000000, 0x000000078000, 0x00018c000000, 0x000042222210, 0x00011518c544, 0x0003884210c4,
    0x0007c444422e, 0x0003a306422e, 0x000211f4a988, 0x0003a3083c3f, 0x0003a317844c, 0x00008442221f,
    0x0003a317462e, 0x0001910f462e, 0x00018c031800, 0x02218c031800, 0x000208208888, 0x000001f07c00,
    0x000088882082, 0x00010044422e, 0x000783daf62e, 0x0004631fc62e, 0x0003e317c62f, 0x0003a210862e,
    0x0003e318c62f, 0x0007c217843f, 0x00004217843f, 0x0003a31e862e, 0x0004631fc631, 0x00038842108e,
    0x00019284211c, 0x000452519531, 0x0007c2108421, 0x0004631ad771, 0x0004739ace71, 0x0003a318c62e,
    0x00004217c62f, 0x00059358c62e, 0x00045257c62f, 0x0003e107043e, 0x00010842109f, 0x0003a318c631,
    0x000114a8c631, 0x0004775ac631, 0x000462a22a31, 0x000108422a31, 0x0007c222221f, 0x00038421084e,
    0x000420820821, 0x00039084210e, 0x000000004544, 0x0007c0000000, 0x000000000082, 0x0007a3e83800,
    0x0003e318bc21, 0x0003a210b800, 0x0007a318fa10, 0x000383f8b800, 0x000084238a4c, 0x0e87a318f800,
    0x00046318bc21, 0x000388421804, 0x064a10843008, 0x00024a32a421, 0x000388421086, 0x00056b5aac00,
    0x00046318bc00, 0x0003a318b800, 0x010be318bc00, 0x1087a318f800, 0x00004219b400, 0x0003e0e0f800,
    0x000324211c42, 0x0007a318c400, 0x00011518c400, 0x0002ab5ac400, 0x000454454400, 0x0e87a318c400,
    0x0007c4447c00, 0x000208411088, 0x000108421084, 0x000088441082, 0x0000008a8800,
};

static uint64_t glyph_of(char letter)
{
    return glyphs[letter >= ' ' && letter <= '~' ? letter - ' ' : '?' - ' '];
}

static bool has_dot(uint64_t glyph, int column, int row)
{
    return glyph >> (GLYPH_WIDTH * row + column) & 1;
}

static bool column_is_empty(uint64_t glyph, int column)
{
    for (int row = 0; row < GLYPH_ROWS; row++)
        if (has_dot(glyph, column, row)) return false;
    return true;
}

// The columns that a glyph fills; a space fills some without dots.
static void glyph_span(uint64_t glyph, int *first, int *end)
{
    *first = 0;
    *end = GLYPH_SPACE;
    if (glyph == 0) return;
    *end = GLYPH_WIDTH;
    while (column_is_empty(glyph, *first))
        ++*first;
    while (column_is_empty(glyph, *end - 1))
        --*end;
}

void canvas_text(canvas *c, int x, int y, int size, canvas_color color, const char *text)
{
    for (; *text; text++) {
        uint64_t glyph = glyph_of(*text);
        int first, end;
        glyph_span(glyph, &first, &end);
        for (int column = first; column < end; column++, x += size)
            for (int row = 0; row < GLYPH_ROWS; row++)
                if (has_dot(glyph, column, row))
                    canvas_fill(c, (canvas_rect){x, y + row * size, size, size}, color);
        x += size;
    }
}

int canvas_text_width(const char *text, int size)
{
    int width = 0;
    for (; *text; text++) {
        int first, end;
        glyph_span(glyph_of(*text), &first, &end);
        width += (end - first + 1) * size;
    }
    return width;
}
