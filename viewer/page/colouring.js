// The colours of a mesh in space: of an attribute on a palette, or of a label, one colour for each of its values if they are few. A colour is a
// place on a texture, so that the values between the corners of a triangle have the colours that the legend shows.
import * as three from "three";
import { element, made } from "./common.js";
import { drawLegend } from "./legend.js";
import { drawPalette } from "./palette.js";
import { ask } from "./requests.js";
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

let values = { least: null, greatest: null, values: null }; // of the label that is chosen

/** Reads the values of the label, if one is chosen. */
export async function readLabel() {
    if (label()) values = await ask("label", { name: label() });
}
/** Whether each value has a colour of its own; more than can be told apart are on the palette. */
const isOfKinds = () => label() !== null && values.values !== null;

export function colourRange() {
    const [low, high] = attribute() ? rangeOf(attribute(), mesh.attributes) : label() ? [values.least, values.greatest] : [0, 1];
    return low === null ? [0, 1] : [low, high > low ? high : low + 1];
}

let texture = null;

/** The palette above, and what has no value below. */
function paint() {
    const canvas = document.createElement("canvas"), context = canvas.getContext("2d");
    [canvas.width, canvas.height] = [width, 2];
    if (isOfKinds()) categories.forEach((colour, i) => { context.fillStyle = colour; context.fillRect((i * width) / categories.length, 0, width / categories.length + 1, 1); });
    else drawPalette(Object.assign(canvas, { width, height: 2 }), element("ramp").value);
    context.fillStyle = `#${theme().body.toString(16)}`;
    context.fillRect(0, 1, width, 1);
    texture = new three.CanvasTexture(canvas);
    Object.assign(texture, { colorSpace: three.SRGBColorSpace, generateMipmaps: false, minFilter: isOfKinds() ? three.NearestFilter : three.LinearFilter, magFilter: isOfKinds() ? three.NearestFilter : three.LinearFilter });
}
/** A texture for a material of its own. */
export const palette = () => (paint(), texture);

/** Where on the texture a value is. */
export function place(value) {
    if (value === null || value === undefined || !(attribute() || label())) return [0.5, 0.25];
    if (isOfKinds()) return [(values.values.indexOf(value) + 0.5) / categories.length, 0.75];
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

export function legend() {
    const name = attribute()?.name ?? label();
    document.body.classList.toggle("bare", name === null);
    document.body.classList.toggle("labelled", isOfKinds());
    if (name === null) return;
    drawLegend({ name, unit: element("unit").value, palette: element("ramp").value, range: colourRange() });
    element("legend-values").replaceChildren(...(isOfKinds() ? values.values : []).map((value, i) => {
        const patch = made("i", {});
        patch.style.background = categories[i];
        return made("li", {}, patch, value.toLocaleString("en", { maximumSignificantDigits: 6 }));
    }));
}
