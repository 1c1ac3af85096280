#!/bin/bash
# The demonstration: all shorelines, borders and rivers of the world, 14.35
# million points, become a triangulation inside a throw-away PostgreSQL cluster,
# in which we then locate, walk, and check; and a mountain range becomes a shaded
# terrain. Pictures are left in build/demo.
#
#   demo.sh          everything (a few minutes)
#   demo.sh quick    shorelines at a fifth of the resolution
set -euo pipefail
. "$(dirname "$0")/common.sh"
. scripts/cluster.sh

resolution=f
if [[ ${1:-} == quick ]]; then resolution=h; fi
pictures=$ABACUS_BUILD/demo
summary=()

now() { date +%s.%N; }

# timed LABEL COMMAND...: runs it and notes its seconds for the closing table.
timed() {
    local label=$1 start
    shift
    start=$(now)
    "$@"
    summary+=("$(awk -v l="$label" -v a="$start" -v b="$(now)" 'BEGIN {printf "%-58s %9.2f s", l, b - a}')")
}

note() {
    summary+=("$(printf '%-58s %11s' "$1" "$2")")
}

value() { run_psql -A -t -c "$1"; }

# Shows abacus_progress from another session, once a second, while $1 lives.
show_progress() {
    local client=$1 line
    sleep 1
    while kill -0 "$client" 2>/dev/null; do
        line=$(value "SELECT format('  %-9s %9s of %-9s %8s a second %5s s left   %s pages read, %s written',
                                    phase, done, coalesce(total::text, '?'), round(per_second),
                                    coalesce(round(extract(epoch FROM time_left))::text, '?'),
                                    pages_read, pages_written)
                      FROM abacus_progress LIMIT 1")
        if [[ -n $line ]]; then echo "$line"; fi
        sleep 1
    done
}

# with_progress SQL: runs it in one session while another one watches.
with_progress() {
    run_psql -c "$1" &
    local client=$!
    show_progress "$client"
    wait "$client"
}

# draw FILE SQL: the bytea that the query yields becomes a picture.
draw() {
    value "SELECT encode(png, 'base64') FROM ($2) AS drawing(png)" | base64 -d >"$pictures/$1"
    echo "  build/demo/$1  $(stat -c %s "$pictures/$1") bytes"
}

load_shorelines() {
    run_psql -c "CREATE TABLE shorelines_points (id bigint, lon float8, lat float8)"
    scripts/gshhg_points.py "$resolution" |
        run_psql -c "COPY shorelines_points FROM STDIN (FORMAT binary)"
}

load_terrain() {
    run_psql -c "CREATE TABLE terrain_points (id bigint, x float8, y float8, height float8)"
    scripts/terrain_points.py | run_psql -c "COPY terrain_points FROM STDIN"
}

scripts/install-dependencies.sh demo
heading "Building and installing the extension"
timed "build and install the extension" install_extension
mkdir -p "$pictures"
cluster_start demo
run_psql -c "CREATE EXTENSION abacus"

heading "The shorelines of the world"
timed "load the points with COPY" load_shorelines
timed "triangulate them: stage, insert, commit" with_progress \
    "SELECT abacus_triangulate('shorelines', 'SELECT id, lon, lat FROM shorelines_points') AS triangles"

heading "Which triangle holds the harbour of Bergen? And its neighbours?"
timed "locate and walk" run_psql <<'SQL'
SELECT * FROM abacus_locate('shorelines', 5.3185, 60.3990);
SELECT facet, neighbour.*
FROM abacus_locate('shorelines', 5.3185, 60.3990) AS here,
     generate_series(0, 2) AS facet,
     LATERAL abacus_walk('shorelines', here, facet) AS neighbour;
SQL

heading "A hundred thousand places, located one by one"
timed "locate 100,000 points of the table" run_psql <<'SQL'
SELECT count(abacus_locate('shorelines', lon + 0.001, lat + 0.001)) AS located
FROM (SELECT * FROM shorelines_points WHERE id % 100 = 0 LIMIT 100000) AS sample;
SQL

heading "Exact verification of every triangle"
timed "check the mesh" with_progress "SELECT count(*) AS faults FROM abacus_check('shorelines')"

heading "The Jacksboro fault as a terrain"
timed "load the elevation model" load_terrain
timed "triangulate it" run_psql -c \
    "SELECT abacus_triangulate('terrain', 'SELECT id, x, y, height FROM terrain_points') AS triangles"

heading "Pictures"
timed "draw the world, all of its triangles" draw world.png \
    "SELECT abacus_draw('shorelines', width => 1600)"
timed "draw the Aegean" draw aegean.png \
    "SELECT abacus_draw('shorelines', width => 1200, lower => '{22.5,35.2}', upper => '{28.5,40.6}')"
timed "draw the fjords around Bergen, short edges only" draw fjords.png \
    "SELECT abacus_draw('shorelines', width => 1200, lower => '{4.7,59.9}', upper => '{6.7,61.1}', max_edge => 0.12)"
timed "draw the terrain, shaded" draw terrain.png \
    "SELECT abacus_draw('terrain', width => 1200, attribute => 'height', edges => false, exaggeration => 2)"

note "points of the shorelines" "$(value 'SELECT count(*) FROM shorelines_points')"
note "triangles" "$(value "SELECT count(*) FROM abacus_simplices('shorelines')")"
note "the table of points" "$(value "SELECT pg_size_pretty(pg_total_relation_size('shorelines_points'))")"
note "simplex pages with index" "$(value "SELECT pg_size_pretty(pg_total_relation_size('shorelines'))")"
note "vertex pages with index" "$(value "SELECT pg_size_pretty(pg_total_relation_size('shorelines_vertices'))")"
heading "Times and sizes"
printf '%s\n' "${summary[@]}"
