// SPDX-License-Identifier: Apache-2.0
// How much of a part's silhouette boxes cover, as a mean over directions from all around: one
// picture for each direction, a bit for each pixel, set if the middle of the pixel is covered. For
// who looks from within, a part may be cut into layers across each direction, with a picture each.
#ifndef OCC_SOUP_SILHOUETTE_H
#define OCC_SOUP_SILHOUETTE_H

#include "soup/voxels.h"

// Three along the axes, six between two of them, four between all three. Opposite directions have
// mirrored silhouettes.
#define OCC_DIRECTIONS 13
#define OCC_LAYERS     8 // at most
#define OCC_PICTURES   (OCC_DIRECTIONS * OCC_LAYERS)

typedef struct occ_picture {
    double across[3], up[3]; // unit vectors of the picture, in world units, times pixels
    double origin[2];        // of pixel (0, 0), in pixels
    uint32_t width, height;  // in pixels; the width is a multiple of 64
    uint32_t first;          // word of the first pixel
    double pixel;            // its area
    double along[3];         // the direction; what it shows is from `near` to `far` along it
    double near, far;
} occ_picture;

typedef struct occ_silhouette {
    occ_picture picture[OCC_PICTURES];
    uint32_t pictures;
    uint64_t *covered, *model; // bits; a box covers only what the model does
    uint32_t words;
    double area; // of the model: the mean over the directions
} occ_silhouette;

// Draws the triangles of a part. `side` is the length of the longer edge of a picture in pixels.
occ_result occ_silhouette_make(occ_hooks *hooks, const occ_triangles *triangles, const float min[3],
                               const float max[3], uint32_t side, uint32_t layers, occ_team *team,
                               occ_silhouette *silhouette);

// The area that a box would cover anew, as a mean over the directions.
double occ_silhouette_gain(const occ_silhouette *silhouette, const occ_box *box);

// Covers what the box does.
void occ_silhouette_cover(occ_silhouette *silhouette, const occ_box *box);

void occ_silhouette_free(occ_hooks *hooks, occ_silhouette *silhouette);

#endif
