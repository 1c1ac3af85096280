// For the browser: words of the elements of a selector in colours that differ too little from what they are on, a ratio below 4.5 (WCAG AA).
export function contrasts(selector) {
    const numbers = (colour) => colour.match(/[\d.]+/g).map(Number);
    const light = ([r, g, b]) => [r, g, b].map((c) => (c / 255 <= 0.04045 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4)).reduce((sum, c, i) => sum + c * [0.2126, 0.7152, 0.0722][i], 0);
    const ground = (one) => {
        for (; one; one = one.parentElement) {
            const colour = numbers(getComputedStyle(one).backgroundColor);
            if ((colour[3] ?? 1) > 0.9) return colour;
        }
        return null;
    };
    return [...document.querySelectorAll(selector)].filter((one) => one.checkVisibility() && !one.disabled && [...one.childNodes].some((node) => node.nodeType === 3 && node.textContent.trim())).map((one) => {
        const on = ground(one), [a, b] = [light(numbers(getComputedStyle(one).color)), on ? light(on) : NaN].sort((x, y) => y - x);
        return on && (a + 0.05) / (b + 0.05) < 4.5 ? `${one.tagName} ${one.textContent.slice(0, 40)}: ${((a + 0.05) / (b + 0.05)).toFixed(2)}` : null;
    }).filter(Boolean);
}
