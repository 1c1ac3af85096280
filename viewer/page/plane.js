// The page of a mesh in the plane: its tools and settings.
import * as maplibre from "maplibre-gl";
import { setUpChart } from "./chart.js";
import { answering, counted, element, essential, openPanel, say, setUpPanels, tool } from "./common.js";
import { setUpComparison } from "./compare.js";
import { comparison } from "./comparison.js";
import { clearLines, drawing } from "./drawing.js";
import { setUpEditing } from "./editing.js";
import { setUpFixed } from "./fixed.js";
import { greatest, least, rangeWithin } from "./heights.js";
import { setUpHover } from "./hover.js";
import { icon, placeIcons } from "./icons.js";
import { clearFound, locate, walkTowards } from "./inspect.js";
import { drawLegend, drawScale } from "./legend.js";
import { attribute, colourRange, coordinates, exaggeration, fit, intervals, makeRoom, map, mesh, refresh, restyle, show } from "./map.js";
import { measure } from "./measure.js";
import { editors, forgetMoved, markChanges } from "./points.js";
import { profile, setUpProfiles } from "./profile.js";
import { setUpRegions } from "./regions.js";
import { setUpSeries } from "./series.js";
import { sight } from "./sight.js";

// ---- Tools -------------------------------------------------------------------------------------

const tools = { locate, profile, sight, measure, ...editors };
const first = { locate: "Click a place.", profile: "Click the start of a line.", sight: "Click the observer.", measure: "Click the first place.",
    insert: "Click where the point is to be.", move: "Click the point.", remove: "Click the point to delete." };
const use = (place) => answering(() => tools[tool()](place));

/** Forgets what has been asked and drawn. */
function forget() {
    clearFound();
    clearLines();
    forgetMoved();
    openPanel("panel", false);
    show([]);
}

/** Begins anew with the tool that is chosen. */
function begin() {
    forget();
    element("heights").hidden = tool() !== "sight";
    say(first[tool()]);
}

function setUpTools() {
    map.on("click", ({ lngLat }) => use(coordinates.toMesh(lngLat)));
    element("go").addEventListener("submit", (event) => {
        event.preventDefault();
        const place = [element("x"), element("y")].map((input) => input.valueAsNumber);
        if (place.some(Number.isNaN)) return say("x and y must be numbers.", "error");
        use(place);
    });
    element("tools").addEventListener("submit", (event) => event.preventDefault());
    element("tools").addEventListener("change", begin);
    element("panel").addEventListener("closed", () => (clearFound(), tool() === "locate" && show([])));
    const arrows = { ArrowRight: [1, 0], ArrowLeft: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    map.getCanvas().addEventListener("keydown", (event) => {
        if (event.key === "Enter") use(coordinates.toMesh(map.getCenter()));
        else if (event.key === "Escape") begin();
        else if (!arrows[event.key] || event.shiftKey || !walkTowards(arrows[event.key])) return;
        event.preventDefault();
        event.stopImmediatePropagation();
    }, { capture: true });
}

// ---- What is shown -----------------------------------------------------------------------------

const factor = (x) => `× ${Number(x.toPrecision(2)).toLocaleString("en")}`;

/** Writes what follows from the settings: the legend, lists, and words beside sliders. */
function write() {
    const found = attribute();
    document.body.classList.toggle("bare", !found || mesh.lower[0] === null);
    element("summary").textContent = `${counted(mesh.simplices.toLocaleString("en"), "triangle")}, ${counted(mesh.vertices.toLocaleString("en"), "vertex", "vertices")}`;
    if (!found || mesh.lower[0] === null) return;
    const { with: other, most, name } = comparison, unit = element("unit").value;
    drawLegend(other ? { name, unit, palette: "diverging", range: [-most, most] } : { name: found.name, unit, palette: element("ramp").value, range: colourRange() });
    element("shade-from-value").textContent = `${element("shade-from").value}°`;
    element("exaggeration-value").textContent = factor(exaggeration());
    const isClamped = found.least < least || found.greatest > greatest;
    element("clamped").hidden = !isClamped;
    element("clamped").textContent = isClamped ? `Relief and terrain show heights beyond ${least.toLocaleString("en")} and ${Math.ceil(greatest).toLocaleString("en")} as these. Colours and contours are right.` : "";
    writeInterval();
}

function writeInterval() {
    const automatic = element("interval").options[0], now = intervals();
    if (automatic && now) automatic.textContent = `automatic: ${now.chosen ? "" : now.at(Math.floor(map.getZoom()))}`.replace(/: $/, "");
}

/** What belongs to an attribute: intervals to choose from, the range, the unit that was entered for it. */
function chooseAttribute() {
    if (!attribute()) return;
    for (const id of ["low", "high"]) element(id).value = "";
    element("interval").replaceChildren(new Option("automatic", ""));
    element("interval").append(...(intervals()?.choices() ?? []).map((step) => new Option(step.toLocaleString("en"), step)));
    element("unit").value = localStorage.getItem(unitKey()) ?? "";
    for (const [id, value] of [["low", attribute().least], ["high", attribute().greatest]]) element(id).placeholder = value;
}
const unitKey = () => `unit of ${mesh.name} ${attribute().name}`;

async function rangeOfView() {
    const { _sw: southWest, _ne: northEast } = map.getBounds();
    const [a, b] = [southWest, northEast].map((place) => maplibre.MercatorCoordinate.fromLngLat(place));
    const range = await rangeWithin([a.x, b.y, b.x, a.y], 22);
    if (!range) return say("The view has no part of the mesh.", "error");
    [element("low").value, element("high").value] = range;
    changed();
}

const changed = () => (restyle(), write());

function setUpDisplay() {
    for (const id of ["ramp", "low", "high", "shade", "contours", "interval", "edges", "vertices", "lines", "regions", "base"]) element(id).addEventListener("change", changed);
    for (const id of ["shade-strength", "shade-from", "exaggeration"]) element(id).addEventListener("input", changed);
    element("attribute").addEventListener("change", () => answering(async () => (chooseAttribute(), await refresh())));
    element("unit").addEventListener("input", () => {
        localStorage.setItem(unitKey(), element("unit").value);
        write();
    });
    element("range-view").addEventListener("click", () => answering(rangeOfView));
    element("range-all").addEventListener("click", () => {
        for (const id of ["low", "high"]) element(id).value = "";
        changed();
    });
    element("relief").addEventListener("change", ({ target }) => {
        changed();
        map.easeTo({ pitch: target.checked ? 60 : 0, bearing: target.checked ? -20 : 0 });
    });
    element("base-row").hidden = !mesh.baseMap;
    map.on("move", () => drawScale(map, coordinates));
    map.on("zoomend", writeInterval);
    map.on("refreshed", write);
}

/** A button of the page beside those of the map. */
class Buttons {
    constructor(...buttons) { this.buttons = buttons; }
    onAdd() {
        this.box = document.createElement("div");
        this.box.className = "maplibregl-ctrl maplibregl-ctrl-group";
        for (const { id, name, picture, click } of this.buttons) {
            const button = document.createElement("button");
            Object.assign(button, { id, type: "button", title: name, ariaLabel: name });
            button.append(icon(picture));
            button.addEventListener("click", click);
            this.box.append(button);
        }
        return this.box;
    }
    onRemove() { this.box.remove(); }
}

placeIcons();
setUpPanels();
setUpTools();
setUpDisplay();
setUpChart(() => (clearLines(), show([])), (height) => makeRoom(height, [...drawing.path, ...drawing.lines.flatMap((one) => one.places)]));
setUpProfiles();
setUpSeries(() => mesh.attributes, () => map.once("idle"));
setUpHover();
map.addControl(new maplibre.NavigationControl({ visualizePitch: true }), "bottom-right");
map.addControl(new Buttons({ id: "fit", name: "Fit to mesh", picture: "maximize", click: fit },
    { id: "three", name: "Terrain in 3D", picture: "box", click: () => element("relief").click() }), "bottom-right");
document.body.classList.toggle("many", Boolean(mesh.isOneOfMany));
element("globe").hidden = !mesh.srid || !mesh.attributes.length || mesh.lower[0] === null;
element("name").textContent = mesh.name;
document.title = `${mesh.name} – Abacus`;
chooseAttribute();
if (mesh.edit) setUpEditing(async () => (forget(), refresh()), markChanges);
if (!map.isStyleLoaded()) await map.once("style.load");
await essential(refresh);
await Promise.all([setUpFixed(), setUpRegions()]);
drawScale(map, coordinates);
if (location.hash === "#3d" && attribute()) element("relief").click();
say(mesh.lower[0] === null ? "The mesh has no triangles yet." : first[tool()]);
await answering(() => setUpComparison(changed));
map.on("idle", () => element("view").setAttribute("data-ready", "true"));
map.on("dataloading", () => element("view").removeAttribute("data-ready"));
map.triggerRepaint();
