// The colours of a mesh in space: of an attribute on a palette, or of a label, one colour for each of its values. A colour is a
// place on a texture, so that the values between the corners of a triangle have the colours that the legend shows.
import * as three from "three";
import { element, made } from "./common.js";
import { drawLegend } from "./legend.js";
import { drawPalette } from "./palette.js";
import { mesh, theme } from "./scene.js";
import { rangeOf } from "./series.js";

// Okabe and Ito's colours, which most people can tell apart, and lighter or darker ones.
const categories = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#f0e442", "#7a5195", "#8c564b", "#6b8e23", "#99a3a4", "#2f4b7c", "#f4a582", "#a6d854", "#b2182b", "#80cdc1"];
const width = 512;

export const attribute = () => mesh.attributes.find((one) => one.name === element("attribute").value) ?? null;
/** The label that is chosen, or null. */
export const label = () => (attribute() ? null : mesh.labels[Number(/^label (\d+)$/.exec(element("attribute").value)?.[1] ?? -1)] ?? null);
/** What requests name: a picture takes an attribute or a label. */
export const named = (parameters) => ({ ...parameters, ...(attribute() && { attribute: attribute().name }) });
export const labelAt = () => mesh.labels.indexOf(label());

export function colourRange() {
    const [low, high] = attribute() ? rangeOf(attribute(), mesh.attributes) : [0, 1];
    return low === null ? [0, 1] : [low, high > low ? high : low + 1];
}

let texture = null;
/** Values of the label, in the order in which they were seen first; each keeps its colour. */
const seen = new Map();

/** The palette above, and what has no value below. */
function paint() {
    const canvas = document.createElement("canvas"), context = canvas.getContext("2d");
    [canvas.width, canvas.height] = [width, 2];
    if (label()) categories.forEach((colour, i) => { context.fillStyle = colour; context.fillRect((i * width) / categories.length, 0, width / categories.length + 1, 1); });
    else drawPalette(Object.assign(canvas, { width, height: 2 }), element("ramp").value);
    context.fillStyle = `#${theme().body.toString(16)}`;
    context.fillRect(0, 1, width, 1);
    texture = new three.CanvasTexture(canvas);
    Object.assign(texture, { colorSpace: three.SRGBColorSpace, generateMipmaps: false, minFilter: label() ? three.NearestFilter : three.LinearFilter, magFilter: label() ? three.NearestFilter : three.LinearFilter });
}
/** A texture for a material of its own. */
export const palette = () => (paint(), texture);

/** Where on the texture a value is. */
export function place(value) {
    if (value === null || value === undefined || !(attribute() || label())) return [0.5, 0.25];
    if (label()) {
        if (!seen.has(value)) seen.set(value, seen.size);
        return [((seen.get(value) % categories.length) + 0.5) / categories.length, 0.75];
    }
    const [low, high] = colourRange(), share = Math.min(Math.max((value - low) / (high - low), 0), 1);
    return [(share * (width - 1) + 0.5) / width, 0.75];
}

/** One colour, for a surface of one value. */
export function colourOf(value) {
    const canvas = document.createElement("canvas"), context = canvas.getContext("2d", { willReadFrequently: true });
    [canvas.width, canvas.height] = [width, 1];
    drawPalette(canvas, element("ramp").value);
    const [r, g, b] = context.getImageData(Math.min(Math.floor(place(value)[0] * width), width - 1), 0, 1, 1).data;
    return new three.Color(`rgb(${r}, ${g}, ${b})`);
}

export const forgetLabels = () => seen.clear();

export function legend() {
    const isBare = !attribute() && !label();
    document.body.classList.toggle("bare", isBare);
    document.body.classList.toggle("labelled", Boolean(label()));
    if (attribute()) drawLegend({ name: attribute().name, unit: element("unit").value, palette: element("ramp").value, range: colourRange() });
    if (!label()) return;
    element("legend-name").textContent = label();
    element("legend-unit").textContent = "";
    element("legend-values").replaceChildren(...[...seen].sort(([a], [b]) => a - b).slice(0, 40).map(([value, at]) => {
        const patch = made("i", {});
        patch.style.background = categories[at % categories.length];
        return made("li", {}, patch, value.toLocaleString("en", { maximumSignificantDigits: 6 }));
    }));
}
