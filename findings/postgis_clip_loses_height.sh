#!/bin/bash
# PostGIS's ST_ClipByBox2D has no heights where it cuts.
#
# Version     PostGIS 3.3.2 with GEOS 3.11.1 (Debian 12: postgresql-15-postgis-3 3.3.2+dfsg-1+b1),
#             PostgreSQL 15
# Behaviour   The vertices that a line or polygon keeps have their Z; those at the box have NaN. If no vertex of a
#             line is within the box, the rest is two-dimensional, and its ST_ZMin is 0. ST_Intersection with the
#             same box interpolates.
# Output      LINESTRING Z (0 0 2,2 0 NaN), and of its middle LINESTRING(1 0,2 0)
# Expected    LINESTRING Z (0 0 2,2 0 5) and LINESTRING Z (1 0 3.5,2 0 5), as by ST_Intersection
# Way out     ST_Intersection, where heights matter.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack_postgis
start_server
psql -Xqd postgres -c "CREATE EXTENSION postgis"

expect "version" "3.3.2, GEOS 3.11.1" "$(value "postgis_lib_version() || ', GEOS ' || split_part(postgis_geos_version(), '-', 1)")"
line="'LINESTRING Z (0 0 2, 4 0 8)'::geometry"
polygon="'POLYGON Z ((0 0 0, 4 0 0, 0 4 8, 0 0 0))'::geometry"
corner="ST_MakeEnvelope(0, -1, 2, 2)"
middle="ST_MakeEnvelope(1, -1, 2, 2)"
expect "line, clipped" "LINESTRING Z (0 0 2,2 0 NaN)" "$(value "ST_AsText(ST_ClipByBox2D($line, $corner))")"
expect "line, intersection" "LINESTRING Z (0 0 2,2 0 5)" "$(value "ST_AsText(ST_Intersection($line, $corner))")"
expect "its middle, clipped" "LINESTRING(1 0,2 0)" "$(value "ST_AsText(ST_ClipByBox2D($line, $middle))")"
expect "its middle, intersection" "LINESTRING Z (1 0 3.5,2 0 5)" "$(value "ST_AsText(ST_Intersection($line, $middle))")"
expect "ST_ZMin of the middle, clipped" 0 "$(value "ST_ZMin(ST_ClipByBox2D($line, $middle))")"
expect "polygon, clipped" "POLYGON Z ((0 0 0,0 2 NaN,2 2 NaN,2 0 NaN,0 0 0))" "$(value "ST_AsText(ST_ClipByBox2D($polygon, $corner))")"
