#!/bin/bash
# ogr2ogr writes a TIN to KML and to MapInfo as a feature without a geometry.
#
# Version     GDAL 3.6.2 (Debian 12: gdal-bin 3.6.2+dfsg-1+b2)
# Behaviour   Neither format knows triangles. The drivers LIBKML and MapInfo File write the attributes alone, without a
#             warning, and the exit status is 0. The drivers KML and GeoJSON say that they cannot, and it is 1.
# Output      no geometry, nothing on the error stream, exit status 0
# Expected    an error, or polygons
# Way out     -nlt MULTIPOLYGON, which makes a polygon with heights of each triangle. -nlt MULTIPOLYGONZ makes none.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack_gdal
expect "version" "GDAL 3.6.2, released 2023/01/02" "$("$tmp/usr/bin/ogr2ogr" --version)"
printf 'id,WKT\n1,"TIN Z (((0 0 1,1 0 2,0 1 3,0 0 1)),((1 0 2,1 1 4,0 1 3,1 0 2)))"\n' >"$tmp/in.csv"

# written DRIVER SUFFIX [ARGUMENT...]: exit status, lines on the error stream, and the geometry that is read again.
written() {
    local status=0
    rm -f "$tmp"/out.*
    "$tmp/usr/bin/ogr2ogr" -f "$1" "$tmp/out.$2" "$tmp/in.csv" -a_srs EPSG:4326 "${@:3}" 2>"$tmp/said" || status=$?
    echo "$status, $(wc -l <"$tmp/said"),$("$tmp/usr/bin/ogrinfo" -q -al "$tmp/out.$2" 2>"$tmp/said" | sed -n 's/^ *\([A-Z]* Z (.*\)/ \1/p')"
}

polygons="MULTIPOLYGON Z (((0 0 1,1 0 2,0 1 3,0 0 1)),((1 0 2,1 1 4,0 1 3,1 0 2)))"
expect "LIBKML" "0, 0," "$(written LIBKML kml)"
expect "MapInfo File" "0, 0," "$(written "MapInfo File" mif)"
expect "KML" "1, 3," "$(written KML kml)"
expect "GeoJSON" "1, 3," "$(written GeoJSON json)"
expect "LIBKML, -nlt MULTIPOLYGON" "0, 0, $polygons" "$(written LIBKML kml -nlt MULTIPOLYGON)"
expect "GeoJSON, -nlt MULTIPOLYGON" "0, 0, $polygons" "$(written GeoJSON json -nlt MULTIPOLYGON)"
expect "LIBKML, -nlt MULTIPOLYGONZ" "0, 0," "$(written LIBKML kml -nlt MULTIPOLYGONZ)"
