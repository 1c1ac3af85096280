#!/bin/bash
# The convex hull of d3-geo-voronoi has wrong corners for points within a hundred metres, and is null within ten.
#
# Version     d3-geo-voronoi 2.1.0, delaunator 5.0.1 (npm)
# Behaviour   geoVoronoi(points).hull() tells the triangles of the far side by their signed area on a sphere of radius 1, with a
#             tolerance of 1e-12, which is 40 square metres on the earth. So it has wrong corners where triangles are smaller,
#             and where all are it is null, which by the manual means that the points span more than a hemisphere. The
#             triangles themselves are right.
# Output      185 triangles and 13, 26 and null corners with sides of 1, 0.001 and 0.0001 degrees
# Expected    185 triangles and 13 corners each time, as in the plane
# Way out     The hull in the plane, of points that are less than some kilometres apart.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

command -v npm >/dev/null || exit 77
npm install --silent --no-audit --no-fund --prefix "$tmp" d3-geo-voronoi@2.1.0 delaunator@5.0.1 >&2 || exit 77

cat >"$tmp/hull.mjs" <<'JAVASCRIPT'
import Delaunator from "delaunator";
import { geoVoronoi } from "d3-geo-voronoi";

let state = 1;
const random = () => (state = (state * 16807) % 2147483647) / 2147483647;
const places = Array.from({ length: 100 }, () => [random(), random()]);
for (const side of [1, 0.001, 0.0001]) {
    const points = places.map(([x, y]) => [7 + side * x, 46 + side * y]), plane = new Delaunator(points.flat()), sphere = geoVoronoi(points);
    const hull = sphere.hull();
    console.log(side, plane.triangles.length / 3, plane.hull.length, sphere.triangles().features.length, hull && hull.coordinates[0].length - 1);
}
JAVASCRIPT

expect "side in degrees; triangles and corners in the plane; triangles and corners on the sphere" $'1 185 13 185 13\n0.001 185 13 185 26\n0.0001 185 13 185 null' \
    "$(node "$tmp/hull.mjs")"
