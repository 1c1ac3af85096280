# Sourced after cluster.sh: how each kind of test is run. scripts/test.sh runs all tests of a kind,
# scripts/dev.sh a few, so most functions take names. Tests that need a server use the one that the
# environment names; cluster_start makes it.

# Warnings are errors in code that the tests build. With ABACUS_WERROR= (empty) they are not, for a compiler
# with other warnings, such as that of any other Debian than 12.
export ABACUS_WERROR=${ABACUS_WERROR-$( ((ABACUS_POSTGRESQL != 15)) || echo 1)}

# Checks that all C++ is formatted by clang-format.
format_check() {
    git ls-files -z '*.cpp' '*.hpp' | xargs -0 clang-format --dry-run -Werror
}

# Checks that the tree agrees with docs/architecture.md, and that files named in documents exist.
layout_check() {
    python3 -m unittest discover -s test/layout -p '*_test.py'
}

# .clang-tidy over some files: tidy_check FILE.... Nothing is compiled in build/tidy; it only says how each
# file would be compiled.
tidy_check() {
    CC=clang CXX=clang++ cmake -S . -B build/tidy -DABACUS_UNITS=OFF -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON >/dev/null &&
        printf '%s\0' "$@" | xargs -0 -n 1 -P "$ABACUS_JOBS" clang-tidy --quiet -p build/tidy
}

# The unit tests, linked with the core as it is compiled for the extension.
build_unit_tests() {
    build_extension &&
        ABACUS_CORE_OBJECTS=$ABACUS_BUILD/extension build_release abacus_unit_tests
}

# Unit tests of a build, in shards: unit_tests FOLDER [OPTION of ctest...]. With ABACUS_SHARE=K/N, only every
# Nth shard.
unit_tests() {
    local share=()
    if [[ -n ${ABACUS_SHARE:-} ]]; then share=(-I "$((${ABACUS_SHARE%/*} + 1)),,${ABACUS_SHARE#*/}"); fi
    exec 8>"$1/ctest.lock"
    flock 8 # two runs in one folder would share a log
    ctest --test-dir "$1" "${@:2}" "${share[@]}" -j "$ABACUS_JOBS" --output-on-failure --no-tests=error 8>&- &&
        awk '/PASSED/ { n += $4 } END { print "All " n " tests passed" }' \
            "$1/Testing/Temporary/LastTest.log"
}

# Regression tests, and isolation tests: regression_tests [TEST...], isolation_tests [TEST...]; all without
# arguments. Regression tests run in parallel, each in a database of its own (in_own_database), but for some whose
# output depends on everything that the server does (progress, freed space), or names the database.
export ABACUS_TESTS_ALONE="build load maintenance parallel privileges stats"
regression_tests() {
    local schedule=$PWD/build/extension/schedule name together=() alone=()
    if ((!$#)); then set -- $(names_of .sql < <(ls sql/*.sql)); fi
    for name; do
        if [[ " $ABACUS_TESTS_ALONE " == *" $name "* ]]; then alone+=("$name"); else together+=("$name"); fi
    done
    {
        if ((${#together[@]})); then echo "test: ${together[*]}"; fi
        if ((${#alone[@]})); then printf 'test: %s\n' "${alone[@]}"; fi
    } >"$schedule"
    "${extension_make[@]}" installcheck ISOLATION= REGRESS="--schedule=$schedule --launcher=$PWD/scripts/in_own_database \
        --max-connections=$ABACUS_JOBS" && return
    cat build/extension/regression.diffs
    return 1
}

isolation_tests() {
    if ((!$#)); then set -- "$(names_of .spec < <(ls test/isolation/specs/*.spec))"; fi
    "${extension_make[@]}" installcheck REGRESS= ISOLATION="$*" && return
    cat build/extension/output_iso/regression.diffs
    return 1
}

# Names of tests from names of files, in one line: names_of ENDING.
names_of() {
    xargs -n 1 basename -s "$1" | paste -sd ' '
}

# pgTAP files; all without arguments. Each has a database of its own, so several run in parallel. Those that need
# PostGIS skip themselves. Status 77 if there is no pgTAP.
pgtap_tests() {
    if [[ ! -e $("$PG_CONFIG" --sharedir)/extension/pgtap.control ]]; then
        echo "skipped: there is no pgTAP for PostgreSQL $ABACUS_POSTGRESQL here"
        return 77
    fi
    if ((!$#)); then set -- test/pgtap/*.sql; fi
    run_psql -c "DROP DATABASE IF EXISTS abacus_pgtap" -c "CREATE DATABASE abacus_pgtap" &&
        run_psql -d abacus_pgtap -c "CREATE EXTENSION pgtap" -c "CREATE EXTENSION abacus" &&
        pg_prove --psql-bin test/pgtap/in_own_database -j "$ABACUS_JOBS" "$@"
}

# The TAP files are copied to a folder where the server's user may write. A small file system serves as a disk
# that is soon full. If it cannot be mounted, that test is skipped. Call tap_end afterwards.
tap_begin() {
    tap_folder=$cluster_folder/tap
    mkdir "$tap_folder" "$tap_folder/disk"
    cp -r test/tap/*.p[lm] test/tap/meshes "$tap_folder"
    if as_root mount -t tmpfs -o size=14m tmpfs "$tap_folder/disk" 2>/dev/null; then
        tap_disk=$tap_folder/disk
        mkdir "$tap_disk/space"
        export ABACUS_SMALL_DISK=$tap_disk/space
    fi
    if ((EUID == 0)); then chown -R postgres: "$tap_folder"; fi
}

tap_end() {
    if [[ -n ${tap_disk:-} ]]; then as_root umount -l "$tap_disk"; fi
    tap_disk=
}

# Crashes, many sessions, dumps, replication, upgrades: in servers that the tests start themselves, as a user
# who may. An interrupted test dies and ends its servers. ABACUS_KILLS says how often to kill. Takes names of
# files in test/tap; all without arguments. If a server of an earlier version was brought (other_version.sh),
# the upgrade starts from it.
tap_tests() {
    local sources old=()
    if [[ -n ${ABACUS_CHROOT:-} && -d /opt/old ]]; then
        old=(LD_LIBRARY_PATH=/opt/old/libraries ABACUS_OLD_SERVER="$(echo /opt/old/lib/postgresql/*)")
    fi
    if ((!$#)); then set -- "$tap_folder"/*.pl; else set -- "${@/#/"$tap_folder/"}"; fi
    sources=$(dirname "$("$PG_CONFIG" --pgxs)")/..
    # TESTDIR until 15, the others since then
    cluster_as_server env TESTDIR="$tap_folder" TESTDATADIR="$tap_folder/tmp_check" \
        TESTLOGDIR="$tap_folder/tmp_check/log" "${old[@]}" PG_REGRESS="$sources/test/regress/pg_regress" \
        PERL5OPT=-Msigtrap=die,INT,TERM prove -j "$ABACUS_JOBS" -I "$sources/test/perl" "$@"
}

# The viewer: its server, and its page in a headless browser. Status 77 if its packages are missing and cannot
# be installed.
viewer_tests() {
    if ! viewer/serve --build; then
        npm ping >/dev/null 2>&1 && return 1
        echo "skipped: npm's registry, which has the packages of the viewer, cannot be reached"
        return 77
    fi
    run_psql -c "DROP DATABASE IF EXISTS abacus_viewer" -c "CREATE DATABASE abacus_viewer" &&
        run_psql -d abacus_viewer -c "CREATE EXTENSION abacus" &&
        # shellcheck disable=SC2086 # a pattern
        PGDATABASE=abacus_viewer node --test --test-reporter=tap --test-concurrency=1 \
            test/viewer/${1:-*}.test.js
}

# The examples of pages, each page in a database of its own, and the pictures of the guide and of breaklines; pages that need
# PostGIS only if it is installed.
documentation_examples() {
    if (($#)); then
        scripts/doc_examples.py "$@"
        return
    fi
    local pages=() page postgis
    postgis=$("$PG_CONFIG" --sharedir)/extension/postgis.control
    for page in README.md docs/guide.md docs/cookbook/*.md docs/reference/*.md docs/{breaklines,relations,lab,operations,upkeep,postgis}.md; do
        if [[ -e $postgis ]] || ! grep -q '^CREATE EXTENSION.* abacus_postgis' "$page"; then pages+=("$page"); fi
    done
    scripts/doc_examples.py "${pages[@]}" && scripts/guide_pictures.py --check
}

# Python tests of the benchmarks' reports and of the scripts; takes names of files in test/suite.
report_tests() {
    python3 -m unittest discover -s test/suite -p "${1:-*_test.py}"
}

# Compares answers with those of SciPy, matplotlib, VTK and CGAL, in a database of its own; takes names of files
# in test/oracle. These are packages of the system's own Python, but for oracle_constrained, which is built.
oracle_tests() {
    run_psql -c "DROP DATABASE IF EXISTS abacus_oracle" -c "CREATE DATABASE abacus_oracle" &&
        run_psql -d abacus_oracle -c "CREATE EXTENSION abacus" &&
        PGDATABASE=abacus_oracle /usr/bin/python3 -m unittest discover -s test/oracle -p "${1:-*_test.py}"
}

# Those that have more points and more settings to compare.
large_oracle_tests() {
    local name
    for name in constrained crossing_lines outlines; do ABACUS_LARGE=1 oracle_tests "${name}_test.py" || return; done
}
