#!/bin/bash
# The benchmark suite: every figure of docs/benchmarks.md, and the page itself.
#
#   bench.sh [full] [PART...]   measures all parts, or the named ones anew; the results go into
#                               docs/benchmarks/results.json, docs/benchmarks.md is made of them
#   bench.sh quick [PART...]    the same with fewer points and runs, in minutes
#   bench.sh smoke [PART...]    with very few, in seconds, to see that everything works
#   bench.sh report             makes docs/benchmarks.md from the results that are there
#   bench.sh list               the parts, and how long each takes in the full mode
#   bench.sh aims               what was wanted of the figures, and whether it was held, for contributors
#   bench.sh pack               puts the part `gpu` into build/gpu-bench, for a machine with an NVIDIA GPU and CuPy that has
#                               nothing else of ours: no server, no compiler, no network
#
# On that machine `gpu-bench/run [full|quick|smoke] >gpu.json` measures the part. Back here, copy gpu.json to
# build/bench-results; `bench.sh report` takes it in.
#
# The results and the page of quick and smoke are in build/bench-results/quick and smoke. Abacus and all other
# engines get the same points, in turns; the server is a fresh one with default settings unless a part says
# otherwise. bench/suite does the work.
set -euo pipefail
. "$(dirname "$0")/common.sh"
. scripts/cluster.sh

# The part in a folder of the form of this one, with the programs, the libraries that they are linked with, and the loader.
pack() {
    local folder=$ABACUS_BUILD/gpu-bench program
    rm -rf "$folder"
    mkdir -p "$folder"/{bench/suite,build,libraries,programs,scripts}
    cp bench/suite/*.py "$folder/bench/suite"
    cp scripts/psql_session.py "$folder/scripts"
    for program in build/release/bench/core_in_memory build/release/test/oracle/oracle_points; do
        cp "$program" "$folder/programs"
        ldd "$program" | grep -o '/[^ ]*' | xargs cp -L -t "$folder/libraries"
        mkdir -p "$folder/$(dirname "$program")"
        cat >"$folder/$program" <<END
#!/bin/sh
top=\$(dirname "\$0")/$(dirname "$program" | sed 's|[^/]*|..|g')
exec "\$top"/libraries/ld-linux* --library-path "\$top/libraries" "\$top/programs/$(basename "$program")" "\$@"
END
        chmod +x "$folder/$program"
    done
    PYTHONPATH=bench/suite python3 -c 'import json, machine; print(json.dumps(machine.built() | {"packages": {}}))' \
        >"$folder/build/brought.json"
    cat >"$folder/run" <<'END'
#!/bin/sh
# Prints the results of the part `gpu`: run [full|quick|smoke]. Ends with 77 if there is no NVIDIA GPU, or no CuPy.
exec python3 "$(dirname "$0")/bench/suite" alone "${1:-full}" gpu
END
    chmod +x "$folder/run"
    du -sh "$folder"
}

mode=${1:-full}
case $mode in
report | list | aims) exec /usr/bin/python3 bench/suite "$mode" ;;
pack)
    if [[ -z ${ABACUS_BUILT:-} ]]; then
        scripts/install-dependencies.sh test
        build_release oracle_points core_in_memory
    fi
    pack
    exit
    ;;
full | quick | smoke) shift $(($# > 0)) ;;
*) fail "usage: $0 [full|quick|smoke] [PART...], or $0 report|list|aims|pack" ;;
esac

if [[ -z ${ABACUS_BUILT:-} ]]; then
    if [[ $mode == smoke ]]; then packages=test; else packages=bench; fi
    scripts/install-dependencies.sh "$packages"
    build_release oracle_points bench_comparators abacus_benchmarks core_in_memory
    install_extension
fi
cluster_start bench
run_psql -c "CREATE EXTENSION abacus" -c "CREATE EXTENSION abacus_lab"
/usr/bin/python3 bench/suite "$mode" "$@"
