// The legend of the colours, and the scale of the map.
import { element } from "./common.js";
import { measured, niceBelow, rounded } from "./numbers.js";
import { drawPalette } from "./palette.js";

/** Values at even steps within a range, from 3 to 6 of them. */
export function ticks([low, high]) {
    const step = niceBelow((high - low) / 3), found = [];
    for (let i = Math.ceil(low / step - 1e-9); i * step <= high + step * 1e-9; ++i) found.push(i * step || 0); // not -0
    return { step, values: found };
}

export function drawLegend({ name, unit, palette, range }) {
    const [low, high] = range, { step, values } = ticks(range);
    element("legend-name").textContent = name;
    element("legend-unit").textContent = unit && `(${unit})`;
    drawPalette(element("legend-ramp"), palette);
    element("legend-ramp").setAttribute("aria-label", `Colours of ${name} from ${low} to ${high} ${unit}`);
    element("legend-ticks").replaceChildren(...values.map((value) => {
        const mark = document.createElement("span");
        mark.textContent = rounded(value, step);
        mark.style.left = `${(100 * (value - low)) / (high - low)}%`;
        return mark;
    }));
}

/** A bar of a round length, as long as the map shows it in its middle. */
export function drawScale(map, coordinates) {
    const { width, height } = map.getCanvas().getBoundingClientRect(), most = 120;
    const [a, b] = [-most / 2, most / 2].map((dx) => coordinates.toMesh(map.unproject([width / 2 + dx, height / 2])));
    const length = coordinates.distance(a, b);
    if (!(length > 0)) return;
    const nice = niceBelow(length), words = measured(nice, coordinates.unit);
    element("scale").style.width = `${(most * nice) / length}px`;
    element("scale").firstElementChild.textContent = words;
    element("scale").setAttribute("aria-label", `Scale: the bar is ${words} long`);
}
