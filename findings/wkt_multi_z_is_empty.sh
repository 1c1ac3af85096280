#!/bin/bash
# MULTIPOLYGON Z and MULTILINESTRING Z become empty geometries in wellknown and in loaders.gl.
#
# Version     wellknown 0.5.0, @loaders.gl/wkt 4.5.2 (npm)
# Behaviour   Both read POLYGON Z, LINESTRING Z and MULTIPOINT Z as PostGIS writes them, and several polygons or lines in the plane. With Z they
#             stop at the letter and return a geometry with no parts: no error, nor null, which is what they say of
#             text that they do not know.
# Output      {"type":"MultiPolygon","coordinates":[]}
# Expected    the polygons with their heights, as wkx 0.5.0 reads them
# Way out     Leave the letter out: both take MULTIPOLYGON (((0 0 1, ...))) with three numbers. Or GeoJSON.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

command -v npm >/dev/null || exit 77
npm install --silent --no-audit --no-fund --prefix "$tmp" wellknown@0.5.0 @loaders.gl/wkt@4.5.2 @loaders.gl/core@4.5.4 wkx@0.5.0 >&2 || exit 77

cat >"$tmp/read.mjs" <<'JAVASCRIPT'
import { parseSync } from "@loaders.gl/core";
import { WKTLoader } from "@loaders.gl/wkt";
import wellknown from "wellknown";
import wkx from "wkx";

const text = process.argv[2];
for (const geometry of [wellknown.parse(text), parseSync(text, WKTLoader), wkx.Geometry.parse(text).toGeoJSON()])
    console.log(JSON.stringify(geometry.coordinates));
JAVASCRIPT
read_wkt() {
    node "$tmp/read.mjs" "$1" | paste -sd ' '
}

ring="(0 0 1,1 0 2,0 1 3,0 0 1)" read="[[0,0,1],[1,0,2],[0,1,3],[0,0,1]]"
expect "MULTIPOLYGON Z, by wellknown, loaders.gl and wkx" "[] [] [[$read]]" "$(read_wkt "MULTIPOLYGON Z (($ring))")"
expect "POLYGON Z" "[$read] [$read] [$read]" "$(read_wkt "POLYGON Z ($ring)")"
expect "MULTILINESTRING Z" "[] [] [$read]" "$(read_wkt "MULTILINESTRING Z ($ring)")"
sed -i 's/, wkx.Geometry.*toGeoJSON()\]/]/' "$tmp/read.mjs"
expect "MULTIPOLYGON with three numbers" "[[$read]] [[$read]]" "$(read_wkt "MULTIPOLYGON (($ring))")"
