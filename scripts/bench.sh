#!/bin/bash
# The benchmark suite: every figure of docs/benchmarks.md, and the page itself.
#
#   bench.sh [full] [PART...]   measures all parts, or the named ones anew; the results go into
#                               docs/benchmarks/results.json, docs/benchmarks.md is made of them
#   bench.sh quick [PART...]    the same with fewer points and runs, in minutes
#   bench.sh smoke [PART...]    with very few, in seconds, to see that everything works
#   bench.sh report             makes docs/benchmarks.md from the results that are there
#   bench.sh list               the parts, and how long each takes in the full mode
#
# The results and the page of quick and smoke are in build/bench-results/quick and smoke. Abacus and all other
# engines get the same points, in turns; the server is a fresh one with default settings unless a part says
# otherwise. bench/suite does the work.
set -euo pipefail
. "$(dirname "$0")/common.sh"
. scripts/cluster.sh

mode=${1:-full}
case $mode in
report | list) exec python3 bench/suite "$mode" ;;
full | quick | smoke) shift $(($# > 0)) ;;
*) fail "usage: $0 [full|quick|smoke] [PART...], or $0 report|list" ;;
esac

if [[ -z ${ABACUS_BUILT:-} ]]; then
    if [[ $mode == smoke ]]; then packages=test; else packages=bench; fi
    scripts/install-dependencies.sh "$packages"
    build_release oracle_points bench_comparators abacus_benchmarks
    install_extension
fi
cluster_start bench
run_psql -c "CREATE EXTENSION abacus" -c "CREATE EXTENSION abacus_lab"
python3 bench/suite "$mode" "$@"
