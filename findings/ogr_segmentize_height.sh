#!/bin/bash
# ogr2ogr -segmentize gives the new vertices of a sloping line the height of one end.
#
# Version     GDAL 3.6.2 (Debian 12: gdal-bin 3.6.2+dfsg-1+b2)
# Behaviour   -segmentize puts vertices into long segments. x and y lie between the ends, but the height and the measure are those of one
#             end. A breakline that falls evenly becomes a step and a level line. There is no warning.
# Output      (0 0 0) (2.5 0 10) (5 0 10) (7.5 0 10) (10 0 10) of a line from (0 0 0) to (10 0 10)
# Expected    (2.5 0 2.5) (5 0 5) (7.5 0 7.5), as ST_Segmentize of SpatiaLite and PostGIS make them
# Way out     -dialect sqlite -sql "SELECT ST_Segmentize(geometry, 3) ...", or ST_Segmentize in PostGIS
set -euo pipefail
. "$(dirname "$0")/tools.bash"

unpack_gdal
expect "version" "GDAL 3.6.2, released 2023/01/02" "$("$tmp/usr/bin/ogr2ogr" --version)"

# made WKT ARGUMENT...: what ogr2ogr makes of the line.
made() {
    printf 'id,WKT\n1,"%s"\n' "$1" >"$tmp/in.csv"
    rm -f "$tmp/out.csv"
    "$tmp/usr/bin/ogr2ogr" -f CSV "$tmp/out.csv" "$tmp/in.csv" -lco GEOMETRY=AS_WKT "${@:2}"
    sed -n 's/^"\([A-Z]* Z*M* ([^"]*\)".*/\1/p' "$tmp/out.csv"
}

expect "to the right" "LINESTRING Z (0 0 0,2.5 0.0 10,5 0 10,7.5 0.0 10,10 0 10)" "$(made "LINESTRING Z (0 0 0, 10 0 10)" -segmentize 3)"
expect "to the left" "LINESTRING Z (10 0 10,7.5 0.0 10,5 0 10,2.5 0.0 10,0 0 0)" "$(made "LINESTRING Z (10 0 10, 0 0 0)" -segmentize 3)"
expect "up" "LINESTRING Z (0 0 0,0.0 2.5 10,0 5 10,0.0 7.5 10,0 10 10)" "$(made "LINESTRING Z (0 0 0, 0 10 10)" -segmentize 3)"
expect "with measures" "LINESTRING ZM (0 0 0 0,5 0 10 100,10 0 10 100)" "$(made "LINESTRING ZM (0 0 0 0, 10 0 10 100)" -segmentize 5)"
expect "a polygon" "POLYGON Z ((0 0 0,5 0 0,10 0 10,10 5 10,10 10 20,5 10 20,0 10 10,0 5 10,0 0 0))" "$(made "POLYGON Z ((0 0 0, 10 0 10, 10 10 20, 0 10 10, 0 0 0))" -segmentize 5)"
expect "SpatiaLite" "LINESTRING Z (0 0 0,3 0 3,6 0 6,9 0 9,10 0 10)" "$(made "LINESTRING Z (0 0 0, 10 0 10)" -dialect sqlite -sql "SELECT ST_Segmentize(geometry, 3) FROM 'in'")"
