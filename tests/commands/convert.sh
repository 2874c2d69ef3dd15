#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# convert.sh PROGRAM FOLDER small|million: `occlude-bench convert` on models that are written here. FOLDER has
# field.awk. `million`: a model of a million triangles must be done in a minute, in less than two gigabytes.
set -eu
program=$1
field=$2/field.awk
group=$3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

fail()
{
    echo "convert.sh: $1" >&2
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

# refused TEXT ARGUMENT...: convert refuses its arguments in one line that has the text.
refused()
{
    text=$1
    shift
    status 2 convert "$@"
    grep -qF -e "$text" err || fail "does not say: $text"
    [ ! -s out ] && [ "$(wc -l <err)" -eq 1 ] || fail "says something else too"
}

# value NAME: of the last line.
value()
{
    tail -n 1 out | tr ' ' '\n' | sed -n "s/^$1=//p"
}

# is NAME VALUE: the last line has it.
is()
{
    [ "$(value "$1")" = "$2" ] || fail "$1 is $(value "$1"), not $2"
}

if [ "$group" = million ]; then
    awk -v rings=50 -v side=10 -f "$field" >field.dae
    ulimit -v 2097152
    status 0 convert field.dae --out field.obs
    # Of the processors, all threads together: other programs may run beside.
    times >times
    seconds=$(awk -F '[ms ]' 'NR == 2 { print int(60 * $1 + $2 + 60 * $4 + $5) }' times)
    [ "$seconds" -gt 0 ] || fail "no time is known"
    is triangles 980002
    [ "$seconds" -lt 60 ] || fail "$seconds seconds"
    echo "$(tail -n 1 out) seconds=$seconds"
    exit 0
fi

refused 'expected --out F.obs' field.dae
refused '--coverage is from 0 to 1' field.dae --out x.obs --coverage 1.5
refused '--cells is from 4096' field.dae --out x.obs --cells 5
refused 'expected light, material or mesh after --split' field.dae --out x.obs --split colour
refused '--inner and --inner-mesh are 1000000 at most' field.dae --out x.obs --inner 1000001
refused '--triangles: expected a number from 1' field.dae --out x.obs --triangles 0
status 1 convert absent.dae --out x.obs
grep -qF absent.dae err || fail "does not name the file"

# A mesh in nine places: split and searched once, and every triangle in one object.
awk -v rings=8 -v side=3 -f "$field" >field.dae
status 0 convert field.dae --out field.obs --names field.csv --frames 12 --inner 0 --inner-mesh 4
is triangles 2018
is inner 36
objects=$(value objects)
[ $(((objects - 1) % 9)) -eq 0 ] || fail "$objects objects are not one and nine times as many"
grep -q "^objects $objects, of instances $((objects - 1))," out || fail "instances are not counted"
awk -F, 'NR > 1 { sum += $2 } NR > 1 && $4 == "\"floor\"" { floor++ } NR > 1 && $4 ~ /^"sphere/ { spheres++ }
         END { exit sum != 2018 || floor != 1 || spheres != NR - 2 }' field.csv || fail "the names are wrong"
cp field.obs first.obs
status 0 convert field.dae --out field.obs --frames 12 --inner 0 --inner-mesh 4
cmp -s field.obs first.obs || fail "the same again gives another scene"
status 0 cull field.obs --repeat 1

# What the truth tool sees is never culled.
status 0 truth field.obs --out field.tru --frames 0,4,8 --size 320x180
status 0 cull field.obs --repeat 1 --out field.vis
status 0 compare field.tru field.vis
is false_hidden 0

# Nor what OpenGL draws, where there is one.
got=0
"$program" image field.obs --model field.dae --size 320x180 >out 2>err || got=$?
if [ "$got" -ne 1 ]; then
    [ "$got" -eq 0 ] || fail "pixels differ"
    is differing_pixels 0
    [ "$(value visible)" -lt "$(value in_frustum)" ] || fail "nothing is culled"
fi

# No occluders at all, and materials kept apart.
status 0 convert field.dae --out bare.obs --frames 2 --inner 0 --inner-mesh 0 --sheets 0
is inner 0
is sheets 0
awk 'BEGIN { for (i = 0; i < 64; i++) print "v", i % 8, int(i / 8), 0
             for (colour = 0; colour < 2; colour++) {
                 print "usemtl", colour ? "black" : "whi\"te"
                 for (i = 0; i < 7; i++) for (j = 0; j < 7; j++) {
                     a = 8 * i + j + 1
                     if ((i + j) % 2 == colour) print "f", a, a + 1, a + 9, a + 8 } } }' >board.obj
status 0 convert board.obj --out board.obs --names board.csv --frames 2 --triangles 200
is objects 1
status 0 convert board.obj --out board.obs --names board.csv --frames 2 --triangles 200 --split material
is objects 2
grep -q '^0,50,0,.*,"whi""te"$' board.csv || fail "the names are wrong"
grep -q '^1,48,1,.*,"black"$' board.csv || fail "the names are wrong"

# Seen from outside a closed box is solid.
awk 'BEGIN { for (i = 0; i < 8; i++) print "v", i % 2, int(i / 2) % 2, int(i / 4)
             split("1 3 4 2 5 6 8 7 1 5 7 3 2 4 8 6 1 2 6 5 3 7 8 4", q)
             for (i = 0; i < 6; i++) print "f", q[4*i+1], q[4*i+2], q[4*i+3], q[4*i+4] }' >box.obj
status 0 convert box.obj --out box.obs --frames 4
is path orbit
is inner 1
status 0 convert box.obj --out box.obs --frames 4 --max-hole 0.1
grep -q 'holes up to 0.1 were asked to count as closed' out || fail "does not name the holes"
