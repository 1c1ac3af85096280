// Points of a mesh in the plane that are added, moved and deleted.
import { counted, element, say, surround } from "./common.js";
import { change } from "./editing.js";
import { nearest } from "./inspect.js";
import { line, places, put, refresh, ring, show } from "./map.js";
import { ask } from "./requests.js";

let moved = null;
export const forgetMoved = () => { moved = null; };

/** The triangles around a place: all of a vertex. */
async function showStar([x, y], words, what = "it") {
    const star = await ask("star", { x, y });
    await refresh();
    show([...star.map((one) => ring("star", one.corners)), ...places([[x, y]])]);
    say(`${words} ${surround(counted(star.length, "triangle"), star.length, what)}`);
}

export const editors = {
    async insert(place) {
        const id = element("id").value;
        const words = `Point ${id} added.`;
        await change("insert", { id, at: place }, words);
        await showStar(place, words);
    },
    async remove(place) {
        const vertex = await nearest(place);
        const words = `Point ${vertex.vertex} deleted.`;
        await change("remove", { id: vertex.vertex, at: [vertex.x, vertex.y] }, words);
        await showStar([vertex.x, vertex.y], words, "its place");
    },
    async move(place) {
        if (!moved) {
            moved = await nearest(place);
            show(places([[moved.x, moved.y]]));
            return say(`Point ${moved.vertex} selected. Click its new place.`);
        }
        const vertex = moved, words = `Point ${vertex.vertex} moved.`;
        moved = null;
        await change("move", { id: vertex.vertex, at: [vertex.x, vertex.y], to: place, values: vertex.attributes ?? undefined }, words);
        await showStar(place, words);
    },
};

/** All unsaved changes on the map: points that were added or moved, the places of those that were deleted, and the ways between. */
export function markChanges(steps) {
    put("changes", steps.flatMap(({ name, at, to }) => (name === "move" ? [line("moved", [at, to]), ...places([at], "remove"), ...places([to], "insert")] : places([at], name))));
    element("view").dataset.changed = steps.length;
}
