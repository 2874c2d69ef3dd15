#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# sh bench/instructions.sh [PROGRAM [OUT.md [KIND:COUNT:SEED:EVERY...]]]: how many instructions a frame takes, counted
# by callgrind inside occ_cull() alone. Unlike times they do not depend on what else the machine does: two commits
# built with one compiler can be compared to a per cent. Needs valgrind, which knows no AVX-512: what is counted is
# the AVX2 code.
set -eu
program=${1:-build/default/bench/occlude-bench}
out=${2:-}
if [ $# -gt 2 ]; then shift 2; else set -- city:10000:2:6 soup:100000:4:20 interior:10000:5:6; fi
if ! command -v valgrind >/dev/null; then
    echo "instructions.sh: valgrind is missing" >&2
    exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# collected REPEATS: instructions inside occ_cull() when every frame is culled so many times after the warm-up.
collected() {
    valgrind --tool=callgrind --callgrind-out-file="$work/callgrind.out" --toggle-collect=occ_cull \
        "$program" cull "$work/scene.obs" --method "$method" --threads 1 --every "$every" --repeat "$1" \
        --csv "$work/rows.csv" >"$work/log" 2>&1 || { cat "$work/log" >&2; return 1; }
    sed -n 's/^==[0-9]*== Collected : \([0-9]*\)$/\1/p' "$work/log"
}

# functions: the seven that take most of the latest run. Those of one name count as one.
functions() {
    callgrind_annotate "$work/callgrind.out" | awk '
        /file:function/ { on = 1 }
        on && match($0, /\([ 0-9.]*%\)/) {
            share = substr($0, RSTART + 1, RLENGTH - 3)
            name = substr($0, RSTART + RLENGTH)
            sub(/ \[.*/, "", name)
            sub(/.*:/, "", name)
            sub(/\047[0-9]*$/, "", name)
            if (!(name in shares)) names[++found] = name
            shares[name] += share
        }
        END {
            for (i = 1; i <= 7 && i <= found; i++)
                printf "%s`%s` %.0f %%", (i > 1 ? ", " : ""), names[i], shares[names[i]]
            print (found ? "" : "?")
        }'
}

# summary KEY: of the latest run's last line.
summary() {
    sed -n "s/^scene=.* $1=\([0-9.]*\).*/\1/p" "$work/log"
}

for scene in "$@"; do
    IFS=: read -r kind count seed every <<END
$scene
END
    "$program" scene "$kind" "$count" "$seed" --out "$work/scene.obs" >/dev/null
    for method in single fused; do
        # The warm-up and the count of what is in the frustum are in both: the difference is one pass over the frames.
        once=$(collected 1)
        twice=$(collected 2)
        frames=$(summary frames)
        printf '| %s %s, seed %s | %s | %s | %s | %s |\n' "$kind" "$count" "$seed" "$method" "$frames" \
            "$(summary visible)" "$(((twice - once + frames / 2) / frames))" >>"$work/lines"
        if [ "$method" = fused ]; then
            collected 9 >/dev/null # so often that the count of what is in the frustum hardly shows
            printf -- '- %s %s: %s\n' "$kind" "$count" "$(functions)" >>"$work/shares"
        fi
    done
done

{
    cat <<END
<!-- SPDX-License-Identifier: Apache-2.0 -->
# Instructions of a frame

Written by \`sh bench/instructions.sh\`: instructions inside \`occ_cull()\` on one thread of the OpenMP backend, mean
over the frames, counted by callgrind. Valgrind knows no AVX-512, so this is the AVX2 code: compare commits with it,
not machines. The boxes are those of \`occlude-bench scene\`.

\`\`\`
$(sed -n -e '/^# compiler=/p' -e '/^# flags=/p' -e '/^# commit=/p' "$work/rows.csv")
# valgrind=$(valgrind --version)
\`\`\`

| scene | method | frames | visible objects | instructions a frame |
|---|---|---:|---:|---:|
END
    cat "$work/lines"
    echo
    echo "Where they go in \`fused\`, functions that the compiler inlined counted with their callers:"
    echo
    cat "$work/shares"
} >"$work/table.md"
cat "$work/table.md"
if [ -n "$out" ]; then cp "$work/table.md" "$out"; fi
