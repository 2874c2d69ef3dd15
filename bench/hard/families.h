// SPDX-License-Identifier: Apache-2.0
/// @file
/// The list of the families, and how one is written down.
#ifndef OCC_HARD_FAMILIES_H
#define OCC_HARD_FAMILIES_H

#include "stage.h"

/// X(name, what its worlds have in common)
#define FAMILY_LIST(X)                                                                             \
    X(eye_face_plane, "the eye in the plane of an occluder's face")                                \
    X(eye_edge_line, "the eye on the line of an occluder's edge")                                  \
    X(eye_corner, "the eye in a corner of one occluder, or of several")                            \
    X(eye_in_occluder, "the eye inside an occluder, or on its surface")                            \
    X(eye_in_object, "the eye inside an object, or on its surface")                                \
    X(occluder_behind_eye, "occluders behind the eye, beside it, and through its plane")           \
    X(object_at_eye, "objects behind the eye, around it, and touching it")                         \
    X(object_at_near, "objects behind the near plane, through it, and touching it")                \
    X(occluder_at_near, "occluders that the near plane cuts open or touches")                      \
    X(coplanar, "faces of objects and occluders in one plane")                                     \
    X(touching, "objects that touch occluders with faces, edges and corners")                      \
    X(identical, "objects and occluders that are the same box")                                    \
    X(abutting, "occluders side by side with the seam on the line of sight")                       \
    X(overlapping, "occluders that overlap and hide together")                                     \
    X(panels, "a wall of panels")                                                                  \
    X(zero_thickness, "boxes with one axis zero")                                                  \
    X(zero_area, "boxes with two axes zero or parallel")                                           \
    X(zero_volume, "boxes with three axes zero or in one plane")                                   \
    X(needles, "boxes a million times as long as thick, or as wide")                               \
    X(scales, "from a millionth to a million within one world")                                    \
    X(far_detail, "millimetres ten million units from the origin")                                 \
    X(huge_occluder, "huge occluders and tiny objects")                                            \
    X(tiny_occluder, "tiny occluders and huge objects")                                            \
    X(mirrored, "mirrored boxes and a mirrored camera")                                            \
    X(sheared, "sheared boxes")                                                                    \
    X(interpenetrating, "boxes that stick out of each other by next to nothing")                   \
    X(pixel_gap, "gaps narrower than a pixel between occluders")                                   \
    X(viewport_edge, "objects at the frustum's planes, touching them from either side")            \
    X(reversed_z, "depth from 1 at the near plane to 0")                                           \
    X(infinite_far, "no far plane")                                                                \
    X(orthographic, "the eye at infinity")                                                         \
    X(off_centre, "the eye's axis beside the picture's middle")                                    \
    X(jittered, "a picture moved by a part of a pixel")                                            \
    X(denormal, "numbers below the smallest normal float")                                         \
    X(largest, "coordinates next to OCC_MAX_COORDINATE")                                           \
    X(few, "no object or one, no occluder or one")                                                 \
    X(sheets_edge_on, "sheets seen edge-on, or nearly")                                            \
    X(sheets_both_sides, "sheets seen from the front and from the back")                           \
    X(sheet_flush, "sheets in the faces of their own objects' bounds")                             \
    X(polygon_abutting, "polygons side by side with the seam on the line of sight")                \
    X(polygon_gap, "polygons with an edge in common but for single ulps")                          \
    X(polygon_tiles, "triangles that tile a wall, corner to corner")                               \
    X(polygon_octagons, "octagons and the squares between them")                                   \
    X(polygon_bent, "polygons with corners an ulp, or more, out of their plane")                   \
    X(polygon_needles, "polygons a million times as long as wide")                                 \
    X(polygon_eye_plane, "the eye in a polygon's plane")                                           \
    X(polygon_eye_edge, "the eye on the line of a polygon's edge")                                 \
    X(polygon_eye_corner, "the eye in a corner of one polygon, or of several")                     \
    X(polygon_one_sided, "polygons that hide from the front, seen from either side")               \
    X(polygon_mixed, "polygons and boxes that hide together")                                      \
    X(polygon_concave, "outlines that are not convex, cross themselves, or have no area")          \
    X(polygon_at_near, "polygons that the near plane cuts, and others behind the eye")             \
    X(polygon_flush, "objects in a polygon's plane, and owners around it")

#define FAMILY_DECLARE(name, brief) void family_##name(family_world *, const family_place *);
FAMILY_LIST(FAMILY_DECLARE)

/// Behind it the body of the function that fills the stage.
#define FAMILY(name)                                                                               \
    static void fill_##name(stage *s);                                                             \
    void family_##name(family_world *world, const family_place *place)                             \
    {                                                                                              \
        stage s;                                                                                   \
        stage_begin(&s, world, place, #name);                                                      \
        fill_##name(&s);                                                                           \
        stage_end(&s);                                                                             \
    }                                                                                              \
    static void fill_##name(stage *s)

/// Objects in most worlds.
enum { FAMILY_CROWD = 28 };

#endif
