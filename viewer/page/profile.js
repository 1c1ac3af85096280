// Profiles: the attribute along lines, as a chart and as CSV.
import { openChart } from "./chart.js";
import { counted, element, number, say } from "./common.js";
import { measured } from "./numbers.js";
import { draw, drawing, follow, withDistances } from "./drawing.js";
import { attribute, coordinates, line, named, places } from "./map.js";
import { ask } from "./requests.js";

const palette = ["#1558d6", "#c2410c", "#0a7d4f", "#8b2fc9", "#a16207", "#be185d"];
const mostPoints = 2000; // of crossed edges: more cannot be told apart

function showProfiles() {
    const withPoints = element("crossings").checked;
    drawing.features = drawing.lines.flatMap(({ places: corners, rows, colour }) => [line("path", corners, { colour }), ...places(corners),
        ...(withPoints && rows.length <= mostPoints ? places(rows.filter((row) => row.value !== null).map((row) => [row.x, row.y]), "crossing") : [])]);
    draw();
    const last = drawing.lines.at(-1), known = last.rows.filter((row) => row.value !== null), { name } = attribute();
    const [low, high] = known.reduce(([least, most], { value }) => [Math.min(least, value), Math.max(most, value)], [Infinity, -Infinity]);
    const rounded = (value) => number(Number(value.toPrecision(6)));
    const words = `Profile of ${name}: ${counted(known.length, "place")}, length ${measured(last.rows.at(-1).along, coordinates.unit)}${known.length ? `, values ${rounded(low)} to ${rounded(high)}` : ""}`;
    element("dock").dataset.places = known.length;
    openChart({ title: drawing.lines.length > 1 ? `${drawing.lines.length} profiles` : "Profile", words, hasTools: true, name, unit: element("unit").value, unitOfLength: coordinates.unit, moved: follow(drawing.lines.map(({ rows }) => rows)),
        series: drawing.lines.map(({ rows, colour }) => ({ x: rows.map((row) => row.along), y: rows.map((row) => row.value), colour,
            fill: drawing.lines.length === 1 ? `${colour}1f` : undefined, hasPoints: withPoints && rows.length <= mostPoints })) });
    say(`${words}. Click to extend the line, or press Escape to start again.`);
}

export async function profile(place) {
    if (!attribute()) throw new Error("The mesh has no attribute, so it has no profile.");
    drawing.path.push(place);
    draw([...places(drawing.path), ...(drawing.path.length > 1 ? [line("path", drawing.path)] : [])]);
    if (drawing.path.length < 2) return say("Start of the line. Click the next point.");
    const corners = [...drawing.path], rows = withDistances(await ask("profile", named({ path: corners.flat().join(",") })));
    if (corners.length > 2) drawing.lines.pop();
    drawing.lines.push({ places: corners, rows, colour: palette[drawing.lines.length % palette.length] });
    showProfiles();
}

function another() {
    drawing.path = [];
    say("Click the start of another line.");
}

/** All places of the lines as text with commas. */
function csv() {
    const head = ["line", "distance", "x", "y", attribute().name.replace(/^(.*[",\n].*)$/s, (text) => `"${text.replaceAll('"', '""')}"`)];
    return [head, ...drawing.lines.flatMap(({ rows }, i) => rows.map((row) => [i + 1, row.along, row.x, row.y, row.value ?? ""]))].map((row) => row.join(",")).join("\n") + "\n";
}

export function setUpProfiles() {
    element("crossings").addEventListener("change", () => drawing.lines.length && showProfiles());
    element("profile-another").addEventListener("click", another);
    element("profile-copy").addEventListener("click", async () => {
        const text = csv();
        await navigator.clipboard.writeText(text).then(() => say(`${counted(text.split("\n").length - 2, "place")} copied.`), () => say("The browser does not let the page copy.", "error"));
    });
}
