#!/bin/bash
# GDAL reads a NULL in an array of PostgreSQL as 0, false or an empty text, and does not warn.
#
# Version     GDAL 3.6.2 (Debian 12: gdal-bin 3.6.2+dfsg-1+b2), PostgreSQL 15
# Behaviour   A column float8[], int[], bool[] or text[] becomes a list of OGR. What is NULL in it
#             is a value there, so all that ogr2ogr writes has a value that the table does not have.
#             A column that is NULL as a whole stays null.
# Output      "f": [ 1.5, 0.0, 3.5 ], "i": [ 1, 0, 3 ], "b": [ true, false, false ], "t": [ "a", "", "c" ]
# Expected    null in GeoJSON, as to_json and PostGIS write it, or a warning that it is lost.
# Way out     Select to_json(column) as text, or write the GeoJSON in SQL.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack gdal-bin=3.6.2+dfsg-1+b2 libgdal32=3.6.2+dfsg-1+b2 gdal-data=3.6.2+dfsg-1 \
    postgresql-15=15.20-0+deb12u1 postgresql-client-15=15.20-0+deb12u1 libpq5=15.20-0+deb12u1
start_server
unset CPL_DEBUG
export GDAL_DATA=$tmp/usr/share/gdal
expect "version" "GDAL 3.6.2, released 2023/01/02" "$("$tmp/usr/bin/ogr2ogr" --version)"

psql -Xqd postgres -c "CREATE TABLE heights (id int PRIMARY KEY, f float8[], i int[], b bool[], t text[], n float8[]);
    INSERT INTO heights VALUES (1, '{1.5, NULL, 3.5}', '{1, NULL, 3}', '{t, NULL, f}', '{a, NULL, c}', NULL)"
expect "to_json of the server" '[1.5,null,3.5]' "$(psql -XqAtd postgres -c 'SELECT to_json(f) FROM heights')"

"$tmp/usr/bin/ogr2ogr" -f GeoJSON "$tmp/heights.json" "PG:dbname=postgres" heights 2>"$tmp/warnings"
properties=$(grep -o '"properties": {.*}, "geometry"' "$tmp/heights.json")
expect "GeoJSON of ogr2ogr" '"properties": { "f": [ 1.5, 0.0, 3.5 ], "i": [ 1, 0, 3 ], "b": [ true, false, false ], "t": [ "a", "", "c" ], "n": null }, "geometry"' "$properties"
expect "warnings" "" "$(cat "$tmp/warnings")"
