/** What the map compares: the meshes that are drawn above, and the one whose difference is shown, as SCHEMA/NAME, each encoded. */
export const comparison = { above: [], with: null, most: 0, name: "", attribute: null, title: "" };
