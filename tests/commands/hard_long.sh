#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# hard_long.sh PROGRAM BACKEND METHOD: 340 times all places, of other seeds than the short test has.
set -eu
last=$("$1" hard --backend "$2" --method "$3" --seed 28000 --worlds 9520 | tee /dev/stderr | tail -n 1)
verdicts=$(printf '%s\n' "$last" | sed 's/.* verdicts=\([0-9]*\) .*/\1/')
case $last in
families=53\ *\ false_hidden=0\ *) [ "$verdicts" -ge 10000000 ] ;;
*) exit 1 ;;
esac
