// A line that is being drawn on the map, place by place, and the shapes of those that are finished.
import { closeChart } from "./chart.js";
import { element, number } from "./common.js";
import { measured } from "./numbers.js";
import { coordinates, places, show } from "./map.js";

export const drawing = { path: [], features: [], lines: [] };

/** Forgets all lines. */
export function clearLines() {
    Object.assign(drawing, { path: [], features: [], lines: [] });
    closeChart();
}

/** Shows the shapes of the drawing, and more until the next time. */
export const draw = (more = []) => show([...drawing.features, ...more]);

/** Distances along rows of a profile, as the map measures them. */
export function withDistances(rows) {
    let sum = 0;
    return rows.map((row, i) => ({ ...row, along: (sum += i ? coordinates.distance([rows[i - 1].x, rows[i - 1].y], [row.x, row.y]) : 0) }));
}

/** The row before a distance, and the place and value there. */
function at(rows, along) {
    let low = 0, high = rows.length - 1;
    while (high - low > 1) {
        const middle = (low + high) >> 1;
        if (rows[middle].along <= along) low = middle;
        else high = middle;
    }
    const a = rows[low], b = rows[high], share = b.along > a.along ? Math.min(Math.max((along - a.along) / (b.along - a.along), 0), 1) : 0;
    const mix = (key) => (a[key] === null || b[key] === null ? null : a[key] + share * (b[key] - a[key]));
    const slope = a.value === null || b.value === null || b.along === a.along ? null : (b.value - a.value) / (b.along - a.along);
    return { place: [mix("x"), mix("y")], value: mix("value"), slope };
}

/** What the cursor of a chart shows: a dot on each line of the map, the distance, values and slopes. */
export function follow(lines) {
    return (along) => {
        if (along === null) {
            element("dock-cursor").textContent = "";
            return draw();
        }
        const found = lines.filter((rows) => along <= rows.at(-1).along).map((rows) => at(rows, along));
        const unit = element("unit").value;
        const words = found.map(({ value, slope }) => (value === null ? "no value" : `${number(Number(value.toPrecision(5)))} ${unit}`.trim() +
            (slope === null ? "" : `, slope ${coordinates.unit && coordinates.unit === unit ? `${(100 * slope).toFixed(1)} %` : Number(slope.toPrecision(2))}`)));
        element("dock-cursor").textContent = [measured(along, coordinates.unit), ...words].join(" · ");
        draw(places(found.map(({ place }) => place), "cursor"));
    };
}

