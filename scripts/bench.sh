#!/bin/bash
# Measures Abacus in PostgreSQL against CGAL in core, side by side: every
# figure that the README quotes. PostgreSQL has its default settings, WAL on.
#
#   bench.sh [-n RUNS] [-c "CACHE SIZES IN MB"] [SIZE...]
#   bench.sh smoke       a run of seconds, to see that everything works
#
# For each size: seconds of CGAL (read, spatial_sort, insert; same compiler
# flags as the core) and of abacus_triangulate(text, text) from a fresh table to
# the committed mesh, in turns, medians; their ratio; the largest private memory
# of the backend; bytes a triangle on disk. Then locations a second in a warm
# mesh (up to a million points), and how long a cancel takes.
set -euo pipefail
. "$(dirname "$0")/common.sh"
. scripts/cluster.sh

runs=5 caches="8 64" sizes=() locations=1000000
while getopts n:c: option; do
    case $option in
    n) runs=$OPTARG ;;
    c) caches=$OPTARG ;;
    *) fail "usage: $0 [-n RUNS] [-c CACHES] [SIZE...]" ;;
    esac
done
shift $((OPTIND - 1))
sizes=("$@")
if ((${#sizes[@]} == 0)); then sizes=(1000000 10000000); fi
if [[ ${sizes[0]} == smoke ]]; then
    runs=1 caches=8 sizes=(50000) locations=50000
fi

folder=$ABACUS_BUILD/bench
tools=$ABACUS_BUILD/release

median() {
    sort -g | awk '{a[NR] = $1} END {print NR % 2 ? a[(NR + 1) / 2] : (a[NR / 2] + a[NR / 2 + 1]) / 2}'
}

# Largest RssAnon of process $1 (kB) while it lives, to standard output.
watch_memory() {
    local key value peak=0
    while [[ -r /proc/$1/status ]]; do
        while read -r key value _; do
            if [[ $key == RssAnon: ]] && ((value > peak)); then peak=$value; fi
        done 2>/dev/null <"/proc/$1/status" || break
        sleep 0.02
    done
    echo "$peak"
}

# A fresh table of the points of file $1, settled so that no earlier work is
# charged to the run.
fresh_table() {
    run_psql -c "DROP TABLE IF EXISTS mesh, mesh_vertices, points" \
        -c "CREATE TABLE points (id bigint, x float8, y float8)" 2>/dev/null
    run_psql -c "COPY points FROM STDIN (FORMAT binary)" <"$1"
    run_psql -c "VACUUM ANALYZE points" -c "CHECKPOINT"
}

# Builds the mesh with a cache of $1 MB; sets `seconds` and `peak_kb`.
build_mesh() {
    run_psql -A -t >"$folder/out" <<SQL &
SET abacus.cache_size = '${1}MB';
SELECT pg_backend_pid();
SELECT pg_sleep(0.1);
\\timing on
SELECT abacus_triangulate('mesh', 'SELECT id, x, y FROM points');
SQL
    local client=$! backend=
    while [[ -z $backend ]]; do
        sleep 0.01
        kill -0 "$client" 2>/dev/null || break
        backend=$(head -n 1 "$folder/out")
    done
    watch_memory "$backend" >"$folder/peak" &
    wait "$client" || fail "abacus_triangulate failed"
    wait $!
    seconds=$(awk '/^Time:/ {print $2 / 1000}' "$folder/out")
    peak_kb=$(<"$folder/peak")
}

compare_builds() {
    local size=$1 cache run
    "$tools/test/oracle/oracle_points" uniform "$size" raw >"$folder/points.raw"
    "$tools/test/oracle/oracle_points" uniform "$size" copy >"$folder/points.copy"
    rm -f "$folder"/seconds.*
    for ((run = 0; run < runs; run++)); do
        "$tools/bench/bench_cgal" "$folder/points.raw" | awk '{print $4}' >>"$folder/seconds.cgal"
        for cache in $caches; do
            fresh_table "$folder/points.copy"
            build_mesh "$cache"
            echo "$seconds" >>"$folder/seconds.$cache"
            echo "$peak_kb" >>"$folder/peaks.$cache"
        done
    done
    local cgal
    cgal=$(median <"$folder/seconds.cgal")
    printf '%s uniform points, median of %s\n' "$size" "$runs"
    printf '  %-34s %8.3f s\n' "CGAL in core" "$cgal"
    for cache in $caches; do
        awk -v name="Abacus, table to commit, ${cache} MB" -v cgal="$cgal" \
            -v s="$(median <"$folder/seconds.$cache")" \
            -v peak="$(sort -g "$folder/peaks.$cache" | tail -n 1)" 'BEGIN {
                printf "  %-34s %8.3f s  ratio %.2f  private memory %.0f MB\n",
                    name, s, s / cgal, peak / 1024 }'
    done
    rm -f "$folder"/peaks.*
    run_psql -A -t -F ' ' -c "
        WITH n AS (SELECT count(*) AS triangles FROM abacus_simplices('mesh'))
        SELECT format('  %s triangles; on disk %s bytes a triangle (simplices and index %s, vertices and index %s)',
                      triangles, round((s + v)::numeric / triangles, 1),
                      round(s::numeric / triangles, 1), round(v::numeric / triangles, 1))
        FROM n, (VALUES (pg_total_relation_size('mesh'), pg_total_relation_size('mesh_vertices'))) AS t(s, v)"
}

measure_location() {
    run_psql -A -t >"$folder/out" <<SQL
SET abacus.cache_size = '256MB';
CREATE TEMP TABLE probes AS
    SELECT random() AS x, random() AS y FROM generate_series(1, $locations);
SELECT count(abacus_locate('mesh', x, y)) FROM probes;
\\timing on
SELECT count(abacus_locate('mesh', x, y)) FROM probes;
SQL
    awk -v n="$locations" '/^Time:/ {printf "  abacus_locate, random points, warm: %.0f a second\n", n * 1000 / $2}' \
        "$folder/out"
}

# Cancels builds at several moments of their run; prints the longest wait.
measure_cancel() {
    local part client cancelled worst=0 wait_ms
    for part in 0.03 0.1 0.25 0.4 0.6 0.8 0.95; do
        run_psql -c "DROP TABLE IF EXISTS mesh, mesh_vertices" 2>/dev/null
        PGAPPNAME=victim run_psql -c "SELECT abacus_triangulate('mesh', 'SELECT id, x, y FROM points')" \
            >/dev/null 2>"$folder/out" &
        client=$!
        sleep "$(awk -v p="$part" -v s="$seconds" 'BEGIN {print p * s}')"
        cancelled=$(date +%s%N)
        run_psql -A -t -o /dev/null -c "SELECT pg_cancel_backend(pid) FROM pg_stat_activity
                                        WHERE application_name = 'victim' AND state = 'active'"
        wait "$client" || true
        wait_ms=$((($(date +%s%N) - cancelled) / 1000000))
        if grep -q 'canceling statement' "$folder/out"; then
            [[ $(run_psql -A -t -c "SELECT to_regclass('mesh') IS NULL") == t ]] ||
                fail "a cancelled build left a mesh behind"
            if ((wait_ms > worst)); then worst=$wait_ms; fi
        fi
    done
    printf '  longest wait for a cancel: %d ms\n' "$worst"
}

if [[ -z ${ABACUS_BUILT:-} ]]; then
    scripts/install-dependencies.sh test
    build_release oracle_points bench_cgal
    install_extension
fi
cluster_start bench
mkdir -p "$folder"
run_psql -c "CREATE EXTENSION abacus"
for size in "${sizes[@]}"; do
    compare_builds "$size"
    if ((size <= 1000000)); then measure_location; fi
    measure_cancel
done
rm -rf "$folder"
