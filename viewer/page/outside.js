// What is outside of the border of a mesh, as polygons.

const twiceArea = (ring) => ring.reduce((sum, [x, y], i) => {
    const [nextX, nextY] = ring[(i + 1) % ring.length], [left, bottom] = ring[0];
    return sum + (x - left) * (nextY - bottom) - (nextX - left) * (y - bottom);
}, 0);

const contains = (ring, [x, y]) => ring.reduce((is, [fromX, fromY], i) => {
    const [toX, toY] = ring[(i + 1) % ring.length];
    return (fromY > y) !== (toY > y) && x < fromX + ((y - fromY) / (toY - fromY)) * (toX - fromX) ? !is : is;
}, false);

/** Polygons that are the world but for the mesh, which is to the left of each ring: one that goes counterclockwise is around
    a part of the mesh, the others are around holes, in which there may be parts again. */
export function outside(world, rings) {
    const holes = rings.filter((ring) => twiceArea(ring) < 0).sort((a, b) => twiceArea(b) - twiceArea(a));
    const polygons = [world, ...holes].map((ring) => [ring]);
    for (const ring of rings.filter((one) => twiceArea(one) > 0)) {
        const middle = [0, 1].map((axis) => (ring[0][axis] + ring[1][axis]) / 2); // of an edge: no corner, where rings may touch
        polygons[holes.findIndex((hole) => contains(hole, middle)) + 1].push(ring);
    }
    return polygons;
}
