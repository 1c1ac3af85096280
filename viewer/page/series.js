// A series of attributes: names that differ in one number, such as vs_0, vs_10, vs_20. A slider and a button run through it, and
// all of it has one range of colours.
import { element } from "./common.js";
import { icon } from "./icons.js";

const pause = 700; // ms between two steps, at least

/** The attributes that are a series with this one, in the order of their numbers; itself alone if there are none. */
function seriesOf(attribute, attributes) {
    const parts = (name) => /^(.*?)(-?\d+(?:\.\d+)?)(\D*)$/.exec(name);
    const own = parts(attribute.name);
    if (!own) return [attribute];
    return attributes.filter(({ name }) => {
        const found = parts(name);
        return found && found[1] === own[1] && found[3] === own[3];
    }).sort((a, b) => Number(parts(a.name)[2]) - Number(parts(b.name)[2]));
}

/** The least and the greatest value of a series. */
export function rangeOf(attribute, attributes) {
    const all = seriesOf(attribute, attributes).filter(({ least }) => least !== null);
    return all.length ? [Math.min(...all.map(({ least }) => least)), Math.max(...all.map(({ greatest }) => greatest))] : [null, null];
}

/** `attributes()` of the mesh; `shown()` is a promise that the step that was chosen is drawn. */
export function setUpSeries(attributes, shown) {
    const select = element("attribute"), slider = element("step"), button = element("play");
    const series = () => {
        const found = attributes().find(({ name }) => name === select.value);
        return found ? seriesOf(found, attributes()) : [];
    };
    let isPlaying = false;
    const write = () => {
        const all = series(), at = all.findIndex(({ name }) => name === select.value);
        element("series").hidden = all.length < 2;
        slider.max = String(Math.max(all.length - 1, 0));
        slider.value = String(at);
        slider.setAttribute("aria-valuetext", select.value);
        element("step-value").textContent = all.length > 1 ? `${at + 1} of ${all.length}` : "";
    };
    const go = (step) => {
        const all = series();
        if (!all[step] || all[step].name === select.value) return undefined;
        select.value = all[step].name;
        select.dispatchEvent(new Event("change"));
        return shown();
    };
    const dress = () => {
        button.replaceChildren(icon(isPlaying ? "pause" : "play"));
        button.title = button.ariaLabel = isPlaying ? "Pause" : "Play the series";
    };
    async function play() {
        while (isPlaying) {
            const from = performance.now();
            await go((Number(slider.value) + 1) % series().length);
            await new Promise((resolve) => setTimeout(resolve, Math.max(0, pause - (performance.now() - from))));
        }
    }
    slider.addEventListener("input", () => go(Number(slider.value)));
    button.addEventListener("click", () => {
        isPlaying = !isPlaying;
        dress();
        if (isPlaying) play();
    });
    select.addEventListener("change", write);
    dress();
    write();
}
