// A plane through the box around a mesh: where it lies, and the sheet on which the server draws the section in it.

const dot = (a, b) => a.reduce((sum, x, i) => sum + x * b[i], 0);
const cross = ([ax, ay, az], [bx, by, bz]) => [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx];
const unit = (a) => a.map((x) => x / Math.hypot(...a));

/** The normal of a plane that dips towards a direction, clockwise from y, by an angle from the horizontal; both in degrees. */
export function normalOf(direction, dip) {
    const [a, d] = [direction, dip].map((degrees) => (degrees * Math.PI) / 180);
    return [Math.sin(a) * Math.sin(d), Math.cos(a) * Math.sin(d), Math.cos(d)];
}

/** The least and the greatest distance along a normal of a place in the box. */
export function rangeAlong(normal, lower, upper) {
    const ends = normal.map((x, i) => [x * lower[i], x * upper[i]]);
    return [Math.min, Math.max].map((choose) => ends.reduce((sum, pair) => sum + choose(...pair), 0));
}

/** Where the plane at a distance along its normal cuts the edges of the box. */
function crossings(normal, distance, lower, upper) {
    const corners = Array.from({ length: 8 }, (_, i) => [0, 1, 2].map((k) => (i & (1 << k) ? upper : lower)[k])), found = [];
    corners.forEach((p, i) => [1, 2, 4].filter((k) => !(i & k)).forEach((k) => {
        const q = corners[i | k], [a, b] = [dot(normal, p) - distance, dot(normal, q) - distance];
        if (a === 0) found.push(p);
        if (b === 0) found.push(q);
        if (a * b < 0) found.push(p.map((x, j) => x + (a / (a - b)) * (q[j] - x)));
    }));
    return found;
}

/** The rectangle in the plane that just holds its part in the box, as abacus_draw_section lays it: z upwards on a steep plane, y on a
    flat one, x to the right. Its corners, counterclockwise from the one to the left below, and its sides; null if they do not meet. */
export function sheetOf(normal, distance, lower, upper) {
    const n = unit(normal), places = crossings(normal, distance, lower, upper);
    if (places.length < 3) return null;
    const towards = Math.abs(n[2]) > Math.hypot(n[0], n[1]) ? [0, 1, 0] : [0, 0, 1];
    const up = unit(towards.map((x, i) => x - dot(towards, n) * n[i]));
    let right = cross(up, n);
    if (right[0] < 0 || (right[0] === 0 && right[1] < 0)) right = right.map((x) => -x);
    const [u, v] = [right, up].map((axis) => places.map((p) => dot(axis, p)));
    const [left, far, low, high] = [Math.min(...u), Math.max(...u), Math.min(...v), Math.max(...v)];
    const base = n.map((x) => x * (distance / Math.hypot(...normal)));
    const at = (a, b) => base.map((x, i) => x + a * right[i] + b * up[i]);
    return { corners: [at(left, low), at(far, low), at(far, high), at(left, high)], width: far - left, height: high - low };
}
