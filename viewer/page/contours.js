// The interval of contours: one that was chosen, or one for each zoom.
import { niceBelow } from "./numbers.js";

const lines = 9; // over the range of a mesh that is as large as the screen
const finer = 0.75; // of a zoom: the ground has less relief in half of the width, but more than half
const index = 5; // each fifth contour is thicker, and has its height

export class Intervals {
    /** `zoom`: that of the whole mesh; `chosen`: an interval, or 0. */
    constructor({ least, greatest }, zoom, chosen) {
        Object.assign(this, { range: greatest - least || 1, zoom, chosen });
    }

    at(zoom) {
        return this.chosen || niceBelow((this.range / lines) * 2 ** (-finer * Math.max(0, zoom - Math.floor(this.zoom))));
    }

    /** An expression of MapLibre for the interval at the zoom of a tile. */
    expression() {
        const zooms = Array.from({ length: 23 }, (_, zoom) => zoom).filter((zoom) => zoom > 0 && this.at(zoom) !== this.at(zoom - 1));
        return zooms.length ? ["step", ["zoom"], this.at(0), ...zooms.flatMap((zoom) => [zoom, this.at(zoom)])] : this.at(0);
    }

    isIndex() {
        return ["==", ["%", ["abs", ["round", ["/", ["get", "value"], this.expression()]]], index], 0];
    }

    /** Intervals to choose from: 1, 2 or 5 times a power of ten. */
    choices() {
        const found = [];
        for (let most = this.range / 4; found.length < 9; most = found.at(-1) * 0.99) found.push(niceBelow(most));
        return found;
    }
}
