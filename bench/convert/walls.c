// SPDX-License-Identifier: Apache-2.0
#include "walls.h"

#include "library.h"
#include "progress.h"

#include <occlude/sheets.h>
#include <stdlib.h>

static bool add_sheets(const occ_found_sheet *sheets, size_t count, obs_scene *scene)
{
    for (size_t i = 0; i < count; i++) {
        uint32_t owner = sheets[i].label == OCC_NO_LABEL ? OBS_NO_OWNER : sheets[i].label;
        if (obs_add_sheet(scene, &sheets[i].sheet, owner) == UINT32_MAX)
            return library_out_of_memory();
    }
    return true;
}

bool walls_find(const model *m, const division *d, const walls_wish *wish, obs_scene *scene,
                walls_report *report)
{
    *report = (walls_report){0};
    if (!wish->most) return true;
    size_t room = wish->most < m->triangle_count ? wish->most : m->triangle_count, count = 0;
    occ_sheets_stats stats;
    occ_found_sheet *sheets = malloc((room + 1) * sizeof *sheets);
    if (!sheets) return library_out_of_memory();
    occ_soup soup = library_soup(m, (const uint32_t(*)[3])m->corners, m->triangle_count);
    occ_sheets_desc desc = {.work = library_work(),
                            .sides = wish->one_sided ? OCC_SIDES_FRONT : OCC_SIDES_BOTH,
                            .min_area = (float)wish->min_area,
                            .labels = d->object_of,
                            .see_through = m->see_through};
    progress_begin("finding sheets, per mille", LIBRARY_STEPS);
    bool good = library_succeeded(occ_sheets_find(&soup, &desc, sheets, room, &count, &stats),
                                  "finding sheets");
    progress_end();
    good = good && add_sheets(sheets, count, scene);
    *report = (walls_report){.sheets = (uint32_t)count,
                             .found = stats.found,
                             .planes = stats.planes,
                             .share = stats.area > 0 ? stats.covered / stats.area : 0};
    free(sheets);
    return good;
}
