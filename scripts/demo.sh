#!/bin/bash
# The demonstration, in a throw-away PostgreSQL cluster. In the plane, all shorelines, borders and rivers of
# the world, 14.35 million points, become a triangulation. The demo locates places in it, walks in it and
# checks it. A mountain range becomes a shaded terrain. In space, a million points of an earthquake model
# become tetrahedra, which give the ground under seismographs. Pictures are left in build/demo.
#
#   demo.sh [--view]        everything (a few minutes); --view then shows the meshes in a browser
#   demo.sh quick [--view]  shorelines at a fifth of the resolution, a coarser earthquake model
set -euo pipefail
. "$(dirname "$0")/common.sh"
. scripts/cluster.sh

resolution=f frequency=0.25 every=100 view=
for word in "$@"; do
    case $word in
    quick) resolution=h frequency=0.1 every=25 ;;
    --view) view=1 ;;
    *) fail "usage: $0 [quick] [--view]" ;;
    esac
done
pictures=$ABACUS_BUILD/demo
summary=()

now() { date +%s.%N; }

# timed LABEL COMMAND...: runs it and notes its seconds for the closing table.
timed() {
    local label=$1 start
    shift
    start=$(now)
    "$@"
    summary+=("$(awk -v l="$label" -v a="$start" -v b="$(now)" 'BEGIN {printf "%-60s %9.2f s", l, b - a}')")
}

note() {
    summary+=("$(printf '%-60s %11s' "$1" "$2")")
}

value() { run_psql -A -t -c "$1"; }

# Notes the stored size of mesh $1, whose points are in the table $1_points.
note_mesh() {
    note "$1: points" "$(value "SELECT count(*) FROM $1_points")"
    note "$1: simplices" "$(value "SELECT value FROM abacus_stats('$1') WHERE name = 'simplices'")"
    note "$1: the table of points" "$(value "SELECT pg_size_pretty(pg_table_size('$1_points'))")"
    note "$1: simplex pages with index" "$(value "SELECT pg_size_pretty(pg_total_relation_size('$1'))")"
    note "$1: vertex pages with index" \
        "$(value "SELECT pg_size_pretty(pg_total_relation_size('$1_vertices'))")"
}

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

# draw FILE SQL: writes the bytea from the query as a picture.
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

load_quake() {
    run_psql -c "CREATE TABLE quake_points AS SELECT (abacus_quake($frequency)).*" \
        -c "ALTER TABLE quake_points ADD PRIMARY KEY (id)"
}

if [[ -n $view ]]; then
    scripts/install-dependencies.sh view
    heading "Building the viewer"
    viewer/serve --build
else
    scripts/install-dependencies.sh demo
fi
heading "Building and installing the extension"
timed "build and install the extension" install_extension
mkdir -p "$pictures"
cluster_start demo
run_psql -c "CREATE EXTENSION abacus" -c "CREATE EXTENSION abacus_lab"

heading "The shorelines of the world"
timed "load the shorelines with COPY" load_shorelines
timed "triangulate the shorelines: stage, insert, commit" with_progress \
    "SELECT abacus_triangulate('shorelines', 'SELECT id, lon, lat FROM shorelines_points') AS triangles"
run_psql -c "SELECT abacus_set_srid('shorelines', 4326)" >/dev/null  # longitude and latitude

heading "Which triangle holds the harbour of Bergen? And its neighbours?"
timed "locate and walk" run_psql <<'SQL'
SELECT * FROM abacus_locate('shorelines', 5.3185, 60.3990);
SELECT facet, neighbour.*
FROM abacus_locate('shorelines', 5.3185, 60.3990) AS here,
     generate_series(0, 2) AS facet,
     LATERAL abacus_walk('shorelines', here, facet) AS neighbour;
SQL

heading "A hundred thousand places, located one by one"
timed "locate 100,000 places among the shorelines" run_psql <<SQL
SELECT count(abacus_locate('shorelines', lon + 0.001, lat + 0.001)) AS located
FROM (SELECT * FROM shorelines_points WHERE id % $every = 0 LIMIT 100000) AS sample;
SQL

heading "Exact verification of every triangle"
timed "check the shorelines" with_progress "SELECT count(*) AS faults FROM abacus_check('shorelines')"

heading "The Jacksboro fault as a terrain"
timed "load the elevation model" load_terrain
timed "triangulate the elevation model" run_psql -c \
    "SELECT abacus_triangulate('terrain', 'SELECT id, x, y, height FROM terrain_points') AS triangles"

heading "An earthquake model: points over a basin that resolve waves of $frequency Hz"
timed "make the points of the earthquake model" load_quake
timed "triangulate the earthquake model: stage, insert, commit" with_progress \
    "SELECT abacus_triangulate('quake', 'TABLE quake_points', dimension => 3) AS tetrahedra"

heading "Shear waves under six seismographs, metres a second"
timed "interpolate below six stations" run_psql <<'SQL'
SELECT station, round(abacus_interpolate('quake', x, y, 0, 'vs')) AS surface,
       round(abacus_interpolate('quake', x, y, -100, 'vs')) AS "100 m",
       round(abacus_interpolate('quake', x, y, -1000, 'vs')) AS "1 km",
       round(abacus_interpolate('quake', x, y, -5000, 'vs')) AS "5 km",
       round(abacus_interpolate('quake', x, y, -20000, 'vs')) AS "20 km"
FROM (VALUES ('valley', 51200, 46300), ('harbour', 36100, 30700), ('airport', 24900, 75600),
             ('university', 61300, 80200), ('observatory', 42500, 70900), ('dam', 93700, 91100))
         AS stations (station, x, y);
SQL
timed "interpolate at 10,000 places of the surface" run_psql <<'SQL'
SELECT count(*) AS places, round(min(v)) AS slowest, round(avg(v)) AS mean, round(max(v)) AS fastest
FROM generate_series(0, 99) AS i, generate_series(0, 99) AS j,
     abacus_interpolate('quake', 1000 * i + 497, 1000 * j + 503, 0, 'vs') AS v;
SQL

heading "Exact verification of every tetrahedron"
timed "check the earthquake model" with_progress "SELECT count(*) AS faults FROM abacus_check('quake')"

heading "Pictures"
timed "draw the world, all of its triangles" draw world.png \
    "SELECT abacus_draw('shorelines', width => 1600)"
timed "draw the Aegean" draw aegean.png \
    "SELECT abacus_draw('shorelines', width => 1200, lower => '{22.5,35.2}', upper => '{28.5,40.6}')"
timed "draw the fjords around Bergen, short edges only" draw fjords.png \
    "SELECT abacus_draw('shorelines', width => 1200, lower => '{4.7,59.9}', upper => '{6.7,61.1}', max_edge => 0.12)"
timed "draw the terrain, shaded" draw terrain.png \
    "SELECT abacus_draw('terrain', width => 1200, attribute => 'height', edges => false, exaggeration => 2)"
timed "draw the terrain as a map" draw terrain_map.png \
    "SELECT abacus_draw('terrain', width => 560, attribute => 'height', edges => false, exaggeration => 2, contours => 50, legend => 'height (m)', scale_bar => 'm')"
timed "draw it with heights on contours" draw contour_labels.png \
    "SELECT abacus_draw('terrain', width => 560, attribute => 'height', edges => false, exaggeration => 2, contours => 20, contour_labels => true, lower => '{11000,9000}', upper => '{17000,13500}')"
timed "draw a section across the basin" draw basin_section.png \
    "SELECT abacus_draw_section('quake', '{52000,45000,0}', '{0.6,0.8,0}', width => 1600, attribute => 'vs')"
timed "draw the rim of the basin, closer" draw basin_rim.png \
    "SELECT abacus_draw_section('quake', '{0,45000,0}', '{0,1,0}', width => 1200, attribute => 'vs', lower => '{28000,0,-6000}', upper => '{44000,100000,0}')"
timed "draw the ground at a depth of 200 m" draw basin_map.png \
    "SELECT abacus_draw_section('quake', '{0,0,-200}', '{0,0,1}', width => 1200, attribute => 'vs', edges => false)"

note_mesh shorelines
note_mesh quake
heading "Times and sizes"
printf '%s\n' "${summary[@]}"

# Until Ctrl+C; the viewer and the server of the database end with this script. If there is a screen, a browser opens.
if [[ -n $view ]]; then
    heading "The meshes in a browser"
    viewer/serve --port 8080 &
    viewer=$!
    trap 'kill "$viewer" 2>/dev/null || true; cluster_stop' EXIT
    address=http://localhost:8080
    printf '  %-36s %s\n' "the terrain, in three dimensions" "$address/mesh/public/terrain/#3d" \
        "the shorelines of the world" "$address/mesh/public/shorelines/" \
        "the earthquake model, cut open" "$address/mesh/public/quake/" \
        "all meshes" "$address/"
    if [[ -n ${DISPLAY:-}${WAYLAND_DISPLAY:-} ]] && command -v xdg-open >/dev/null; then
        sleep 1
        xdg-open "$address/mesh/public/terrain/#3d" >/dev/null 2>&1 || true
    fi
    wait "$viewer"
fi
