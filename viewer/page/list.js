// The list of the meshes of a database: a picture of each, what it is, how large it is and when it was written last.
import { counted, element, made } from "./common.js";
import { icon, placeIcons } from "./icons.js";
import { ask } from "./requests.js";

const units = ["bytes", "kB", "MB", "GB", "TB"];
function size(bytes) {
    const power = Math.min(Math.floor(Math.log(Math.max(bytes, 1)) / Math.log(1024)), units.length - 1);
    return `${(bytes / 1024 ** power).toLocaleString("en", { maximumSignificantDigits: 3 })} ${units[power]}`;
}

const spans = [["year", 31_557_600], ["month", 2_629_800], ["day", 86_400], ["hour", 3600], ["minute", 60]];
/** How long ago a time was, in words. */
function ago(time) {
    const seconds = (Date.now() - new Date(time)) / 1000, [name, length] = spans.find(([, length]) => seconds >= length) ?? [];
    return name ? new Intl.RelativeTimeFormat("en", { numeric: "auto" }).format(-Math.floor(seconds / length), name) : "just now";
}

const many = (count) => count.toLocaleString("en");
function content({ kind, dimension, simplices, vertices, leaves }) {
    if (kind === "octree") return [`${dimension === 2 ? "Quadtree" : "Octree"} of ${counted(many(leaves), "leaf", "leaves")}`];
    return [dimension === 2 ? counted(many(simplices), "triangle") : counted(many(simplices), "tetrahedron", "tetrahedra"), counted(many(vertices), "vertex", "vertices")];
}

function card(mesh) {
    const { schema, name, bytes, changed, srid, error } = mesh, address = `/mesh/${encodeURIComponent(schema)}/${encodeURIComponent(name)}/`;
    const picture = made("div", { class: "picture" }), isEmpty = !error && !mesh.simplices && !mesh.leaves;
    if (error || isEmpty) picture.append(icon(error ? "triangle-alert" : "shapes"));
    else {
        const image = made("img", { src: `${address}pictures/brief`, alt: "", loading: "lazy" });
        image.addEventListener("error", () => image.replaceWith(icon("shapes")));
        picture.append(image);
    }
    const facts = [size(bytes), ...(srid ? [`EPSG:${srid}`] : []), ...(changed ? [`written ${ago(changed)}`] : [])];
    const words = made("div", { class: "words" }, made("h2", {}, ...(schema === "public" ? [] : [made("small", {}, `${schema}.`)]), name),
        ...(error ? [made("p", { class: "error" }, error)] : [made("p", {}, isEmpty ? "Empty" : content(mesh).join(", "))]), made("p", { class: "facts" }, ...facts.map((fact) => made("span", {}, fact))));
    return error ? made("div", { class: "mesh" }, picture, words) : made("a", { class: "mesh", href: address }, picture, words);
}

let cards = [];
function filter() {
    const wanted = element("search").value.trim().toLowerCase();
    const found = cards.filter(([name, node]) => !(node.hidden = !name.includes(wanted)));
    element("summary").textContent = found.length === cards.length ? `${counted(many(cards.length), "mesh", "meshes")}` : `${many(found.length)} of ${counted(many(cards.length), "mesh", "meshes")}`;
}

placeIcons();
try {
    cards = (await ask("meshes")).map((mesh) => [`${mesh.schema}.${mesh.name}`.toLowerCase(), card(mesh)]);
    element("meshes").replaceChildren(...(cards.length ? cards.map(([, node]) => node) : [made("p", { class: "nothing" }, "This database has no mesh that you may read. abacus_triangulate() makes one.")]));
    element("search").addEventListener("input", filter);
    filter();
} catch (error) {
    element("summary").textContent = error.message;
}
element("meshes").dataset.ready = "true";
