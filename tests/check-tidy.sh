#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# tests/check-tidy.sh [BUILD]: clang-tidy 14 over every C file that BUILD (build/default) compiles.
set -eu
cd "$(dirname "$0")/.."
build=${1:-build/default}
tidy=${CLANG_TIDY:-clang-tidy-14}
if [ ! -f "$build/compile_commands.json" ]; then
    echo "check-tidy: no $build/compile_commands.json: configure that build first" >&2
    exit 1
fi
# lanes.c is in the list once for each instruction set; generated files are not ours to mend.
root=$(pwd)
generated=$(cd "$build" && pwd)
files=$(sed -n 's/^ *"file": "\(.*\.c\)",\{0,1\}$/\1/p' "$build/compile_commands.json" |
    sort -u | grep -v -e "^$generated/" -e "^$root/tests/twins/")
echo "clang-tidy: $(printf '%s\n' "$files" | wc -l) files"
# One file at a time for each core, silent unless it has something to say; xargs fails when any does.
printf '%s\n' "$files" | xargs -P "$(nproc)" -n 1 sh -c '
    said=$("$0" --quiet -p "$1" "$2" 2>&1) || {
        printf "%s\n" "$said"
        exit 1
    }' "$tidy" "$build"
