// SPDX-License-Identifier: Apache-2.0
#include "family.h"

#include "families.h"

#include <string.h>

#define FAMILY_ENTRY(name, brief) {#name, brief, family_##name},
const family families[] = {FAMILY_LIST(FAMILY_ENTRY){NULL, NULL, NULL}};

const family *family_find(const char *name)
{
    for (const family *f = families; f->name; f++)
        if (strcmp(f->name, name) == 0) return f;
    return NULL;
}

uint32_t family_count(void)
{
    return sizeof families / sizeof *families - 1;
}

family_place family_sweep(uint64_t number)
{
    static const double scales[] = {1e-6, 1e-3, 0.1, 1, 7, 1e3, 1e6},
                        offsets[] = {0, 100, 1e4, 1e7};
    return (family_place){scales[number % 7], offsets[number / 7 % 4], number};
}

void family_aim(family_world *world)
{
    if (world->camera.eye) world->camera.eye = world->eye;
    if (world->camera.origin) world->camera.origin = world->origin;
}
