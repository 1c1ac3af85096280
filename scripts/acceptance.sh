#!/bin/bash
# Are meshes equal to CGAL's triangulation, simplex by simplex, whatever the
# input, its order and the size of the cache? Goes through SQL from end to end:
# points with COPY into a table, abacus_triangulate, abacus_check, simplices
# with COPY out, oracle_compare.
#
#   acceptance.sh [quick|full] [DATA SET...]
#
# quick takes a minute or two, full (1 M to 14 M points a set) about an hour.
set -euo pipefail
. "$(dirname "$0")/common.sh"
. scripts/cluster.sh

mode=${1:-quick}
case $mode in
quick)
    sets=(uniform:100000 grid:100000 circle:20000 rounded_circle:20000 wheel:20000 lines:50000
        clusters:100000 exponents:5000 duplicates:100000)
    # cache (MB, or the smallest, largest or default size):order
    runs=(smallest:made default:shuffled largest:sorted smallest:reversed)
    ;;
full)
    sets=(uniform:1000000 grid:4000000 circle:100000 rounded_circle:100000 wheel:100000
        lines:1000000 clusters:1000000 exponents:20000 duplicates:1000000
        shorelines:0 uniform:10000000)
    runs=(smallest:made 8:made 64:made largest:made default:shuffled smallest:sorted 8:reversed)
    ;;
*) fail "usage: $0 [quick|full] [DATA SET...]" ;;
esac
if (($# > 1)); then
    wanted=" ${*:2} "
    for i in "${!sets[@]}"; do
        [[ $wanted == *" ${sets[i]%:*} "* ]] || unset "sets[$i]"
    done
fi

declare -A order_by=(
    [made]="" [shuffled]="ORDER BY hashint8(id), id"
    [sorted]="ORDER BY x, y, id" [reversed]="ORDER BY x DESC, y DESC, id"
)
folder=$ABACUS_BUILD/acceptance
oracle=$ABACUS_BUILD/release/test/oracle
compared=0 differing=0

# Cache size in MB for a word of `runs`.
cache_size() {
    case $1 in
    smallest) run_psql -A -t -c "LOAD 'abacus'" \
        -c "SELECT min_val FROM pg_settings WHERE name = 'abacus.cache_size'" ;;
    largest) run_psql -A -t -c "LOAD 'abacus'" \
        -c "SELECT max_val FROM pg_settings WHERE name = 'abacus.cache_size'" ;;
    default) run_psql -A -t -c "LOAD 'abacus'" \
        -c "SELECT boot_val FROM pg_settings WHERE name = 'abacus.cache_size'" ;;
    *) echo "$1" ;;
    esac
}

# One build of the table points: faults of abacus_check, then the comparison.
compare() {
    local cache=$1 order=$2 faults result start built checked
    start=${EPOCHREALTIME/./}
    run_psql -o /dev/null -c "SET abacus.cache_size = '${cache}MB'" \
        -c "SELECT abacus_triangulate('mesh', 'SELECT id, x, y FROM points ${order_by[$order]}')"
    built=${EPOCHREALTIME/./}
    faults=$(run_psql -A -t -c "SELECT * FROM abacus_check('mesh') LIMIT 3")
    checked=${EPOCHREALTIME/./}
    result=$(run_psql -c "COPY (SELECT code, v0, v1, v2 FROM abacus_simplices('mesh'))
                          TO STDOUT (FORMAT binary)" |
        ABACUS_ORACLE_FIRST_IDS=$([[ $order == made ]] && echo 1 || echo 0) \
            "$oracle/oracle_compare" 2 "$folder/points.copy" - "$folder/kept") || true
    run_psql -c "DROP TABLE mesh, mesh_vertices"
    compared=$((compared + 1))
    printf '%-15s cache %8s MB  %-8s  built in %6d ms, checked in %6d ms  %s\n' "$name" "$cache" \
        "$order" $(((built - start) / 1000)) $(((checked - built) / 1000)) "${result##*$'\n'}"
    if [[ ${result##*$'\n'} != equal:* || -n $faults ]]; then
        differing=$((differing + 1))
        printf '%s\n%s\n' "$result" "$faults"
    fi
}

if [[ ! -x $oracle/oracle_compare ]] || [[ -z ${ABACUS_BUILT:-} ]]; then
    scripts/install-dependencies.sh test
    build_release oracle_points oracle_compare
    install_extension
fi
cluster_start acceptance
run_psql -c "CREATE EXTENSION abacus"
mkdir -p "$folder"

for set in "${sets[@]}"; do
    name=${set%:*} size=${set#*:}
    rm -f "$folder/kept"
    if [[ $name == shorelines ]]; then
        scripts/gshhg_points.py f >"$folder/points.copy"
    else
        "$oracle/oracle_points" "$name" "$size" copy >"$folder/points.copy"
    fi
    run_psql -c "CREATE TABLE points (id bigint, x float8, y float8)"
    run_psql -c "COPY points FROM STDIN (FORMAT binary)" <"$folder/points.copy"
    for run in "${runs[@]}"; do
        compare "$(cache_size "${run%:*}")" "${run#*:}"
    done
    run_psql -c "DROP TABLE points"
done
rm -rf "$folder"
printf '%d meshes compared with CGAL, %d differ\n' "$compared" "$differing"
((differing == 0))
