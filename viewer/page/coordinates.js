// Places of the mesh and of the map. Coordinates that are not longitude and latitude are put on a part of the map around
// 0, 0 by a shift and a scale: the square `world` is the map of the world.
import * as maplibre from "maplibre-gl";

const half = 20037508.342789244; // of the side of the map of Web Mercator, in metres
const degree = 111_319.49; // metres of longitude at the equator
// Systems in metres: UTM with ETRS89 and WGS 84, Web Mercator, and those of countries that are used most.
const inMetres = (srid) => (srid >= 25828 && srid <= 25838) || (srid >= 32601 && srid <= 32660) || (srid >= 32701 && srid <= 32760) ||
    [2056, 2154, 3035, 3857, 21781, 27700, 28992, 31466, 31467, 31468, 31469].includes(srid);

export class Coordinates {
    constructor({ srid, world, system }) {
        this.world = world ?? (srid === 3857 ? [-half, -half, 2 * half] : null);
        this.isOnEarth = srid !== null;
        this.isGeographic = this.isOnEarth && srid !== 3857;
        /** The unit of lengths; of a mesh in an unknown system there is none. */
        this.unit = this.isOnEarth || inMetres(system) ? "m" : "";
        /** Metres of the map for one unit of height. */
        this.heightScale = this.isOnEarth ? 1 : (2 * half) / this.world[2];
    }

    toMap([x, y]) {
        if (!this.world) return [x, y];
        const [left, bottom, side] = this.world;
        const { lng, lat } = new maplibre.MercatorCoordinate((x - left) / side, 1 - (y - bottom) / side).toLngLat();
        return [lng, lat];
    }

    toMesh({ lng, lat }) {
        if (!this.world) return [lng, lat];
        const [left, bottom, side] = this.world;
        const place = maplibre.MercatorCoordinate.fromLngLat([lng, lat]);
        return [left + place.x * side, bottom + (1 - place.y) * side];
    }

    /** How far apart two places are: metres on the earth, or units of the mesh. */
    distance(a, b) {
        if (!this.isOnEarth) return Math.hypot(b[0] - a[0], b[1] - a[1]);
        return new maplibre.LngLat(...this.toMap(a)).distanceTo(new maplibre.LngLat(...this.toMap(b)));
    }

    /** The area of a polygon: square metres on the earth near its middle, or square units of the mesh. */
    area(places) {
        const map = this.isOnEarth ? places.map((place) => this.toMap(place)) : places;
        const middle = map.reduce((sum, [, lat]) => sum + lat, 0) / map.length;
        const [width, height] = this.isOnEarth ? [degree * Math.cos((middle * Math.PI) / 180), degree] : [1, 1];
        const twice = map.reduce((sum, [x, y], i) => {
            const [nextX, nextY] = map[(i + 1) % map.length];
            return sum + (x - map[0][0]) * (nextY - map[0][1]) - (nextX - map[0][0]) * (y - map[0][1]);
        }, 0);
        return (Math.abs(twice) / 2) * width * height;
    }

    /** The longer side of the mesh, in units of height. */
    extent({ lower, upper }) {
        const scale = this.isGeographic ? degree : 1;
        return Math.max(...upper.map((x, i) => (x - lower[i]) * scale));
    }
}
