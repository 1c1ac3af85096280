// Points of a mesh in the plane that are added, moved and deleted.
import { counted, element, say, surround } from "./common.js";
import { change } from "./editing.js";
import { nearest } from "./inspect.js";
import { places, refresh, ring, show } from "./map.js";
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
        await change("insert", { id, at: place });
        await showStar(place, `Point ${id} added.`);
    },
    async remove(place) {
        const vertex = await nearest(place);
        await change("remove", { id: vertex.vertex, at: [vertex.x, vertex.y] });
        await showStar([vertex.x, vertex.y], `Point ${vertex.vertex} deleted.`, "its place");
    },
    async move(place) {
        if (!moved) {
            moved = await nearest(place);
            show(places([[moved.x, moved.y]]));
            return say(`Point ${moved.vertex} selected. Click its new place.`);
        }
        const vertex = moved;
        moved = null;
        await change("move", { id: vertex.vertex, at: [vertex.x, vertex.y], to: place, values: vertex.attributes ?? undefined });
        await showStar(place, `Point ${vertex.vertex} moved.`);
    },
};
