#!/bin/bash
# The cache statistics of the dissertation's §5.6 and §5.7, beside its own figures.
#
#   statistics.sh [POINTS IN 2D [POINTS IN 3D]]
#
# Uniform points in 2D, the nearest earthquake data set in 3D, a million of each unless
# said. The upper rows are those of abacus_stats after abacus_triangulate. Stored
# links make a miss one search; so the lower rows come from a run of the core
# without them (bench/probing_statistics), in which each miss is probed for as §4.10
# has it. The dissertation's 1.3 M points in 3D fitted its cache: its column beside is
# the next larger set.
set -euo pipefail
. "$(dirname "$0")/common.sh"
. scripts/cluster.sh
. scripts/points.sh

size2=${1:-1000000} size3=${2:-1000000}
folder=$ABACUS_BUILD/statistics
tools=$ABACUS_BUILD/release

rows=(
    ""
    "points"
    "simplices"
    "simplices deleted an insertion (§5.3.2)"
    "simplices created an insertion (§5.3.2)"
    "walk attempts: links followed (§5.6)"
    "cache hit ratio"
    "incircle cache hit ratio"
    "time between pages and memory (§5.7)"
    "cache misses, links stored"
    "page searches a miss"
    "cache misses, links not stored (§5.7)"
    "served by a quick probe"
    "served by a ray-casting probe"
    "served by a concentric probe"
    "pages read a miss"
)

# One column of the table a file, one row a line. The dissertation's: Figures 5.7, 5.8 and
# 5.17 to 5.20. Its time is that spent in hash tables, measured with 40 M points.
dissertation_2d() {
    printf '%s\n' "dissertation, 8 MB" "1 M" "2 M" 4.7 6.6 "11 M" "99.9948 %" "81.88 %" "47 %" - - \
        596 "67.79 %" "31.54 %" "0.67 %" -
}
dissertation_3d() {
    printf '%s\n' "dissertation, 6 GB" "1.3 M" "7 M" 36.1 41.6 "118 M" "100 %" "92.28 %" - - - 0 - - - -
}
dissertation_3d_larger() {
    printf '%s\n' "dissertation, 6 GB" "11.3 M" "63.4 M" 36.1 41.6 "1.1 B" "99.99958 %" "92.29 %" - - - \
        4459 "50.93 %" "42.52 %" "6.55 %" -
}

# What abacus_stats says of a mesh of the table points, built with a cache of size $2.
measured() {
    local cache
    cache=$(cache_size "$2")
    run_psql -o /dev/null -c "SET abacus.cache_size = '${cache}MB'" \
        -c "SELECT abacus_triangulate('mesh', 'SELECT id, $(coordinates "$1") FROM points',
                                      dimension => $1)"
    run_psql -A -t <<'SQL'
SELECT concat_ws(E'\n', to_char(points, 'FM999,999,999,999'), to_char(simplices, 'FM999,999,999,999'),
                 round(deleted / insertions, 1), round(created / insertions, 1),
                 to_char(steps, 'FM999,999,999,999'),
                 round(100 * (1 - misses / steps), 5) || ' %',
                 round(100 * incircle_hits / incircle_tests, 2) || ' %',
                 round(100 * translation_ns / total_ns) || ' %',
                 misses, coalesce(round(link_probes / nullif(misses, 0), 2)::text, '-'))
FROM (SELECT jsonb_object_agg(name, value) AS stats FROM abacus_stats('mesh')) AS t,
     jsonb_to_record(stats) AS s(points numeric, simplices numeric, insertions numeric,
         deleted numeric, created numeric, steps numeric, misses numeric, incircle_hits numeric,
         incircle_tests numeric, translation_ns numeric, total_ns numeric, link_probes numeric);
SQL
    run_psql -c "DROP TABLE mesh, mesh_vertices"
    "$tools/bench/probing_statistics" "$1" "$folder/points.raw" "$cache" | awk '
        { value[$1] = $2 }
        function share(kind) {
            return value["misses"] ? sprintf("%.2f %%", 100 * value["served_" kind] / value["misses"]) : "-"
        }
        END {
            pages = value["pages_quick"] + value["pages_ray"] + value["pages_concentric"]
            printf "%d\n%s\n%s\n%s\n%s\n", value["misses"], share("quick"), share("ray"),
                share("concentric"), value["misses"] ? sprintf("%.2f", pages / value["misses"]) : "-"
        }'
}

# A table for points of dimension $1, data set $2, size $3; the other words are columns:
# the dissertation's, then cache sizes.
table() {
    local dimension=$1 set=$2 size=$3 word columns=()
    heading "${dimension}D: $set points"
    "$tools/test/oracle/oracle_points" "$dimension" "$set" "$size" raw >"$folder/points.raw"
    "$tools/test/oracle/oracle_points" "$dimension" "$set" "$size" copy >"$folder/points.copy"
    create_points "$dimension" "$folder/points.copy"
    for word in "${@:4}"; do
        columns+=("$folder/column-${#columns[@]}")
        if [[ $word == dissertation* ]]; then
            "$word"
        else
            printf 'Abacus, %s\n' "$(sed -E 's/^[0-9]+$/& MB/' <<<"$word")"
            measured "$dimension" "$word"
        fi >"${columns[-1]}"
    done
    run_psql -c "DROP TABLE points"
    printf '%s\n' "${rows[@]}" | paste -d '|' - "${columns[@]}" | awk -F '|' '{
        # %-43s counts bytes; a § has two.
        printf "%-" (43 + gsub("§", "§", $1)) "s", $1
        for (i = 2; i <= NF; ++i) printf "%20s", $i
        print ""
    }'
}

if [[ -z ${ABACUS_BUILT:-} ]]; then
    scripts/install-dependencies.sh test
    build_release oracle_points probing_statistics
    install_extension
fi
cluster_start statistics
mkdir -p "$folder"
run_psql -c "CREATE EXTENSION abacus"
table 2 uniform "$size2" dissertation_2d 8 largest
table 3 quake "$size3" dissertation_3d dissertation_3d_larger 16 largest
rm -rf "$folder"
