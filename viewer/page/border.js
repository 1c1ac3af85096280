// Heights beyond the border of a mesh, for relief and terrain: those of the nearest place of the border. So the ground goes
// on evenly there, and has neither a wall nor steps at the seams of tiles.

export const side = 256; // pixels of a tile
const squares = 32; // of a tile: at their corners heights beyond the border are calculated

/** Rings of [x, y, height] as segments: x, y, height and dx, dy, dheight of each. */
export const segments = (rings) => Float64Array.from(rings.flatMap((ring) => ring.flatMap(([x, y, height], i) => {
    const [toX, toY, toHeight] = ring[(i + 1) % ring.length];
    return [x, y, height, toX - x, toY - y, toHeight - height];
})));

/** The height of the border nearest to a place of the map. */
function nearestHeight(border, x, y) {
    let best = Infinity, height = NaN;
    for (let i = 0; i < border.length; i += 6) {
        const fromX = x - border[i], fromY = y - border[i + 1], dx = border[i + 3], dy = border[i + 4], length = dx * dx + dy * dy;
        const share = length === 0 ? 0 : Math.min(Math.max((fromX * dx + fromY * dy) / length, 0), 1);
        const apart = (fromX - share * dx) ** 2 + (fromY - share * dy) ** 2;
        if (apart < best) {
            best = apart;
            height = border[i + 2] + share * border[i + 5];
        }
    }
    return height;
}

/** Fills what is NaN in a tile, between the corners of squares that tiles share at their seams. */
export function filled(heights, z, x, y, border) {
    if (!border || !heights.some(Number.isNaN)) return heights;
    const row = squares + 1, corners = new Float64Array(row * row), result = heights.slice();
    for (let i = 0; i < corners.length; ++i)
        corners[i] = nearestHeight(border, (x + (i % row) / squares) / 2 ** z, (y + Math.floor(i / row) / squares) / 2 ** z);
    for (let i = 0; i < result.length; ++i) {
        if (!Number.isNaN(result[i])) continue;
        const across = (((i % side) + 0.5) * squares) / side, down = ((Math.floor(i / side) + 0.5) * squares) / side;
        const at = Math.floor(down) * row + Math.floor(across), share = across % 1;
        const above = corners[at] + (corners[at + 1] - corners[at]) * share, below = corners[at + row] + (corners[at + row + 1] - corners[at + row]) * share;
        result[i] = above + (below - above) * (down % 1);
    }
    return result;
}
