// What both pages have in common: requests, words, tables, changes.

export const element = (id) => document.getElementById(id);
export const tool = () => document.forms.tools.elements.tool.value;

let session = null; // of a browser that edits
export const sessionHeaders = () => (session ? { "X-Session": session } : {});

async function request(path, options) {
    const response = await fetch(path, { ...options, headers: { ...sessionHeaders(), ...options?.headers } });
    const answer = await response.json();
    if (response.ok) return answer;
    if (response.status === 410) session = null;
    throw new Error([answer.error, answer.hint].filter(Boolean).join(". "));
}

export const ask = (name, parameters = {}) => request(`/api/${name}?${new URLSearchParams(parameters)}`);
const post = (name, body = {}) =>
    request(`/edit/${name}`, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) });

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
    if (!found.simplex) rows.push([word, "none: the place is outside"]);
    else {
        const { center, radius } = circumsphere(found.simplex.corners);
        rows.push([`${word}, by ids`, found.simplex.ids.join(" ")], ["code", found.simplex.code],
            [found.place.length === 2 ? "circumcircle" : "circumsphere", `radius ${number(radius)} around ${center.map(number).join(", ")}`]);
        found.neighbours.forEach((one, facet) => rows.push([`across facet ${facet}`, one ? one.ids.join(" ") : "none: the hull"]));
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

// ---- Changes ------------------------------------------------------------------------------------

/** Sets the page up to edit; `changed` is called when the mesh may look different. */
export function setUpEditing(changed) {
    document.body.classList.add("edit");
    element("id").value = String(Date.now());
    const finish = (name, words) => answering(async () => {
        const { changes } = await post(name);
        show(0);
        say(words(changes));
        await changed();
    });
    element("save").addEventListener("click", () => finish("save", (n) => `Saved: ${n} changes.`));
    element("undo").addEventListener("click", () => finish("undo", (n) => `Undone: ${n} changes.`));
    addEventListener("beforeunload", (event) => { if (!element("save").disabled) event.preventDefault(); });
    addEventListener("pagehide", () => {
        if (session) fetch("/edit/end", { method: "POST", keepalive: true, body: "{}", headers: { "Content-Type": "application/json", ...sessionHeaders() } });
    });
}

function show(changes) {
    element("save").disabled = element("undo").disabled = changes === 0;
    element("changes").textContent = changes === 0 ? "no changes" : `${changes} not saved`;
}

/** A change; how many there are. */
export async function change(name, body) {
    session ??= (await post("begin")).session;
    show((await post(name, body)).changes);
    if (name === "insert") element("id").value = String(BigInt(element("id").value) + 1n);
}
