// Numbers in words: rounded, with units, and round ones.

const digits = (step) => Math.max(0, Math.min(12, -Math.floor(Math.log10(step) + 1e-9)));

/** A number with as many digits as differ within `step`, and thousands apart. */
export const rounded = (x, step) => (x === null || x === undefined ? "–" : x.toLocaleString("en", { minimumFractionDigits: digits(step), maximumFractionDigits: digits(step) }));

/** A number with the digits that count where a thousandth of `extent` does. */
export const plain = (x, extent) => (extent > 0 ? Number(x.toFixed(digits(extent / 1000))) : x);

/** A length or an area in words: 1,250 m, 12.5 km. */
export function measured(x, unit, power = 1) {
    const kilo = 1000 ** power;
    const [value, name] = unit === "m" && Math.abs(x) >= 10 * kilo ? [x / kilo, "km"] : [x, unit];
    const text = value === 0 ? "0" : value.toLocaleString("en", { maximumSignificantDigits: Math.abs(value) >= 1000 ? 6 : 4 });
    return `${text}${name ? ` ${name}` : ""}${name && power === 2 ? "²" : ""}`;
}

/** The greatest of 1, 2 or 5 times a power of ten that is at most `most`. */
export function niceBelow(most) {
    const power = 10 ** Math.floor(Math.log10(most));
    return Number(([5, 2, 1].find((digit) => digit * power <= most * (1 + 1e-9)) * power).toPrecision(1));
}
