#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# sh bench/knobs.sh PROGRAM SCENES TRUTHS [SCENE...]: what each knob costs and brings on the scenes with goals, in
# turns (bench/pair.sh). SCENES is the folder of scene files, TRUTHS the folder `truth` that `error --targets` left.
# Prints Markdown. The programs PROGRAM-plain and PROGRAM-avx2 are compared too where they were built.
set -eu
program=$1 scenes=$2 truths=$3
shift 3
here=$(dirname "$0")
if [ $# -eq 0 ]; then
    set -- seedscene_1000 seedscene_10000 seedscene_100000 city_1000 city_10000 city_100000 city_1000000 \
        forest_100000 soup_100000 interior_10000
fi

echo '<!-- SPDX-License-Identifier: Apache-2.0 -->'
echo '# What each knob costs and brings'
echo
# shellcheck disable=SC2016 # Markdown's own quotes
echo 'Written by `sh bench/knobs.sh`: method `fused` on one thread, one knob turned at a time, all settings of a scene'
echo 'in turns. Times are milliseconds of the median frame and of the slowest, the median over the rounds; errors by'
echo 'sampling at frames 0, 20 and 40, without the judge. Default: `--min-area 3e-4 --max-splits 48'
echo '--max-occluders 1024 --grain 64`.'
setup=$(mktemp)
"$program" scene city 1 2 --out "$setup.obs" >/dev/null
"$program" cull "$setup.obs" --repeat 1 --csv "$setup" >/dev/null
echo
echo '```'
sed -n -e '/^# cpu=/p' -e '/^# compiler=/p' -e '/^# flags=/p' -e '/^# commit=/p' "$setup"
echo '```'
rm "$setup" "$setup.obs"
for scene in "$@"; do
    file=$scenes/$scene.obs
    if [ ! -f "$file" ]; then
        echo "knobs.sh: there is no $file" >&2
        exit 1
    fi
    found=$(find "$truths" -name "$scene-????????????????.tru")
    if [ "$(echo "$found" | wc -w)" -ne 1 ]; then
        echo "knobs.sh: expected one truth for $scene in $truths" >&2
        exit 1
    fi
    echo
    echo "## $scene"
    echo
    repeat='--repeat 3'
    if [ "${scene%%_*}" = seedscene ]; then repeat='--repeat 50'; fi # one frame
    list=$(mktemp)
    {
        echo "$program"
        for knob in '--max-splits 4' '--max-splits 8' '--max-splits 16' '--max-splits 256' '--min-area 5e-5' \
            '--min-area 1e-4' '--min-area 5e-4' '--min-area 1e-3' '--min-area 4e-3' '--max-occluders 256' \
            '--grain 16' '--grain 256' '--preset fast' '--preset thorough' '--method single'; do
            echo "$program $knob"
        done
        for lanes in avx2 plain; do
            if [ -x "$program-$lanes" ]; then echo "$program-$lanes"; fi
        done
    } >"$list"
    set --
    while read -r setting; do set -- "$@" "$setting $repeat"; done <"$list"
    rm "$list"
    ROUNDS=${ROUNDS:-5} sh "$here/pair.sh" "$file" "$found" "$@" |
        sed -e "s/ $repeat |/ |/" -e 's/^| |/| default |/'
done
