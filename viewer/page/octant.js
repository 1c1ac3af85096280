// The leaf of an octree at a place, and the leaves beside it.
import * as three from "three";
import { element, made, number, offerWalk, say, table } from "./common.js";
import { box, corners, isFlat, marks, mesh, put } from "./scene.js";
import { ask } from "./requests.js";

const colours = { leaf: 0xd6246e, neighbour: 0x1c2a2c };
/** Corners of a leaf in space; one of a quadtree is flat. */
const flat = (place) => (isFlat ? [...place, 0] : place);

function describe({ place, leaf, neighbours }) {
    const names = mesh.attributes.map((one) => one.name), { value: chosen } = element("attribute"), at = names.indexOf(chosen);
    const rows = [["Place", place.map(number).join(", ")]];
    if (!leaf) return [table([...rows, ["Leaf", "none: the place is outside the octree"]])];
    const size = leaf.upper.map((x, i) => number(x - leaf.lower[i])).join(" × ");
    const value = at >= 0 && leaf.values?.[at] !== null ? [made("p", { class: "value" }, number(leaf.values[at]), made("small", {}, element("unit").value && ` ${element("unit").value}`))] : [];
    return [...value, table([...rows, ["Level", leaf.level], ["Size", size], ["From", leaf.lower.map(number).join(", ")], ["To", leaf.upper.map(number).join(", ")],
        ...names.map((name, i) => [name, number(leaf.values?.[i])]), ["Code", leaf.code]]),
    made("h3", {}, `Leaves beside it: ${neighbours.length}`), table(neighbours.slice(0, 30).map((one) => [one.level, one.code, ...(at >= 0 ? [number(one.values?.[at])] : [])]), ["level", "code", ...(at >= 0 ? [chosen] : [])])];
}

export async function locateLeaf(place) {
    const found = await ask("locate", Object.fromEntries(place.slice(0, corners.lower.length - (isFlat ? 1 : 0)).map((x, i) => ["xyz"[i], x])));
    const group = new three.Group();
    for (const one of found.neighbours) group.add(marks(box(flat(one.lower), flat(one.upper)), colours.neighbour));
    if (found.leaf) group.add(marks(box(flat(found.leaf.lower), flat(found.leaf.upper)), colours.leaf));
    put("found", group);
    say(describe(found));
    offerWalk(null);
}
