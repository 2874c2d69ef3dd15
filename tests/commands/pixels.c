// SPDX-License-Identifier: Apache-2.0
// pixels P.png X Y WIDTH HEIGHT R G B TOLERANCE: prints how many pixels of a rectangle have a
// colour, give or take the tolerance in each channel, and on the next line the colour in its
// middle.
#define STB_IMAGE_IMPLEMENTATION
#define STBI_ONLY_PNG
#include <stb/stb_image.h>

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

int main(int argc, char **argv)
{
    int width, height, channels, number[8], count = 0;
    if (argc != 10) return 1;
    for (int i = 0; i < 8; i++)
        number[i] = atoi(argv[2 + i]);
    unsigned char *pixels = stbi_load(argv[1], &width, &height, &channels, 3);
    const int left = number[0], top = number[1], right = left + number[2], bottom = top + number[3];
    bool inside = pixels && left >= 0 && top >= 0 && left < right && top < bottom;
    if (!inside || right > width || bottom > height) return 1;
    for (int y = top; y < bottom; y++)
        for (int x = left; x < right; x++) {
            const unsigned char *p = &pixels[3 * ((size_t)y * (size_t)width + (size_t)x)];
            bool same = true;
            for (int k = 0; k < 3; k++)
                same = same && abs(p[k] - number[4 + k]) <= number[7];
            count += same;
        }
    const size_t middle = (size_t)((top + bottom) / 2) * (size_t)width + (size_t)(left + right) / 2;
    printf("%d\n%d %d %d\n", count, pixels[3 * middle], pixels[3 * middle + 1],
           pixels[3 * middle + 2]);
    stbi_image_free(pixels);
    return 0;
}
