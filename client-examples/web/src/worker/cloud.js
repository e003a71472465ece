/**
 * What the page draws. Positions are Float32 and relative to `origin`, which is exact, so that
 * geographic coordinates of millions of metres lose nothing.
 * @typedef {object} Cloud
 * @property {number} total points that the whole shape has
 * @property {number} count points that are here; fewer than total in a sample
 * @property {number[]} origin
 * @property {Float32Array} positions
 * @property {Uint8Array} [colors] red, green and blue of each point
 * @property {Object<string, Float32Array>} attributes
 * @property {Uint32Array} [index] corners of triangles
 */

/** Middle of the bounding box of xyz triples. */
function middle(points) {
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < points.length; ++i) {
        const c = i % 3;
        if (points[i] < low[c]) low[c] = points[i];
        if (points[i] > high[c]) high[c] = points[i];
    }
    return low.map((value, c) => (Number.isFinite(value) ? (value + high[c]) / 2 : 0));
}

/**
 * @param {Float64Array|Float32Array} points xyz triples
 * @param {object} rest the other members of the cloud
 * @returns {Cloud}
 */
export function make_cloud(points, rest = {}) {
    const origin = middle(points);
    const positions = new Float32Array(points.length);
    for (let i = 0; i < points.length; ++i) positions[i] = points[i] - origin[i % 3];
    const count = points.length / 3;
    return { total: count, count, origin, positions, attributes: {}, ...rest };
}

/** The buffers of a cloud that can be handed over instead of copied. */
export function cloud_buffers(cloud) {
    const arrays = [cloud.positions, cloud.colors, cloud.index, ...Object.values(cloud.attributes)];
    return arrays.filter(Boolean).map((array) => array.buffer);
}
