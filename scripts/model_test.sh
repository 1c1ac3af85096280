#!/bin/bash
# Do meshes stay correct when points come and go? Random changes of random points in random transactions,
# compared with a plain table of the expected points, with CGAL, and with abacus_check; scripts/model_test.py
# has the details.
#
#   model_test.sh [lines|track] [-t seconds] [-n worlds] [-s seed] [-w world]
#
# With `lines`, points, lines and regions of a mesh come and go, compared with a fresh mesh (scripts/model_lines.py); with
# `track`, rows of tables of points and lines that a mesh follows (scripts/model_track.py), which needs PostGIS.
# Ends after that time (default 60 s), or after that many worlds. A failure prints the seed and the number of
# the world; -s and -w run that world again.
set -euo pipefail
. "$(dirname "$0")/common.sh"
. scripts/cluster.sh

oracle=$ABACUS_BUILD/release/test/oracle/oracle_compare
if [[ ! -x $oracle || -z ${ABACUS_BUILT:-} ]]; then
    scripts/install-dependencies.sh test
    build_release oracle_compare
    install_extension
fi
case ${1:-} in
lines) name=model_lines ;;
track) name=model_track ;;
*) name=model_test ;;
esac
folder=$ABACUS_BUILD/$name
cluster_start "$name"
run_psql -c "CREATE EXTENSION abacus"
mkdir -p "$folder"
if [[ $name == model_track ]]; then run_psql -c "CREATE EXTENSION abacus_postgis CASCADE"; fi
if [[ $name != model_test ]]; then
    "scripts/$name.py" ${ABACUS_SEED:+-s "$ABACUS_SEED"} --folder "$folder" "${@:2}"
else
    scripts/model_test.py ${ABACUS_SEED:+-s "$ABACUS_SEED"} --oracle "$oracle" --folder "$folder" "$@"
fi
