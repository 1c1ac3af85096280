#!/bin/bash
# delaunay-triangulate covers the sides of a grid with triangles of no area.
#
# Version     delaunay-triangulate 1.1.6 (npm)
# Behaviour   The points lie in straight lines along the hull, as those of any grid do. Beside the right triangles there are flat ones
#             with three points of such a line. Gradients and normals of them are NaN, and edges at the hull belong to two
#             triangles.
# Output      38 triangles of 5 by 5 points, 6 of them flat; 270 tetrahedra of 4 by 4 by 4 points, 108 of them flat
# Expected    32 triangles, and tetrahedra with a volume
# Way out     Drop simplices whose orientation is exactly 0 (robust-orientation); or delaunator for the plane.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

command -v npm >/dev/null || exit 77
npm install --silent --no-audit --no-fund --prefix "$tmp" delaunay-triangulate@1.1.6 delaunator@5.0.1 robust-orientation@1.2.1 >&2 || exit 77

cat >"$tmp/flat.mjs" <<'JAVASCRIPT'
import Delaunator from "delaunator";
import triangulate from "delaunay-triangulate";
import orientation from "robust-orientation";

function count(points) {
    const simplices = triangulate(points);
    const flat = simplices.filter((simplex) => orientation(...simplex.map((i) => points[i])) === 0);
    return `${simplices.length} simplices, ${flat.length} flat`;
}
const grid = (steps, ...rest) => (rest.length ? grid(...rest) : [[]]).flatMap((place) => Array.from({ length: steps }, (_, x) => [x, ...place]));
console.log(count(grid(5, 5)));
console.log(count(grid(4, 4, 4)));
console.log(count(grid(5, 5).map(([x, y]) => [x + y * y / 64, y + x * x / 64])));
console.log(Delaunator.from(grid(5, 5)).triangles.length / 3);
JAVASCRIPT
expect "5 by 5 points, 4 by 4 by 4, 5 by 5 with a bent hull, delaunator" "38 simplices, 6 flat
270 simplices, 108 flat
38 simplices, 0 flat
32" "$(node "$tmp/flat.mjs")"
