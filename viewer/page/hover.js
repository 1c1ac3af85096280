// What is under the pointer: coordinates, the region and the value there, and the triangle as an outline.
import { element, made } from "./common.js";
import { rounded } from "./numbers.js";
import { attribute, coordinates, line, map, mesh, put } from "./map.js";
import { withRegion } from "./regions.js";
import { ask } from "./requests.js";

const least = 7; // pixels of a triangle that is outlined
let cell = null; // the triangle that was read last
let next = null, isBusy = false;

/** Shares of the corners of a triangle at a place; all are at least 0 within it. */
function shares([a, b, c], [x, y]) {
    const whole = (b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]);
    const second = ((x - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (y - a[1])) / whole;
    const third = ((b[0] - a[0]) * (y - a[1]) - (x - a[0]) * (b[1] - a[1])) / whole;
    return [1 - second - third, second, third];
}
const isWithin = (place) => cell && shares(cell.corners, place).every((share) => share >= 0);

/** Places of the mesh a pixel apart: the step of the coordinates that are shown. */
function step() {
    const { width, height } = map.getCanvas().getBoundingClientRect(), middle = [width / 2, height / 2];
    const [a, b] = [middle, [middle[0] + 1, middle[1]]].map((point) => coordinates.toMesh(map.unproject(point)));
    return Math.max(Math.hypot(b[0] - a[0], b[1] - a[1]), 1e-12);
}

function write(place) {
    const words = place.map((x) => rounded(x, step())), column = attribute() ? mesh.attributes.indexOf(attribute()) : -1;
    element("pointer").replaceChildren(made("span", {}, words.join("  ")));
    if (isWithin(place) && cell.region) element("pointer").append(made("em", {}, cell.region));
    if (!isWithin(place) || column < 0 || !cell.values) return;
    const value = shares(cell.corners, place).reduce((sum, share, i) => sum + share * (cell.values[i]?.[column] ?? NaN), 0);
    const { least: low, greatest: high } = attribute();
    element("pointer").append(made("strong", {}, Number.isNaN(value) ? "no value" : `${rounded(value, (high - low || 1) / 5000)} ${element("unit").value}`.trim()));
}

/** The outline of the triangle, if it is large enough to be seen. */
function outline() {
    const size = cell ? Math.min(...[0, 1].map((axis) => {
        const at = cell.corners.map((corner) => map.project(coordinates.toMap(corner))[axis ? "y" : "x"]);
        return Math.max(...at) - Math.min(...at);
    })) : 0;
    put("under", size >= least ? [line("under", [...cell.corners, cell.corners[0]])] : []);
    element("view").dataset.under = size >= least ? [cell.v0, cell.v1, cell.v2].join(" ") : "";
}

/** Reads the triangle at the last place that the pointer was at; one request at a time. */
async function read() {
    isBusy = true;
    while (next) {
        const place = next;
        next = null;
        try {
            [cell = null] = await ask("star", { x: place[0], y: place[1], ...withRegion() });
        } catch {
            cell = null; // the next answer says so
        }
        outline();
        if (!next) write(place);
    }
    isBusy = false;
}

export function setUpHover() {
    map.on("mousemove", ({ lngLat }) => {
        const place = coordinates.toMesh(lngLat);
        write(place);
        if (isWithin(place)) return;
        next = place;
        if (!isBusy) read();
    });
    map.on("mouseout", () => {
        next = cell = null;
        outline();
        element("pointer").replaceChildren();
    });
    map.on("refreshed", () => { cell = null; });
    map.on("zoomend", outline);
}

