// SPDX-License-Identifier: Apache-2.0
// The directions along which a cloud of points spreads: eigenvectors by Jacobi's method.
#ifndef OCC_JACOBI_H
#define OCC_JACOBI_H

#include <math.h>

// Makes m[i][j] vanish by a turn in the plane of i and j.
static inline void occ_jacobi_turn(double m[3][3], double axes[3][3], int i, int j)
{
    if (m[i][j] == 0.0) return;
    double theta = (m[j][j] - m[i][i]) / (2.0 * m[i][j]);
    double t = (theta < 0.0 ? -1.0 : 1.0) / (fabs(theta) + sqrt(theta * theta + 1.0));
    double cosine = 1.0 / sqrt(t * t + 1.0), sine = t * cosine;
    for (int k = 0; k < 3; k++) {
        double a = m[k][i], b = m[k][j];
        m[k][i] = cosine * a - sine * b;
        m[k][j] = sine * a + cosine * b;
    }
    for (int k = 0; k < 3; k++) {
        double a = m[i][k], b = m[j][k];
        m[i][k] = cosine * a - sine * b;
        m[j][k] = sine * a + cosine * b;
        a = axes[i][k];
        b = axes[j][k];
        axes[i][k] = cosine * a - sine * b;
        axes[j][k] = sine * a + cosine * b;
    }
}

// The axes of a symmetric matrix, which becomes nearly diagonal.
static inline void occ_jacobi_axes(double m[3][3], int sweeps, double axes[3][3])
{
    for (int j = 0; j < 3; j++)
        for (int k = 0; k < 3; k++)
            axes[j][k] = j == k;
    for (int sweep = 0; sweep < sweeps; sweep++)
        for (int k = 0; k < 3; k++)
            occ_jacobi_turn(m, axes, k, (k + 1) % 3);
}

#endif
