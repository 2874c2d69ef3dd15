// SPDX-License-Identifier: Apache-2.0
#include "canvas_png.h"

// The header defines functions that are not used here.
#if defined(__GNUC__)
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
#ifndef __clang_analyzer__ // what it finds in there is not ours to mend
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#endif
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

static void write_bytes(void *context, void *bytes, int size)
{
    fwrite(bytes, 1, (size_t)size, context);
}

bool canvas_encode_png(FILE *stream, int width, int height, const canvas_color *pixels)
{
    return stbi_write_png_to_func(write_bytes, stream, width, height, 3, pixels, 3 * width) != 0;
}
