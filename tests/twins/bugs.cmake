# SPDX-License-Identifier: Apache-2.0
# The planted bugs, and of the regular tests those that catch them (planting.cmake says how).

set(can_be_seen "duel [0-9]+: hidden, but it can be seen")
set(decided_otherwise "range [0-9]+ is decided otherwise")
set(frustum_plane "frustum plane [0-5]: the offset [-+.0-9a-fpx]+ is too far")
set(answers_differ "[a-z0-9]+: (hidden [01]|another list)|hidden [01], where C says [0-3]|gather: hidden [01] in C")
set(in_kernels IN kernels/geometry.h)
set(in_shadow IN src/shadow.c COMPILE shadow.c)
set(in_camera IN src/camera.c COMPILE camera.c)

# --- a removed error bound -----------------------------------------------------------------------
# Everywhere: the judge sees what is called hidden. In one backend or one instruction set alone: it
# differs from what the bound makes of the same numbers.
set(bound "((size)*OCC_SLACK + (slack_floor))")
set(no_bound ${in_kernels} REPLACE "${bound}" BY "(0.0f * ((size)*OCC_SLACK + (slack_floor)))")
occ_plant(no_bound ${no_bound} COMPILE box.c)
occ_caught_by(no_bound shadow duels "${can_be_seen}" COMPILED)
occ_plant(no_bound_scalar ${no_bound} COMPILE box.c backend_plain.c)
occ_caught_by(no_bound_scalar backend_edges host "openmp [a-z0-9]+: ${decided_otherwise}")
foreach(isa IN LISTS occ_planted_lanes)
    occ_plant(no_bound_${isa} ${no_bound} COMPILE lanes_${isa})
    occ_caught_by(no_bound_${isa} backend_edges host "openmp ${isa}: ${decided_otherwise}")
    occ_caught_by(no_bound_${isa} lanes variants "${isa} in round [0-9]+")
endforeach()
if(occ_opencl)
    occ_plant(no_bound_opencl ${no_bound} COMPILE kernels)
    occ_caught_by(no_bound_opencl backend_edges device "opencl on a device: ${decided_otherwise}")
endif()
# Its absolute part, which swallows underflow.
occ_plant(no_floor ${in_kernels} REPLACE "${bound}" BY "((size)*OCC_SLACK + 0.0f * (slack_floor))" COMPILE box.c)
occ_caught_by(no_floor shadow "by hand" "${can_be_seen}" COMPILED)

# The bounds of set-up: what a plane is moved by, what its offset and its eye may be off by, and
# when a face counts as seen.
occ_plant(not_inward ${in_shadow} REPLACE "inward - abs_quad(inward) * 0x1p-21" BY "inward")
occ_caught_by(not_inward shadow_planes exact "inward by [-+.0-9e]+ u.d.")
occ_plant(no_offset_error ${in_shadow} REPLACE "(p->d - p->d_error) * scale" BY "(p->d - 0.0 * p->d_error) * scale")
occ_caught_by(no_offset_error shadow_planes exact "inward by [-+.0-9e]+ u.d.")
occ_plant(no_eye_doubt ${in_shadow} REPLACE "8.0 * EPS * dot_magnitude_quad(p->n, doubt)" BY "0.0 * doubt[0]")
occ_caught_by(no_eye_doubt camera_planes silhouettes "camera [0-9]+: silhouette [0-9]+ holds the eye")
occ_plant(no_origin_doubt ${in_camera} REPLACE "camera->doubt[j] += fabs(camera->eye[j])" BY "camera->doubt[j] += 0.0")
occ_caught_by(no_origin_doubt camera_planes frusta "${frustum_plane} inward")
occ_plant(no_sight_error ${in_shadow} REPLACE "above_quad(margin, error)" BY "above_quad(margin, 0.0 * error)")
occ_caught_by(no_sight_error shadow "by hand" "Assertion 'oracle_box[^']* == ORACLE_HIDDEN' failed")
occ_plant(no_plane_error ${in_camera} REPLACE "(d + error) * scale" BY "(d + 0.0 * error) * scale")
occ_caught_by(no_plane_error camera_planes frusta "${frustum_plane} inward")
occ_plant(no_low_half ${in_camera} REPLACE "(float)(camera->eye[j] - (double)high)" BY "0.0f * high")
occ_caught_by(no_low_half camera eyes "Assertion 'fabs.pair - eye.j.. <=")

# --- a swapped comparison ------------------------------------------------------------------------
set(swapped ${in_kernels} REPLACE "((s) - (r) > (e))" BY "((s) - (r) >= (e))")
occ_plant(swapped_scalar ${swapped} COMPILE backend_plain.c)
occ_caught_by(swapped_scalar backend_edges host "plain one by one: ${decided_otherwise}")
foreach(isa IN LISTS occ_planted_lanes)
    occ_plant(swapped_${isa} IN src/lanes_objects.h REPLACE "above_wide(s - r, o->e)" BY "~above_wide(o->e, s - r)" COMPILE lanes_${isa})
    occ_caught_by(swapped_${isa} backend_edges host "openmp ${isa}: ${decided_otherwise}")
    occ_caught_by(swapped_${isa} lanes variants "${isa} in round [0-9]+")
endforeach()
if(occ_opencl)
    occ_plant(swapped_opencl ${swapped} COMPILE kernels)
    occ_caught_by(swapped_opencl backend_edges device "opencl on a device: ${decided_otherwise}")
endif()
occ_plant(swapped_outside ${in_kernels} REPLACE "((s) + (r) < -(e))" BY "((s) + (r) <= -(e))" COMPILE backend_plain.c)
occ_caught_by(swapped_outside backend_edges host "plain one by one: ${decided_otherwise}")
occ_plant(swapped_sight ${in_shadow} REPLACE "above_quad(margin, error)" BY "~above_quad(error, margin)")
occ_caught_by(swapped_sight shadow "by hand" "Assertion 'hides_from.5, 0, 0, &sheet, &left.' failed")
occ_plant(swapped_side ${in_shadow} REPLACE "s->facing = where_quad(ahead," BY "s->facing = where_quad(~ahead,")
occ_caught_by(swapped_side shadow "by hand" "Assertion 'hides_from.5, 0, 0, &sheet, &left.' failed")

# --- an occluder grown by one part in a million --------------------------------------------------
occ_plant(grown ${in_shadow} REPLACE "make_quad(a, b, c, c);"
    BY "make_quad(a, b, c, c) * 1.000001;")
occ_caught_by(grown shadow "by hand" "Assertion 'hides_from.1001, 0, 0, &wall, &by_its_face. ==")
occ_caught_by(grown shadow_planes exact "a normal is off by [.0-9]+ u")

# --- a missing test of near faces, edges, or what the near plane cuts away -----------------------
occ_plant(no_faces ${in_shadow} REPLACE "add_planes(shadow, &faces, seen, 3)" BY "add_planes(shadow, &faces, seen & 0u, 3)")
occ_caught_by(no_faces shadow duels "${can_be_seen}")
if(TARGET test_gl_scenes)
    occ_caught_by(no_faces gl_scenes city "city, frame 0, method 0: [0-9]+ objects are left out that OpenGL")
endif()
occ_plant(no_edge ${in_shadow} REPLACE "lanes[k], 4)" BY "lanes[k], 3)")
occ_caught_by(no_edge shadow duels "${can_be_seen}")
set(past_near "point [0-9]+ of object [0-9]+ can be seen")
occ_plant(no_near_plane ${in_shadow} REPLACE "if (!seen || !survives_near(&s, camera, seen)) return false"
    BY "(void)survives_near(&s, camera, seen);
    if (!seen) return false")
occ_caught_by(no_near_plane near "at random" "${past_near}")
occ_plant(no_near_reach ${in_shadow} REPLACE "(reach[0] + reach[1] + reach[2]) >" BY "0.0 * reach[0] >")
occ_caught_by(no_near_reach near "at random" "${past_near}")
occ_plant(no_near_corner ${in_shadow} REPLACE "int c = 0; c < 4; c++" BY "int c = 0; c < 3; c++")
occ_caught_by(no_near_corner near "at random" "${past_near}")

# --- a frustum plane off by one ulp --------------------------------------------------------------
# Towards the middle, where it loses objects, and away from it.
set(outward "occ_round_up(wide + fabs(wide) * 0x1p-21)")
occ_plant(plane_inward ${in_camera} REPLACE "${outward}" BY "nextafterf(${outward}, -1e38f)")
occ_caught_by(plane_inward camera_planes frusta "${frustum_plane} inward")
occ_plant(plane_outward ${in_camera} REPLACE "${outward}" BY "nextafterf(${outward}, 1e38f)")
occ_caught_by(plane_outward camera_planes frusta "${frustum_plane} outward")

# --- an object hidden by what it owns ------------------------------------------------------------
set(own "if (shadow->owner == row) continue;")
occ_plant(owner_scalar IN src/backend_plain.c REPLACE "${own}" BY "" COMPILE backend_plain.c)
occ_caught_by(owner_scalar backend_edges host "plain one by one: ${decided_otherwise}")
occ_plant(owner_lanes IN src/lanes_objects.h REPLACE "near &= ~(1u << own)" BY "near &= ~0u" COMPILE lanes_plain)
occ_caught_by(owner_lanes backend_edges host "openmp plain: ${decided_otherwise}")
occ_plant(owner_node IN src/lanes_walk.h REPLACE "owner - question->first < question->rows" BY "owner - question->first < 0u * question->rows"
    COMPILE lanes_plain)
if(TARGET test_lanes_walk)
    occ_caught_by(owner_node lanes_walk edges "${answers_differ}")
endif()
if(occ_opencl)
    occ_plant(owner_opencl IN kernels/test.cl REPLACE "${own}" BY "" COMPILE kernels)
    occ_caught_by(owner_opencl backend_edges device "opencl on a device: ${decided_otherwise}")
    occ_plant(owner_ranges IN kernels/range.cl REPLACE "open & (iota != (int)(shadow->owner - row))" BY "open"
        COMPILE kernels)
    occ_caught_by(owner_ranges backend_edges device "opencl by ranges on a device: ${decided_otherwise}")
endif()

# --- small worlds and large scenes ---------------------------------------------------------------
# What finds such bugs by itself, among random worlds, and what remembers how it found them.
if(TARGET test_property)
    foreach(bug IN ITEMS grown no_faces no_near_plane no_low_half)
        occ_caught_by(${bug} property host "world [0-9]+: object [0-9]+ is [a-z, ]+: [a-z]+, plain")
    endforeach()
    occ_caught_by(no_bound property host "world [0-9]+: [a-z]+: the mask is 0x[0-9a-f]+, on OpenMP")
    occ_caught_by(no_bound regressions host "error_bound_removed.obs")
    occ_caught_by(grown regressions host "occluder_grown_by_1e-6.obs")
    occ_caught_by(no_faces regressions host "first_near_face_missing.obs")
    occ_caught_by(no_low_half regressions host "eye_low_half_dropped.obs")
    occ_caught_by(owner_scalar regressions host "node_owners_forgotten.obs")

    occ_plant(unmirrored ${in_shadow} REPLACE "above_quad(zero, splat_quad(depth[0]))" BY "above_quad(zero, zero)")
    occ_caught_by(unmirrored property host "world [0-9]+: object [0-9]+ is left out, but seen")
    occ_caught_by(unmirrored regressions host "mirrored_axes_ignored.obs")
    occ_caught_by(unmirrored metamorphic judged "pairwise, mirrored, camera [0-3]: object [0-9]+ is")

    occ_plant(area_of_its_own IN src/occluders.c COMPILE occluders.c REPLACE "choice->least = frame->knobs.min_area;"
        BY "choice->least = frame->knobs.min_area * 0.05f * (float)fabs(camera->eye[0]);")
    occ_caught_by(area_of_its_own metamorphic exact "single, scaled, camera [0-3]: object [0-9]+ is")
    occ_plant(odd_one_out IN src/walk.c COMPILE walk.c REPLACE "i = 0; i < count; i++)\n        if (occ_occluders_add(frame, i,"
        BY "i = count % 2 * 400; i < count; i++)\n        if (occ_occluders_add(frame, i,")
    occ_caught_by(odd_one_out metamorphic_edits occluders "one occluder [a-z]+: object [0-9]+ is seen again")
endif()

# --- what several hide together ------------------------------------------------------------------
if(TARGET test_fusion)
    set(fused_too_much "world [0-9]+: object [0-9]+ is hidden, but it can be seen")
    occ_plant(fusion_without_bounds IN kernels/piece.h REPLACE "((d) - ((object)*OCC_OBJECT_SLACK + " BY "((d) + 32.0f * ((object)*OCC_OBJECT_SLACK + "
        COMPILE backend_plain.c)
    occ_caught_by(fusion_without_bounds fusion random "${fused_too_much}")
    occ_plant(fusion_in_front IN kernels/fusion.h REPLACE "if (by_faces || occ_box_is_behind(box, shadow)) return 1;"
        BY "(void)box;\n    (void)shadow;\n    if (!by_faces) return 1;" COMPILE backend_plain.c)
    occ_caught_by(fusion_in_front fusion random "${fused_too_much}")
    occ_plant(fusion_of_owners IN kernels/fusion.h REPLACE "if (shadow->owner == row) continue;" BY "(void)row;"
        COMPILE backend_plain.c)
    occ_caught_by(fusion_of_owners fusion random "${fused_too_much}")
    occ_plant(fusion_half_a_piece IN kernels/fusion.h REPLACE "if (cut == OCC_CUT_TWO) fusion->depth++;"
        BY "if (cut == OCC_CUT_TWO && n->x < 0.0f) fusion->depth++;" COMPILE backend_plain.c)
    occ_caught_by(fusion_half_a_piece fusion random "${fused_too_much}")
endif()

# In vectors: the same scenes, and what the walk asks. Where occluders are on the screen is not to
# decide anything.
if(TARGET test_lanes_fusion)
    set(fused_otherwise "[a-z0-9]+ in world [0-9]+")
    set(vectors COMPILE lanes_plain)
    occ_plant(vectors_turned_round IN src/lanes_piece.h REPLACE "old[i - head]" BY "old[n - 1 - i]" ${vectors})
    occ_caught_by(vectors_turned_round lanes_fusion worlds "${fused_otherwise}")
    if("avx512" IN_LIST occ_planted_lanes)
        occ_plant(vectors_one_late IN src/lanes_piece.h REPLACE "iota + (int)first, beyond" BY "iota + (int)first + 1, beyond"
            COMPILE lanes_avx512)
        occ_caught_by(vectors_one_late lanes_fusion worlds "${fused_otherwise}")
    endif()
    occ_plant(vectors_third_face_cuts_nothing IN src/lanes_fusion.h REPLACE "return shadow->planes & ~inside;"
        BY "return shadow->planes & ~inside & 0xffu;" ${vectors})
    occ_caught_by(vectors_third_face_cuts_nothing lanes_fusion worlds "${fused_otherwise}")
    occ_plant(vectors_third_face_parts_nothing IN src/lanes_fusion.h REPLACE "if (n[3] == OCC_NO_PLANE_AT) return;"
        BY "if (n[3] <= OCC_NO_PLANE_AT) return;" ${vectors})
    occ_caught_by(vectors_third_face_parts_nothing lanes_walk worlds "${answers_differ}")
    occ_plant(vectors_third_face_holds_all IN src/lanes_fusion.h REPLACE "if (!(shadow->planes >> OCC_PLANE_LANES)) return true;"
        BY "if (shadow->planes >> OCC_PLANE_LANES < 2u) return true;" ${vectors})
    occ_caught_by(vectors_third_face_holds_all lanes variants "plain in round [0-9]+")
    occ_plant(vectors_third_face_for_all IN src/lanes_fusion.h REPLACE "n[3], x, y, z) > e;" BY "n[3], x, y, z) > e && n[3] < OCC_NO_PLANE_AT;" ${vectors})
    occ_caught_by(vectors_third_face_for_all lanes_fusion worlds "${fused_otherwise}")
    occ_plant(vectors_lose_what_the_picture_cuts IN src/lanes_fusion.h REPLACE "if (cut == OCC_CUT_INSIDE) continue;"
        BY "if (cut == OCC_CUT_INSIDE || cut == OCC_CUT_TWO) continue;" ${vectors})
    occ_caught_by(vectors_lose_what_the_picture_cuts lanes_fusion worlds "${fused_otherwise}")
    occ_plant(node_in_front IN src/lanes_walk.h REPLACE "is_behind(question->box, &set->wide[i])" BY "question->box" ${vectors})
    occ_caught_by(node_in_front lanes_walk worlds "${answers_differ}")
    occ_plant(corners_beside_the_picture IN src/lanes_screen.h REPLACE "in &= inner;" BY "in &= inner | 0xffu;" ${vectors})
    occ_caught_by(corners_beside_the_picture lanes_fusion worlds "${fused_otherwise}")
    occ_caught_by(corners_beside_the_picture lanes_walk worlds "${answers_differ}")
    occ_plant(rects_too_small IN src/occluders.c REPLACE "(1.0f + most) * 0x1p-10f" BY "(1.0f + most) * -0x1p-10f" COMPILE occluders.c)
    occ_caught_by(rects_too_small lanes_fusion worlds "${fused_otherwise}")
    occ_plant(rects_without_tolerance IN src/occluders.c REPLACE "(camera->tolerance > 0.0)" BY "(camera->tolerance > 1e9)" COMPILE occluders.c)
    occ_caught_by(rects_without_tolerance lanes_fusion tolerance "${fused_otherwise}")
    occ_caught_by(rects_without_tolerance tolerance backends "world [0-9]+ differs")
endif()
occ_plant(frustum_asks_occluders IN src/walk.c REPLACE "attached.count && frame->knobs.method != OCC_METHOD_FRUSTUM" BY "attached.count"
    COMPILE walk.c)
occ_caught_by(frustum_asks_occluders view stats "Assertion 'stats.walk_hidden . stats.test_hidden . stats.occluders_used == 0' failed")

# --- triangles, and bounds of them ---------------------------------------------------------------
set(in_overlap IN src/soup/overlap.c COMPILE soup/overlap.c)
if(TARGET test_overlap)
    set(other_contact "trial [0-9]+: [012], not [012]")
    occ_plant(contact_without_error ${in_overlap} REPLACE "(terms / fabs(volume))) * 0x1p-53" BY "(terms / fabs(volume))) * 0x1p-80")
    occ_caught_by(contact_without_error overlap contacts "${other_contact}")
    occ_plant(contact_of_edges_without_error ${in_overlap} REPLACE "(16.0 * (e) * (q) + 0x1p-48 * (q) * (q))" BY "(0.0 * (e) * (q))")
    occ_caught_by(contact_of_edges_without_error overlap contacts "${other_contact}")
    occ_plant(contact_of_normals_without_error ${in_overlap} REPLACE "(128.0 * (e) * (q) * (q) + 0x1p-44 * (q) * (q) * (q))"
        BY "(0.0 * (e) * (q))")
    occ_caught_by(contact_of_normals_without_error overlap contacts "${other_contact}")
    occ_plant(contact_without_edges ${in_overlap} REPLACE "(void)(try_faces(search, &led, 3) && try_normal(search, &led) && try_edges(search, &led));"
        BY "(void)(try_faces(search, &led, 3) && try_normal(search, &led) && (search->contact == OCC_APART || try_edges(search, &led) || (search->contact = OCC_ENTERING)));")
    occ_caught_by(contact_without_edges overlap contacts "${other_contact}")
    occ_plant(touching_is_apart ${in_overlap} REPLACE "if (low > half || high < -half)" BY "if (low >= half || high < -half)")
    occ_caught_by(touching_is_apart overlap contacts "${other_contact}")
endif()
if(TARGET test_soup_bounds)
    occ_plant(bounds_unproven IN src/soup/fit_hold.c REPLACE "if (holds_all(points, &ready, reach)) return true;"
        BY "if (holds_all(points, &ready, reach) || tries == 0) return true;" COMPILE soup/fit_hold.c)
    occ_caught_by(bounds_unproven soup_bounds inside "[a-z]+ [0-9]+: vertex [0-9]+")
    occ_plant(bounds_upright IN src/soup/soup_bounds.c REPLACE "(1.0 - 0x1p-10)" BY "0.0" COMPILE soup/soup_bounds.c)
    occ_caught_by(bounds_upright soup_bounds small "Assertion 'sum / boxes <= 1.02' failed")
    # What finds the bounds and what verifies them share the test of a point: the judge does not.
    occ_plant(points_by_luck ${in_overlap} REPLACE "fabs(value) + terms * 0x1p-49 <= reach" BY "fabs(value) - terms * 0x1p-40 <= reach")
    occ_caught_by(points_by_luck overlap contacts "trial [0-9]+: point")
endif()

# --- what a tolerance may hide -------------------------------------------------------------------
if(TARGET test_tolerance)
    set(widened "world [0-9]+: object [0-9]+ is hidden, but seen past the widened occluders")
    occ_plant(tolerance_on_each_side ${in_shadow} REPLACE "double by = 0.5 * tolerance" BY "double by = tolerance")
    occ_caught_by(tolerance_on_each_side tolerance random "${widened}")
    occ_plant(tolerance_of_faces ${in_shadow} REPLACE "if (!add_silhouettes(shadow, &s, camera)) return false"
        BY "if (!add_silhouettes(shadow, &s, camera)) return false;
    for (int j = 0; j < 3; j++) s.middle[j] *= 1.0 - 0.5 * camera->tolerance")
    occ_caught_by(tolerance_of_faces tolerance random "${widened}")
    occ_plant(tolerance_of_points ${in_shadow} REPLACE "fmax(1.0 + occ_dot(t->unit, all[o].unit), 0.0)"
        BY "fmax(4.0 + occ_dot(t->unit, all[o].unit), 0.0)")
    occ_caught_by(tolerance_of_points tolerance random "world [0-9]+: object [0-9]+ is hidden, but seen far from all outlines")
endif()

# --- sheets ----------------------------------------------------------------------------------------
set(in_sheet IN src/shadow_sheet.c COMPILE shadow_sheet.c)
if(TARGET test_sheet_shadow)
    occ_plant(sheet_without_an_edge ${in_sheet} REPLACE "uint32_t i = odd; i < l->count; i += 2"
        BY "uint32_t i = odd; i + 1 < l->count; i += 2")
    occ_caught_by(sheet_without_an_edge sheet_shadow exact "trial [0-9]+: an edge has no plane")
    occ_plant(sheet_from_its_nearest_corner ${in_sheet} REPLACE "-l.high, l.error" BY "-l.low, l.error")
    occ_caught_by(sheet_from_its_nearest_corner sheet_shadow exact "inward by [-+.0-9e]+ u.d.")
    occ_plant(sheet_of_any_side ${in_sheet} REPLACE "OCC_SIDES_FRONT && l->turn > 0.0" BY "OCC_SIDES_FRONT && l->turn > 2.0")
    occ_caught_by(sheet_of_any_side sheet_shadow exact "trial [0-9]+: from behind")
    occ_plant(sheet_around_the_eye ${in_sheet} REPLACE "return l->low > l->error" BY "return l->high > l->error")
    occ_caught_by(sheet_around_the_eye sheet_shadow exact "the eye is behind a corner")
    occ_plant(sheet_without_sight_error ${in_sheet} REPLACE "return l->low > l->error" BY "return l->low > 0.0 * l->error")
    occ_caught_by(sheet_without_sight_error sheet_shadow exact "(the eye is behind a corner|trial [0-9]+: an edge has no plane)")
    occ_plant(sheet_with_a_wide_notch ${in_sheet} REPLACE "l->corner[k]) > slack" BY "l->corner[k]) > slack - 1e300")
    occ_caught_by(sheet_with_a_wide_notch sheet_tolerance random "a point off by [-+.0-9e]+ of the tolerance is held")
endif()
if(TARGET test_sheet_shadow)
    occ_plant(sheet_not_inward ${in_sheet} REPLACE "inward - fabs(inward) * 0x1p-21" BY "inward")
    occ_caught_by(sheet_not_inward sheet_shadow exact "inward by [-+.0-9e]+ u.d.")
    occ_plant(sheet_no_offset_error ${in_sheet} REPLACE "(d - d_error) * scale" BY "(d - 0.0 * d_error) * scale")
    occ_caught_by(sheet_no_offset_error sheet_shadow exact "inward by [-+.0-9e]+ u.d.")
    occ_plant(sheet_no_normal_error ${in_sheet} REPLACE "normal_error > size * 0x1p-26" BY "normal_error > size * 0x1p99")
    occ_caught_by(sheet_no_normal_error sheet_shadow exact "trial [0-9]+: an edge has no plane")
    occ_plant(sheet_no_eye_doubt ${in_sheet} REPLACE "8.0 * EPS * occ_dot_magnitude(n, camera->doubt)" BY "0.0")
    occ_caught_by(sheet_no_eye_doubt camera_planes silhouettes "camera [0-9]+: silhouette [0-9]+ holds the eye")
endif()
if(TARGET test_sheet_verdicts)
    occ_plant(sheet_cut_open ${in_sheet} REPLACE "|| !survives_near(&l, camera)" BY "|| (0 && !survives_near(&l, camera))")
    occ_caught_by(sheet_cut_open sheet_verdicts flat_boxes "seed [0-9]+, frame [0-9]+")
    occ_plant(sheet_with_a_corner_twice ${in_sheet} REPLACE "sheet->corner[before])) continue;" BY "sheet->corner[before])) {}")
    occ_caught_by(sheet_with_a_corner_twice sheet_verdicts by_hand "Assertion 'hides..twice, .behind")
endif()
if(TARGET test_sheet_frames)
    # Edges in the lanes in which boxes have faces are none.
    foreach(isa IN LISTS occ_planted_lanes)
        occ_plant(sheet_with_more_faces_${isa} IN src/lanes_fusion.h REPLACE "shadow->faces & ~inside & 0xffu"
            BY "shadow->planes & ~inside & (3u << OCC_FACE_LANE)" COMPILE lanes_${isa})
        occ_caught_by(sheet_with_more_faces_${isa} sheet_frames vectors "[a-z0-9]+: (another mask|other counts)")
    endforeach()
endif()

# --- an explanation that leaves out an occluder --------------------------------------------------
set(in_explain IN src/explain.c COMPILE explain.c)
set(past_those "[a-z_]+ [0-9]+: object [0-9]+ can be seen past the [0-9]+ that hide it")
occ_plant(explains_less ${in_explain} REPLACE "occ_view_fits(view, occluders, capacity, found.count, count)"
    BY "occ_view_fits(view, occluders, capacity, found.count -= found.count > 1, count)")
occ_caught_by(explains_less explain judged "${past_those}")
# One that shrinks too far, and one that takes an object's own occluders.
occ_plant(explains_too_little ${in_explain} REPLACE "prove(frame, claim, fewer.place, fewer.count, &used)) continue;"
    BY "prove(frame, claim, fewer.place, fewer.count, &used)) used = fewer;")
occ_caught_by(explains_too_little explain judged "${past_those}")
occ_plant(explains_by_own ${in_explain} REPLACE "if (shadow->owner == row) continue;" BY "(void)row;")
occ_caught_by(explains_by_own explain judged "[a-z_]+ [0-9]+: object [0-9]+ is hidden by its own")
# And one that does not look at the nodes with which an object fell.
occ_plant(explains_no_nodes ${in_explain} REPLACE "for (uint32_t i = path->count; i-- > 0;)" BY "for (uint32_t i = 0; i-- > 0;)")
occ_caught_by(explains_no_nodes explain judged "[a-z_]+ [0-9]+: object [0-9]+: OCC_ERROR_CORRUPT")

# --- inner boxes that are not ---------------------------------------------------------------------
if(TARGET test_inner_random)
    # A face that grows through triangles: what comes of it is thrown away.
    occ_plant(grown_through IN src/soup/grow.c REPLACE "if (!occ_ready_box_entered(&ready, corner)) continue;" BY "if (corner[0]) continue;"
        COMPILE soup/grow.c)
    occ_caught_by(grown_through inner_random soups "Assertion 'report.boxes >= 1500' failed")
    # What the search and the verification both get wrong is for the judge.
    occ_plant(closed_by_flood IN src/soup/free_space.c REPLACE "(!mark->bits.count && !space->outside_solid)" BY "false"
        COMPILE soup/free_space.c)
    occ_caught_by(closed_by_flood inner_random soups "soup [0-9]+: box [0-9]+ is in no solid")
    occ_plant(touched_less IN src/soup/voxels.c REPLACE "#define MARGIN 0x1p-16" BY "#define MARGIN -0x1p-16" COMPILE soup/voxels.c)
    occ_caught_by(touched_less soup_voxels touched "cell [0-9]+ [0-9]+ [0-9]+ is touched, but not marked")
endif()
occ_plant(intruders_unseen IN src/soup/grow.c REPLACE "if (!apart && occ_ready_box_entered(&ready, corner)) return t;" BY "(void)apart;"
    COMPILE soup/grow.c)
occ_caught_by(intruders_unseen inner verify "Assertion 'judge.&box, &fault. == OCC_INNER_ENTERED")
occ_plant(edges_uncut IN src/soup/edges.c REPLACE "fits = cut_edge(&s, u->low, u->high);" BY "fits = u->low < u->high || cut_edge(&s, u->low, u->high);"
    COMPILE soup/edges.c)
occ_caught_by(edges_uncut closed lattices "lattice [0-9]+: cell [0-9]+ is closed off, but not marked")
occ_plant(rules_forgotten IN src/soup/marks.c REPLACE "if (cluster->rule_count)" BY "if (cluster->rule_count > UINT32_MAX / 2)"
    COMPILE soup/marks.c)
occ_caught_by(rules_forgotten closed lattices "lattice [0-9]+: cell [0-9]+ is outside, but marked")
occ_plant(grid_on_trust IN src/soup/verify_inner.c REPLACE "voxels->grid.hole <= call->desc->max_hole &&" BY ""
    COMPILE soup/verify_inner.c)
occ_caught_by(grid_on_trust inner verify "Assertion 'occ_verify_inner")
occ_plant(rooms_filled IN src/soup/free_space.c REPLACE "if (occ_marks_differ(mark, &space->marks[i])) continue;" BY "continue;"
    COMPILE soup/free_space.c)
occ_caught_by(rooms_filled inner verify "Assertion 'occ_verify_inner")

# --- sheets that are none -------------------------------------------------------------------------
set(in_proof IN src/soup/sheet_proof.c COMPILE soup/sheet_proof.c)
if(TARGET test_sheet_random)
    set(sight_passes "soup [0-9]+: a sight passes a sheet that was")
    occ_plant(rims_unseen ${in_proof} REPLACE "if (!meets_rim(p, (const float(*)[2])at)) continue;" BY "if (meets_rim(p, (const float(*)[2])at) || i < plane->rims) continue;")
    occ_caught_by(rims_unseen sheet_random soups "${sight_passes} (found|forged)")
    occ_plant(backs_drawn ${in_proof} REPLACE "if (turned && desc->sides == OCC_SIDES_FRONT)" BY "if (turned && desc->sides > OCC_SIDES_FRONT)")
    occ_caught_by(backs_drawn sheet_random soups "${sight_passes} forged")
    occ_plant(backs_fill ${in_proof} REPLACE "(!one_sided && next == corner[2]" BY "((one_sided || next != last) && next == corner[2]")
    occ_caught_by(backs_fill sheet_random soups "${sight_passes} forged")
endif()
occ_plant(off_plane ${in_proof} REPLACE "point) == 0;" BY "point) < 2;")
occ_caught_by(off_plane sheet_find verify "Assertion 'judge[^']* == OCC_SHEET_OPEN' failed")
occ_plant(stars_convex ${in_proof} REPLACE "for (uint32_t k = 0; k < n; k++) {" BY "for (uint32_t k = (i + 2) % n, once = 1; once > 0; once--) {")
occ_caught_by(stars_convex sheet_find verify "Assertion 'judge[^']* == OCC_SHEET_BENT' failed")
