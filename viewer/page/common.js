// What both pages have in common: words and tables.

export const element = (id) => document.getElementById(id);
export const tool = () => document.forms.tools.elements.tool.value;

/** Runs what somebody has asked for, and says what went wrong. */
export async function answering(task) {
    element("view").setAttribute("aria-busy", "true");
    try {
        return await task();
    } catch (error) {
        say(error.message, "error");
    } finally {
        element("view").removeAttribute("aria-busy");
    }
}

export function say(content, kind = "") {
    const answer = element("answer");
    answer.className = kind;
    answer.replaceChildren(...[content].flat());
}

export function made(name, attributes = {}, ...children) {
    const svg = ["svg", "path", "circle", "text", "title"].includes(name);
    const node = svg ? document.createElementNS("http://www.w3.org/2000/svg", name) : document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
    node.append(...children);
    return node;
}

/** A number of things in words: 1 change, 2 changes. */
export const counted = (count, one, many = `${one}s`) => `${count} ${count === 1 ? one : many}`;

/** The same as a part of a sentence: 1 unsaved change was undone. */
export const undone = (count) => `${counted(count, "unsaved change")} ${count === 1 ? "was" : "were"} undone`;

/** 6 triangles surround it. */
export const surround = (things, count, what) => `${things} ${count === 1 ? "surrounds" : "surround"} ${what}.`;

export const number = (x) => (x === null || x === undefined ? "none" : Number(x.toPrecision(8)).toString());

export function table(rows, heads) {
    return made("table", {}, ...(heads ? [made("tr", {}, ...heads.map((head) => made("th", { scope: "col" }, head)))] : []),
        ...rows.map(([head, ...cells]) => made("tr", {}, made(heads ? "td" : "th", heads ? {} : { scope: "row" }, String(head)),
            ...cells.map((cell) => made("td", {}, String(cell))))));
}

/** Centre and radius of the circle or sphere through the corners of a simplex. */
export function circumsphere(corners) {
    const n = corners.length - 1, a = corners[0];
    const rows = corners.slice(1).map((p) => {
        const d = p.map((x, i) => x - a[i]);
        return [...d, d.reduce((sum, x) => sum + x * x, 0) / 2];
    });
    for (let i = 0; i < n; ++i) { // Gauss, with the greatest pivot
        const best = rows.slice(i).reduce((at, row, k) => (Math.abs(row[i]) > Math.abs(rows[at][i]) ? i + k : at), i);
        [rows[i], rows[best]] = [rows[best], rows[i]];
        for (let k = 0; k < n; ++k)
            if (k !== i) rows[k] = rows[k].map((x, j) => x - (rows[i][j] * rows[k][i]) / rows[i][i]);
    }
    const to = rows.map((row, i) => row[n] / row[i]);
    return { center: to.map((x, i) => x + a[i]), radius: Math.hypot(...to) };
}

export const centroid = (corners) => corners[0].map((_, axis) => corners.reduce((sum, p) => sum + p[axis], 0) / corners.length);

/** What there is to say of a place. */
export function describe(found, word) {
    const rows = [["place", found.place.map(number).join(", ")]];
    if (!found.simplex) rows.push([word, "none: the place is outside the mesh"]);
    else {
        const { center, radius } = circumsphere(found.simplex.corners);
        rows.push([`vertices of the ${word}`, found.simplex.ids.join(" ")], ["code", found.simplex.code],
            [found.place.length === 2 ? "circumcircle" : "circumsphere", `radius ${number(radius)}, centre ${center.map(number).join(", ")}`]);
        found.neighbours.forEach((one, facet) => rows.push([`across facet ${facet}`, one ? one.ids.join(" ") : "none: the mesh ends here"]));
    }
    for (const [method, value] of Object.entries(found.values)) rows.push([`value, ${method}`, number(value)]);
    if (found.nearest) rows.push(["nearest vertex", `${found.nearest.vertex}, ${number(found.nearest.distance)} away`]);
    return table(rows);
}

/** Buttons that walk to neighbours. */
export function offerWalk(found, walk) {
    element("walk").hidden = !found?.simplex;
    element("facets").replaceChildren(...(found?.neighbours ?? []).map((one, facet) => {
        const button = made("button", { type: "button", ...(one ? {} : { disabled: "" }) }, `facet ${facet}`);
        button.addEventListener("click", () => walk(facet));
        return button;
    }));
}
