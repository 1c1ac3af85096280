// A profile as a picture: the value along the way, with a dot at each edge that is crossed.
import { counted, made, number, table } from "./common.js";

const mostDots = 2000, mostInTable = 1000; // more cannot be told apart, nor read
const width = 360, height = 180, margin = { left: 46, right: 8, top: 10, bottom: 22 };

export function chart(rows, name) {
    const known = rows.filter((row) => row.value !== null);
    const [low, high] = known.reduce(([least, most], { value }) => [Math.min(least, value), Math.max(most, value)], [Infinity, -Infinity]);
    const length = rows.at(-1).distance;
    const x = (distance) => margin.left + (distance / (length || 1)) * (width - margin.left - margin.right);
    const y = (value) => height - margin.bottom - ((value - low) / (high - low || 1)) * (height - margin.top - margin.bottom);
    let path = "", isOpen = false;
    for (const row of rows) {
        if (row.value !== null) path += `${isOpen ? "L" : "M"}${x(row.distance).toFixed(2)},${y(row.value).toFixed(2)}`;
        isOpen = row.value !== null;
    }
    const text = (at, words, anchor) => made("text", { class: "axis", x: at[0], y: at[1], "text-anchor": anchor }, words);
    const dots = (known.length > mostDots ? [] : known).map((row) => made("circle", { class: "crossing", cx: x(row.distance).toFixed(2), cy: y(row.value).toFixed(2), r: rows.length > 150 ? 1 : 2 },
        made("title", {}, `${number(row.value)} at distance ${number(row.distance)}`)));
    const words = `Profile of ${name}: ${counted(known.length, "place")}, length ${number(length)}${known.length ? `, values ${number(low)} to ${number(high)}` : ""}`;
    const picture = made("svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": words }, made("path", { class: "line", d: path }), ...dots,
        ...(known.length ? [text([margin.left - 4, y(high) + 4], number(Number(high.toPrecision(5))), "end"), text([margin.left - 4, y(low)], number(Number(low.toPrecision(5))), "end")] : []),
        text([margin.left, height - 6], "0", "start"), text([width - margin.right, height - 6], number(Number(length.toPrecision(5))), "end"));
    const details = made("details", {}, made("summary", {}, rows.length > mostInTable ? `As a table (the first ${mostInTable} places)` : "As a table"),
        table(rows.slice(0, mostInTable).map((row) => [number(row.distance), number(row.x), number(row.y), number(row.value)]), ["distance", "x", "y", name]));
    return { picture, details, words };
}
