// The regions of a mesh: all are tinted on request, and one can be shown alone.
import { answering, counted, element } from "./common.js";
import { map, refresh } from "./map.js";
import { ask } from "./requests.js";

/** What requests about a place say, so that the answer has its region. */
export const withRegion = () => (Number(element("view").dataset.regions) > 0 ? { regions: "yes" } : {});

/** Offers the regions, if the mesh has any; if the role may not read them, says so. */
async function read() {
    const row = element("regions-row"), label = row.querySelector("span"), select = element("within"), chosen = select.value;
    let names = [];
    try {
        names = (await ask("regions")).map(({ region }) => region);
        row.hidden = names.length === 0;
        label.textContent = `Tints of ${counted(names.length, "region")}`;
    } catch (error) {
        row.hidden = false;
        label.textContent = `Names of regions cannot be shown: ${error.message}`;
    }
    select.replaceChildren(new Option("whole mesh", ""), ...names.map((name) => new Option(name, name)));
    select.value = names.includes(chosen) ? chosen : "";
    element("within-row").hidden = names.length === 0;
    element("view").dataset.regions = names.length;
}

export function setUpRegions() {
    element("within").addEventListener("change", () => answering(refresh));
    map.on("refreshed", read);
    return read();
}
