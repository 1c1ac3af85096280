#!/bin/bash
# All set-up and all tests, from a clean clone, re-runnable: packages, builds,
# unit tests (plain and sanitized), a bounded fuzzing run, SQL tests, crashes, the
# examples of the documentation, comparison with CGAL, random changes against a
# model, reports of benchmarks, smoke runs of the benchmarks and the evaluation. Logs are left in build/test.
set -uo pipefail
. "$(dirname "$0")/common.sh"
. scripts/cluster.sh

FUZZ_SECONDS=${FUZZ_SECONDS:-30}
logs=$ABACUS_BUILD/test
mkdir -p "$logs"
passed=0 failed=0

# suite NAME COMMAND...: runs it, output into a log that is shown on failure.
suite() {
    local name=$1 start=$SECONDS log
    shift
    log=$logs/${name// /-}.log
    if ("$@") >"$log" 2>&1; then
        passed=$((passed + 1))
        printf 'ok      %-28s %4d s   %s\n' "$name" $((SECONDS - start)) "$(summary "$log")"
    else
        failed=$((failed + 1))
        printf 'FAILED  %-28s %4d s   (%s)\n' "$name" $((SECONDS - start)) "${log#"$ABACUS_ROOT"/}"
        tail -n 40 "$log"
        return 1
    fi
}

# The line of a log that says how much was tested.
summary() {
    grep -E -o '[0-9]+% tests passed.*|All [0-9]+ tests passed|^Files=.*Tests=[0-9]+|^[0-9]+ examples.*|^[0-9]+ meshes compared.*|^[0-9]+ steps in .*|^Done [0-9]+ runs.*|^Ran [0-9]+ tests.*' "$1" |
        tail -n 1
}

# By clang, which takes half of gcc's time for it: build_with_clang FOLDER OPTION. What is
# sanitized and what is fuzzed are compiled apart, for what the fuzzer needs makes all tests take
# twice their time.
build_with_clang() {
    CC=clang CXX=clang++ cmake -S . -B "$1" "$2" >/dev/null &&
        cmake --build "$1" -j "$ABACUS_JOBS"
}

unit_tests() {
    ctest --test-dir "$1" -j "$ABACUS_JOBS" --output-on-failure --no-tests=error &&
        awk '/PASSED/ { n += $4 } END { print "All " n " tests passed" }' \
            "$1/Testing/Temporary/LastTest.log"
}

# All fuzz targets beside one another, FUZZ_SECONDS of processor time in all. What a target finds
# stays in build/fuzz/corpus for the next run; test/fuzz/corpus/<target> are its seeds.
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
    "build/fuzz/test/$1" -max_total_time="$2" -artifact_prefix=build/fuzz/ -print_final_stats=1 \
        -verbosity=1 "${folders[@]}"
}

regression_tests() {
    make -s -C build/extension -f "$ABACUS_ROOT/Makefile.pgxs" PG_CONFIG="$PG_CONFIG" installcheck ||
        { cat build/extension/regression.diffs; return 1; }
}

pgtap_tests() {
    psql -X -q -c "DROP DATABASE IF EXISTS abacus_pgtap" -c "CREATE DATABASE abacus_pgtap" &&
        psql -X -q -d abacus_pgtap -c "CREATE EXTENSION pgtap" -c "CREATE EXTENSION abacus" &&
        pg_prove -d abacus_pgtap test/pgtap/*.sql
}

# Crashes, many sessions, dumps, replication, upgrades: in servers that the tests
# start themselves, as the user who may. One that is interrupted dies, and ends its servers
# at that. ABACUS_KILLS says how often to kill.
tap_tests() {
    local sources
    sources=$(dirname "$("$PG_CONFIG" --pgxs)")/..
    cluster_as_server env TESTDIR="$tap_folder" PG_REGRESS="$sources/test/regress/pg_regress" \
        PERL5OPT=-Msigtrap=die,INT,TERM prove -j "$ABACUS_JOBS" -I "$sources/test/perl" "$tap_folder"/*.pl
}

# A second line of suites, those that need a server, beside all that is sanitized: servers mostly wait,
# and few of the suites use more than one processor. It is a process group, which ends with
# this script. A small file system of its own is a full disk soon; where it cannot be mounted, that
# test is skipped.
second_line_begin() {
    tap_folder=$cluster_folder/tap
    mkdir "$tap_folder" "$tap_folder/disk"
    cp -r test/tap/*.p[lm] test/tap/meshes "$tap_folder"
    if as_root mount -t tmpfs -o size=14m tmpfs "$tap_folder/disk" 2>/dev/null; then
        tap_disk=$tap_folder/disk
        mkdir "$tap_disk/space"
        export ABACUS_SMALL_DISK=$tap_disk/space
    fi
    if ((EUID == 0)); then chown -R postgres: "$tap_folder"; fi
    set -m
    second_line 9>&- &
    second=$!
    set +m
    trap 'kill -INT -- "-$second"; second_line_end; cluster_stop' EXIT
}

second_suites=10
second_line() {
    trap 'exit "$second_suites"' INT # with none of what is left
    passed=0 failed=0
    suite "pg_regress" regression_tests
    suite "pgTAP" pgtap_tests
    suite "documentation examples" documentation_examples
    suite "TAP" tap_tests
    suite "acceptance quick" scripts/acceptance.sh quick
    suite "acceptance goose" scripts/acceptance.sh goose
    suite "model test" scripts/model_test.sh -t 30
    suite "benchmark reports" python3 -m unittest discover -s test/suite -p '*_test.py'
    suite "bench smoke" scripts/bench.sh smoke
    suite "evaluation smoke" scripts/evaluation.sh smoke
    exit "$failed"
}

# Waits for them, and counts them: it ends with the number of those that failed, broken off with
# that of all.
second_line_end() {
    local lost=0
    wait "$second" || lost=$?
    if ((lost > second_suites)); then lost=$second_suites; fi
    passed=$((passed + second_suites - lost)) failed=$((failed + lost))
    if [[ -n ${tap_disk:-} ]]; then as_root umount -l "$tap_disk"; fi
    trap cluster_stop EXIT
}

documentation_examples() {
    scripts/doc_examples.py docs/sql.md docs/lab.md docs/operations.md README.md
}

scripts/install-dependencies.sh test || fail "packages are missing"
export ABACUS_BUILT=1 # tells the scripts below that all is built and installed
suite "build extension" install_extension
ABACUS_CORE_OBJECTS=$ABACUS_BUILD/extension suite "build" build_release

cluster_start test
second_line_begin
suite "build sanitized" build_with_clang build/sanitize -DABACUS_SANITIZE=ON
suite "build fuzz targets" build_with_clang build/fuzz -DABACUS_FUZZ=ON
suite "unit tests" unit_tests build/release
suite "unit tests sanitized" unit_tests build/sanitize
suite "fuzz" fuzz
second_line_end

echo "$passed passed, $failed failed"
((failed == 0))
