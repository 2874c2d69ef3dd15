// SPDX-License-Identifier: Apache-2.0
// A sound scene for tests to damage, so that the validator can show its teeth.
#ifndef OCC_TEST_KIT_DAMAGE_H
#define OCC_TEST_KIT_DAMAGE_H

#include "kit_tree.h"

// A way to damage it.
typedef struct kit_damage {
    const char *what;
    void (*do_it)(void);
} kit_damage;

extern occ_scene *kit_victim;

// Makes the scene, committed and valid.
void kit_damage_set_up(void);

// Mends what was damaged outside the arrays.
void kit_damage_mend(void);

// Mends and destroys it.
void kit_damage_tear_down(void);

// Fails the test unless the validator sees the damage and the log names an invariant.
void kit_damage_check(const char *what);

#endif
