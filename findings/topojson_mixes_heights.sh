#!/bin/bash
# Features that share an edge of a map get heights of each other in TopoJSON.
#
# Version     topojson-server 3.0.1, topojson-client 3.1.0 (npm)
# Behaviour   topology() joins places by x and y alone, but keeps a third coordinate in the arcs. Where two polygons meet
#             at different heights, as roofs or terraces do, the second one gets the heights of the first along their common
#             edge. Its ring then begins at one height and ends at another. There is no error.
# Output      [[0,0,5],[1,1,5],[2,2,9],[0,2,9],[0,0,9]] of a level polygon at the height 9, beside one at 5
# Expected    the polygon as it was, or without heights
# Way out     Heights as properties; or one topology for each feature.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

command -v npm >/dev/null || exit 77
npm install --silent --no-audit --no-fund --prefix "$tmp" topojson-server@3.0.1 topojson-client@3.1.0 >&2 || exit 77

cat >"$tmp/heights.mjs" <<'JAVASCRIPT'
import { feature } from "topojson-client";
import { topology } from "topojson-server";

const polygon = (...ring) => ({ type: "Polygon", coordinates: [ring] });
const low = polygon([0, 0, 5], [2, 0, 5], [2, 2, 5], [1, 1, 5], [0, 0, 5]), high = polygon([0, 0, 9], [1, 1, 9], [2, 2, 9], [0, 2, 9], [0, 0, 9]);
const made = topology({ low, high });
console.log(JSON.stringify(feature(made, made.objects.high).geometry.coordinates[0]));
const alone = topology({ high });
console.log(JSON.stringify(feature(alone, alone.objects.high).geometry.coordinates[0]));
JAVASCRIPT

expect "beside another polygon, and alone" $'[[0,0,5],[1,1,5],[2,2,9],[0,2,9],[0,0,9]]\n[[0,0,9],[1,1,9],[2,2,9],[0,2,9],[0,0,9]]' "$(node "$tmp/heights.mjs")"
