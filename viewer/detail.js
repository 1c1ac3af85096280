// Levels of detail: the greatest error of a tile, in units of the attribute; null: the full mesh. It depends on the zoom alone, so
// that tiles of a zoom fit.
import { plane } from "./queries.js";

const steps = 256; // of colours: an error of one cannot be seen
const side = 256; // pixels of a tile
const worlds = { 4326: 360, 3857: 2 * 20037508.342789244 }; // sides, in units of the coordinates

/** The attribute of the levels of a mesh; null if it has none that can be read, or if they are older than the mesh. */
export async function levelsOf(query) {
    const [table] = await query(plane.levelsTable);
    const [found] = table ? await query(plane.levels(table.name)) : [];
    return found?.attribute ?? null;
}

/** The error of a picture or of heights whose pixels are so long in the mesh: where each has several triangles, none that can be seen. */
export function errorOfPixel(mesh, found, pixel) {
    if (!found || mesh.levels !== found.name || found.least === null) return null;
    const [width, height] = mesh.upper.map((x, i) => x - mesh.lower[i]), trianglesOfPixel = (mesh.simplices * pixel * pixel) / (width * height);
    return trianglesOfPixel > 1 ? (found.greatest - found.least) / steps : null;
}

export const errorOfTile = (mesh, found, zoom) => errorOfPixel(mesh, found, (mesh.srid ? worlds[mesh.srid] : mesh.world[2]) / 2 ** zoom / side);

// What Cesium takes as the error of a tile of zoom 0; it shows tiles of which that is at most two pixels.
const ofRoot = { 4326: 77067.34, 3857: 154134.68 };

/** The error of a tile of terrain for Cesium: half a pixel. */
export const errorOfTerrain = (mesh, attribute, zoom) => (mesh.levels === attribute ? ofRoot[mesh.srid] / 2 ** zoom / 4 : null);
