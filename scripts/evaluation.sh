#!/bin/bash
# Repeats the measurements of chapter 5 of the dissertation, and writes the results beside its figures.
#
#   evaluation.sh quick [PART...]    minutes; into build/evaluation-results/quick/evaluation.md
#   evaluation.sh full [PART...]     all sizes; into docs/evaluation.md
#   evaluation.sh smoke              seconds, to see that everything works
#   evaluation.sh report             docs/evaluation.md anew from the results that are there
#   evaluation.sh list               the parts, and about how long each takes
#
# Each part leaves a file of results when it has ended. So after an interrupted run, name the remaining parts.
# Parts without enough room on the disk are skipped, with a message. Control groups with limited memory are
# made by root (or sudo).
set -euo pipefail
. "$(dirname "$0")/common.sh"
. scripts/cluster.sh

mode=${1:-quick}
case $mode in
quick | full | smoke | report | list) shift $(($# > 0)) ;;
*) fail "usage: $0 [quick|full|smoke|report|list] [PART...]" ;;
esac
if [[ $mode != list && $mode != report ]]; then
    if [[ -z ${ABACUS_BUILT:-} ]]; then
        if [[ $mode == smoke ]]; then packages=test; else packages=bench; fi
        scripts/install-dependencies.sh "$packages"
        build_release oracle_points bench_cgal bench_tetgen bench_qhull io_trace probing_statistics
        install_extension
    fi
    cluster_start evaluation
    run_psql -c "CREATE EXTENSION abacus" -c "CREATE EXTENSION abacus_lab"
fi
PYTHONPATH=bench/suite /usr/bin/python3 bench/evaluation "$mode" "$@"
