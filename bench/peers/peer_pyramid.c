// SPDX-License-Identifier: Apache-2.0
// The idea is Godot 4's (MIT licence), as in
// servers/rendering/renderer_scene_occlusion_cull.{h,cpp} of github.com/godotengine/godot at
// 05ce6eb0b9fcb2bc88301dd4e16795e97075b2b9; the code is ours.
#include "peer_pyramid.h"

#include <stdlib.h>

enum { MOST_PIXELS = 512 }; // looked at for one object; as many as Godot looks at

static int half_of(int side)
{
    return side > 1 ? side / 2 : 1;
}

static int smaller(int a, int b)
{
    return a < b ? a : b;
}

static float farther(float a, float b)
{
    return a > b ? a : b;
}

bool peer_pyramid_open(peer_pyramid *pyramid, uint32_t width, uint32_t height)
{
    *pyramid = (peer_pyramid){.level_count = 1};
    pyramid->levels[0] = (peer_level){.width = (int)width, .height = (int)height};
    size_t size = (size_t)width * height;
    for (peer_level *last = pyramid->levels; last->width > 1 || last->height > 1; last++) {
        last[1].width = half_of(last->width);
        last[1].height = half_of(last->height);
        size += (size_t)last[1].width * (size_t)last[1].height;
        pyramid->level_count++;
    }
    pyramid->memory = calloc(size, sizeof *pyramid->memory);
    if (!pyramid->memory) return false;
    pyramid->size = size;
    float *next = pyramid->memory;
    for (int i = 0; i < pyramid->level_count; i++) {
        pyramid->levels[i].depth = next;
        next += (size_t)pyramid->levels[i].width * (size_t)pyramid->levels[i].height;
    }
    return true;
}

void peer_pyramid_close(peer_pyramid *pyramid)
{
    free(pyramid->memory);
    *pyramid = (peer_pyramid){0};
}

// A pixel covers two by two of the level below; where that has an odd side the third is the last
// pixel's too, and every pixel takes it: it does no harm to take one too many.
static void make_level(const peer_level *below, peer_level *level)
{
    int columns = below->width & 1 ? 3 : 2, rows = below->height & 1 ? 3 : 2;
    for (int y = 0; y < level->height; y++) {
        float *out = level->depth + (size_t)y * (size_t)level->width;
        for (int row = 0; row < rows; row++) {
            int from = smaller(2 * y + row, below->height - 1);
            const float *in = below->depth + (size_t)from * (size_t)below->width;
            for (int x = 0; x < level->width; x++) {
                float depth = farther(in[2 * x], in[smaller(2 * x + 1, below->width - 1)]);
                if (columns == 3) depth = farther(depth, in[smaller(2 * x + 2, below->width - 1)]);
                out[x] = row == 0 ? depth : farther(out[x], depth);
            }
        }
    }
}

void peer_pyramid_update(peer_pyramid *pyramid)
{
    for (int i = 1; i < pyramid->level_count; i++)
        make_level(&pyramid->levels[i - 1], &pyramid->levels[i]);
}

// The pixel at a place given in pixels.
static int pixel_at(float place, int side)
{
    if (!(place > 0)) return 0;
    return place < (float)(side - 1) ? (int)place : side - 1;
}

// The first level on which the rectangle is no longer than a pixel.
static int first_level(const peer_pyramid *pyramid, const float rectangle[4])
{
    float width = (rectangle[2] - rectangle[0]) * (float)pyramid->levels[0].width;
    float height = (rectangle[3] - rectangle[1]) * (float)pyramid->levels[0].height;
    float side = farther(width, height);
    int level = 0;
    while (level + 1 < pyramid->level_count && (float)(1 << level) < side)
        level++;
    return level;
}

bool peer_pyramid_covers(const peer_pyramid *pyramid, const float rectangle[4], float depth)
{
    int looked_at = 0;
    for (int i = first_level(pyramid, rectangle); i >= 0; i--) {
        const peer_level *level = &pyramid->levels[i];
        float width = (float)level->width, height = (float)level->height;
        int x0 = pixel_at(rectangle[0] * width - 1, level->width);
        int y0 = pixel_at(rectangle[1] * height - 1, level->height);
        int x1 = pixel_at(rectangle[2] * width + 1, level->width);
        int y1 = pixel_at(rectangle[3] * height + 1, level->height);
        looked_at += (x1 - x0 + 1) * (y1 - y0 + 1);
        if (looked_at > MOST_PIXELS) return false;
        bool covered = true;
        for (int y = y0; y <= y1 && covered; y++) {
            const float *row = level->depth + (size_t)y * (size_t)level->width;
            for (int x = x0; x <= x1; x++)
                covered = covered && !(row[x] > depth);
        }
        if (covered) return true;
    }
    return false;
}
