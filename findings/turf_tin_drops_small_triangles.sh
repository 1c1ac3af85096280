#!/bin/bash
# tin of Turf leaves out triangles that are a few centimetres long.
#
# Version     @turf/tin 7.4.0 (npm)
# Behaviour   Coordinates are longitudes and latitudes. tin drops a triangle of at most 2.5e-13 square degrees, which is
#             half a square with sides of 8 cm: of points 5 cm apart, as a drone or a scanner on the ground measures
#             them, it makes a few triangles or none. There is no error, and the manual names no limit.
# Output      0 triangles of 100 points, 10 by 10, that are 0.0000005 degrees apart; 162 if they are 0.00001 apart
# Expected    162 triangles, however small they are
# Way out     Multiply the coordinates by a power of two before, and divide those of the triangles by it.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

command -v npm >/dev/null || exit 77
npm install --silent --no-audit --no-fund --prefix "$tmp" @turf/tin@7.4.0 @turf/helpers@7.4.0 >&2 || exit 77

cat >"$tmp/tin.mjs" <<'JAVASCRIPT'
import { featureCollection, point } from "@turf/helpers";
import { tin } from "@turf/tin";

const [step, scale] = process.argv.slice(2).map(Number), places = [];
for (let i = 0; i < 10; ++i)
    for (let j = 0; j < 10; ++j)
        places.push(point([scale * (7 + step * (i + j / 16)), scale * (46 + step * (j - i / 16))]));
console.log(tin(featureCollection(places)).features.length);
JAVASCRIPT

for step in 0.00001=162 0.00000072=162 0.0000007=0 0.0000005=0; do
    expect "points ${step%=*} degrees apart, triangles" "${step#*=}" "$(node "$tmp/tin.mjs" "${step%=*}" 1)"
done
expect "points 0.0000005 degrees apart, times 1024, triangles" 162 "$(node "$tmp/tin.mjs" 0.0000005 1024)"
