#!/bin/bash
# All set-up and all tests, from a clean clone, re-runnable: packages, builds,
# unit tests (plain and sanitized), a bounded fuzzing run, SQL tests, crashes, the
# examples of the documentation, comparison with CGAL, SciPy, matplotlib and VTK, the
# viewer in a browser without a screen, random changes against a model, reports of
# benchmarks, smoke runs of the benchmarks and the evaluation. Logs are left in build/test.
#
#   test.sh             all suites but tidy and other versions
#   test.sh NAME...     these, after the builds that they need; `all` are those of above
#   test.sh list        the names
#   test.sh --postgresql N [short|NAME...]
#                       with PostgreSQL 17 or 18, in a Debian that has it (chroot.sh): all that a
#                       server and the core concerns, compiled there; these suites; or, in some
#                       minutes, what differs between servers, with the core as it is compiled here
set -uo pipefail
. "$(dirname "$0")/common.sh"
. scripts/cluster.sh
. scripts/suites.sh
. scripts/other_version.sh

FUZZ_SECONDS=${FUZZ_SECONDS:-30}
logs=$ABACUS_BUILD/test
mkdir -p "$logs"
passed=0 failed=0 skipped=0

# The short form: TAP files that concern what differs between versions, and data sets.
short_tap="standby.pl logical.pl pg_upgrade.pl vacuum.pl build_crash.pl"
short_sets="wheel octree duplicates"

# Each suite, and what runs it.
declare -A command=(
    [format]=format_check
    [layout]=layout_check
    [build-extension]=install_extension
    [build]=build_release
    [build-sanitized]="build_with_clang build/sanitize -DABACUS_SANITIZE=ON"
    [build-threads]="build_with_clang build/threads -DABACUS_SANITIZE_THREADS=ON"
    [tidy]=tidy_core
    [unit]="unit_tests build/release"
    [unit-sanitized]="unit_tests build/sanitize"
    [unit-threads]="unit_tests build/threads"
    [fuzz]=fuzz
    [regress]=regression_tests
    [pgtap]=pgtap_tests
    [docs]=documentation_examples
    [oracles]=oracle_tests
    [viewer]=viewer_tests
    [tap]="tap_tests ${ABACUS_SHORT:+$short_tap}"
    [acceptance]="scripts/acceptance.sh quick ${ABACUS_SHORT:+$short_sets}"
    [acceptance-goose]="scripts/acceptance.sh goose"
    [model]="scripts/model_test.sh -t 30"
    [reports]=report_tests
    [bench]="scripts/bench.sh smoke"
    [evaluation]="scripts/evaluation.sh smoke"
    [postgresql-17]="scripts/test.sh --postgresql 17 short"
    [postgresql-18]="scripts/test.sh --postgresql 18 short"
)
# The order. The second line runs beside the first, since servers mostly wait, and few of
# its suites use more than one processor.
first_builds=(format layout build-extension build)
first_line=(build-sanitized build-threads tidy unit unit-sanitized unit-threads fuzz)
second_line=(regress pgtap docs oracles viewer tap acceptance acceptance-goose model reports bench evaluation)
# Then, beside each other.
other_versions=(postgresql-17 postgresql-18)
# These take long, or load much: only where they are named.
not_in_all=(tidy "${other_versions[@]}")
# The builds that a suite needs.
declare -A needs=([unit]=build [build-sanitized]=build [unit-sanitized]=build-sanitized [unit-threads]=build-threads [fuzz]=build-sanitized)
for name in build regress pgtap docs oracles viewer tap; do needs[$name]=build-extension; done
for name in acceptance acceptance-goose model bench evaluation "${other_versions[@]}"; do needs[$name]=build; done
if [[ -n ${ABACUS_SHORT:-} ]]; then needs[acceptance]=build-extension; fi # the oracle was brought

# choose NAME...: leaves in the lists these, and what they need.
declare -A chosen=()
choose() {
    local name
    for name in "$@"; do
        [[ -n ${command[$name]:-} ]] || fail "No suite $name. There are: $(suites)"
        while [[ -n $name ]]; do
            chosen[$name]=1
            name=${needs[$name]:-}
        done
    done
    keep_chosen first_builds
    keep_chosen first_line
    keep_chosen second_line
    keep_chosen other_versions
}

suites() {
    echo "${first_builds[@]}" "${first_line[@]}" "${second_line[@]}" "${other_versions[@]}"
}

# The names that `all` stands for.
all_suites() {
    suites | tr ' ' '\n' | grep -vxF -f <(printf '%s\n' "${not_in_all[@]}")
}

keep_chosen() {
    local -n line=$1
    local name kept=()
    for name in "${line[@]}"; do
        if [[ -n ${chosen[$name]:-} ]]; then kept+=("$name"); fi
    done
    line=("${kept[@]}")
}

# suite NAME: runs it, output into a log that is shown on failure. Status 77: it cannot be run here.
suite() {
    local name=$1 start=$SECONDS log=$logs/$1.log status=0
    # shellcheck disable=SC2086 # the words of a command
    (${command[$name]}) >"$log" 2>&1 || status=$?
    if ((status == 0)); then
        passed=$((passed + 1))
        printf 'ok      %-18s %4d s   %s\n' "$name" $((SECONDS - start)) "$(summary "$log")"
    elif ((status == 77)); then
        skipped=$((skipped + 1))
        printf 'SKIPPED %-18s %4d s   %s\n' "$name" $((SECONDS - start)) "$(tail -n 1 "$log")"
    else
        failed=$((failed + 1))
        printf 'FAILED  %-18s %4d s   (%s)\n' "$name" $((SECONDS - start)) "${log#"$ABACUS_ROOT"/}"
        tail -n 40 "$log"
    fi
}

# The line of a log that says how much was tested.
summary() {
    grep -E -o '[0-9]+% tests passed.*|All [0-9]+ tests passed|^Files=.*Tests=[0-9]+|^[0-9]+ examples.*|^[0-9]+ meshes compared.*|^[0-9]+ steps in .*|^Done [0-9]+ runs.*|^Ran [0-9]+ tests.*|^# pass [0-9]+|^[0-9]+ passed, [0-9]+ failed' "$1" |
        tail -n 1
}

# build_with_clang FOLDER OPTION: clang takes half of gcc's time for this.
build_with_clang() {
    CC=clang CXX=clang++ cmake -S . -B "$1" "$2" -DABACUS_WERROR=ON >/dev/null &&
        cmake --build "$1" -j "$ABACUS_JOBS"
}

# The whole core; `dev.sh tidy` checks what has changed.
tidy_core() {
    local files
    mapfile -t files < <(git ls-files 'src/*.cpp')
    tidy_check "${files[@]}"
}

# All fuzz targets at once, FUZZ_SECONDS of processor time in all. The inputs that a target finds
# stay in build/fuzz/corpus for the next run. Its seeds are in test/fuzz/corpus/<target>.
fuzz() {
    local targets=(test/fuzz/*.cpp) target runs=() run status=0
    local seconds=$((FUZZ_SECONDS / ABACUS_JOBS))
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

# The second line is a process group, which ends with this script.
second_begin() {
    cluster_start test
    if [[ -n ${chosen[tap]:-} ]]; then tap_begin; fi
    set -m
    second_run 9>&- &
    second=$!
    set +m
    trap 'kill -INT -- "-$second"; second_end; cluster_stop' EXIT
}

second_run() {
    local name
    trap 'exit "${#second_line[@]}"' INT # with none of what is left
    passed=0 failed=0 skipped=0
    for name in "${second_line[@]}"; do suite "$name"; done
    exit $((failed + 16 * skipped))
}

# Waits for the second line, and counts its suites: its exit status is the number of those that
# failed, and 16 for each that was skipped, or the number of all if it was interrupted.
second_end() {
    local count=${#second_line[@]} status=0 lost left
    wait "$second" || status=$?
    lost=$((status % 16)) left=$((status / 16))
    if ((lost + left > count)); then lost=$count left=0; fi
    passed=$((passed + count - lost - left)) failed=$((failed + lost)) skipped=$((skipped + left))
    tap_end
    trap cluster_stop EXIT
}

# Each in a Debian of its own, and none waits for another. They are process groups, which end with
# this script; what runs in a Debian takes only signal 9.
other_versions_run() {
    local name run before
    before=$(trap -p EXIT) # stops the server of the second line
    runs=()
    set -m
    for name in "${other_versions[@]}"; do
        (passed=0 failed=0 skipped=0; suite "$name"; exit $((failed + 2 * skipped))) &
        runs+=($!)
    done
    set +m
    trap "kill -KILL -- ${runs[*]/#/-}; ${before:+cluster_stop}" EXIT
    for run in "${runs[@]}"; do
        wait "$run"
        case $? in 0) passed=$((passed + 1)) ;; 2) skipped=$((skipped + 1)) ;; *) failed=$((failed + 1)) ;; esac
    done
    eval "${before:-trap - EXIT}"
}

case ${1:-all} in
list) suites | tr ' ' '\n'; exit ;;
--postgresql) shift; other_postgresql "$@" ;;
all) shift $(($# > 0)); mapfile -t names < <(all_suites); set -- "${names[@]}" "$@" ;;
esac
choose "$@"
scripts/install-dependencies.sh "${ABACUS_PACKAGES:-test}" || fail "packages are missing"
export ABACUS_BUILT=1 # tells the scripts below that all is built and installed
export ABACUS_CORE_OBJECTS=$ABACUS_BUILD/extension # what is tested is what is installed
for name in "${first_builds[@]}"; do suite "$name"; done
unset ABACUS_CORE_OBJECTS
export ABACUS_TEST_OBJECTS=$ABACUS_BUILD/release/test/CMakeFiles/abacus_unit_tests.dir # for the sanitized core
if ((${#second_line[@]})); then second_begin; fi
for name in "${first_line[@]}"; do suite "$name"; done
if ((${#second_line[@]})); then second_end; fi
if ((${#other_versions[@]})); then other_versions_run; fi

echo "$passed passed, $failed failed$( ((!skipped)) || echo ", $skipped skipped")"
((failed == 0))
