#!/bin/bash
# One line in an object of an OBJ file, and three.js draws all its faces as lines.
#
# Version     three 0.187.0 (npm)
# Behaviour   An object of the file has faces (f) and a line (l), as a terrain with a ridge has. OBJLoader makes one LineSegments of it,
#             with the corners of the triangles taken by twos: a zigzag through the faces, no surface, and no error. The order of f and l does not matter.
# Output      LineSegments with 8 vertices, of two triangles and one line
# Expected    a Mesh with 6 and LineSegments with 2
# Way out     Begin another object (o) before the lines.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

command -v npm >/dev/null || exit 77
npm install --silent --no-audit --no-fund --prefix "$tmp" three@0.187.0 >&2 || exit 77

cat >"$tmp/read.mjs" <<'JAVASCRIPT'
import { OBJLoader } from "three/addons/loaders/OBJLoader.js";

const vertices = ["v 0 0 1", "v 1 0 2", "v 1 1 3", "v 0 1 4"], faces = ["f 1 2 3", "f 1 3 4"], line = ["l 1 3"];
const files = { faces, "faces, line": [...faces, ...line], "line, faces": [...line, ...faces], "two objects": [...faces, "o ridge", ...line] };
for (const [name, lines] of Object.entries(files)) {
    const { children } = new OBJLoader().parse(["o terrain", ...vertices, ...lines].join("\n"));
    console.log(`${name}:`, children.map(({ type, geometry }) => `${type} ${geometry.attributes.position.count}`).join(", "));
}
JAVASCRIPT
expect "objects" "faces: Mesh 6
faces, line: LineSegments 8
line, faces: LineSegments 8
two objects: Mesh 6, LineSegments 2" "$(node "$tmp/read.mjs")"
