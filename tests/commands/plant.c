// SPDX-License-Identifier: Apache-2.0
// plant IN.obs OUT.obs X Y Z FACTOR: the scene with the occluder whose middle is nearest to a point
// made so many times as large. Prints its place in the file, and its owner.
#include "obs.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void find_middle(const obs_scene *scene, uint32_t place, double middle[3])
{
    const occ_sheet *sheet = obs_occluder_sheet(scene, place);
    for (int k = 0; k < 3; k++) {
        middle[k] = sheet ? 0 : (double)scene->occluders[place].box.center[k];
        for (uint32_t c = 0; sheet && c < sheet->corner_count; c++)
            middle[k] += (double)sheet->corner[c][k] / sheet->corner_count;
    }
}

static uint32_t nearest_to(const obs_scene *scene, const double point[3])
{
    uint32_t best = 0;
    double least = INFINITY;
    for (uint32_t i = 0; i < obs_occluder_total(scene); i++) {
        double distance = 0, middle[3];
        find_middle(scene, i, middle);
        for (int k = 0; k < 3; k++)
            distance += pow(middle[k] - point[k], 2);
        if (distance >= least) continue;
        least = distance;
        best = i;
    }
    return best;
}

static void enlarge(obs_scene *scene, uint32_t place, double factor)
{
    double middle[3];
    find_middle(scene, place, middle);
    if (place < scene->occluder_count) {
        for (int i = 0; i < 9; i++)
            scene->occluders[place].box.axis[i / 3][i % 3] *= (float)factor;
        return;
    }
    occ_sheet *sheet = &scene->sheets[place - scene->occluder_count].sheet;
    for (uint32_t c = 0; c < sheet->corner_count; c++)
        for (int k = 0; k < 3; k++) {
            double from_middle = (double)sheet->corner[c][k] - middle[k];
            sheet->corner[c][k] = (float)(middle[k] + factor * from_middle);
        }
}

int main(int argc, char **argv)
{
    obs_scene scene;
    if (argc != 7 || !obs_read(argv[1], &scene)) return 1;
    const double point[3] = {atof(argv[3]), atof(argv[4]), atof(argv[5])};
    bool good = obs_occluder_total(&scene) > 0;
    if (good) {
        uint32_t place = nearest_to(&scene, point);
        enlarge(&scene, place, atof(argv[6]));
        good = obs_write(argv[2], &scene);
        printf("%u %u\n", place, obs_occluder_owner(&scene, place));
    }
    obs_free(&scene);
    return good ? 0 : 1;
}
