// What is under the pointer in space: coordinates, and the value or label there.
import { element, made } from "./common.js";
import { attribute, label, labelAt } from "./colouring.js";
import { extent, mesh } from "./scene.js";
import { plain, rounded } from "./numbers.js";
import { ask } from "./requests.js";

const minus = (a, b) => a.map((x, i) => x - b[i]);
/** Six times the volume of a tetrahedron, with its sign. */
function volume([a, b, c, d]) {
    const [[ux, uy, uz], [vx, vy, vz], [wx, wy, wz]] = [minus(b, a), minus(c, a), minus(d, a)];
    return ux * (vy * wz - vz * wy) - uy * (vx * wz - vz * wx) + uz * (vx * wy - vy * wx);
}
/** The value at a place of a tetrahedron with values at its corners, whose shares there are its parts of the volume. */
function valueAt(place, corners, values) {
    const whole = volume(corners);
    return corners.reduce((sum, _, i) => sum + (volume(corners.map((corner, k) => (k === i ? place : corner))) / whole) * (values[i] ?? NaN), 0);
}

async function valueOf(place) {
    const at = Object.fromEntries(place.map((x, i) => ["xyz"[i], x])), column = mesh.attributes.indexOf(attribute());
    if (mesh.kind === "octree") return column < 0 ? null : (await ask("locate", at)).leaf?.values?.[column] ?? null;
    const [cell] = await ask("star", at);
    if (label()) return cell?.labels?.[labelAt()] ?? null;
    return cell?.values && column >= 0 ? valueAt(place, cell.corners, cell.values.map((values) => values?.[column])) : null;
}

let next = null, isBusy = false;
function write(place, value) {
    const words = place.map((x, i) => plain(x, extent[i]).toLocaleString("en", { maximumFractionDigits: 12 }));
    element("pointer").replaceChildren(made("span", {}, words.join("  ")));
    if (value === null || Number.isNaN(value)) return;
    const { least = 0, greatest = 0 } = attribute() ?? {};
    element("pointer").append(made("strong", {}, attribute() ? `${rounded(value, (greatest - least || 1) / 5000)} ${element("unit").value}`.trim() : `${label()} ${value.toLocaleString("en", { maximumSignificantDigits: 6 })}`));
}

/** Shows a place, or nothing; of its values one is asked for at a time. */
export async function point(place) {
    next = place;
    if (!place) return element("pointer").replaceChildren();
    write(place, null);
    if (isBusy) return undefined;
    isBusy = true;
    while (next) {
        const asked = next, value = await valueOf(asked).catch(() => null); // the next answer says so
        if (next !== asked) continue;
        next = null;
        write(asked, value);
    }
    isBusy = false;
    return undefined;
}
