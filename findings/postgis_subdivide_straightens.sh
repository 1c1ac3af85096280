#!/bin/bash
# ST_Subdivide of PostGIS leaves out vertices that lie on a straight line in the plane, whatever their height.
#
# Version     PostGIS 3.3.2 (Debian 12: postgresql-15-postgis-3 3.3.2+dfsg-1+b1), GEOS 3.11.1, PostgreSQL 15
# Behaviour   A straight road or a profile with heights loses its ups and downs as soon as it is divided, and a polygon the
#             heights along its straight edges. A geometry that has few enough vertices stays as it is. ST_Intersection with a
#             box keeps all of them. Measures (M) are dropped altogether.
# Output      a line of six vertices, divided at 5 a part: two parts of two vertices, 82.1 long in space; before, 84.3
#             a wall with heights of 50 and 70 on its edge: the parts have 0 there
# Expected    the same surface and length; more vertices at the cuts, and no fewer elsewhere.
# Way out     ST_Intersection with the cells of a grid (ST_SquareGrid).
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack_postgis
start_server
psql -Xqd postgres -c "CREATE EXTENSION postgis"

line="'LINESTRING Z (0 0 0, 10 10 10, 20 20 30, 30 30 31, 40 40 32, 50 50 33)'::geometry"
bent="'LINESTRING Z (0 0 0, 10 1 10, 20 0 30, 30 1 31, 40 0 32, 50 1 33)'::geometry"
wall="'POLYGON Z ((0 0 0, 10 0 50, 20 0 0, 30 0 70, 40 0 0, 40 10 0, 30 10 0, 20 10 0, 10 10 0, 0 10 0, 0 0 0))'::geometry"

expect "version" "3.3.2, 3.11.1" "$(value "PostGIS_Lib_Version() || ', ' || split_part(PostGIS_GEOS_Version(), '-', 1)")"
expect "straight line" "LINESTRING Z (0 0 0,25 25 30.5) LINESTRING Z (25 25 30.5,50 50 33)" \
    "$(value "string_agg(ST_AsText(part), ' ') FROM ST_Subdivide($line, 5) AS part")"
expect "... its length in space, before and after" "84.3 82.1" \
    "$(value "round(ST_3DLength($line)::numeric, 1) || ' ' || round(sum(ST_3DLength(part))::numeric, 1) FROM ST_Subdivide($line, 5) AS part")"
expect "bent line: vertices of the parts" 12 "$(value "sum(ST_NPoints(part)) FROM ST_Subdivide($bent, 5) AS part")"
expect "straight line, left whole" 6 "$(value "sum(ST_NPoints(part)) FROM ST_Subdivide($line, 8) AS part")"
expect "straight line, cut by ST_Intersection" "LINESTRING Z (0 0 0,10 10 10,20 20 30,25 25 30.5)" \
    "$(value "ST_AsText(ST_Intersection($line, ST_MakeEnvelope(0, 0, 25, 25)))")"
expect "polygon: greatest height, before and after" "70 0" \
    "$(value "ST_ZMax($wall) || ' ' || max(ST_ZMax(part)) FROM ST_Subdivide($wall, 6) AS part")"
expect "measures" "LINESTRING(0 0,25 25) LINESTRING(25 25,50 50)" \
    "$(value "string_agg(ST_AsText(part), ' ') FROM ST_Subdivide('LINESTRING M (0 0 0, 10 10 1, 20 20 2, 30 30 3, 40 40 4, 50 50 5)'::geometry, 5) AS part")"
