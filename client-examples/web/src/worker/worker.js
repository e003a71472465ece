// All that takes long with points happens here, off the thread that draws and answers the user.
import { cloud_buffers, make_cloud } from './cloud.js';
import { distances_in_order, distances_to, nearest_seeds } from './distances.js';
import { read_draco } from './draco.js';
import { read_fields } from './fields.js';
import { estimate_surface } from './normals.js';
import { read_ply } from './ply.js';
import { make_sample } from './samples.js';

async function read_cloud(file, maxPoints) {
    const magic = await file.slice(0, 5).text();
    if (magic === 'DRACO') return read_draco(file, maxPoints);
    if (magic.startsWith('ply')) return read_ply(file, maxPoints);
    throw new Error('This file is neither PLY nor Draco. Its first bytes would be "ply" or "DRACO".');
}

async function download({ url, headers }) {
    const response = await fetch(url, { headers });
    if (!response.ok) throw new Error(`${url} was answered with status ${response.status}.`);
    return response;
}

/** x, y, z of every pattern point and atom as one array each. */
function pack_dictionary(json) {
    return {
        patternPoints: Float32Array.from(json.patternPoints.flat()),
        atoms: json.atoms.map((atom) => Float32Array.from(atom.flat())),
        usage: json.usage,
        pattern: json.pattern,
        radius: json.radius,
    };
}

const methods = {
    read_cloud,
    async fetch_cloud(request, maxPoints) {
        return read_cloud(await (await download(request)).blob(), maxPoints);
    },
    async fetch_fields(request) {
        return read_fields(await (await download(request)).blob());
    },
    async fetch_dictionary(request) {
        return pack_dictionary(await (await download(request)).json());
    },
    make_sample(name) {
        const { file, reference } = make_sample(name);
        return { file, reference: make_cloud(reference) };
    },
    distances_to,
    distances_in_order,
    nearest_seeds,
    estimate_surface,
};

function buffers_of(result) {
    if (result?.positions) return cloud_buffers(result);
    return ArrayBuffer.isView(result) ? [result.buffer] : [];
}

onmessage = async ({ data: { id, method, args } }) => {
    try {
        const result = await methods[method](...args);
        postMessage({ id, result }, buffers_of(result));
    } catch (error) {
        postMessage({ id, error: error.message });
    }
};
