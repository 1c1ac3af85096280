#!/bin/bash
# Measures Abacus in PostgreSQL against CGAL in core, side by side: every
# figure that the README quotes. PostgreSQL has its default settings, WAL on.
#
#   bench.sh [-d DIMENSION] [-s DATA SET] [-n RUNS] [-c "CACHE SIZES"] [SIZE...]
#   bench.sh smoke       a run of seconds, to see that everything works
#
# For each size: seconds of CGAL (read, spatial_sort, insert; same compiler
# flags as the core) and of abacus_triangulate(text, text) from a fresh table to
# the committed mesh, in turns, medians; their ratio; the largest private memory
# of the backend; the ratio of the first cache size to the last; bytes a simplex on
# disk. Then locations a second in a warm mesh (up to a million points), and how
# long a cancel takes. Cache sizes are in MB, or smallest, default or largest (which
# is no limit in practice). Data sets are those of oracle_points.
set -euo pipefail
. "$(dirname "$0")/common.sh"
. scripts/cluster.sh
. scripts/points.sh

dimension=2 set=uniform runs=5 caches="" sizes=() locations=1000000
while getopts d:s:n:c: option; do
    case $option in
    d) dimension=$OPTARG ;;
    s) set=$OPTARG ;;
    n) runs=$OPTARG ;;
    c) caches=$OPTARG ;;
    *) fail "usage: $0 [-d DIMENSION] [-s DATA SET] [-n RUNS] [-c CACHES] [SIZE...]" ;;
    esac
done
shift $((OPTIND - 1))
sizes=("$@")
columns=$(coordinates "$dimension")
if ((dimension == 2)); then
    caches=${caches:-8 64}
    if ((${#sizes[@]} == 0)); then sizes=(1000000 10000000); fi
else
    caches=${caches:-16 default largest}
    if ((${#sizes[@]} == 0)); then sizes=(1000000); fi
fi
if [[ ${sizes[0]} == smoke ]]; then
    runs=1 caches="smallest largest" sizes=($((dimension == 2 ? 50000 : 20000))) locations=50000
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
    run_psql -c "DROP TABLE IF EXISTS mesh, mesh_vertices, points" 2>/dev/null
    create_points "$dimension" "$1"
    run_psql -c "VACUUM ANALYZE points" -c "CHECKPOINT"
}

triangulate="SELECT abacus_triangulate('mesh', 'SELECT id, $columns FROM points',
                                       dimension => $dimension)"

# Builds the mesh with a cache of size $1; sets `seconds` and `peak_kb`.
build_mesh() {
    local cache_mb
    cache_mb=$(cache_size "$1")
    run_psql -A -t >"$folder/out" <<SQL &
SET abacus.cache_size = '${cache_mb}MB';
SELECT pg_backend_pid();
SELECT pg_sleep(0.1);
\\timing on
$triangulate;
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
    local size=$1 cache run cgal points
    "$tools/test/oracle/oracle_points" "$dimension" "$set" "$size" raw >"$folder/points.raw"
    "$tools/test/oracle/oracle_points" "$dimension" "$set" "$size" copy >"$folder/points.copy"
    rm -f "$folder"/seconds.* "$folder"/peaks.*
    for ((run = 0; run < runs; run++)); do
        "$tools/bench/bench_cgal" "$dimension" "$folder/points.raw" | awk '{print $4}' \
            >>"$folder/seconds.cgal"
        for cache in $caches; do
            fresh_table "$folder/points.copy"
            build_mesh "$cache"
            echo "$seconds" >>"$folder/seconds.$cache"
            echo "$peak_kb" >>"$folder/peaks.$cache"
        done
    done
    cgal=$(median <"$folder/seconds.cgal")
    points=$(run_psql -A -t -c "SELECT value FROM abacus_stats('mesh') WHERE name = 'points'")
    printf '%s points in %dD, %s, median of %s\n' "$points" "$dimension" "$set" "$runs"
    printf '  %-42s %8.3f s\n' "CGAL in core" "$cgal"
    for cache in $caches; do
        awk -v name="Abacus, table to commit, cache $cache" -v cgal="$cgal" \
            -v s="$(median <"$folder/seconds.$cache")" \
            -v peak="$(sort -g "$folder/peaks.$cache" | tail -n 1)" 'BEGIN {
                printf "  %-42s %8.3f s  ratio %.2f  private memory %.0f MB\n",
                    name, s, s / cgal, peak / 1024 }'
    done
    if [[ $caches == *" "* ]]; then
        awk -v a="${caches%% *}" -v b="${caches##* }" \
            -v s="$(median <"$folder/seconds.${caches%% *}")" \
            -v t="$(median <"$folder/seconds.${caches##* }")" \
            'BEGIN { printf "  cache %s against cache %s: ratio %.2f\n", a, b, s / t }'
    fi
    run_psql -A -t -c "
        SELECT format('  %s simplices; on disk %s bytes a simplex; vertex table %s bytes a point',
                      s.simplices, round(s.bytes_per_simplex, 1),
                      round((s.vertex_table_bytes + s.vertex_index_bytes) / s.points, 1))
        FROM (SELECT jsonb_object_agg(name, value) AS stats FROM abacus_stats('mesh')) AS t,
             jsonb_to_record(stats) AS s(simplices bigint, points bigint, bytes_per_simplex numeric,
                 vertex_table_bytes numeric, vertex_index_bytes numeric)"
}

# Random places of the box around the points; those outside the hull count as well.
measure_location() {
    run_psql -A -t >"$folder/out" <<SQL
SET abacus.cache_size = '1GB';
CREATE TEMP TABLE probes AS
    SELECT $(sed -E 's/([xyz])/low_\1 + random() * (high_\1 - low_\1) AS \1/g' <<<"$columns")
    FROM generate_series(1, $locations),
         (SELECT $(sed -E 's/([xyz])/min(\1) AS low_\1, max(\1) AS high_\1/g' <<<"$columns")
          FROM points) AS box;
SELECT count(abacus_locate('mesh', $columns)) FROM probes;
\\timing on
SELECT count(abacus_locate('mesh', $columns)) FROM probes;
SQL
    awk -v n="$locations" '/^Time:/ {printf "  abacus_locate, random places, warm: %.0f a second\n", n * 1000 / $2}' \
        "$folder/out"
}

# Cancels builds at several moments of their run; prints the longest wait.
measure_cancel() {
    local part client cancelled worst=0 wait_ms
    for part in 0.03 0.1 0.25 0.4 0.6 0.8 0.95; do
        run_psql -c "DROP TABLE IF EXISTS mesh, mesh_vertices" 2>/dev/null
        PGAPPNAME=victim run_psql -c "$triangulate" \
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
