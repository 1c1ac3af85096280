#!/bin/bash
# ogr2ogr writes a sloping polygon to DXF as a level one: all its vertices get one height.
#
# Version     GDAL 3.6.2 (Debian 12: gdal-bin 3.6.2+dfsg-1+b2)
# Behaviour   A polygon becomes a HATCH, which has one elevation. The driver takes the middle between the lowest
#             and the highest vertex, without a warning, and the exit status is 0. So the triangles of a terrain
#             become level plates that no longer meet at their edges. Lines keep the height of every vertex.
# Output      POLYGON Z ((0 0 35,4 0 35,0 4 35,0 0 35))
# Expected    POLYGON Z ((0 0 10,4 0 20,0 4 60,0 0 10)), as it was given, or a warning. DXF has entities for
#             it, for example 3DFACE, which GDAL reads.
# Way out     Write the rings as lines: -nlt LINESTRING, or ST_ExteriorRing in SQL.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack_gdal
expect "version" "GDAL 3.6.2, released 2023/01/02" "$("$tmp/usr/bin/ogr2ogr" --version)"

cat >"$tmp/terrain.geojson" <<'GEOJSON'
{"type": "FeatureCollection", "features": [
{"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates": [[[0, 0, 10], [4, 0, 20], [0, 4, 60], [0, 0, 10]]]}},
{"type": "Feature", "properties": {}, "geometry": {"type": "Polygon", "coordinates": [[[4, 0, 20], [4, 4, 100], [0, 4, 60], [4, 0, 20]]]}}
]}
GEOJSON

# The geometries of the DXF that ogr2ogr writes with these arguments.
written() {
    "$tmp/usr/bin/ogr2ogr" -f DXF "$@" "$tmp/terrain.dxf" "$tmp/terrain.geojson" 2>"$tmp/warnings" || echo "exit status $?"
    "$tmp/usr/bin/ogrinfo" -q -al "$tmp/terrain.dxf" | sed -n 's:^ *\([A-Z]* Z (.*\):\1:p'
}

expect "polygons" "POLYGON Z ((0 0 35,4 0 35,0 4 35,0 0 35))
POLYGON Z ((4 0 60,4 4 60,0 4 60,4 0 60))" "$(written)"
expect "warnings" "" "$(cat "$tmp/warnings")"
expect "lines" "LINESTRING Z (0 0 10,4 0 20,0 4 60,0 0 10)
LINESTRING Z (4 0 20,4 4 100,0 4 60,4 0 20)" "$(written -nlt LINESTRING)"
