#!/bin/bash
# All set-up and tests, from a clean clone, re-runnable: packages, builds, unit tests (plain and
# sanitized), a bounded fuzzing run, SQL tests, crashes, the examples of the documentation, comparison
# with CGAL, SciPy, matplotlib and VTK, the viewer in a browser without a screen, random changes against
# a model, other versions of PostgreSQL, smoke runs of the benchmarks and the evaluation. Logs are left
# in build/test, and the times of the suites in build/test/times.
#
#   test.sh             the usual size: less than 35 minutes on two quiet cores
#   test.sh quick       what shows most faults of SQL, in some minutes
#   test.sh everything  all, whole
#   test.sh NAME...     these suites, whole, after the builds that they need
#   test.sh list [quick|usual|everything]
#                       the names: all, or those of a size, with the part that has its turn;
#                       test/sizes says which is in which
#   test.sh --postgresql N [short|NAME...]
#                       with PostgreSQL 17, 18 or 19, in a Debian that has it (chroot.sh): all that a
#                       server and the core concerns, compiled there; these suites; or, in some
#                       minutes, what differs between servers, with the core as it is compiled here
#
# ABACUS_SEED is a number that decides what has its turn in the usual size, and where servers are killed; by
# default the number comes from the tree.
set -uo pipefail
. "$(dirname "$0")/common.sh"
. scripts/cluster.sh
. scripts/suites.sh
. scripts/sizes.sh
. scripts/other_version.sh

FUZZ_SECONDS=${FUZZ_SECONDS:-30}
logs=$ABACUS_BUILD/test
mkdir -p "$logs"

# The short form: TAP files about differences between versions, and data sets.
short_tap="standby.pl logical.pl pg_upgrade.pl vacuum.pl build_crash.pl repack.pl read_only.pl all_visible.pl"
short_sets="wheel octree duplicates"

# Each suite and its command, in the order in which they begin, each as soon as its needs have passed.
suites=(format layout build-extension build tap build-benchmarks build-sanitized build-threads
    postgresql-17 postgresql-18 postgresql-19 viewer unit-sanitized unit-threads unit acceptance unit-apart oracles pgtap
    regress isolation docs model model-lines model-track fuzz reports acceptance-goose acceptance-shards oracles-large viewer-large tidy bench evaluation demo-shards)
declare -A command=(
    [format]=format_check
    [layout]=layout_check
    [build-extension]=install_extension
    [build]="build_with_core abacus_tests"
    [build-benchmarks]="build_with_core all"
    [build-sanitized]="build_with_clang build/sanitize -DABACUS_SANITIZE=ON"
    [build-threads]="build_with_clang build/threads -DABACUS_SANITIZE_THREADS=ON"
    [tidy]=tidy_core
    [unit]="unit_tests build/release -E apart"
    [unit-apart]="unit_tests build/release -R apart"
    [unit-sanitized]="unit_tests build/sanitize"
    [unit-threads]="unit_tests build/threads"
    [fuzz]=fuzz
    [regress]="with_server regression_tests"
    [isolation]="with_server isolation_tests"
    [pgtap]="with_server pgtap_tests"
    [docs]="with_server documentation_examples"
    [oracles]="with_server oracle_tests"
    [oracles-large]="with_server large_oracle_tests"
    [viewer]="with_server viewer_tests"
    [viewer-large]="with_server viewer_tests large/*"
    [tap]="with_server tap_suite ${ABACUS_SHORT:+$short_tap}"
    [acceptance]="scripts/acceptance.sh quick ${ABACUS_SHORT:+$short_sets}"
    [acceptance-goose]="scripts/acceptance.sh goose"
    [acceptance-shards]="scripts/acceptance.sh shards"
    [model]="scripts/model_test.sh -t 30"
    [model-lines]="scripts/model_test.sh lines -t 20"
    [model-track]="scripts/model_test.sh track -t 20"
    [reports]=report_tests
    [bench]="scripts/bench.sh smoke"
    [demo-shards]="scripts/demo_shards.sh quick"
    [evaluation]="scripts/evaluation.sh smoke"
    [postgresql-17]="scripts/test.sh --postgresql 17 short"
    [postgresql-18]="scripts/test.sh --postgresql 18 short"
    [postgresql-19]="scripts/test.sh --postgresql 19 short"
)
# What must have passed before a suite begins.
declare -A needs=([unit]=build [unit-apart]=build [build-sanitized]=build [build-benchmarks]=build
    [unit-sanitized]=build-sanitized [unit-threads]=build-threads [fuzz]=build-sanitized
    [bench]=build-benchmarks [evaluation]=build-benchmarks)
for name in build regress isolation pgtap docs viewer viewer-large tap; do needs[$name]=build-extension; done
for name in acceptance acceptance-goose acceptance-shards model model-lines model-track oracles oracles-large postgresql-17 postgresql-18 postgresql-19; do needs[$name]=build; done
if [[ -n ${ABACUS_SHORT:-} ]]; then needs[acceptance]=build-extension; fi # the oracle was brought

# The line of a log that says how much was tested.
summary() {
    grep -E -o '[0-9]+% tests passed.*|All [0-9]+ tests passed|^Files=.*Tests=[0-9]+|^[0-9]+ examples.*|^[0-9]+ meshes compared.*|^[0-9]+ steps in .*|^Done [0-9]+ runs.*|^Ran [0-9]+ tests.*|^# pass [0-9]+|^[0-9]+ passed, [0-9]+ failed' "$1" |
        tail -n 1
}

# The tests test the installed extension.
build_with_core() {
    ABACUS_CORE_OBJECTS=$ABACUS_BUILD/extension build_release "$@"
}

# build_with_clang FOLDER OPTION: clang takes half of gcc's time for this.
build_with_clang() {
    ABACUS_TEST_OBJECTS=$ABACUS_BUILD/release/test/CMakeFiles/abacus_unit_tests.dir \
        CC=clang CXX=clang++ cmake -S . -B "$1" "$2" -DABACUS_WERROR=ON >/dev/null &&
        cmake --build "$1" -j "$ABACUS_JOBS"
}

# The whole core; `dev.sh tidy` checks only changed files.
tidy_core() {
    local files
    mapfile -t files < <(git ls-files 'src/*.cpp')
    tidy_check "${files[@]}"
}

# All fuzz targets in parallel, with FUZZ_SECONDS of processor time in total. The inputs that a target finds
# stay in build/fuzz/corpus for the next run. Its seeds are in test/fuzz/corpus/<target>.
fuzz() {
    local targets=(test/fuzz/*.cpp) target runs=() run status=0
    local seconds=$((FUZZ_SECONDS / ABACUS_JOBS))
    ((seconds)) || seconds=1 # 0 is without a limit
    for target in "${targets[@]}"; do
        fuzz_target "$(basename "$target" .cpp)" "$seconds" &
        runs+=($!)
    done
    for run in "${runs[@]}"; do wait "$run" || status=1; done
    return "$status"
}

fuzz_target() {
    local folders=("build/fuzz/corpus/$1")
    mkdir -p "${folders[0]}"
    if [[ -d test/fuzz/corpus/$1 ]]; then folders+=("test/fuzz/corpus/$1"); fi
    "build/sanitize/test/$1" -max_total_time="$2" -artifact_prefix=build/fuzz/ -print_final_stats=1 \
        -verbosity=1 "${folders[@]}"
}

# Runs the suite in a server of its own.
with_server() {
    cluster_start "$suite" && "$@"
}

tap_suite() {
    tap_begin
    trap 'tap_end; cluster_stop' EXIT
    tap_tests "$@"
}

# --suite NAME: runs one suite. timed.py, which calls this, notes its times.
if [[ ${1:-} == --suite ]]; then
    suite=$2
    # shellcheck disable=SC2086 # the words of a command
    ${command[$suite]}
    exit
fi

# choose NAME...: keeps in `suites` only these and what they need.
choose() {
    local name kept=()
    declare -A chosen=()
    for name in "$@"; do
        [[ -n ${command[$name]:-} ]] || fail "There is no suite $name. The suites are: ${suites[*]}"
        while [[ -n $name ]]; do
            chosen[$name]=1
            name=${needs[$name]:-}
        done
    done
    for name in "${suites[@]}"; do
        if [[ -n ${chosen[$name]:-} ]]; then kept+=("$name"); fi
    done
    suites=("${kept[@]}")
}

# start NAME: runs the suite in the background, as a process group, with its output in a log.
start() {
    local share=
    if [[ -n ${by_turns[$1]:-} ]]; then share=$(share_of "$1" "$seed"); fi
    rm -f "$logs/$1.times"
    set -m
    ABACUS_SHARE=$share ABACUS_MOST_SECONDS=$most scripts/timed.py "$logs/$1.times" scripts/test.sh --suite "$1" </dev/null >"$logs/$1.log" 2>&1 &
    running[$!]=$1
    set +m
}

# The tests that failed according to a TAP log, with what they say: the end of a long log shows only what passed after them.
failed_taps() {
    awk '/^ *not ok / { lines = 40 } /^ *(ok |# Subtest)/ { lines = 0 } lines && ++shown <= 200 { print; --lines }' "$1"
}

# ended PID STATUS: reports how its suite ended, with what failed and the end of the log if it failed. Status 77: it cannot be
# run here.
ended() {
    local name=${running[$1]} status=$2 log=$logs/${running[$1]}.log word=ok said elapsed=- used=- kernel=-
    unset "running[$1]"
    said=$(summary "$log")
    case $status in
    0) passed=$((passed + 1)) good[$name]=1 ;;
    77) skipped=$((skipped + 1)) word=SKIPPED said=$(tail -n 1 "$log") ;;
    *) failed=$((failed + 1)) word=FAILED said="(${log#"$ABACUS_ROOT"/})" ;;
    esac
    if [[ -s $logs/$name.times ]]; then read -r elapsed used kernel <"$logs/$name.times"; fi
    printf '%-16s %9s %9s %9s  %s\n' "$name" "$elapsed" "$used" "$kernel" "$word" >>"$logs/times"
    printf '[%d/%d] %-7s %-16s %6s s   %s\n' $((passed + failed + skipped)) ${#suites[@]} "$word" "$name" "$elapsed" "$said"
    if [[ $word == FAILED ]]; then
        failed_taps "$log"
        tail -n 40 "$log"
    fi
}

# The first remaining suite whose needs have passed; suites whose needs have failed fail.
next_suite() {
    local name need
    ready=
    for name in "${!left[@]}"; do
        need=${needs[${left[name]}]:-}
        if [[ -z $need || -n ${good[$need]:-} ]]; then
            ready=${left[name]}
            unset "left[name]"
            return
        elif [[ " ${left[*]} ${running[*]} " != *" $need "* ]]; then
            failed=$((failed + 1))
            echo "[$((passed + failed + skipped))/${#suites[@]}] FAILED  ${left[name]}: $need is missing"
            unset "left[name]"
        fi
    done
}

# All suites, as many in parallel as there are processors: servers mostly wait, and few suites use more than
# one.
run_suites() {
    local left=("${suites[@]}") pid status ready
    declare -gA running=() good=()
    trap 'for pid in "${!running[@]}"; do kill -TERM -- "-$pid"; done; wait' EXIT
    printf '%-16s %9s %9s %9s\n' suite elapsed processor kernel >"$logs/times"
    while ((${#left[@]} + ${#running[@]})); do
        while ((${#running[@]} < lanes)); do
            next_suite
            if [[ -z $ready ]]; then break; fi
            start "$ready"
        done
        if ((!${#running[@]})); then continue; fi
        status=0
        wait -n -p pid "${!running[@]}" || status=$?
        ended "$pid" "$status"
    done
    trap - EXIT
}

seed=$(tree_seed) || exit
size=usual
most=0
declare -A by_turns=()
case ${1:-usual} in
list)
    if (($# < 2)); then printf '%s\n' "${suites[@]}"; exit; fi
    names=$(suites_of "$2" "$seed") || exit
    for name in $names; do
        echo "$name$([[ $2 == everything ]] || share_of "$name" "$seed" | sed 's/^/ /')"
    done
    exit
    ;;
--postgresql) shift; other_postgresql "$@" ;;
quick | usual | everything)
    size=${1:-usual}
    names=$(suites_of "$size" "$seed") || exit
    mapfile -t names <<<"$names"
    if ((ABACUS_POSTGRESQL != 15)); then
        mapfile -t names < <(printf '%s\n' "${names[@]}" | grep -xF "${version_suites// /$'\n'}")
        echo "Only Debian 12 has all that is needed for every test. With PostgreSQL $ABACUS_POSTGRESQL, those of the server and the core are run."
    fi
    if [[ $size != everything ]]; then
        most=1800 # seconds: a suite that hangs must not keep the others from being reported
        for name in "${names[@]}"; do by_turns[$name]=1; done
    fi
    for name in "${@:2}"; do unset "by_turns[$name]"; done # these are whole
    set -- "${names[@]}" "${@:2}"
    ;;
*) size=named ;;
esac
choose "$@"
packages=test
if ((ABACUS_POSTGRESQL != 15)); then packages=versions; fi
scripts/install-dependencies.sh "${ABACUS_PACKAGES:-$packages}" || fail "packages are missing"
if ((EUID != 0)); then sudo -v || fail "sudo is needed: suites install the extension, and cannot ask for a password"; fi
export ABACUS_BUILT=1 # tells the scripts below that all is built and installed
export ABACUS_SEED=$seed
if [[ -n ${by_turns[tap]:-} ]]; then
    turn_of tap kills:
    export ABACUS_KILLS=${ABACUS_KILLS:-$turn}
fi
lanes=${ABACUS_LANES:-$ABACUS_JOBS}
passed=0 failed=0 skipped=0
echo "Size $size, ABACUS_SEED=$seed: ${suites[*]}"
run_suites
{
    echo
    cat "$logs/times"
    awk 'NR > 1 { used += $3; kernel += $4 } END { printf "%-16s %9d %9.1f %9.1f\n", "all", elapsed, used, kernel }' elapsed=$SECONDS "$logs/times"
    echo "(seconds)"
}

echo "$passed passed, $failed failed$( ((!skipped)) || echo ", $skipped skipped")"
((failed == 0))
