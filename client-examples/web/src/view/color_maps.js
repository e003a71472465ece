/** Stops of colour maps; lightness only rises or only falls along each. */
export const MAPS = {
    heat: ['#1b1140', '#5a1a7c', '#a5307a', '#e2574f', '#fb9f3a', '#fdf3a1'],
    sea: ['#2d2a6e', '#2a5fa0', '#21908c', '#4fbf6b', '#c7dd3b', '#fdf6a8'],
    ember: ['#33415c', '#4c5a78', '#96697f', '#e07a5f', '#f6b25e', '#fff1b8'],
    rust: ['#cfcbc6', '#e3bd8c', '#e08a4c', '#c4452f', '#84123a'],
};

/** Colours of points by the dimension of the shape around them. */
export const DIMENSIONS = [
    { name: 'too few points', color: '#8b93a7' },
    { name: 'curve', color: '#f28e2b' },
    { name: 'surface', color: '#3fa7d6' },
];

/** '#rrggbb' as three bytes */
export function rgb(color) {
    const value = parseInt(color.slice(1), 16);
    return [value >> 16, (value >> 8) & 255, value & 255];
}

/** The map as 256 colours in a row. */
function table(stops) {
    const colors = stops.map(rgb);
    const out = new Uint8Array(256 * 3);
    for (let i = 0; i < 256; ++i) {
        const at = Math.min(colors.length - 1.001, i / 255 * (colors.length - 1));
        const [from, to] = [colors[Math.floor(at)], colors[Math.floor(at) + 1]];
        for (let c = 0; c < 3; ++c) out[i * 3 + c] = from[c] + (to[c] - from[c]) * (at % 1);
    }
    return out;
}

/** @returns {Uint8Array} tints of values between low and high */
export function map_values(values, [low, high], map) {
    const colors = table(MAPS[map]);
    const scale = 255 / (high - low || 1);
    const tints = new Uint8Array(values.length * 3);
    for (let i = 0; i < values.length; ++i) {
        const at = 3 * Math.round(Math.min(255, Math.max(0, (values[i] - low) * scale || 0)));
        tints[i * 3] = colors[at];
        tints[i * 3 + 1] = colors[at + 1];
        tints[i * 3 + 2] = colors[at + 2];
    }
    return tints;
}

/** @returns {Uint8Array} tints of `count` points, `color(i)` being three bytes */
export function tints_of(count, color) {
    const tints = new Uint8Array(count * 3);
    for (let i = 0; i < count; ++i) {
        const [r, g, b] = color(i);
        tints[i * 3] = r;
        tints[i * 3 + 1] = g;
        tints[i * 3 + 2] = b;
    }
    return tints;
}
