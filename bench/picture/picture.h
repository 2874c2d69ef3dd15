// SPDX-License-Identifier: Apache-2.0
/// @file
/// What one frame's picture tells, and the parts that draw it.
#ifndef OCC_BENCH_PICTURE_H
#define OCC_BENCH_PICTURE_H

#include "canvas.h"
#include "obs.h"

/// What became of an object.
typedef enum picture_verdict {
    PICTURE_OUTSIDE = 0, ///< Outside the frustum.
    PICTURE_HIDDEN = 1,
    PICTURE_TOGETHER = 2, ///< Hidden by several occluders together, none of them alone.
    PICTURE_VISIBLE = 3
} picture_verdict;

enum { PICTURE_VERDICTS = 4 };

/// What a picture is to show.
typedef struct picture_wish {
    uint32_t frame;
    const char *vis_path; ///< Where to take the verdicts from; NULL: the library decides.
    bool fused;           ///< With method fused rather than single.
    bool explain;         ///< Show what hides an object.
    uint32_t object;      ///< That object.
} picture_wish;

/// A frame and its verdicts. picture_facts_free() it when done.
typedef struct picture_facts {
    const obs_scene *scene;
    const obs_frame *frame;
    uint8_t *verdicts;                 ///< A picture_verdict for each object.
    uint32_t counts[PICTURE_VERDICTS]; ///< Objects by picture_verdict.
    uint32_t *used; ///< The occluders that took part, nearest first: places in the scene file.
    size_t used_count;
    bool used_known; ///< False for verdicts from a file, which does not tell.
    bool fused;      ///< Whether PICTURE_TOGETHER is told apart.

    bool explained; ///< Whether the rest is set.
    uint32_t object;
    uint32_t *culprits; ///< The occluders that hide the object, nearest first: places in the file.
    size_t culprit_count;
} picture_facts;

/// Decides with the library; with a `vis_path`, only what is outside, and takes the rest from that
/// file. On failure says why and returns false.
bool picture_decide(const obs_scene *scene, const picture_wish *wish, picture_facts *facts);

void picture_facts_free(picture_facts *facts);

/// The colours of the verdicts, of occluders, and of those that hide an explained object.
extern const canvas_color picture_colors[PICTURE_VERDICTS];
extern const canvas_color picture_occluder_color;
extern const canvas_color picture_culprit_color;
extern const canvas_color picture_ink;
extern const canvas_color picture_paper;

/// A colour on a face that these two directions lie in: light from above, a little from one side.
canvas_color picture_shade(canvas_color color, const float u[3], const float v[3]);

/// A colour half as bright, for lines.
canvas_color picture_half(canvas_color color);

/// Fills a panel from sky to horizon, so that empty pixels do not read as a surface.
void picture_sky(canvas *c, canvas_rect panel);

/// Draws the map in a rectangle of the canvas, and tells in `caption` what part of the scene it is.
/// Returns false when memory runs out.
bool picture_draw_map(canvas *c, canvas_rect panel, const picture_facts *facts, char *caption,
                      size_t size);

/// Draws what the camera sees, hidden objects shining through, or of these only the explained one.
/// Returns false when memory runs out.
bool picture_draw_camera(canvas *c, canvas_rect panel, const picture_facts *facts);

#endif
