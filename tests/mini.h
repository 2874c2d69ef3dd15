// SPDX-License-Identifier: Apache-2.0
// Mini worlds: a camera, a few objects and a few occluders, made at random with a bias to all that
// touches, lies in one plane or is level with the eye. What every method on every backend makes of
// one is held against the exact judges; a failing one is shrunk and kept as a scene file.
#ifndef OCC_TEST_MINI_H
#define OCC_TEST_MINI_H

#include "kit.h"
#include "obs.h"
#include "worlds.h"

enum {
    MINI_OBJECTS = 36, // 24, and one for each occluder that needs an owner in a file
    MINI_OCCLUDERS = 12
};

typedef struct mini_camera {
    obs_frame frame; // its matrices; its `eye` is `eye` below, rounded
    occ_depth depth; // a file holds only the default
    bool eye_given;  // to the library; else it is derived from the matrices
    double eye[3];
} mini_camera;

typedef struct mini {
    mini_camera camera;
    uint32_t object_count, occluder_count;
    occ_box objects[MINI_OBJECTS];
    world_occluder occluders[MINI_OCCLUDERS];
} mini;

// --- cameras -------------------------------------------------------------------------------------

// The camera as the library takes it. It points into the world.
occ_camera_desc mini_view_of(const mini *m);

bool mini_is_orthographic(const mini *m);

// Puts the eye there. What follows from it, the last column of `view` above all, is set anew.
void mini_set_eye(mini *m, const double eye[3]);

// Sets the rows of `view`: rightward, upward, and backward.
void mini_set_rows(mini *m, const float rows[3][3]);

// Sets `proj`: the cotangents (orthographic: the reciprocals of the half sizes) and the distances;
// far_z 0: infinite, which is for perspective alone.
void mini_set_lens(mini *m, bool orthographic, const double scale[2], double near_z, double far_z);

// All of the world times a power of two, or moved.
void mini_scale(mini *m, float factor);
void mini_move(mini *m, const double by[3]);

// --- making --------------------------------------------------------------------------------------

void mini_make(mini *m, uint64_t seed);

// --- files ---------------------------------------------------------------------------------------

// NULL, or what of the world a scene file cannot hold.
const char *mini_not_for_files(const mini *m);

// Gives an occluder without an owner a body: an object that is the occluder's own box.
void mini_embody(mini *m);

// Says why on standard error if it fails.
bool mini_write(const mini *m, const char *path);

// Reads frame `frame` of a file, and says in `frames` how many there are. Whether the eye is given
// stands in no file. False, after a message, if the file is none or too large.
bool mini_read(mini *m, const char *path, uint32_t frame, uint32_t *frames);

// Every number, for what is no scene file.
bool mini_write_text(const mini *m, const char *path);

#endif
