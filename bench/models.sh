#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# sh bench/models.sh [MODELS [OPTION...]]: real models through `convert`, `image` and `truth`, as a table in
# docs/results/models.md. MODELS is a folder with the five named below (default ../shared/scenes); options go to
# `convert`, and then the table is printed instead. Takes about ten minutes on two cores.
set -eu
cd "$(dirname "$0")/.."
models=${1:-../shared/scenes}
[ $# -eq 0 ] || shift
out=build/models
program=build/default/bench/occlude-bench
mkdir -p "$out"
cmake --preset default >"$out/build.log"
cmake --build --preset default --target occlude-bench >>"$out/build.log"

# value NAME FILE: of the file's last line.
value()
{
    tail -n 1 "$2" | tr ' ' '\n' | sed -n "s/^$1=//p"
}

# unseen FILE: of the objects in the frustum, but in no pixel, the share that was culled, from an image's summary.
unseen()
{
    awk -v inside="$(value in_frustum "$1")" -v left="$(value visible "$1")" -v seen="$(value seen "$1")" \
        'BEGIN { printf "%.1f", (inside > seen ? 100 * (inside - left) / (inside - seen) : 0) }'
}

culled=$out/culled.txt
truths=$out/truths.txt
: >"$culled"
: >"$truths"
for name in alphacorp complex institute pandora sponza; do
    model=$(find "$models" -name "$name.*" | head -n 1)
    if [ -z "$model" ]; then
        echo "models.sh: there is no $name in $models" >&2
        exit 1
    fi
    echo "$name..." >&2
    started=$(date +%s.%N)
    "$program" convert "$model" --out "$out/$name.obs" "$@" >"$out/$name.txt"
    seconds=$(echo "$started $(date +%s.%N)" | awk '{ printf "%.1f", $2 - $1 }')
    for method in single fused; do
        "$program" image "$out/$name.obs" --model "$model" --method $method --against frustum \
            --pictures "$out/$name" >"$out/$name-$method.txt" || true # it ends with 3 where a pixel differs
        tail -n 1 "$out/$name-$method.txt" | grep -q '^frames=' # and has a summary all the same
    done
    s=$out/$name-single.txt f=$out/$name-fused.txt
    awk -v a="$(value in_frustum "$f")" -v b="$(value seen "$f")" -v n="$(value frames "$f")" \
        -v head="| $name | $(value triangles "$out/$name.txt") | $(value objects "$out/$name.txt") | $(
            value sheets "$out/$name.txt") + $(value inner "$out/$name.txt") | $seconds |" \
        -v tail="| $(value objects_culled_pct "$s"), $(value triangles_culled_pct "$s") | $(unseen "$s") | $(
            value objects_culled_pct "$f"), $(value triangles_culled_pct "$f") | $(unseen "$f") | $(
            value differing_pixels "$s"), $(value differing_pixels "$f") |" \
        'BEGIN { printf "%s %.0f | %.0f %s\n", head, a / n, b / n, tail }' >>"$culled"
    "$program" truth "$out/$name.obs" --frames 0,10,20,30,40,50 --out "$out/$name.tru" >/dev/null
    row="| $name |"
    for options in '--method single' '--method fused' '--method fused --tolerance 0.0002'; do
        # shellcheck disable=SC2086 # two words or four
        "$program" cull "$out/$name.obs" --repeat 1 $options --out "$out/$name.vis" >/dev/null
        # It ends with 3 where something is hidden falsely, which a tolerance may do.
        "$program" compare "$out/$name.tru" "$out/$name.vis" >"$out/$name-compare.txt" 2>/dev/null || true
        tail -n 1 "$out/$name-compare.txt" | grep -q '^frames='
        row="$row $(value missed_pct "$out/$name-compare.txt") % (false-hidden $(
            value false_hidden "$out/$name-compare.txt")) |"
    done
    c=$out/$name-compare.txt
    echo "$row" | awk -v inside="$(value in_frustum "$c")" -v shown="$(value visible "$c")" '{
        sub(/^\| [a-z]* \|/, sprintf("& %.1f %% |", (inside > 0 ? 100 * (inside - shown) / inside : 0))); print }' >>"$truths"
done

{
    echo '<!-- SPDX-License-Identifier: Apache-2.0 -->'
    echo '# Real models'
    echo
    # shellcheck disable=SC2016 # Markdown's own quotes
    echo "Written by \`sh bench/models.sh\`${*:+, convert $*}: scenes as \`convert\` makes them, every frame of the path at"
    # shellcheck disable=SC2016
    echo '1920x1080 ([image](../image.md)). Occluders: sheets + inner boxes. `unseen culled` is the share of the objects in'
    echo 'the frustum, but in no pixel, that a method hides. Seconds include reading the model and making the path.'
    echo
    echo '```'
    "$program" cull "$out/complex.obs" --repeat 1 --csv "$out/setup.csv" >/dev/null
    sed -n -e '/^# cpu=/p' -e '/^# compiler=/p' -e '/^# commit=/p' "$out/setup.csv"
    echo '```'
    echo
    echo '| model | triangles | objects | occluders | seconds | in frustum | seen | single: objects, triangles, % | unseen culled, % | fused: objects, triangles, % | unseen culled, % | differing pixels: single, fused |'
    echo '|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|'
    cat "$culled"
    echo
    # shellcheck disable=SC2016
    echo 'What these occluders could hide, if all of them were combined perfectly, and how much of that the methods miss:'
    # shellcheck disable=SC2016
    echo '`truth` and `compare` at frames 0, 10, … 50.'
    echo
    echo '| model | hidden, of the objects in the frustum | single misses | fused misses | fused, `--tolerance 0.0002`, misses |'
    echo '|---|---:|---:|---:|---:|'
    cat "$truths"
} >"$out/models.md"
if [ $# -eq 0 ]; then cp "$out/models.md" docs/results/models.md; else cat "$out/models.md"; fi
