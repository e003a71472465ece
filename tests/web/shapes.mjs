// What the tests send: made here, the same every time.

/** Random numbers from 0 to 1 (a linear congruential generator). */
function random_numbers(seed) {
    let state = seed >>> 0;
    return () => {
        state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
        return state / 2 ** 32;
    };
}

/** A noisy sphere with colours and intensity, as binary PLY. */
export function sphere_ply(points, noise = 0.02) {
    const random = random_numbers(1);
    const header = `ply\nformat binary_little_endian 1.0\nelement vertex ${points}\n` +
        'property float x\nproperty float y\nproperty float z\nproperty uchar red\n' +
        'property uchar green\nproperty uchar blue\nproperty float intensity\nend_header\n';
    const body = Buffer.alloc(points * 19);
    for (let i = 0; i < points; ++i) {
        const z = 2 * random() - 1;
        const angle = 2 * Math.PI * random();
        const r = 1 + noise * (random() + random() + random() - 1.5);
        const flat = Math.sqrt(1 - z * z);
        const place = [r * flat * Math.cos(angle), r * flat * Math.sin(angle), r * z];
        place.forEach((value, c) => body.writeFloatLE(value, i * 19 + 4 * c));
        for (let c = 0; c < 3; ++c) body[i * 19 + 12 + c] = Math.round(127 + 127 * place[c] / r);
        body.writeFloatLE((z + 1) / 2, i * 19 + 15);
    }
    return Buffer.concat([Buffer.from(header), body]);
}

/** A file that says it is PLY, and holds less than it claims. */
export function broken_ply() {
    return Buffer.from('ply\nformat ascii 1.0\nelement vertex 1000\nproperty float x\n' +
        'property float y\nproperty float z\nend_header\n0 0 0\n');
}
