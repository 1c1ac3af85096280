// The palettes of the server's pictures (src/draw/palette.cpp; a test compares them), for legends. Between two colours it
// mixes as the server does, in Oklab.
const palettes = {
    terrain: ["#24564f", "#3f7a58", "#75a065", "#b0bf78", "#dfd193", "#dcb888", "#cfa58d", "#e3d2c8", "#ffffff"],
    strata: ["#fdf3c4", "#f8d384", "#f0a65f", "#de775a", "#bb5772", "#8f5290", "#6a5ba0", "#5076a8", "#5a9bb0"],
    viridis: ["#440154", "#472d7b", "#3b528b", "#2c728e", "#21908c", "#27ad81", "#5dc863", "#aadc32", "#fde725"],
    magma: ["#000004", "#1d1147", "#51127c", "#822681", "#b63679", "#e65164", "#fb8861", "#fec287", "#fcfdbf"],
    cividis: ["#00204d", "#00336f", "#39486b", "#575c6d", "#707173", "#8a8779", "#a69d75", "#c4b56c", "#e4cf5b", "#ffea46"],
    grey: ["#121212", "#f6f6f6"],
    diverging: ["#1d3a70", "#2f69a8", "#6fa3cf", "#b9d3e6", "#f5f4f2", "#f0c9b4", "#df8e6c", "#bb4a3c", "#7a1b2c"],
    space: ["#f2e6b1", "#f0a35e", "#c8443c", "#6b2a6e", "#22306b"], // of meshes in space, which the page colours itself
};

export const stops = (name) => palettes[name] ?? palettes.terrain;

/** Draws a palette from left to right over a canvas. */
export function drawPalette(canvas, name) {
    const context = canvas.getContext("2d"), colours = stops(name), { width, height } = canvas;
    for (let x = 0; x < width; ++x) {
        const place = (x / (width - 1)) * (colours.length - 1), before = Math.min(Math.floor(place), colours.length - 2);
        context.fillStyle = `color-mix(in oklab, ${colours[before + 1]} ${100 * (place - before)}%, ${colours[before]})`;
        context.fillRect(x, 0, 1, height);
    }
}
