// The lines of a mesh, whose segments are fixed edges.
import { counted, element } from "./common.js";
import { line, map, put } from "./map.js";
import { ask } from "./requests.js";

/** Draws the lines, if the mesh has any; of one with too many, or that the role may not read, says so. */
async function read() {
    const row = element("lines-row"), label = row.querySelector("span");
    try {
        const parts = new Map();
        for (const { line: id, part, kind, x, y } of await ask("lines")) {
            const key = `${id}/${part}`;
            if (!parts.has(key)) parts.set(key, { id, kind, places: [] });
            parts.get(key).places.push([x, y]);
        }
        put("lines", [...parts.values()].map(({ id, kind, places }) => line(kind, places, { id })));
        const count = new Set([...parts.values()].map(({ id }) => id)).size;
        row.hidden = count === 0;
        label.textContent = `Fixed edges of ${counted(count, "line")}`;
        element("view").dataset.lines = count;
    } catch (error) {
        row.hidden = false;
        element("lines").disabled = true;
        label.textContent = `Fixed edges cannot be shown: ${error.message}`;
    }
}

export function setUpFixed() {
    map.on("refreshed", read);
    return read();
}
