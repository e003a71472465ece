// Scans that the page simulates, so that one can try the service without having a scan. Each is a
// function of two random numbers: a place on the shape, and a number from 0 to 1 for its paint.

const TAU = 2 * Math.PI;

function cube_face(u, v, face) {
    const [a, b] = [2 * u - 1, 2 * v - 1];
    const side = face % 2 ? 1 : -1;
    return [[side, a, b], [a, side, b], [a, b, side]][face >> 1];
}

/** A wire that rises from one upper corner of the cube and comes down at the opposite one. */
function wire(u) {
    const along = 2 * u - 1;
    const bow = 0.35 * Math.sin(TAU * u);
    return [along + bow * 0.7, along - bow * 0.7, 1 + 1.1 * Math.sin(Math.PI * u)];
}

function cube_with_wire(random) {
    if (random() < 0.05) {
        const u = random();
        return { place: wire(u), paint: u };
    }
    const place = cube_face(random(), random(), Math.floor(random() * 6));
    return { place, paint: (place[2] + 1) / 2 };
}

function sphere_with_border(random) {
    const z = 1 - 1.55 * random();
    const angle = TAU * random();
    const r = Math.sqrt(1 - z * z);
    const paint = 0.5 + 0.5 * Math.sin(5 * angle + 6 * z);
    return { place: [r * Math.cos(angle), r * Math.sin(angle), z], paint };
}

function sinusoid(random) {
    const [x, y] = [2.6 * random() - 1.3, 2.6 * random() - 1.3];
    const z = 0.22 * Math.sin(4.2 * x) * Math.cos(3.4 * y);
    return { place: [x, y, z], paint: 0.5 + z / 0.44 };
}

function knot(random) {
    const t = TAU * random();
    const s = TAU * random();
    const core = (a) => [Math.cos(2 * a) * (2 + Math.cos(3 * a)), Math.sin(2 * a) * (2 + Math.cos(3 * a)),
        Math.sin(3 * a)].map((v) => v * 0.42);
    const unit = (v) => v.map((x) => x / Math.hypot(...v));
    const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0]];
    const p = core(t);
    const ahead = core(t + 0.001);
    const tangent = unit(ahead.map((v, c) => v - p[c]));
    const side = unit(cross(tangent, [0, 0, 1]));
    const up = cross(side, tangent);
    const place = p.map((v, c) => v + 0.2 * (Math.cos(s) * side[c] + Math.sin(s) * up[c]));
    return { place, paint: 0.5 + 0.5 * Math.sin(6 * t) };
}

/** The samples that can be had, in the order in which they are offered. */
export const SAMPLES = {
    cube: { make: cube_with_wire, points: 40_000, noise: 0.02 },
    sphere: { make: sphere_with_border, points: 30_000, noise: 0.018 },
    sinusoid: { make: sinusoid, points: 30_000, noise: 0.02 },
    knot: { make: knot, points: 40_000, noise: 0.016 },
};

/** Mulberry32: the same sample every time. */
export function random_numbers(seed) {
    let state = seed;
    return () => {
        state = (state + 0x6D2B79F5) | 0;
        let t = Math.imul(state ^ (state >>> 15), 1 | state);
        t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
        return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
    };
}

function gauss(random) {
    return Math.sqrt(-2 * Math.log(1 - random())) * Math.cos(TAU * random());
}

/** From deep blue over rose to sand. @returns {number[]} red, green, blue */
export function paint_color(t) {
    const stops = [[46, 74, 138], [198, 92, 120], [244, 204, 138]];
    const at = Math.min(1.999, Math.max(0, t * 2));
    const [from, to] = [stops[Math.floor(at)], stops[Math.floor(at) + 1]];
    return from.map((value, c) => value + (to[c] - value) * (at % 1));
}

/**
 * @param {string} name of SAMPLES
 * @returns {{file: File, reference: Float64Array}} the noisy scan as PLY; places on the true shape
 */
export function make_sample(name) {
    const { make, points, noise } = SAMPLES[name];
    const random = random_numbers(1);
    const header = ['ply', 'format binary_little_endian 1.0', `comment simulated: ${name}`,
        `element vertex ${points}`, ...['x', 'y', 'z'].map((c) => `property float ${c}`),
        ...['red', 'green', 'blue'].map((c) => `property uchar ${c}`), 'property float intensity',
        'end_header', ''].join('\n');
    const stride = 19;
    const view = new DataView(new ArrayBuffer(points * stride));
    for (let i = 0; i < points; ++i) {
        const { place, paint } = make(random);
        place.forEach((v, c) => view.setFloat32(i * stride + 4 * c, v + noise * gauss(random), true));
        paint_color(paint).forEach((v, c) => view.setUint8(i * stride + 12 + c, Math.round(v)));
        view.setFloat32(i * stride + 15, 0.3 + 0.6 * paint + 0.03 * gauss(random), true);
    }
    const reference = new Float64Array(300_000);
    for (let i = 0; i < reference.length; i += 3) reference.set(make(random).place, i);
    return { file: new File([header, view.buffer], `${name}.ply`), reference };
}
