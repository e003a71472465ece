import { DRACOLoader } from 'three/examples/jsm/loaders/DRACOLoader.js';
import { make_cloud } from './cloud.js';

const loader = new DRACOLoader().setWorkerLimit(1);

/** Every step-th item of an attribute, its values made by `value`. */
function pick(attribute, Type, count, step, value) {
    const out = new Type(count * 3);
    const getters = ['getX', 'getY', 'getZ'];
    for (let i = 0; i < count; ++i) {
        for (let c = 0; c < 3; ++c) out[i * 3 + c] = value(attribute[getters[c]](i * step));
    }
    return out;
}

/** Bytes come as 0 to 1 or as 0 to 255, as the file marks them or forgets to. */
function color_scale(values) {
    return values.some((value) => value > 1) ? 1 : 255;
}

/**
 * Decodes a Draco file for drawing, thinned to at most maxPoints.
 * @param {Blob} file
 * @param {number} maxPoints
 * @returns {Promise<import('./cloud.js').Cloud>}
 */
export async function read_draco(file, maxPoints) {
    const buffer = await file.arrayBuffer();
    const geometry = await new Promise((resolve, reject) => {
        const fail = (error) => reject(new Error(
            `This Draco file cannot be decoded: ${error?.error ?? error?.message ?? 'it is damaged'}.`));
        // Colours as they are in the file: the page draws without conversions.
        loader.decodeDracoFile(buffer, resolve, null, null, undefined, fail);
    });
    const { position, color } = geometry.attributes;
    const total = position.count;
    const step = Math.max(1, Math.ceil(total / maxPoints));
    const count = Math.ceil(total / step);
    const points = pick(position, Float64Array, count, step, (v) => v);
    const scale = color && color_scale(color.array);
    const colors = color && pick(color, Uint8Array, count, step, (v) => Math.round(v * scale));
    const index = step === 1 && geometry.index ? new Uint32Array(geometry.index.array) : undefined;
    return make_cloud(points, { total, colors, index });
}
