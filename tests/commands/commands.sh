#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# sh commands.sh PROGRAM GROUP: runs occlude-bench with arguments good and bad, and demands of each run
# its exit status, what it says, and that bad ones leave no file behind. Groups: truth, compare,
# settle, settle_absent (a build without GMP), cull, picture, seed, sheets, error, error_hard, targets,
# and wrong, which must fail.
set -u
program=$1
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0

fail()
{
    echo "occlude-bench $line"
    echo "  $1"
    sed 's/^/  out: /' out
    sed 's/^/  err: /' err
    failures=$((failures + 1))
}

# expect STATUS STREAM TEXT ARGUMENTS...: the run ends with STATUS, and TEXT is in its STREAM (out or
# err). If STATUS is 1 or 2 there is nothing on standard output, one line on standard error, and no
# new file.
expect()
{
    wanted=$1
    stream=$2
    text=$3
    shift 3
    line=$*
    before=$(ls)
    status=0
    "$program" "$@" >out 2>err || status=$?
    [ "$status" -eq "$wanted" ] || fail "ended with status $status, not $wanted"
    grep -qF -e "$text" "$stream" || fail "does not say on standard $stream: $text"
    case $wanted in
    1 | 2)
        [ ! -s out ] || fail "says something on standard output"
        [ "$(wc -l <err)" -eq 1 ] || fail "says not just one line on standard error"
        [ "$(ls)" = "$before" ] || fail "left a file behind"
        ;;
    esac
}

# A city of 161 objects and 60 frames, what can be seen in two of them, and a result.
: >out
: >err
make_files()
{
    expect 0 out ' objects, ' scene city 100 2 --out city.obs
    expect 0 out 'frames=2 ' truth city.obs --out city.tru --frames 0,30 --size 128x72
    expect 0 out 'frames=60 ' cull city.obs --repeat 1 --backend plain --out city.vis
}

truth_group()
{
    make_files
    expect 0 out 'build_ms=' cull city.obs --repeat 1 --every 30 --builds 3 --threads 2
    expect 0 out ' commit_ms=' cull city.obs --repeat 1 --every 30 --backend plain
    expect 2 err '--builds is 1000 at most' cull city.obs --builds 1001
    expect 0 out 'usage: occlude-bench truth' truth --help
    expect 0 out 'usage: occlude-bench truth' truth city.obs --frames bad -h

    expect 2 err 'expected a scene file' truth
    expect 2 err 'expected a scene file' truth --out new.tru
    expect 2 err 'expected --out T.tru' truth city.obs
    expect 2 err 'one word too many' truth city.obs other.obs --out new.tru
    expect 2 err '--frame: no such option' truth city.obs --out new.tru --frame 0
    expect 2 err '--out: expected a value after it' truth city.obs --out
    for size in '' 64 64x x64 0x64 64x0 64X64 64x64x64 16385x1 1x16385 -1x1 ' 1x1' 1x1.5 \
        00000000000000000000000000000000001x1; do
        expect 2 err 'expected --size as 4096x2304, 16384x16384 at most' \
            truth city.obs --out new.tru --size "$size"
    done
    for frames in '' , 0, ,0 0,,1 1,0 0,0 60 0,60 -1 0,x 0x1 '0, 1' 99999999999999999999; do
        expect 1 err 'expected --frames as 0,20,40: ascending, and in the scene' \
            truth city.obs --out new.tru --size 16x9 --frames "$frames"
    done
    expect 1 err 'absent.obs' truth absent.obs --out new.tru
    expect 1 err 'city.tru: byte 0: expected the magic "OBS1"' truth city.tru --out new.tru
    expect 1 err 'absent/new.tru' truth city.obs --out absent/new.tru --frames 0 --size 16x9

    # One sample; the last frame; what it does by itself; options before words.
    expect 0 out 'frames=1 ' truth city.obs --out new.tru --frames 59 --size 1x1
    expect 0 out 'frames=3 ' truth --size 16x9 --out new.tru city.obs
}

compare_group()
{
    make_files
    expect 0 out 'usage: occlude-bench compare' compare -h
    expect 2 err 'expected a truth file and a result file' compare
    expect 2 err 'expected a truth file and a result file' compare city.tru
    expect 2 err 'one word too many' compare city.tru city.vis city.obs
    expect 2 err '--sense: no such option' compare city.tru city.vis --sense
    expect 2 err '--scene: expected a value after it' compare city.tru city.vis --scene
    expect 2 err 'expected --scene F.obs beside --settle and --hidden' compare city.tru city.vis --settle 5
    expect 2 err 'expected --scene F.obs beside' compare city.tru city.vis --hidden 5
    for limit in '' 0 -1 x 1.5 4294967296; do
        expect 2 err '--settle: expected a number from 1' \
            compare city.tru city.vis --scene city.obs --settle "$limit"
    done
    expect 1 err 'absent.tru' compare absent.tru city.vis
    expect 1 err 'absent.vis' compare city.tru absent.vis
    expect 1 err 'city.vis: byte 0: expected the magic "TRU1"' compare city.vis city.vis
    expect 1 err 'city.tru: byte ' compare city.tru city.tru

    expect 0 out ' objects, ' scene city 1000 2 --out large.obs
    expect 0 out 'frames=60 ' cull large.obs --repeat 1 --backend plain --out large.vis
    expect 1 err 'do not go together: another number of objects' compare city.tru large.vis

    expect 0 out 'frames=2 ' compare city.tru city.vis
    [ "$(wc -l <out)" -eq 1 ] || fail "prints more than its line"
    { head -c 8 city.vis && head -c $(($(wc -c <city.vis) - 8)) /dev/zero; } >none.vis
    expect 3 out ' missed=0 ' compare city.tru none.vis
    expect 3 err 'is reported hidden' compare city.tru none.vis
}

settle_group()
{
    make_files
    expect 0 out ' objects, ' scene city 1000 2 --out large.obs
    expect 1 err 'absent.obs' compare city.tru city.vis --scene absent.obs
    expect 1 err 'expected the magic "OBS1"' compare city.tru city.vis --scene city.tru
    expect 1 err 'city.tru and large.obs do not go together: another number of objects' \
        compare city.tru city.vis --scene large.obs

    expect 0 out ' unsettled=0 ' compare city.tru city.vis --scene city.obs
    tail -n 2 out | head -n 1 | grep -qE '^settled=[0-9]+ judged_visible=[0-9]+ judged_hidden=[0-9]+ unsettled=0 false_confirmed=0 false_refuted=0$' ||
        fail "the line before the last is not that of the judge"
    tail -n 1 out | grep -qE '^frames=2 in_frustum=[0-9.]+ visible=[0-9.]+ false_hidden=0 largest_px=0 missed=[0-9]+ missed_pct=[0-9.]+$' ||
        fail "the last line is not the verdict"

    expect 0 out ' unsettled=0 ' compare city.tru city.vis --scene city.obs --hidden 100000
    head -n 1 out | grep -qE '^hidden_judged=[1-9][0-9]* hidden_seen=0 hidden_doubtful=0 hidden_unjudged=0$' ||
        fail "the first line is not that of what both take for hidden"
    [ "$(wc -l <out)" -eq 3 ] || fail "prints other than three lines"

    # What can be seen and is reported hidden is confirmed; everything reported visible, missed.
    { head -c 8 city.vis && head -c $(($(wc -c <city.vis) - 8)) /dev/zero; } >none.vis
    expect 3 err ' see it, and so does the judge' compare city.tru none.vis --scene city.obs
    expect 3 out 'settled=2 judged_visible=2 judged_hidden=0 ' \
        compare city.tru none.vis --scene city.obs --settle 2
    expect 3 err ' see it, and the judge was not asked' \
        compare city.tru none.vis --scene city.obs --settle 2
    expect 0 out 'frames=60 ' cull city.obs --repeat 1 --backend plain --method frustum --out all.vis
    expect 0 out 'settled=7 ' compare city.tru all.vis --scene city.obs --settle 7
}

settle_absent_group()
{
    make_files
    expect 1 err 'built without GMP, which --scene needs' compare city.tru city.vis --scene city.obs
}

# column NAME: the values of a column of the report, one to a line. Reasons have commas, and go.
column()
{
    sed -e '/^#/d' -e 's/"[^"]*"//' report/error.csv | awk -F, -v name="$1" '
        NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) wanted = i }
        NR > 1 { print $wanted }'
}

# rows METHOD SCALE: false-hidden objects of the method at that scale, one run to a line.
rows()
{
    sed -e '/^#/d' -e 's/"[^"]*"//' report/error.csv | awk -F, -v method="$1" -v scale="$2" '
        NR == 1 { for (i = 1; i <= NF; i++) place[$i] = i }
        NR > 1 && $place["method"] == method && $place["scale"] == scale && $place["frames"] != "" {
            print $place["false_hidden_objects"]
        }'
}

fast='--quick --repeat 1 --size 512x288'

# What holds for a report of whatever scenes: rows as wide as their head, nothing visible hidden by
# the library's methods, and much by the thesis's.
check_report()
{
    [ -s report/error.md ] || fail "no report/error.md"
    sed -e '/^#/d' -e 's/"[^"]*"//' report/error.csv >rows.csv
    awk -F, 'NR == 1 { wide = NF } NF != wide { exit 1 }' rows.csv || fail "rows of another width"
    head -n 1 rows.csv | grep -q '^scene,method,backend,threads,min_area_sr,.*,missed_pct,.*,skipped$' ||
        fail "other columns"
    for key in cpu compiler flags driver commit peer repeats; do
        grep -q "^# $key=" report/error.csv || fail "no line # $key="
    done
    for method in frustum single pairwise; do
        [ "$(rows $method 1 | sort -u)" = 0 ] || fail "$method hides what can be seen"
        [ "$(rows $method 1 | wc -l)" -ge 1 ] || fail "$method was not run"
    done
    [ "$(rows single 0.01 | sort -u)" = 0 ] || fail "single at scale 0.01 hides what can be seen"
    rows thesis 0.01 | awk '{ sum += $1 } END { exit sum > 0 ? 0 : 1 }' ||
        fail "the thesis's test hides nothing at scale 0.01"
}

# Every knob of cull: what it takes and what it refuses.
cull_group()
{
    make_files
    expect 0 out 'usage: occlude-bench cull' cull --help
    for preset in fast balanced thorough; do
        expect 0 out 'frames=60 ' cull city.obs --repeat 1 --method fused --preset $preset
    done
    expect 0 out 'frames=60 ' cull city.obs --repeat 1 --method fused --tolerance 0.1 --max-splits 1
    expect 0 out 'frames=60 ' cull city.obs --repeat 1 --method fused --out none.vis
    expect 0 out 'frames=60 ' cull city.obs --repeat 1 --method fused --preset balanced --max-splits 48 \
        --tolerance 0 --min-area 3e-4 --out same.vis
    cmp -s none.vis same.vis || fail "the stated defaults give another result"
    expect 0 out 'frames=60 ' cull city.obs --repeat 1 --method fused --tolerance 0.05 --out wide.vis
    cmp -s none.vis wide.vis && fail "a tolerance hides nothing"

    expect 2 err 'expected fast, balanced or thorough after --preset' cull city.obs --preset slow
    expect 2 err '--tolerance is 0.1 at most' cull city.obs --tolerance 0.11 --out new.vis
    for number in '' x -1 nan inf 1e400; do
        expect 2 err '--tolerance: expected a number that is not negative' cull city.obs --tolerance "$number"
    done
    for number in '' x 0 -1 1.5 4294967296; do
        expect 2 err '--max-splits: expected a number from 1' cull city.obs --max-splits "$number"
    done
}

# Finds one of the 161 objects of the city whose fate in frame 30 is as said, from the last one on, and
# leaves what was printed.
find_one_that_is()
{
    for object in $(seq 160 -1 0); do
        line="picture city.obs --size 800x400 --frame 30 --method $2 --explain $object"
        "$program" $line --out found.png >out 2>err || break
        grep -qE "^object=$object fate=$1\$" out && return
    done
    fail "no object has fate=$1"
}

picture_group()
{
    make_files
    expect 0 out 'usage: occlude-bench picture' picture --help
    expect 0 out 'frame=0 objects=161 visible=' picture city.obs --out first.png
    [ "$(head -c 4 first.png | tail -c 3)" = PNG ] || fail "first.png is no picture"
    expect 0 out ' hidden=' picture city.obs --size 800x400 --frame 30 --vis city.vis --out vis.png
    expect 2 err 'expected single or fused after --method' picture city.obs --out new.png --method pairwise
    expect 2 err '--vis goes with neither' picture city.obs --out new.png --vis city.vis --explain 1
    expect 2 err '--vis goes with neither' picture city.obs --out new.png --vis city.vis --method single
    # A file that is not there, or a build without Assimp.
    expect 1 err 'absent.obj' picture city.obs --out new.png --model absent.obj
    expect 2 err 'go with --model' picture city.obs --out new.png --bounds
    expect 1 err 'no object 161 among 161' picture city.obs --out new.png --explain 161
    expect 1 err 'no frame 60 among 60' picture city.obs --out new.png --frame 60
    for number in '' x -1 1.5 4294967296; do
        expect 2 err 'expected a number from 0 after --explain' picture city.obs --out new.png --explain "$number"
    done

    # One line more, and a picture of its own.
    expect 0 out ' together=' picture city.obs --size 800x400 --frame 30 --method fused --out fused.png
    find_one_that_is 'outside occluders=none' fused
    find_one_that_is 'visible occluders=none' single
    find_one_that_is 'hidden occluders=[0-9]+' single
    find_one_that_is 'hidden occluders=[0-9]+' fused
    [ "$(wc -l <out)" -eq 2 ] || fail "prints other than two lines"
    cmp -s found.png fused.png && fail "the picture does not show what hides object $object"
}

error_group()
{
    expect 0 out 'usage: occlude-bench error' error --help
    expect 2 err '--fast: no such option' error --fast
    expect 2 err 'one word too many' error city.obs
    expect 2 err '--repeat is 1000 at most' error --repeat 1001
    expect 2 err 'expected --size as 4096x2304' error --size 4096
    for name in '' a/b ../city 'a b'; do
        expect 2 err "expected a scene's name after --scene, as city_1000" error --scene "$name"
    done
    mkdir report
    expect 1 err 'there is no file nameless.obs and no generator makes it' \
        error --out report --scene nameless
    expect 1 err 'cannot make the folder absent/report' error --out absent/report --scene city_1000
    echo 'no scene' >broken.obs
    expect 1 err 'expected the magic "OBS1"' error --out report --scenes . --scene broken

    expect 0 out ' objects, ' scene seedscene 60 1 --out tiny.obs
    expect 0 out ' objects, ' scene interior 50 5 --out rooms.obs
    expect 0 out 'rooms: ' error --out report --scenes . --scene tiny --scene rooms $fast
    check_report
    [ "$(column scene | sort -u | tr '\n' ' ')" = 'rooms tiny ' ] || fail "other scenes"
    [ "$(ls report/truth | grep -c '^tiny-.*\.tru$')" -eq 3 ] || fail "not a truth for each scale"
    if command -v gnuplot >/dev/null; then
        [ -s report/tiny.png ] && [ -s report/rooms.png ] || fail "plots are missing"
        grep -q '(tiny.png)' report/error.md || fail "report/error.md shows no plot"
    fi
    # Truths that are there are taken, and a report over another one.
    rm report/error.csv
    expect 0 out 'tiny: ' error --out report --scenes . --scene tiny $fast
    check_report
}

error_hard_group()
{
    expect 0 out ' objects, ' scene seedscene 60 1 --out tiny.obs
    expect 0 out 'hard families: ' error --out report --scenes . --scene tiny $fast --hard
    check_report
    [ "$(column scene | grep -c '^hard/panels$')" -ge 3 ] || fail "no rows of the hard families"
    grep -q '^| panels |' report/error.md || fail "no table of the hard families"
}

# target SCENE COLUMN: a cell of report/targets.csv.
target()
{
    sed -e '/^#/d' report/targets.csv | awk -F, -v scene="$1" -v name="$2" '
        NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) wanted = i }
        NR > 1 && $1 == scene && wanted { print $wanted }'
}

targets_group()
{
    quick='error --targets --out report --scenes . --repeat 1 --size 512x288'
    expect 2 err '--targets has no hard families' error --targets --hard
    mkdir report
    expect 1 err 'nameless is no scene of --targets' $quick --scene city_1000 --scene nameless
    expect 1 err 'seedscene_500 is no scene of --targets' $quick --scene seedscene_500

    # One scene that its generator makes, and one from a file that is called as another seed.
    expect 0 out ' objects, ' scene city 100 7 --out city_1000_seed11.obs
    expect 0 out 'scene=city_1000_seed11 seed=11 from=file ' \
        $quick --scene city_1000 --scene city_1000_seed11
    grep -q '^scene=city_1000 seed=2 from=generator method=fused objects=1001 frames=60 ' out ||
        fail "no line for city_1000"
    grep -q '^- false-hidden objects, all scenes: 0 (limit 0: met)$' out || fail "false-hidden objects"
    grep -q '^- scenes where one thread and two gave other masks: 0 (limit 0: met)$' out ||
        fail "masks depend on the number of threads"
    sed -e '/^#/d' report/targets.csv | awk -F, 'NR == 1 { wide = NF } NF != wide { exit 1 }' ||
        fail "rows of another width"
    [ "$(target city_1000 target_ms) $(target city_1000 target_missed_pct)" = '0.02 1.9' ] || fail "another target"
    [ "$(target city_1000 same_masks) $(target city_1000 truth_frames)" = 'yes 3' ] || fail "another row"
    [ -z "$(target city_1000 peer_fast_ms)" ] || fail "other programs' figures for other boxes"
    [ "$(target city_1000_seed11 objects)" = 161 ] || fail "the file was not taken"
    for key in median_ms p99_ms max_ms first_ms first_warm_ms two_threads_ms build_ms; do
        target city_1000 $key | awk '!($1 > 0) { bad = 1 } END { exit bad || NR != 1 }' || fail "$key is not a time"
    done
    grep -q '^| city_1000 | 1001 | ' report/targets.md || fail "no row in report/targets.md"
}

# A file of version 2, through every command that takes one.
sheets_group()
{
    expect 0 out 'families=1 worlds=1 ' hard --family polygon_mixed --seed 3 --out sheets.obs
    [ "$(head -c 4 sheets.obs)" = OBS2 ] || fail "sheets.obs is not of version 2"
    expect 0 out 'frames=1 ' truth sheets.obs --out sheets.tru --size 320x180
    for method in single fused pairwise frustum; do
        expect 0 out 'frames=1 objects=' cull sheets.obs --repeat 1 --backend plain --method $method --out sheets.vis
        expect 0 out ' false_hidden=0 ' compare sheets.tru sheets.vis --scene sheets.obs --hidden 100
    done
    expect 0 out ' missed_pct=100.000' compare sheets.tru sheets.vis --scene sheets.obs
    if "$program" picture --help >out 2>err; then
        expect 0 out ' together=' picture sheets.obs --size 800x400 --out sheets.png --method fused
    fi
    head -c 4 sheets.obs | tr 2 1 >older.obs
    tail -c +5 sheets.obs >>older.obs
    expect 1 err 'older.obs: byte ' cull older.obs --repeat 1
}

seed_group()
{
    expect 0 out 'usage: occlude-bench seed' seed --help
    expect 2 err 'expected fused or single after --method' seed --method frustum
    expect 2 err 'expected numbers from 1 to 20000000, parted by commas' seed --counts 1,,2
    for method in single fused; do
        expect 0 out "method $method, backend openmp" \
            seed --method $method --counts 10,501 --scenes 2 --repeat 1 --csv $method.csv
        grep -q "^# method=$method\$" $method.csv || fail "no line # method="
        awk -F, '/^501,/ && NF == 8 && $5 > 0 && $7 == "6.97" && $8 > 501 * 48 { good = 1 } END { exit !good }' \
            $method.csv || fail "another row of 501 objects"
    done
    # Fusion hides more, never less.
    [ "$(awk -F, '/^501,/ { printf "%d", 10 * $4 }' fused.csv)" -le \
        "$(awk -F, '/^501,/ { printf "%d", 10 * $4 }' single.csv)" ] || fail "fused leaves more than single"
}

case $2 in
cull) cull_group ;;
picture) picture_group ;;
seed) seed_group ;;
sheets) sheets_group ;;
targets) targets_group ;;
error) error_group ;;
error_hard) error_hard_group ;;
truth) truth_group ;;
compare) compare_group ;;
settle) settle_group ;;
settle_absent) settle_absent_group ;;
wrong) expect 2 err 'expected a truth file' compare --help ;;
*)
    echo "no group is named $2"
    exit 1
    ;;
esac
[ "$failures" -eq 0 ]
