// The triangle at a place, and walks from it to its neighbours.
import { answering, centroid, circumsphere, describe, element, made, offerWalk, say, table } from "./common.js";
import { otherAt } from "./compare.js";
import { coordinates, map, mesh, named, places, ring, show } from "./map.js";
import { withRegion } from "./regions.js";
import { ask } from "./requests.js";

let found = null;
const round = 96; // corners of a circle

export function clearFound() {
    found = null;
    offerWalk(null);
}

function draw() {
    const features = places([found.place]);
    if (found.simplex) {
        const { center, radius } = circumsphere(found.simplex.corners);
        const circle = Array.from({ length: round }, (_, i) => [center[0] + radius * Math.cos((2 * i * Math.PI) / round), center[1] + radius * Math.sin((2 * i * Math.PI) / round)]);
        features.push(ring("circle", circle), ...found.neighbours.filter(Boolean).map((one) => ring("neighbour", one.corners)), ring("simplex", found.simplex.corners));
    }
    show(features);
}

export async function locate([x, y]) {
    found = await ask("locate", { ...named({ x, y }), ...withRegion() });
    draw();
    const other = await otherAt([x, y], found.values.linear);
    say([...describe(found, "triangle", mesh.attributes.map((one) => one.name), element("unit").value), ...(other.length ? [made("h3", {}, "Other mesh"), table(other)] : [])]);
    offerWalk(found, walk);
}

const walk = (facet) => answering(async () => {
    const next = found?.neighbours[facet];
    if (!next) return say("There is no triangle beyond this edge: it is on the boundary of the mesh or on a fault.");
    await locate(centroid(next.corners));
    if (!map.getBounds().contains(coordinates.toMap(found.place))) map.panTo(coordinates.toMap(found.place));
});

/** Walks to the neighbour that lies most in a direction; false if no triangle is shown. */
export function walkTowards([dx, dy]) {
    if (!found?.simplex) return false;
    const from = centroid(found.simplex.corners);
    const turns = found.neighbours.map((one) => {
        if (!one) return -2;
        const to = centroid(one.corners), x = to[0] - from[0], y = to[1] - from[1];
        return (x * dx + y * dy) / Math.hypot(x, y);
    });
    walk(turns.indexOf(Math.max(...turns)));
    return true;
}

export const nearest = async ([x, y]) => {
    const answer = await ask("locate", named({ x, y }));
    if (!answer.nearest) throw new Error("the mesh has no vertices");
    return answer.nearest;
};
