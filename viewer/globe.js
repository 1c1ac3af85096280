// Terrain for globes in three dimensions: which tiles a mesh has, for Cesium's layer.json, and each of them.
import { errorOfTerrain } from "./detail.js";
import { Refused } from "./errors.js";
import { plane } from "./queries.js";

const half = 20037508.342789244; // of the side of the map of Web Mercator, in metres
const finest = { 4326: 29, 3857: 30 };

function attributeOf(p, mesh) {
    if (!mesh.srid || !mesh.attributes.length) throw new Refused(404, "there is no terrain of this mesh: it needs an attribute, and longitude and latitude (SRID 4326) or Web Mercator (3857)");
    if (mesh.lower[0] === null) throw new Refused(404, "the mesh is empty");
    return p.text("attribute") ?? mesh.attributes[0].name;
}

const degrees = ([x, y]) => [(x / half) * 180, (Math.atan(Math.sinh((y / half) * Math.PI)) / Math.PI) * 180];

/** What Cesium has to know of the tiles. It must get all that it asks for, or it waits for tiles beside the mesh for ever: so
    there are tiles everywhere, and at each zoom that abacus_tile_mesh has. */
export function layer(p, mesh) {
    const attribute = attributeOf(p, mesh), { srid, lower, upper } = mesh, wide = srid === 4326 ? 2 : 1;
    const available = Array.from({ length: finest[srid] + 1 }, (_, z) => [{ startX: 0, startY: 0, endX: wide * 2 ** z - 1, endY: 2 ** z - 1 }]);
    return { tilejson: "2.1.0", name: mesh.name, version: "1.0.0", format: "quantized-mesh-1.0", scheme: "tms", projection: `EPSG:${srid}`,
        tiles: [`{z}/{x}/{y}.terrain?attribute=${encodeURIComponent(attribute)}`], extensions: ["octvertexnormals"],
        bounds: (srid === 4326 ? [lower, upper] : [degrees(lower), degrees(upper)]).flat(), minzoom: 0, maxzoom: finest[srid], available };
}

/** A tile without anything to see: a triangle all of whose corners are one vertex in its middle, and a header of zeros, whose point
    of the horizon is hidden from everywhere. */
export const nothing = (() => {
    const header = Buffer.alloc(88), bytes = (Type, ...numbers) => Buffer.from(Type.from(numbers).buffer), middle = 2 * 16384; // zigzag
    return Buffer.concat([header, bytes(Uint32Array, 3), bytes(Uint16Array, middle, 0, 0, middle, 0, 0, 0, 0, 0), bytes(Uint32Array, 1), bytes(Uint16Array, 0, 1, 1),
        bytes(Uint32Array, 0, 0, 0, 0), Buffer.from([1]), bytes(Uint32Array, 6), Buffer.alloc(6, 128)]);
})();

/** A tile: its statement and parameters. */
export function terrain(place, p, mesh) {
    const attribute = attributeOf(p, mesh);
    return { text: plane.mesh, values: [...place, attribute, mesh.srid, errorOfTerrain(mesh, attribute, place[0])] };
}
