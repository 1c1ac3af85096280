// Other meshes of the database over the one of the page: their pictures, the difference from one of them, and the volumes between
// the two.
import * as maplibre from "maplibre-gl";
import { answering, element, made, number, say, table } from "./common.js";
import { comparison } from "./comparison.js";
import { usualDifference, setDifference } from "./difference.js";
import { attribute, coordinates, map, mesh, tileAddress } from "./map.js";
import { measured } from "./numbers.js";
import { ask, request } from "./requests.js";

let changed = () => {};
const about = (one) => ({ ...one, of: `${encodeURIComponent(one.schema)}/${encodeURIComponent(one.name)}`, title: one.schema === "public" ? one.name : `${one.schema}.${one.name}` });

/** The attribute of the other mesh that is compared: the one of the same name, or its first. */
async function attributeOf(of) {
    const { attributes } = await ask("info", { of });
    return (attributes.find(({ name }) => name === attribute()?.name) ?? attributes[0])?.name ?? null;
}

async function choose(others) {
    const other = others.find(({ of }) => of === element("other").value) ?? null, name = other && await attributeOf(other.of);
    comparison.with = null;
    element("volume").disabled = true;
    if (other && (!attribute() || name === null)) {
        element("other").value = "";
        say("Both meshes must have an attribute.", "error");
    } else if (other) {
        const addresses = [{}, { of: other.of, attribute: name }].map((more) => tileAddress("terrain", { outside: "none", exact: "yes", ...more }))
            .map((address) => (z, x, y) => address.replace("{z}", z).replace("{x}", x).replace("{y}", y));
        setDifference({ addresses, most: 1 });
        const [a, b] = [mesh.lower, mesh.upper].map((place) => maplibre.MercatorCoordinate.fromLngLat(coordinates.toMap(place)));
        const most = await usualDifference([a.x, b.y, b.x, a.y]);
        setDifference({ addresses, most: most || 1 });
        Object.assign(comparison, { with: other.of, most: most || 1, name: `${attribute().name} − ${other.title}`, attribute: name, title: other.title });
        element("volume").disabled = false;
        if (most === 0) say("The two meshes do not differ where both are, or have no place in common.");
    }
    changed();
}

/** Cut is where the mesh of the page is above the other. */
async function volumes() {
    const { area, cut, fill, net } = await ask("volume", { of: comparison.with, own: attribute().name, attribute: comparison.attribute });
    const { unit } = coordinates;
    const words = (volume) => volume.toLocaleString("en", { maximumSignificantDigits: 8 });
    say([made("p", { class: "value" }, words(net)), table([["Net volume", words(net)], [`Above ${comparison.title}`, words(cut)], [`Below ${comparison.title}`, words(fill)],
        ["Area in common", coordinates.isGeographic ? number(area) : measured(area, unit, 2)]])]);
}

/** What the other mesh says of a place, for the panel. */
export async function otherAt([x, y], own) {
    if (!comparison.with) return [];
    const { values } = await ask("locate", { x, y, of: comparison.with, attribute: comparison.attribute });
    const value = values.linear ?? null;
    return [[`In ${comparison.title}`, number(value)], ["Difference", value === null || own === null || own === undefined ? "none" : number(own - value)]];
}

/** Offers the other meshes in the plane that lie on the same map; `drawn` is called when others are to be drawn. */
export async function setUpComparison(drawn) {
    if (!mesh.isOneOfMany) return;
    changed = drawn;
    const others = (await request("/api/meshes", {})).map(about).filter((one) => one.kind === "mesh" && one.dimension === 2 && one.simplices > 0 && one.srid === mesh.system && location.pathname !== `/mesh/${one.of}/`);
    element("compare").hidden = others.length === 0;
    element("other").append(...others.map(({ of, title }) => new Option(title, of)));
    element("above").replaceChildren(...others.map(({ of, title }) => {
        const box = made("input", { type: "checkbox" });
        box.addEventListener("change", () => {
            comparison.above = box.checked ? [...comparison.above, of] : comparison.above.filter((one) => one !== of);
            changed();
        });
        return made("label", { class: "check" }, box, ` ${title}`);
    }));
    element("other").addEventListener("change", () => answering(() => choose(others)));
    element("attribute").addEventListener("change", () => comparison.with && answering(() => choose(others)));
    element("opacity").addEventListener("input", changed);
    element("volume").addEventListener("click", () => answering(volumes));
    map.on("refreshed", () => comparison.with && answering(() => choose(others)));
}
