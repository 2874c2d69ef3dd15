// SPDX-License-Identifier: Apache-2.0
// plant IN.obs OUT.obs X Y Z FACTOR: the scene with the occluder whose middle is nearest to a point
// made so many times as large. Prints its place in the file, and its owner.
#include "obs.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static uint32_t nearest_to(const obs_scene *scene, const double point[3])
{
    uint32_t best = 0;
    double least = INFINITY;
    for (uint32_t i = 0; i < scene->occluder_count; i++) {
        double distance = 0;
        for (int k = 0; k < 3; k++)
            distance += pow((double)scene->occluders[i].box.center[k] - point[k], 2);
        if (distance >= least) continue;
        least = distance;
        best = i;
    }
    return best;
}

int main(int argc, char **argv)
{
    obs_scene scene;
    if (argc != 7 || !obs_read(argv[1], &scene)) return 1;
    const double point[3] = {atof(argv[3]), atof(argv[4]), atof(argv[5])};
    bool good = scene.occluder_count > 0;
    if (good) {
        uint32_t place = nearest_to(&scene, point);
        float factor = (float)atof(argv[6]);
        for (int axis = 0; axis < 3; axis++)
            for (int k = 0; k < 3; k++)
                scene.occluders[place].box.axis[axis][k] *= factor;
        good = obs_write(argv[2], &scene);
        printf("%u %u\n", place, scene.occluders[place].owner);
    }
    obs_free(&scene);
    return good ? 0 : 1;
}
