#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# picture.sh PROGRAM PIXELS: `occlude-bench picture --model` on a slab that is written here, seen from an
# orbit around it: which colours triangles, sheets and boxes have, and what is refused.
set -eu
program=$1
pixels=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

fail()
{
    echo "picture.sh: $1" >&2
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

# refused STATUS TEXT ARGUMENT...: picture refuses in a line that has the text, and draws nothing.
refused()
{
    wanted=$1
    text=$2
    shift 2
    status "$wanted" picture "$@" --out refused.png
    grep -qF -e "$text" err || fail "does not say: $text"
    [ ! -s out ] && [ "$(wc -l <err)" -eq 1 ] || fail "says something else too"
    [ ! -e refused.png ] || fail "a picture after all"
}

# draw SCENE FRAME ARGUMENT...: into drawn.png.
draw()
{
    scene=$1
    frame=$2
    shift 2
    status 0 picture "$scene.obs" --frame "$frame" --model slab.obj --up y --out drawn.png "$@"
    title="$scene, frame $frame $*"
}

# In a picture of the usual size the middle of what the camera sees is at 1086, 347. Beside it is no
# edge of a triangle.
middle='1080 340 9 9'

# is COLOUR WHAT: the middle of drawn.png has it.
is()
{
    # shellcheck disable=SC2086
    "$pixels" drawn.png $middle $1 2 >found
    [ "$(head -n 1 found)" -eq 81 ] || fail "$title: $2 is $(tail -n 1 found), not $1"
}

# has LEAST MOST COLOUR WHAT: so many pixels of what the camera sees have it.
has()
{
    # shellcheck disable=SC2086
    number=$("$pixels" drawn.png 592 70 990 555 $3 2 | head -n 1)
    [ "$number" -ge "$1" ] && [ "$number" -le "$2" ] || fail "$title: $number pixels of $4, $3"
}

# A slab of stone, largest in front and at the back, and close before its front a pane.
awk 'BEGIN {
    for (i = 0; i < 8; i++) print "v", i % 2 * 2 - 1, int(i / 2) % 2 * 2 - 1, int(i / 4) - 0.5
    for (i = 0; i < 4; i++) print "v", i % 2 * 2 - 1, int(i / 2) * 2 - 1, 0.504
    print "o slab\nf 1 3 4 2\nf 5 6 8 7\nf 1 5 7 3\nf 2 4 8 6\nf 1 2 6 5\nf 3 7 8 4"
    print "o pane\nf 9 10 12 11"
}' >slab.obj
glass='--see-through pane*'
division="--triangles 2 $glass"
stone='160 159 156'

# The slab's front is towards frames 1 and 2 of 8, its back towards 5 and 6.
# shellcheck disable=SC2086
status 0 convert slab.obj --out bare.obs --up y $division --frames 8 --sheets 0 --inner 0
grep -q 'objects=7 .*path=orbit$' out || fail "another scene"

# Arguments, before anything is drawn, and a division that is not the scene's.
refused 2 'go with --model' bare.obs --triangles 2
refused 2 'go with --model' bare.obs --see-through 'pane*'
refused 2 'go with --model' bare.obs --bounds
refused 2 '--explain goes without --model' bare.obs --model slab.obj --explain 1
refused 2 'expected y or z after --up' bare.obs --model slab.obj --up x
refused 1 'absent.obj' bare.obs --model absent.obj
advice='give --triangles, --split, --up and --see-through as they were given to convert'
refused 1 "$advice" bare.obs --model slab.obj --up y --triangles 12 --see-through 'pane*'
refused 1 "$advice" bare.obs --model slab.obj --up z --triangles 2 --see-through 'pane*'

# Stone, and the same through the pane; sky beside it. Nothing else has the colours of occluders.
# shellcheck disable=SC2086
draw bare 5 $division
is "$stone" 'the back'
has 0 0 '118 138 164' 'sheets, and there are none,'
has 0 0 '174 153 86' 'boxes, and there are none,'
# shellcheck disable=SC2086
draw bare 1 $division
is '134 158 164' 'the front'

# Without the model everything is as it was.
status 0 picture bare.obs --frame 1 --out plain.png
cmp -s plain.png drawn.png && fail "the model is not drawn"

# One sheet, as large as the front or the back: it covers the one, and from the other side the stone
# covers it. Seen from a sharp angle it is still there, with its outline.
# shellcheck disable=SC2086
status 0 convert slab.obj --out sheet.obs --up y $division --frames 8 --sheets 1 --inner 0
# shellcheck disable=SC2086
draw sheet 5 $division
# shellcheck disable=SC2086
if [ "$("$pixels" drawn.png $middle 118 138 164 2 | head -n 1)" -eq 81 ]; then
    has 500 3000 '44 71 108' "a sheet's outline"
    # shellcheck disable=SC2086
    draw sheet 1 $division
    is '134 158 164' 'the side without a sheet'
else
    is "$stone" 'the side without a sheet'
    has 0 0 '44 71 108' 'the outline of a sheet that is behind'
    # shellcheck disable=SC2086
    draw sheet 1 $division
    is '108 145 168' 'the sheet behind the pane'
fi

# An inner box in the surface, and its outline. Bounds are lines over all.
# shellcheck disable=SC2086
status 0 convert slab.obj --out inner.obs --up y $division --frames 8 --sheets 0 --inner 1
grep -q ' inner=1 ' out || fail "not one inner box"
# shellcheck disable=SC2086
draw inner 5 $division
is '174 153 86' 'the box'
has 300 3000 '113 93 27' "a box's outline"
green=$("$pixels" drawn.png 592 70 990 555 42 164 120 40 | head -n 1)
[ "$green" -eq 0 ] || fail "bounds that were not asked for"
# shellcheck disable=SC2086
draw inner 5 $division --bounds
is '174 153 86' 'the box within bounds'
green=$("$pixels" drawn.png 592 70 990 555 42 164 120 40 | head -n 1)
[ "$green" -gt 500 ] || fail "no bounds"

# Where the front is a pyramid, the box lies deep behind it and shines through.
awk '$1 == "v" && ++n > 8 { next } /^o pane/ { exit } { print }
     /^o slab/ { print "v 0 0 0.62\nf 5 6 9\nf 6 8 9\nf 8 7 9\nf 7 5 9" }' slab.obj | sed '/^f 5 6 8 7$/d' >tent.obj
for inner in 0 1; do
    status 0 convert tent.obj --out tent.obs --up y --frames 8 --sheets 0 --inner $inner
    grep -q " inner=$inner .*path=orbit\$" out || fail "another tent"
    status 0 picture tent.obs --frame 1 --model tent.obj --up y --out tent$inner.png
done
# shellcheck disable=SC2086
surface=$("$pixels" tent0.png $middle 0 0 0 0 | tail -n 1)
# shellcheck disable=SC2086
[ "$("$pixels" tent0.png $middle $surface 2 | head -n 1)" -eq 81 ] || fail "an edge is in the middle"
# Half and half: the surface's colour, and a box's face that is turned to this side.
mixed=$(echo "$surface" | awk '{ print int($1 / 2 + 94), int($2 / 2 + 74), int($3 / 2 + 8) }')
# shellcheck disable=SC2086
"$pixels" tent1.png $middle $mixed 3 >found
[ "$(head -n 1 found)" -eq 81 ] || fail "behind the pyramid, $surface, the box is $(tail -n 1 found)"
