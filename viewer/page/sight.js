// Lines of sight: whether the target is visible, and which parts of the ground between are.
import { openChart } from "./chart.js";
import { element, number, openPanel, say, table } from "./common.js";
import { measured } from "./numbers.js";
import { clearLines, draw, drawing, follow, withDistances } from "./drawing.js";
import { attribute, coordinates, feature, line, named, places } from "./map.js";
import { ask } from "./requests.js";
import { colours } from "./style.js";

const heightAbove = (id) => element(id).valueAsNumber || 0;

/** Parts of a line of which a target at its height above the ground can be seen, and of which it cannot: the ground is a
    line of straight pieces, so they change where its angle from the eye is the greatest so far. */
function sightParts(rows, observer, target) {
    const eye = rows[0].value + observer, parts = [];
    const rise = (row) => (row.value - eye) / row.distance;
    let steepest = -Infinity;
    const add = (isVisible, row) => {
        if (parts.at(-1)?.isVisible !== isVisible) parts.push({ isVisible, rows: parts.length ? [parts.at(-1).rows.at(-1)] : [rows[0]] });
        parts.at(-1).rows.push(row);
    };
    for (let i = 1; i < rows.length; ++i) {
        const from = rows[i - 1], to = rows[i];
        if (from.value === null || to.value === null) continue;
        const isOver = (row) => row.distance === 0 || (row.value + target - eye) / row.distance >= steepest;
        const begins = isOver(from);
        const ends = isOver(to);
        if (begins !== ends) {
            // where the target's height meets the steepest line so far
            const gap = (row) => row.value + target - eye - steepest * row.distance, share = gap(from) / (gap(from) - gap(to));
            const mix = (key) => from[key] + share * (to[key] - from[key]);
            const middle = { x: mix("x"), y: mix("y"), along: mix("along"), distance: mix("distance"), value: mix("value") };
            add(begins, middle);
        }
        add(ends, to);
        if (to.distance > 0) steepest = Math.max(steepest, rise(to));
    }
    return parts;
}

function showSight(rows, seen) {
    const [observer, target] = ["observer", "target"].map(heightAbove), parts = sightParts(rows, observer, target);
    drawing.features = [...parts.map((part) => line(part.isVisible ? "visible" : "hidden", part.rows.map((row) => [row.x, row.y]))),
        ...drawing.path.map((place, i) => feature("place", "Point", coordinates.toMap(place), { name: ["Observer", "Target"][i] })),
        ...(seen?.x !== null && seen?.x !== undefined ? places([[seen.x, seen.y]]) : [])];
    draw();
    const first = rows[0], last = rows.at(-1), ends = [first, last].every((row) => row.value !== null);
    const as = (list, more) => ({ x: list.map((row) => row.along), y: list.map((row) => row.value), ...more });
    openChart({ title: "Line of sight", words: "The ground along the line of sight: parts that are visible and parts that are hidden", name: attribute().name, unit: element("unit").value, unitOfLength: coordinates.unit,
        moved: follow([rows]), series: [as(rows, { colour: "#8a9491", width: 1, fill: "#8a949126" }),
            ...parts.map((part) => as(part.rows, { colour: part.isVisible ? colours.visible : colours.hidden, width: 3 })),
            ...(ends ? [{ x: [first.along, last.along], y: [first.value + observer, last.value + target], colour: "#1558d6", width: 1.5, dash: [6, 4] }] : [])] });
    const length = (isVisible) => parts.filter((part) => part.isVisible === isVisible).reduce((sum, part) => sum + part.rows.at(-1).along - part.rows[0].along, 0);
    return { visible: length(true), hidden: length(false) };
}

export async function sight(place) {
    if (!attribute()) throw new Error("The mesh has no attribute, so it has no heights to look over.");
    if (drawing.path.length === 2) {
        clearLines();
        openPanel("panel", false);
    }
    drawing.path.push(place);
    draw(places(drawing.path));
    if (drawing.path.length < 2) return say("Observer set. Now click the target.");
    const [from, to] = drawing.path, [seen, profiled] = await Promise.all([
        ask("sight", named({ from: from.join(","), to: to.join(","), observer: heightAbove("observer"), target: heightAbove("target") })),
        ask("profile", named({ path: [...from, ...to].join(",") }))]);
    const { visible, hidden } = showSight(withDistances(profiled), seen), isBlocked = seen?.x !== null && seen?.x !== undefined;
    say([table([["Line of sight", seen?.visible === true ? "the target is visible" : seen?.visible === false ? "the target is not visible" : "unknown: a place is outside the mesh"],
        ...(isBlocked ? [["Blocked at", `${[seen.x, seen.y].map(number).join(", ")}, height ${number(seen.z)}`]] : []),
        ["Observer", from.map(number).join(", ")], ["Target", to.map(number).join(", ")],
        ["Length", measured(coordinates.distance(from, to), coordinates.unit)],
        ["Visible", measured(visible, coordinates.unit)], ["Hidden", measured(hidden, coordinates.unit)]])]);
}
