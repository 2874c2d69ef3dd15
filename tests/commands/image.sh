#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# image.sh PROGRAM PLANT: `occlude-bench image` on a hall that is written here, and on the same hall
# with an occluder that is larger than its wall. Ends with 77 where there is no OpenGL, unless
# OCC_REQUIRE_GL or CI says that there must be.
set -eu
program=$1
plant=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

fail()
{
    echo "image.sh: $1" >&2
    sed 's/^/  out: /' out >&2
    sed 's/^/  err: /' err >&2
    exit 1
}

# status WANTED ARGUMENT...: runs, and demands that exit status.
status()
{
    wanted=$1
    shift
    got=0
    "$program" "$@" >out 2>err || got=$?
    [ "$got" -eq "$wanted" ] || fail "exit status $got, not $wanted: $*"
}

# refused STATUS TEXT ARGUMENT...: image refuses in one line that has the text.
refused()
{
    wanted=$1
    text=$2
    shift 2
    status "$wanted" image "$@"
    grep -qF -e "$text" err || fail "does not say: $text"
    [ ! -s out ] && [ "$(wc -l <err)" -eq 1 ] || fail "says something else too"
}

# value NAME: of the last line.
value()
{
    tail -n 1 out | tr ' ' '\n' | sed -n "s/^$1=//p"
}

# A hall of 60 by 40 metres and 6 high, a wall across its middle that leaves four metres at each side
# and one below the ceiling, and crates everywhere, on both sides of it.
awk 'function quad(a, b, c, d) { print "f " n + a, n + b, n + c, n + d }
     function box(x0, y0, z0, x1, y1, z1, inward) {
         for (i = 0; i < 8; i++)
             print "v", (int(i) % 2 ? x1 : x0), (int(i / 2) % 2 ? y1 : y0), (int(i / 4) % 2 ? z1 : z0)
         if (inward) {
             quad(1, 2, 4, 3); quad(5, 7, 8, 6); quad(1, 3, 7, 5); quad(2, 6, 8, 4); quad(1, 5, 6, 2); quad(3, 4, 8, 7)
         } else {
             quad(1, 3, 4, 2); quad(5, 6, 8, 7); quad(1, 5, 7, 3); quad(2, 4, 8, 6); quad(1, 2, 6, 5); quad(3, 7, 8, 4)
         }
         n += 8
     }
     BEGIN {
         print "o hall"; box(-30, 0, -20, 30, 6, 20, 1)
         print "o wall"; box(-0.25, 0, -16, 0.25, 5, 16, 0)
         print "o crates"
         for (x = -28; x < 29; x += 2)
             for (z = -18; z < 19; z += 3) {
                 if (x * x < 4 || z * z < 9) continue
                 h = 0.5 + (x * x + 7 * z * z) % 13 / 10
                 box(x - 0.3, 0, z - 0.3, x + 0.3, h, z + 0.3, 0)
             }
     }' >hall.obj
status 0 convert hall.obj --out hall.obs --up y --triangles 12 --frames 9
all=$(sed 's/.*objects=\([0-9]*\) .*/\1/' out | tail -n 1)
small='--size 320x180 --triangles 12 --up y'

# Arguments, before anything is drawn.
status 0 image --help
grep -q 'usage: occlude-bench image' out || fail "no help"
refused 2 'expected a scene file' --model hall.obj
refused 2 'expected --model MODEL' hall.obs
refused 2 'expected --size as 1920x1080' hall.obs --model hall.obj --size 0x10
refused 2 'expected --size as 1920x1080' hall.obs --model hall.obj --size 8193x10
refused 2 'expected frustum, pairwise, single or fused' hall.obs --model hall.obj --method thesis
refused 2 'expected plain, openmp or opencl' hall.obs --model hall.obj --backend gpu
refused 2 'expected all or frustum after --against' hall.obs --model hall.obj --against none
refused 2 '--tolerance is 0.1 at most' hall.obs --model hall.obj --tolerance 1
refused 2 '--triangles: expected a number from 1' hall.obs --model hall.obj --triangles 0
refused 1 'absent.obj' hall.obs --model absent.obj
refused 1 'absent.obs' absent.obs --model hall.obj
refused 1 'expected --frames as 0,20,40' hall.obs --model hall.obj --frames 9
refused 1 'give --triangles, --split, --up and --see-through as they were given to convert' \
    hall.obs --model hall.obj --up y
refused 1 'has another box than hall.obj gives it' hall.obs --model hall.obj --triangles 12 --up z

# Without any EGL the reason is told. (Where EGL has no vendors to choose from this is not looked at.)
got=0
# shellcheck disable=SC2086
__EGL_VENDOR_LIBRARY_FILENAMES=/dev/null "$program" image hall.obs --model hall.obj $small >out 2>err || got=$?
case $got in
0) ;;
1) grep -qE '^occlude-bench: OpenGL: .*(EGL|window)' err || fail "does not say what is missing" ;;
*) fail "exit status $got without EGL" ;;
esac

# shellcheck disable=SC2086
if ! "$program" image hall.obs --model hall.obj $small --frames 0 >out 2>err && grep -q 'OpenGL: ' err; then
    cat err >&2
    [ -z "${CI:-}${OCC_REQUIRE_GL:-}" ] || exit 1
    exit 77
fi

# Nothing differs, something is saved, and the sums are right.
for method in fused single frustum; do
    # shellcheck disable=SC2086
    status 0 image hall.obs --model hall.obj $small --method $method --csv $method.csv --backend plain
    tail -n 1 out | grep -qE '^frames=9 differing_pixels=0 triangles_drawn=[0-9]+ triangles_saved=[0-9]+ ' ||
        fail "another last line"
    triangles=$(sed -n 's/^model *\([0-9]*\) triangles.*/\1/p' out)
    [ $(($(value triangles_drawn) + $(value triangles_saved))) -eq $((9 * triangles)) ] || fail "triangles get lost"
    [ $(($(value draws) + $(value draws_saved))) -eq $((9 * all)) ] || fail "draw calls get lost"
    [ "$(value draws)" -eq "$(value visible)" ] || fail "a visible object is not one draw call"
    sed '/^#/d' $method.csv | awk -F, -v wanted="$(value triangles_drawn) $(value in_frustum) 0" '
        NR == 1 { for (i = 1; i <= NF; i++) place[$i] = i; wide = NF }
        NF != wide { exit 1 }
        NR > 1 { drawn += $place["triangles"]; inside += $place["in_frustum"]; other += $place["differing_pixels"] }
        END { exit NR == 10 && drawn " " inside " " other == wanted ? 0 : 1 }' || fail "the table says otherwise"
    value visible >$method.visible
    value in_frustum >$method.in_frustum
done
[ "$(cat fused.visible)" -le "$(cat single.visible)" ] || fail "fused leaves more than single"
[ "$(cat single.visible)" -lt "$(cat single.in_frustum)" ] || fail "the wall hides nothing"
[ "$(cat frustum.visible)" -eq "$(cat frustum.in_frustum)" ] || fail "frustum hides something"
# shellcheck disable=SC2086
status 0 image hall.obs --model hall.obj $small --against frustum --frames 0,2,4,5 --every 2
[ $(($(value triangles_drawn) + $(value triangles_saved))) -eq "$(value triangles_in_frustum)" ] ||
    fail "not compared with what is in the frustum"
[ "$(value frames)" -eq 2 ] || fail "not each second frame of the list"
# shellcheck disable=SC2086
status 0 image hall.obs --model hall.obj $small --one-sided
[ -z "$(ls ./*.png 2>/dev/null)" ] || fail "pictures, and nothing differs"

# The wall's sheet, three times as large: crates that show beside it are missing.
"$plant" hall.obs planted.obs -0.25 2.5 0 3 >planted
read -r occluder owner <planted
# shellcheck disable=SC2086
status 3 image planted.obs --model hall.obj $small --pictures found --method single
[ "$(value differing_pixels)" -gt 0 ] || fail "no pixel differs"
grep -qE '^occlude-bench: frame [0-9]+: [0-9]+ pixels differ, [0-9]+ objects are missing$' err ||
    fail "does not say how much is missing"
grep -qE ": object [0-9]+ shows in [0-9]+ pixels, first at [0-9]+,[0-9]+ \\(triangle [0-9]+\\): hidden by occluders $occluder \\(of object $owner\\)\$" err ||
    fail "does not name occluder $occluder"
grep -q "object $owner shows" err && fail "names the wall that is seen"
[ "$(grep -c 'no object is missing' err)" -eq 0 ] || fail "a pixel is not accounted for"
frame=$(sed -n 's/.*: frame \([0-9]*\): .* pixels differ.*/\1/p' err | head -n 1)
for kind in full culled; do
    [ "$(head -c 4 "found-frame$frame-$kind.png" | tail -c 3)" = PNG ] || fail "no picture of frame $frame, $kind"
done
cmp -s "found-frame$frame-full.png" "found-frame$frame-culled.png" && fail "the pictures are the same"
[ "$(ls found-*.png | wc -l)" -eq $((2 * $(grep -c ' pixels differ, ' err))) ] || fail "not two pictures for each frame"

# Another command says the same of that object, in that frame.
object=$(sed -n "s/.*: frame $frame: object \([0-9]*\) shows.*/\1/p" err | head -n 1)
status 0 picture planted.obs --frame "$frame" --method single --explain "$object" --out explained.png
grep -q "^object=$object fate=hidden occluders=$occluder\$" out || fail "picture explains object $object otherwise"

# Crates of glass hide nothing, show as veils, and are missed like any other.
status 0 convert hall.obj --out glass.obs --up y --triangles 12 --frames 9 --see-through 'crates*'
refused 1 'as they were given to convert' glass.obs --model hall.obj --triangles 12 --up z --see-through 'crates*'
# shellcheck disable=SC2086
status 0 image glass.obs --model hall.obj $small --see-through 'crates*' --method single
grep -qE '^model .* [1-9][0-9]* of them see-through' out || fail "no glass"
[ "$(value visible)" -lt "$(value in_frustum)" ] || fail "the wall hides no glass"
"$plant" glass.obs planted_glass.obs -0.25 2.5 0 3 >planted
read -r occluder owner <planted
# shellcheck disable=SC2086
status 3 image planted_glass.obs --model hall.obj $small --see-through 'crates*' --method single
grep -qE ": object [0-9]+ shows in .* \(see-through\): hidden by occluders $occluder \(of object $owner\)\$" err ||
    fail "names no glass"
[ "$(grep -c 'no object is missing' err)" -eq 0 ] || fail "a pixel of glass is not accounted for"

# What is not used does no harm, and what is named first is drawn by default.
# shellcheck disable=SC2086
status 0 image planted.obs --model hall.obj $small --method frustum
# shellcheck disable=SC2086
status 3 image planted.obs --model hall.obj $small
ls planted-frame*-full.png >out 2>err || fail "no picture under the scene's name"
