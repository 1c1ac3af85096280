// Profiles as a chart: the value along each line, with axes, and a cursor that other parts follow.
import UPlot from "uplot";
import { element } from "./common.js";

const style = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
let plot = null, shown = null, opened = () => {};

function axes(unitOfLength, name, unit) {
    const common = { stroke: style("--muted"), font: "12px system-ui, sans-serif", grid: { stroke: style("--line"), width: 1 }, ticks: { stroke: style("--line"), width: 1, size: 4 } };
    const words = (plot, values) => values.map((value) => value.toLocaleString("en", { maximumSignificantDigits: 6 }));
    return [{ ...common, label: unitOfLength ? `Distance (${unitOfLength})` : "Distance", labelSize: 18, labelFont: "12px system-ui, sans-serif", size: 34, values: words },
        { ...common, label: unit ? `${name} (${unit})` : name, labelSize: 18, labelFont: "12px system-ui, sans-serif", size: 62, values: words }];
}

/** Values between those of the x that a series has: the chart has one list of x for all of them. */
function joined(series) {
    return UPlot.join(series.map(({ x, y }) => [x, y]), series.map(({ y }) => y.map((value) => (value === null ? 2 : 1))));
}

function draw() {
    const box = element("chart"), { series, name, unit, unitOfLength, moved } = shown;
    plot?.destroy();
    plot = new UPlot({
        width: Math.max(box.clientWidth, 100), height: Math.max(box.clientHeight, 100),
        scales: { x: { time: false } },
        legend: { show: false },
        cursor: { y: false, points: { size: 9, fill: (one, i) => one.series[i].stroke(), stroke: () => style("--surface-solid"), width: 2 }, drag: { x: true, y: false } },
        axes: axes(unitOfLength, name, unit),
        series: [{}, ...series.map(({ colour, width = 2, dash, fill, hasPoints }) => ({ stroke: colour, width, dash, fill, spanGaps: true,
            points: { show: Boolean(hasPoints), size: 5, stroke: colour, fill: style("--surface-solid") } }))],
        hooks: { setCursor: [({ cursor, posToVal }) => moved(cursor.left >= 0 ? plot?.posToVal(cursor.left, "x") ?? null : null)] },
    }, joined(series), box);
}

/** Shows lines in the chart below the map: `series` of { x, y, colour … }; `moved(x)` hears where the cursor is. */
export function openChart(given) {
    shown = given;
    element("dock").hidden = false;
    document.body.classList.add("charted");
    element("dock-title").textContent = given.title;
    for (const tool of element("dock").querySelectorAll(".of-profiles")) tool.hidden = !given.hasTools;
    element("chart").setAttribute("aria-label", given.words);
    draw();
    opened(element("dock").offsetHeight);
}

export function closeChart() {
    if (element("dock").hidden && !plot) return;
    element("dock").hidden = true;
    document.body.classList.remove("charted");
    plot?.destroy();
    plot = shown = null;
    opened(0);
}

/** `closed` is called when the user closes the chart, `resized` with the height that it takes from the map. */
export function setUpChart(closed, resized) {
    opened = resized;
    new ResizeObserver(() => plot?.setSize({ width: element("chart").clientWidth, height: element("chart").clientHeight })).observe(element("chart"));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => shown && draw());
    element("dock").addEventListener("closed", () => (closeChart(), closed()));
}
