// SPDX-License-Identifier: Apache-2.0
// Only + - * / and sqrt: the same frames on every machine with IEEE doubles.
#include "obs.h"

#include <math.h>
#include <string.h>

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(double *out, const double *a, const double *b)
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static void normalize(double *v)
{
    double length = sqrt(dot(v, v));
    for (int k = 0; k < 3; k++)
        v[k] /= length;
}

obs_frame obs_look(const double eye[3], const double direction[3], double cotangent, double aspect,
                   double near_z, double far_z)
{
    double forward[3] = {direction[0], direction[1], direction[2]}, side[3], up[3];
    normalize(forward);
    bool vertical = fabs(forward[0]) < 1e-6 && fabs(forward[2]) < 1e-6;
    const double sky[3] = {0, vertical ? 0 : 1, vertical ? 1 : 0};
    cross(side, forward, sky);
    normalize(side);
    cross(up, side, forward);

    obs_frame frame;
    memset(&frame, 0, sizeof frame);
    for (int k = 0; k < 3; k++) {
        frame.eye[k] = (float)eye[k];
        frame.dir[k] = (float)forward[k];
        frame.view[4 * k] = (float)side[k];
        frame.view[4 * k + 1] = (float)up[k];
        frame.view[4 * k + 2] = (float)-forward[k];
    }
    frame.view[12] = (float)-dot(side, eye);
    frame.view[13] = (float)-dot(up, eye);
    frame.view[14] = (float)dot(forward, eye);
    frame.view[15] = 1.0f;
    frame.proj[0] = (float)(cotangent / aspect);
    frame.proj[5] = (float)cotangent;
    frame.proj[10] = (float)((far_z + near_z) / (near_z - far_z));
    frame.proj[11] = -1.0f;
    frame.proj[14] = (float)(2 * far_z * near_z / (near_z - far_z));
    return frame;
}

void obs_view_projection(const obs_frame *frame, float out[16])
{
    for (int c = 0; c < 4; c++)
        for (int r = 0; r < 4; r++) {
            double sum = 0;
            for (int k = 0; k < 4; k++)
                sum += (double)frame->proj[4 * k + r] * (double)frame->view[4 * c + k];
            out[4 * c + r] = (float)sum;
        }
}
