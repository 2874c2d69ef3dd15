// SPDX-License-Identifier: Apache-2.0
#include "image_camera.h"

#include <math.h>

enum { ROW_X, ROW_Y, ROW_Z, ROW_W };

static void cross(const double *a, const double *b, double *out)
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

static double dot(const double *a, const double *b)
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// Moves a perspective camera so that its eye, where x, y and w are 0, is where the frame says.
static bool move_eye(double row[4][4], const float eye[3])
{
    double of_x[3], of_y[3], of_w[3], moved[3];
    cross(row[ROW_Y], row[ROW_W], of_x);
    cross(row[ROW_W], row[ROW_X], of_y);
    cross(row[ROW_X], row[ROW_Y], of_w);
    double determinant = dot(of_x, row[ROW_X]);
    for (int k = 0; k < 3; k++) {
        double at = of_x[k] * row[ROW_X][3] + of_y[k] * row[ROW_Y][3] + of_w[k] * row[ROW_W][3];
        moved[k] = -at / determinant - (double)eye[k];
    }
    for (int r = 0; r < 4; r++)
        row[r][3] += dot(row[r], moved);
    return isfinite(dot(moved, moved));
}

bool image_camera_of(const obs_frame *frame, double clip[16])
{
    float matrix[16];
    double row[4][4];
    obs_view_projection(frame, matrix);
    for (int i = 0; i < 16; i++)
        row[i % 4][i / 4] = (double)matrix[i];
    bool is_perspective = dot(row[ROW_W], row[ROW_W]) > 0.0;
    if (is_perspective && !move_eye(row, frame->eye)) return false;
    for (int k = 0; k < 4; k++)
        row[ROW_Z][k] = 0.5 * (row[ROW_W][k] - row[ROW_Z][k]);
    for (int i = 0; i < 16; i++)
        clip[i] = row[i % 4][i / 4];
    return true;
}
