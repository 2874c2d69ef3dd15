// SPDX-License-Identifier: Apache-2.0
// Worlds for what several occluders hide together: crowds of boxes, walls of panels, and objects
// among and behind them; and the shadows that a frame makes of their occluders.
#ifndef OCC_TEST_CROWDS_H
#define OCC_TEST_CROWDS_H

#include "frame.h"
#include "worlds.h"

enum { CROWD_OBJECTS = 64, CROWD_OCCLUDERS = 48 };

typedef struct crowd {
    occ_camera_desc camera;
    double eye[3]; // what camera.eye points to, if it does
    float scale;   // what everything was multiplied by
    bool strange;  // occluders stand anywhere, and not where their owners do
    occ_box objects[CROWD_OBJECTS];
    world_occluder occluders[CROWD_OCCLUDERS];
    uint32_t object_count, occluder_count;
} crowd;

void crowd_put(crowd *c, const occ_box *box, int owner);

// Twelve boxes about the origin, and as many objects as asked for among and behind them.
void crowd_about(kit_random *random, crowd *c, uint32_t objects);

// A wall of panels, turned somehow, that abut, overlap or leave gaps, by nothing, by little or by
// an ulp; objects behind it.
void crowd_panels(kit_random *random, crowd *c, uint32_t objects);

// Occluders and objects all round the eye, some of them through its plane, at a scale from 2^-60 to
// 2^40 and with a matrix that is multiplied by anything; the camera may be skewed.
void crowd_around(kit_random *random, crowd *c, uint32_t objects);

// A frame with the shadows of all of its occluders, in the order of their rows.
typedef struct crowd_frame {
    occ_hooks hooks;
    occ_scene *scene;
    occ_frame frame;
} crowd_frame;

void crowd_frame_open(crowd_frame *f, const crowd *c, double tolerance);
void crowd_frame_close(crowd_frame *f);

#endif
