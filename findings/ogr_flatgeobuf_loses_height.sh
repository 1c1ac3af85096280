#!/bin/bash
# ogr2ogr drops all heights on the way to FlatGeobuf if the layer does not say that it has any.
#
# Version     GDAL 3.6.2 (Debian 12: gdal-bin 3.6.2+dfsg-1+b2)
# Behaviour   The layer has the geometry type unknown, as a CSV file with WKT has, or a PostGIS column of type geometry
#             without more. The geometries have Z, but FlatGeobuf gets them without, with no warning, and the exit
#             status is 0. GeoPackage, Shapefile and GeoJSON get them with Z.
# Output      POINT (1 2)
# Expected    POINT Z (1 2 5), or a warning.
# Way out     -dim XYZ, or a type such as -nlt POINTZ
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack_gdal
expect "version" "GDAL 3.6.2, released 2023/01/02" "$("$tmp/usr/bin/ogr2ogr" --version)"
printf 'id,WKT\n1,POINT Z (1 2 5)\n' >"$tmp/points.csv"
expect "type of the layer" "Geometry: Unknown (any)" "$("$tmp/usr/bin/ogrinfo" -so "$tmp/points.csv" points | grep Geometry)"

# The point that is read from a file of this driver and suffix, written with these arguments.
again() {
    rm -f "$tmp/copy.$2"
    "$tmp/usr/bin/ogr2ogr" -f "$1" "$tmp/copy.$2" "$tmp/points.csv" "${@:3}" 2>"$tmp/warnings" || echo "exit status $?"
    "$tmp/usr/bin/ogrinfo" -q -al "$tmp/copy.$2" 2>>"$tmp/warnings" | sed -n 's:^ *\(POINT.*\):\1:p'
}

expect "FlatGeobuf" "POINT (1 2)" "$(again FlatGeobuf fgb)"
expect "warnings" "" "$(cat "$tmp/warnings")"
expect "GeoPackage" "POINT Z (1 2 5)" "$(again GPKG gpkg)"
expect "Shapefile" "POINT Z (1 2 5)" "$(again "ESRI Shapefile" shp)"
expect "GeoJSON" "POINT Z (1 2 5)" "$(again GeoJSON geojson)"
expect "FlatGeobuf, -dim XYZ" "POINT Z (1 2 5)" "$(again FlatGeobuf fgb -dim XYZ)"
expect "FlatGeobuf, -nlt POINTZ" "POINT Z (1 2 5)" "$(again FlatGeobuf fgb -nlt POINTZ)"
