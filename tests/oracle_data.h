// SPDX-License-Identifier: Apache-2.0
// What the two halves of the oracle share: oracle_camera.c makes one, oracle.c asks it.
#ifndef OCC_TEST_ORACLE_DATA_H
#define OCC_TEST_ORACLE_DATA_H

#include "exact.h"
#include "oracle.h"

enum { MOST_SLABS = 5, CLIP_PLANES = 6, NEAR_PLANE = 4 };

// A fraction with a denominator that is not negative; over 0 it is infinite.
typedef struct fraction {
    mpz_t n, d;
} fraction;

typedef struct slab {
    exact3 m;
    mpz_t w;
} slab;

struct oracle {
    long places;
    exact3 e; // the eye, or the direction to it
    mpz_t ew; // positive, or 0
    bool has_planes;
    exact3 n[CLIP_PLANES]; // planes: n.(x - b / bw) + c / cd >= 0
    mpz_t c[CLIP_PLANES], cd;
    exact3 b;
    mpz_t bw;
    // the occluder in hand
    exact3 center, axis[3];
    slab slabs[MOST_SLABS];
    int slab_count, rank;
    // scratch
    exact3 p, d, u, v;
    mpz_t t[4];
    fraction low, high, at;
};

// Three doubles in the oracle's unit. Aborts where they are finer than any float.
void oracle_set_point(const oracle *o, mpz_t *out, const double point[3]);

#endif
