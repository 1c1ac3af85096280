// What both pages have in common: words and tables.

export const element = (id) => document.getElementById(id);
export const tool = () => document.forms.tools.elements.tool.value;

let running = 0;
/** Runs what somebody has asked for, and says what went wrong. */
export async function answering(task) {
    ++running;
    element("view").setAttribute("aria-busy", "true");
    try {
        return await task();
    } catch (error) {
        say(error.message, "error");
    } finally {
        if (--running === 0) element("view").removeAttribute("aria-busy");
    }
}

const patience = 1500; // ms

/** What the page cannot do without. It says so if this takes long, and what went wrong if it fails: then the page stops here. */
export async function essential(task) {
    const timer = setTimeout(() => say("The mesh is being read. The first time this takes a while if it is large."), patience);
    try {
        return await task();
    } catch (error) {
        say(`${error.message} Reload the page to try again.`, "error");
        throw error;
    } finally {
        clearTimeout(timer);
    }
}

/** A sentence goes to the line at the bottom, what is longer to the panel, which opens. */
export function say(content, kind = "") {
    const isLine = typeof content === "string";
    element("hint").className = `card ${kind}`;
    element("hint").hidden = !isLine;
    element("hint-text").textContent = isLine ? content : "";
    if (isLine) return;
    element("answer").replaceChildren(...[content].flat());
    openPanel("panel");
}

/** An error that nobody's question led to, as of a tile: one that is shown already stays, since it may say what was lost. */
export function mention(text) {
    const { hidden, classList } = element("hint");
    if (hidden || !classList.contains("error")) say(text, "error");
}

/** Opens a panel. On a small screen there is room for one. */
export function openPanel(id, isOpen = true) {
    element(id).hidden = !isOpen;
    for (const other of ["panel", "display"])
        if (isOpen && other !== id && matchMedia("(max-width: 60rem)").matches) openPanel(other, false);
    const button = element(`${id}-open`);
    button?.setAttribute("aria-expanded", String(isOpen));
}

/** Buttons that close what they are in. */
export function setUpPanels() {
    for (const button of document.querySelectorAll(".close"))
        button.addEventListener("click", () => {
            const closed = button.closest("[id].card");
            if (element(`${closed.id}-open`)) openPanel(closed.id, false);
            else closed.hidden = true;
            closed.dispatchEvent(new Event("closed"));
        });
    element("display-open").addEventListener("click", () => openPanel("display", element("display").hidden));
    element("go-open").addEventListener("click", () => {
        element("go").hidden = !element("go").hidden;
        element("go-open").setAttribute("aria-expanded", String(!element("go").hidden));
        if (!element("go").hidden) element("x").focus();
    });
}

export function made(name, attributes = {}, ...children) {
    const svg = ["svg", "path", "circle", "text", "title"].includes(name);
    const node = svg ? document.createElementNS("http://www.w3.org/2000/svg", name) : document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
    node.append(...children);
    return node;
}

/** A number of things in words: 1 change, 2 changes. */
export const counted = (count, one, many = `${one}s`) => `${count} ${String(count) === "1" ? one : many}`;

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

/** What there is to say of a place: the value, and the simplex around it. `names`: of the attributes. */
export function describe(found, word, names = [], unit = "") {
    const parts = [];
    const { linear } = found.values;
    if (linear !== undefined && linear !== null) parts.push(made("p", { class: "value" }, number(linear), made("small", {}, unit && ` ${unit}`)));
    const rows = [["Place", found.place.map(number).join(", ")]];
    if (found.nearest) rows.push(["Nearest vertex", `${found.nearest.vertex}, ${number(found.nearest.distance)} away`]);
    if (!found.simplex) rows.push([capital(word), "none: the place is outside the mesh"]);
    if (found.region) rows.push(["Region", found.region]);
    for (const [method, value] of Object.entries(found.values)) rows.push([`Value, ${method}`, number(value)]);
    if (!found.simplex) return [...parts, table(rows)];
    const { center, radius } = circumsphere(found.simplex.corners), { ids, values, code } = found.simplex;
    const corners = ids.map((id, i) => [id, ...names.map((_, k) => number(values?.[i]?.[k]))]);
    const more = [[found.place.length === 2 ? "Circumcircle" : "Circumsphere", `radius ${number(radius)}, centre ${center.map(number).join(", ")}`], ["Code", code],
        ...found.neighbours.map((one, facet) => [`Across facet ${facet}`, one ? one.ids.join(" ") : "none: the mesh ends here"])];
    return [...parts, table(rows), made("h3", {}, `Vertices of the ${word}`), table(corners, ["id", ...names]),
        made("h3", {}, capital(word)), table(more)];
}
const capital = (word) => word[0].toUpperCase() + word.slice(1);

/** Buttons that walk to neighbours. */
export function offerWalk(found, walk) {
    element("walk").hidden = !found?.simplex;
    element("facets").replaceChildren(...(found?.neighbours ?? []).map((one, facet) => {
        const button = made("button", { type: "button", ...(one ? {} : { disabled: "" }) }, `facet ${facet}`);
        button.addEventListener("click", () => walk(facet));
        return button;
    }));
}
