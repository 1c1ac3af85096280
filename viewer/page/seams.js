// Tiles of heights have a border of one pixel, which MapLibre fills from their neighbours once. When tiles are read again, one
// may be filled from a neighbour that is about to be replaced, and the new neighbour not at all: a line at the seam. So each
// tile that arrives is to be filled anew, and its neighbours from it.
const names = ["shade", "heights"];

function fillAnew(source) {
    const load = source.loadTile.bind(source), loaded = new Map();
    source.loadTile = async (tile) => {
        await load(tile);
        if (!tile.dem) return;
        loaded.set(tile.tileID.key, tile);
        tile.neighboringTiles = source._getNeighboringTiles(tile.tileID);
        for (const key of Object.keys(tile.neighboringTiles)) {
            const mine = loaded.get(key)?.neighboringTiles?.[tile.tileID.key];
            if (mine) mine.backfilled = false;
        }
    };
    const unload = source.unloadTile.bind(source);
    source.unloadTile = (tile) => {
        if (loaded.get(tile.tileID.key) === tile) loaded.delete(tile.tileID.key);
        return unload(tile);
    };
}

export function avoidSeams(map) {
    const known = new WeakSet();
    map.on("sourcedataloading", () => {
        for (const source of names.map((name) => map.getSource(name)).filter((one) => one && !known.has(one))) {
            known.add(source);
            fillAnew(source);
        }
    });
}
