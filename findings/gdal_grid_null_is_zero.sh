#!/bin/bash
# gdal_grid counts a point without a value as a point of the value 0.
#
# Version     GDAL 3.6.2 (Debian 12: gdal-bin 3.6.2+dfsg-1+b2)
# Behaviour   With -zfield, a feature whose field is null stays among the points, with the height 0, whatever the
#             algorithm is. There is no warning, and the exit status is 0. All given heights here are 100, so the
#             hole that appears in the grid is the work of one missing measurement.
# Output      100 100 100 100 | 100 0 50 100 | 100 50 50 100 | 100 100 100 100
#             by the algorithm linear; without that point, 100 everywhere
# Expected    A point without a value is left out, or refused.
# Way out     -where "z IS NOT NULL"
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack_gdal
expect "version" "GDAL 3.6.2, released 2023/01/02" "$("$tmp/usr/bin/gdal_grid" --version)"

feature() {
    printf '{"type": "Feature", "properties": {"z": %s}, "geometry": {"type": "Point", "coordinates": [%s, %s]}}' "$1" "$2" "$3"
}
printf '{"type": "FeatureCollection", "features": [%s, %s, %s, %s, %s]}\n' "$(feature 100 0.5 0.5)" "$(feature 100 3.5 0.5)" \
    "$(feature 100 0.5 3.5)" "$(feature 100 3.5 3.5)" "$(feature null 1.5 2.5)" >"$tmp/points.geojson"

# The values of a grid of 4 x 4 cells, from the north-west, whole metres; a fifth point has no value.
grid() {
    "$tmp/usr/bin/gdal_grid" -q -zfield z -txe 0 4 -tye 0 4 -outsize 4 4 -ot Float64 "$@" \
        "$tmp/points.geojson" "$tmp/grid.tif" 2>"$tmp/warnings" || echo "exit status $?"
    "$tmp/usr/bin/gdal_translate" -q -of XYZ "$tmp/grid.tif" /vsistdout/ | awk '{ printf "%.0f%s", $3, NR % 4 ? " " : NR < 16 ? " | " : "\n" }'
}

whole="100 100 100 100 | 100 100 100 100 | 100 100 100 100 | 100 100 100 100"
expect "linear" "100 100 100 100 | 100 0 50 100 | 100 50 50 100 | 100 100 100 100" "$(grid -a linear:radius=0:nodata=-9)"
expect "warnings" "" "$(cat "$tmp/warnings")"
expect "invdist" "100 59 74 100 | 59 0 51 85 | 74 51 67 88 | 100 85 88 100" "$(grid -a invdist:nodata=-9)"
expect "nearest, in the cell of that point" 0 "$(grid -a nearest:nodata=-9 | awk '{ print $7 }')"
for algorithm in linear:radius=0:nodata=-9 nearest:nodata=-9 invdist:nodata=-9; do
    expect "$algorithm, without that point" "$whole" "$(grid -a "$algorithm" -where 'z IS NOT NULL')"
done
