#!/bin/bash
# ST_Snap of PostGIS gives a vertex the height NaN if it moves to a place that has none.
#
# Version     PostGIS 3.3.2 (Debian 12: postgresql-15-postgis-3 3.3.2+dfsg-1+b1), GEOS 3.11.1, PostgreSQL 15
# Behaviour   A line with heights that is snapped to points, lines or polygons of the plane, such as parcels, keeps the heights
#             of the vertices that stay. A vertex that moves, or is added, has the height NaN. Then the length in space is
#             NaN, and ST_AsGeoJSON writes a bare NaN, which JSON does not have.
# Output      LINESTRING Z (0 0 0,5 0 NaN,10 0 10); [5,0,NaN]
# Expected    the vertex' own height, or that of the line there: 5
# Way out     ST_Snap to a reference with heights, which are then taken; or ST_SetZ over a raster afterwards.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack_postgis
start_server
psql -Xqd postgres -c "CREATE EXTENSION postgis"

line="'LINESTRING Z (0 0 0, 5 0.1 5, 10 0 10)'::geometry"
straight="'LINESTRING Z (0 0 0, 10 0 10)'::geometry"
snapped="ST_Snap($line, 'POINT (5 0)', 0.5)"

expect "version" "3.3.2, 3.11.1" "$(value "PostGIS_Lib_Version() || ', ' || split_part(PostGIS_GEOS_Version(), '-', 1)")"
expect "a vertex that moves" "LINESTRING Z (0 0 0,5 0 NaN,10 0 10)" "$(value "ST_AsText($snapped)")"
expect "a vertex that is added" "LINESTRING Z (0 0 0,5 0 NaN,10 0 10)" "$(value "ST_AsText(ST_Snap($straight, 'POINT (5 0)', 0.5))")"
expect "to a point with a height" "LINESTRING Z (0 0 0,5 0 7,10 0 10)" "$(value "ST_AsText(ST_Snap($line, 'POINT Z (5 0 7)', 0.5))")"
expect "length in space" NaN "$(value "ST_3DLength($snapped)")"
expect "GeoJSON" '{"type":"LineString","coordinates":[[0,0,0],[5,0,NaN],[10,0,10]]}' "$(value "ST_AsGeoJSON($snapped)")"
expect "... is not JSON" "invalid input syntax for type json" \
    "$(value "ST_AsGeoJSON($snapped)::json" 2>&1 | sed -n 's/^ERROR:  //p')"
