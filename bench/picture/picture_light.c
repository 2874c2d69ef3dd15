// SPDX-License-Identifier: Apache-2.0
#include "picture.h"

#include <math.h>

canvas_color picture_shade(canvas_color color, const float u[3], const float v[3])
{
    float n[3], square = 1e-30f;
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        n[k] = u[i] * v[j] - u[j] * v[i];
        square += n[k] * n[k];
    }
    // Signs do not matter: of two opposite faces only one is seen, and few look down.
    float length = sqrtf(square), up = fabsf(n[1]) / length, aside = fabsf(n[0]) / length;
    float dark = 0.78f + 0.16f * aside, pale = 0.42f * up * up;
    const float rgb[3] = {(float)color.r, (float)color.g, (float)color.b};
    uint8_t out[3];
    for (int k = 0; k < 3; k++) {
        float lit = rgb[k] * (dark + (1 - dark) * up);
        out[k] = (uint8_t)(lit + (255 - lit) * pale);
    }
    return (canvas_color){out[0], out[1], out[2]};
}

canvas_color picture_half(canvas_color color)
{
    return (canvas_color){(uint8_t)(color.r / 2), (uint8_t)(color.g / 2), (uint8_t)(color.b / 2)};
}

void picture_sky(canvas *c, canvas_rect panel)
{
    for (int y = 0; y < panel.height; y++) {
        int tone = 236 + 16 * y / panel.height;
        canvas_color color = {(uint8_t)(tone - 4), (uint8_t)(tone - 1), (uint8_t)tone};
        canvas_fill(c, (canvas_rect){panel.x, panel.y + y, panel.width, 1}, color);
    }
}
