#!/bin/bash
# Measures changes of a finished mesh in PostgreSQL: many points in one statement beside the
# first build, single points in transactions of their own, deletion beside CGAL's, and what
# changes cost in WAL and space.
#
#   edit_bench.sh [-d DIMENSION] [-n RUNS] [POINTS]      1,000,000 by default
#
# Times are medians of RUNS (3). The single points are timed with fsync off, as what is
# measured is the change and not the disk.
set -euo pipefail
. "$(dirname "$0")/common.sh"
. scripts/cluster.sh
. scripts/points.sh

dimension=2 runs=3
while getopts d:n: option; do
    case $option in
    d) dimension=$OPTARG ;;
    n) runs=$OPTARG ;;
    *) fail "usage: $0 [-d DIMENSION] [-n RUNS] [POINTS]" ;;
    esac
done
shift $((OPTIND - 1))
points=${1:-1000000}
columns=$(coordinates "$dimension")
folder=$ABACUS_BUILD/edit_bench
mkdir -p "$folder"

median() {
    sort -g | awk '{a[NR] = $1} END {print a[int((NR + 1) / 2)]}'
}

# Milliseconds that statement $1 takes, commit included, on the mesh that $2 makes anew.
milliseconds() {
    run_psql -A -t -c "DROP TABLE IF EXISTS mesh, mesh_vertices CASCADE" -c "$2" -c CHECKPOINT \
        -c '\timing on' -c "$1" 2>/dev/null | sed -n 's/^Time: \([0-9.]*\) ms.*/\1/p' | tail -n 1
}

# The same, a median.
timed() {
    local run
    for ((run = 0; run < runs; run++)); do milliseconds "$1" "$2"; done | median
}

# Median latency, in milliseconds, of $2 transactions of the statement $1.
latency() {
    rm -f "$folder"/log.*
    printf '%s\n' '\set n random(1, 2000000000)' "$1" >"$folder/statement"
    pgbench -n -t "$2" -f "$folder/statement" -l --log-prefix="$folder/log" >/dev/null 2>&1
    awk '{print $3 / 1000}' "$folder"/log.* | median
}

query() {
    run_psql -A -t -c "$1"
}

if [[ ${ABACUS_BUILT:-} != 1 ]]; then
    scripts/install-dependencies.sh test
    build_release
    install_extension
fi
cluster_start edit_bench
run_psql -o /dev/null -c "CREATE EXTENSION abacus" -c "SELECT setseed(0.25)" -c "CREATE TABLE points AS
    SELECT i AS id, random() AS x, random() AS y, random() AS z
    FROM generate_series(1, 2 * $points) AS i"
run_psql -c "VACUUM ANALYZE points"

make="SELECT abacus_triangulate('mesh', 'SELECT id, $columns FROM points WHERE id <= $points',
                                dimension => $dimension)"
half="SELECT id, $columns FROM points WHERE id <= $points AND id % 2 = 0"
heading "$points points in dimension $dimension, medians of $runs"
built=$(timed "$make" "SELECT 1")
inserted=$(timed "SELECT abacus_insert('mesh', 'SELECT id, $columns FROM points WHERE id > $points')" "$make")
deleted=$(timed "SELECT abacus_delete('mesh', '$half')" "$make")
echo "build: $built ms"
echo "as many again by one abacus_insert: $inserted ms, $(echo "scale=2; $inserted / $built" | bc) of the build"
echo "half of them by one abacus_delete: $deleted ms"
echo "CGAL's remove of half of 1,000,000, the same in core (along the curve, at random):"
build/release/bench/abacus_benchmarks --benchmark_filter="CgalRemove<$dimension>" \
    --benchmark_format=csv 2>/dev/null | awk -F, '/^"/ {print "  " $1 ": " $3 " ms"}'

heading "WAL and space"
query "DROP TABLE IF EXISTS mesh CASCADE" 2>/dev/null
query "$make" >/dev/null
fresh=$(query "SELECT pg_total_relation_size('mesh') + pg_total_relation_size('mesh_vertices')")
start=$(query "SELECT pg_current_wal_insert_lsn()")
# In one session: it gives the space of its own earlier statements back.
for part in 0 1 2 3 4 5 6 7 8 9; do
    where="WHERE hashint8(id) & 1023 BETWEEN $part * 51 AND $part * 51 + 50"
    echo "SELECT abacus_delete('mesh', 'SELECT id, $columns FROM points $where AND id <= $points');"
    echo "SELECT abacus_insert('mesh', 'SELECT id, $columns FROM points $where AND id > $points');"
done | run_psql >/dev/null
changed=$(query "SELECT count(*) FROM points WHERE hashint8(id) & 1023 < 510")
wal=$(query "SELECT pg_current_wal_insert_lsn() - '$start'")
grown=$(query "SELECT pg_total_relation_size('mesh') + pg_total_relation_size('mesh_vertices')")
run_psql -c "VACUUM mesh, mesh_vertices"
vacuumed=$(query "SELECT pg_total_relation_size('mesh') + pg_total_relation_size('mesh_vertices')")
echo "$changed points, half of them deleted and half inserted, at random places in 20 statements:"
echo "WAL: $(echo "$wal / $changed" | bc) bytes a point; both tables: fresh $fresh, after $grown, after VACUUM $vacuumed bytes, $(echo "scale=2; $vacuumed / $fresh" | bc) of fresh"
query "SELECT 'faults: ' || count(*) FROM abacus_check('mesh')"

heading "single points, each its own transaction, fsync off; median of 5000"
run_psql -c "ALTER SYSTEM SET fsync = off" -c "SELECT pg_reload_conf()" >/dev/null
place="(:n % 99991) / 99991.0, (:n % 77773) / 77773.0"
if ((dimension == 3)); then place+=", (:n % 55541) / 55541.0"; fi
echo "abacus_insert: $(latency "SELECT abacus_insert('mesh', 'SELECT 3000000000 + :n, $place');" 5000) ms"
query "CREATE TABLE victims AS SELECT row_number() OVER (ORDER BY hashint8(id)) AS number, id, $columns
       FROM points WHERE id <= $points AND hashint8(id) & 1023 >= 510" >/dev/null
query "CREATE UNIQUE INDEX ON victims (number)"
query "CREATE SEQUENCE next_victim"
echo "abacus_delete: $(latency "SELECT abacus_delete('mesh', format('SELECT id, $columns FROM victims WHERE number = %s', nextval('next_victim')));" 5000) ms"
query "SELECT 'faults: ' || count(*) FROM abacus_check('mesh')"
