#!/bin/bash
# Shapefiles with heights but without measures are read as other places by loaders.gl.
#
# Version     @loaders.gl/shapefile 4.5.2, @loaders.gl/core 4.5.4 (npm); GDAL 3.6.2 (Debian 12: gdal-bin 3.6.2+dfsg-1+b2)
# Behaviour   Shapes of the types PointZ, PolyLineZ, PolygonZ and MultiPointZ may come without measures, and GDAL writes
#             none where a layer has none. loaders.gl then still counts four numbers a vertex in an array of three: x of
#             the second vertex becomes the measure of the first one, the height of the second its y, and so on. Vertices of a polygon, which
#             are turned round, are NaN. There is no error.
# Output      (0 0 5 1) (0 6 1 1) (7 NaN NaN NaN) of a line (0 0 5) (1 0 6) (1 1 7)
# Expected    (0 0 5) (1 0 6) (1 1 7), as from the same line with measures, or in the plane
# Way out     Write measures, even if they mean nothing (ogr2ogr -dim XYZM), or GeoJSON.
set -euo pipefail
. "$(dirname "$0")/tools.bash"

command -v npm >/dev/null || exit 77
unpack_gdal
npm install --silent --no-audit --no-fund --prefix "$tmp" @loaders.gl/shapefile@4.5.2 @loaders.gl/core@4.5.4 >&2 || exit 77

# The loader asks for the .shp, .dbf and .prj one by one.
cat >"$tmp/read.mjs" <<'JAVASCRIPT'
import { existsSync, readFileSync } from "node:fs";
import { load } from "@loaders.gl/core";
import { ShapefileLoader } from "@loaders.gl/shapefile";

const file = (url) => `${process.argv[2]}/${String(url).split("/").pop()}`;
const fetch = async (url) => (existsSync(file(url)) ? new Response(readFileSync(file(url))) : new Response("", { status: 404 }));
const table = await load("http://localhost/shapes.shp", ShapefileLoader, { worker: false, fetch, core: { worker: false, fetch } });
const said = (part) => (Array.isArray(part[0]) ? part.map(said).join(" ") : `(${part.join(" ")})`);
for (const { geometry } of table.data ?? table) console.log(geometry.type, said(geometry.coordinates));
JAVASCRIPT

# read WKT [ARGUMENT...]: the shape as loaders.gl reads it from a file that ogr2ogr wrote.
read_shape() {
    rm -f "$tmp"/shapes.*
    printf 'id,WKT\n1,"%s"\n' "$1" >"$tmp/in.csv"
    "$tmp/usr/bin/ogr2ogr" "$tmp/shapes.shp" "$tmp/in.csv" "${@:2}"
    node "$tmp/read.mjs" "$tmp"
}

line="LINESTRING Z (0 0 5, 1 0 6, 1 1 7)"
expect "a line with heights" "LineString (0 0 5 1) (0 6 1 1) (7 NaN NaN NaN)" "$(read_shape "$line")"
expect "in the plane" "LineString (0 0) (1 0) (1 1)" "$(read_shape "$line" -dim XY)"
expect "with measures" "LineString (0 0 5 0) (1 0 6 0) (1 1 7 0)" "$(read_shape "$line" -dim XYZM)"
expect "several points" "MultiPoint (1 2 3 4) (5 6 NaN NaN)" "$(read_shape "MULTIPOINT Z (1 2 3, 4 5 6)")"
expect "a polygon" "Polygon (NaN NaN NaN NaN) (7 0 0 5) (1 6 1 1) (NaN NaN NaN NaN)" "$(read_shape "POLYGON Z ((0 0 5, 0 1 6, 1 1 7, 0 0 5))")"
