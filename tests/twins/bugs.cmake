# SPDX-License-Identifier: Apache-2.0
# The planted bugs and the regular tests that catch them (planting.cmake says how).

# --- a removed error bound -----------------------------------------------------------------------
set(bound "((size)*OCC_SLACK + (slack_floor))")
set(without_bound "(0.0f * ((size)*OCC_SLACK + (slack_floor)))")
set(otherwise "range [0-9]+ is decided otherwise")

# In all of the host: what can be seen is hidden.
occ_plant(no_bound IN kernels/geometry.h REPLACE "${bound}" BY "${without_bound}" COMPILE box.c)
occ_caught_by(no_bound shadow duels "duel [0-9]+: hidden, but it can be seen" COMPILED)
# In one backend or instruction set alone: it differs from the others.
occ_plant(no_bound_scalar IN kernels/geometry.h REPLACE "${bound}" BY "${without_bound}"
    COMPILE box.c backend_plain.c)
occ_caught_by(no_bound_scalar backend_edges host "openmp [a-z0-9]+: ${otherwise}")
foreach(isa IN LISTS occ_planted_lanes)
    occ_plant(no_bound_${isa} IN kernels/geometry.h REPLACE "${bound}" BY "${without_bound}" COMPILE lanes_${isa})
    occ_caught_by(no_bound_${isa} backend_edges host "openmp ${isa}: ${otherwise}")
    occ_caught_by(no_bound_${isa} lanes variants "${isa} in round [0-9]+")
endforeach()
if(occ_opencl)
    occ_plant(no_bound_opencl IN kernels/geometry.h REPLACE "${bound}" BY "${without_bound}" COMPILE kernels)
    occ_caught_by(no_bound_opencl backend_edges device "opencl on a device: ${otherwise}")
endif()

# --- set-up does not round inward, forgets its own errors, forgets the eye's doubt ---------------
occ_plant(not_inward IN src/shadow.c REPLACE "inward - fabs(inward) * 0x1p-21" BY "inward" COMPILE shadow.c)
occ_caught_by(not_inward planes shadows "a face: the offset [-x.0-9a-fp+]+ is on the wrong side")
occ_plant(no_offset_error IN src/shadow.c REPLACE "(d - d_error) * scale" BY "(d - 0.0 * d_error) * scale"
    COMPILE shadow.c)
occ_caught_by(no_offset_error planes shadows "a face: the offset [-x.0-9a-fp+]+ is on the wrong side")
occ_plant(no_doubt IN src/shadow.c REPLACE "d_error = 8.0 * EPS * occ_dot_magnitude(n, camera->doubt)"
    BY "d_error = 0.0" COMPILE shadow.c)
occ_caught_by(no_doubt planes shadows "camera [0-9]+: silhouette [0-9]+ holds the eye")
occ_plant(no_sight_error IN src/shadow.c REPLACE "!(margin > error)" BY "!(margin > 0.0 * error)" COMPILE shadow.c)
occ_caught_by(no_sight_error shadow "by hand" ".*")

# --- a swapped comparison ------------------------------------------------------------------------
set(inside "((s) - (r) > (e))")
set(inside_or_on "((s) - (r) >= (e))")
occ_plant(swapped_scalar IN kernels/geometry.h REPLACE "${inside}" BY "${inside_or_on}" COMPILE backend_plain.c)
occ_caught_by(swapped_scalar backend_edges host "plain one by one: ${otherwise}")
foreach(isa IN LISTS occ_planted_lanes)
    occ_plant(swapped_${isa} IN kernels/geometry.h REPLACE "${inside}" BY "${inside_or_on}" COMPILE lanes_${isa})
    occ_caught_by(swapped_${isa} backend_edges host "openmp ${isa}: ${otherwise}")
    occ_caught_by(swapped_${isa} lanes variants "${isa} in round [0-9]+")
endforeach()
if(occ_opencl)
    occ_plant(swapped_opencl IN kernels/geometry.h REPLACE "${inside}" BY "${inside_or_on}" COMPILE kernels)
    occ_caught_by(swapped_opencl backend_edges device "opencl on a device: ${otherwise}")
endif()
occ_plant(swapped_outside IN kernels/geometry.h REPLACE "((s) + (r) < -(e))" BY "((s) + (r) <= -(e))"
    COMPILE backend_plain.c)
occ_caught_by(swapped_outside backend_edges host "plain one by one: ${otherwise}")
occ_plant(swapped_sight IN src/shadow.c REPLACE "!(margin > error)" BY "!(margin >= error)" COMPILE shadow.c)
occ_caught_by(swapped_sight shadow "by hand" ".*")
occ_plant(swapped_side IN src/shadow.c REPLACE "f->facing = side > 0.0" BY "f->facing = side <= 0.0" COMPILE shadow.c)
occ_caught_by(swapped_side shadow duels ".*")

# --- an occluder grown by one part in a million --------------------------------------------------
occ_plant(grown IN src/shadow.c REPLACE "s->axis[k][j] = (double)box->axis[k][j]"
    BY "s->axis[k][j] = (double)box->axis[k][j] * 1.000001" COMPILE shadow.c)
occ_caught_by(grown shadow duels "duel [0-9]+: hidden, but it can be seen")
occ_caught_by(grown planes shadows ".*")

# --- a missing near-face test, a missing near-plane test, a missing silhouette -------------------
occ_plant(no_faces IN src/shadow.c REPLACE "seen[k].sign && !add_face" BY "seen[k].sign > 1 && !add_face"
    COMPILE shadow.c)
occ_caught_by(no_faces shadow duels "duel [0-9]+: hidden, but it can be seen")
occ_plant(no_near_plane IN src/shadow.c REPLACE "if (!survives_near(&s, camera, seen)) return false"
    BY "(void)survives_near(&s, camera, seen)" COMPILE shadow.c)
occ_caught_by(no_near_plane near "at random" "point [0-9]+ of object [0-9]+ can be seen")
occ_plant(no_edge IN src/shadow.c REPLACE "i < 4; i++) {\n            int turn" BY "i < 3; i++) {\n            int turn"
    COMPILE shadow.c)
occ_caught_by(no_edge shadow duels "duel [0-9]+: hidden, but it can be seen")

# --- a frustum plane off by one ulp --------------------------------------------------------------
set(outward "occ_round_up(wide + fabs(wide) * 0x1p-21)")
occ_plant(plane_inward IN src/camera.c REPLACE "${outward}" BY "nextafterf(${outward}, -1e30f)" COMPILE camera.c)
occ_caught_by(plane_inward planes frusta "a frustum plane: the offset [-x.0-9a-fp+]+ is on the wrong side")
occ_plant(plane_outward IN src/camera.c REPLACE "${outward}" BY "nextafterf(${outward}, 1e30f)" COMPILE camera.c)
occ_caught_by(plane_outward planes frusta "a frustum plane: the offset [-x.0-9a-fp+]+ is moved too far")

# --- the low half of the eye, an object hidden by its own ----------------------------------------
occ_plant(no_low_half IN src/camera.c REPLACE "(float)(camera->eye[j] - (double)high)" BY "0.0f * high"
    COMPILE camera.c)
occ_caught_by(no_low_half shadow duels "duel [0-9]+: hidden, but it can be seen")
