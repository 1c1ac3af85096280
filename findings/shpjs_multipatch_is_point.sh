#!/bin/bash
# A TIN in a shapefile becomes one point in shpjs, at a place that it does not have.
#
# Version     shpjs 6.2.0 (npm); GDAL 3.6.2 (Debian 12: gdal-bin 3.6.2+dfsg-1+b2)
# Behaviour   Shapefiles keep triangles as shapes of the type MultiPatch. shpjs takes the type for that of a point with height, and so the
#             bounding box of the shape for coordinates: the least x, the least y, and the greatest x as the height. There is no error.
# Output      a point (100 200 110), of two triangles between (100 200 5) and (110 220 8)
# Expected    triangles, or an error: shapefile 0.6.6 says "unsupported shape type: 31"
# Way out     ogr2ogr -nlt MULTIPOLYGON to GeoJSON first.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

command -v npm >/dev/null || exit 77
unpack_gdal
npm install --silent --no-audit --no-fund --prefix "$tmp" shpjs@6.2.0 shapefile@0.6.6 >&2 || exit 77

cat >"$tmp/read.mjs" <<'JAVASCRIPT'
import { readFileSync } from "node:fs";
import { open } from "shapefile";
import { parseShp } from "shpjs";

const bytes = readFileSync(process.argv[2]);
console.log(JSON.stringify(parseShp(new DataView(bytes.buffer, bytes.byteOffset, bytes.length))));
console.log(await open(bytes).then(() => "no error", (error) => error.message));
JAVASCRIPT

printf 'id,WKT\n1,"TIN Z (((100 200 5, 110 200 6, 100 220 7, 100 200 5)), ((110 220 8, 100 220 7, 110 200 6, 110 220 8)))"\n' >"$tmp/in.csv"
"$tmp/usr/bin/ogr2ogr" "$tmp/tin.shp" "$tmp/in.csv" -lco SHPT=MULTIPATCH
expect "as GDAL reads it" "TIN Z (((100 200 5,110 200 6,100 220 7,100 200 5)),((110 220 8,100 220 7,110 200 6,110 220 8)))" \
    "$("$tmp/usr/bin/ogrinfo" -q -al "$tmp/tin.shp" | sed -n 's/^ *\(TIN.*\)/\1/p')"
expect "as shpjs does, and shapefile" '[{"type":"Point","coordinates":[100,200,110]}]
unsupported shape type: 31' "$(node "$tmp/read.mjs" "$tmp/tin.shp")"
