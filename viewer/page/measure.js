// Lengths and areas.
import { say, table } from "./common.js";
import { measured } from "./numbers.js";
import { draw, drawing } from "./drawing.js";
import { coordinates, feature, line, places } from "./map.js";

export function measure(place) {
    const { path } = drawing;
    path.push(place);
    drawing.features = [...(path.length > 2 ? [feature("area", "Polygon", [[...path, path[0]].map((p) => coordinates.toMap(p))])] : []), ...(path.length > 1 ? [line("path", path)] : []), ...places(path)];
    draw();
    if (path.length < 2) return say("Click the next place.");
    const lengths = path.slice(1).map((p, i) => coordinates.distance(path[i], p)), length = lengths.reduce((sum, one) => sum + one, 0);
    const { unit } = coordinates;
    say([table([["Length", measured(length, unit)], ...(path.length > 2 ? [["Last part", measured(lengths.at(-1), unit)], ["Area", measured(coordinates.area(path), unit, 2)],
        ["Perimeter", measured(length + coordinates.distance(path.at(-1), path[0]), unit)]] : [])])]);
}
