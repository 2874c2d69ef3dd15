#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# tests/fuzz/run_fuzzer.sh PROGRAM CORPUS WORK SECONDS: libFuzzer on a copy of the corpus, so that
# what it adds stays out of the checkout. An input that fails is left in WORK.
set -eu
program=$1 corpus=$2 work=$3 seconds=$4
rm -rf "$work"
mkdir -p "$work/corpus"
if [ -d "$corpus" ]; then
    cp -R "$corpus/." "$work/corpus/"
fi
# A file of the corpus may be larger than libFuzzer's 4096 bytes.
"$program" -runs=20000 -max_total_time="$seconds" -timeout=10 -seed=1 -print_final_stats=1 \
    -artifact_prefix="$work/" "$work/corpus"
