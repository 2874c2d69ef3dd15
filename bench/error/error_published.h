// SPDX-License-Identifier: Apache-2.0
/// @file
/// What other programs took and missed on the very same boxes, measured once for this project on a
/// 2-core x86-64 machine with AVX-512, one thread, medians over all frames. False-hidden objects
/// are sums over three frames. Figures hold for the scene of that identity alone: another
/// generator's scene of the same name is another scene.
#ifndef OCC_BENCH_ERROR_PUBLISHED_H
#define OCC_BENCH_ERROR_PUBLISHED_H

#include <stdint.h>

/// The method that goes furthest: MaskedOcclusionCulling with occluders tested before they are
/// drawn, the best 1,024 of them, and a tree over the objects.
#define ERROR_PUBLISHED_STRONG "Masked + tree"

/// A point of time against error.
typedef struct error_published {
    const char *scene, *method, *setting;
    double ms, missed_pct;
    uint32_t false_hidden;
} error_published;

/// All of them, scene by scene and method by method; the last has a NULL scene.
extern const error_published error_published_points[];

/// The first point of the scene that has this identity, or NULL. The scene's others follow it.
const error_published *error_published_find(const char *scene, uint64_t identity);

#endif
